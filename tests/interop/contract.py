"""The contract in a checkable form: the names and colours of layers, the keys and types of job.json and structure.json."""

from __future__ import annotations

import re
from typing import Any

LAYERS = ("ENGRAVE", "SCORE", "CUT_INNER", "CUT_OUTER", "SHEET")
DXF_COLOURS = {"CUT_OUTER": 1, "CUT_INNER": 5, "SCORE": 3, "ENGRAVE": 4, "SHEET": 8}
RGB = {"CUT_OUTER": (1, 0, 0), "CUT_INNER": (0, 0, 1), "SCORE": (0, 1, 0), "ENGRAVE": (0, 1, 1)}

NUMBER, COUNT, TEXT, TRUTH, ANY = "number", "count", "text", "true or false", "anything"


class Maybe:
    """May be null."""

    def __init__(self, inner: Any) -> None:
        self.inner = inner


class Optional:
    """The key may be left out, or be null."""

    def __init__(self, inner: Any) -> None:
        self.inner = inner


class Either:
    def __init__(self, *inner: Any) -> None:
        self.inner = inner


class OneOf:
    def __init__(self, *words: Any) -> None:
        self.words = words


class Matching:
    def __init__(self, pattern: str) -> None:
        self.pattern = pattern


class Row:
    """A list with these entries, in this order."""

    def __init__(self, *inner: Any) -> None:
        self.inner = inner


SHA = Matching(r"[0-9a-f]{64}")
POINT = Row(NUMBER, NUMBER)
AXIS = {"node": COUNT, "bottom": POINT, "top": POINT}
STRIP = {
    "nodes": [COUNT],
    "closed": TRUTH,
    "axes": [AXIS],
    "folds": [{"node": COUNT, "angle_deg": NUMBER}],
    "slits": [
        {
            "node": COUNT,
            "from": OneOf("top", "bottom"),
            "width": NUMBER,
            "depth": NUMBER,
            "offset": NUMBER,
            "crossing_deg": NUMBER,
            "partner": TEXT,
        }
    ],
    "splices": [{"fin": Row(COUNT, COUNT)}],
    "setbacks": Optional(Row(NUMBER, NUMBER)),
}
CONNECTOR = {
    "node": COUNT,
    "fins": [Row(TEXT, NUMBER)],
    "slots": [{"fin": TEXT, "to": Optional(COUNT), "angle_deg": NUMBER, "width": NUMBER, "length": NUMBER}],
    "kind": OneOf("hub", "hinge"),
    "radius": NUMBER,
    "hole": NUMBER,
    "thickness": NUMBER,
    "copies": [{"height": NUMBER, "angle_deg": NUMBER, "fins": [TEXT]}],
}
FIN = {"nodes": Row(COUNT, COUNT), "axes": [AXIS], "setbacks": Row(NUMBER, NUMBER)}
HARDWARE = {"kind": TEXT, "diameter": NUMBER, "length": Maybe(NUMBER), "quantity": COUNT, "nodes": [COUNT]}
PART = {
    "id": TEXT,
    "kind": OneOf("strip", "fin", "connector", "coupon"),
    "quantity": COUNT,
    "label": TEXT,
    "outline": [POINT],
    "holes": [[POINT]],
    "area": NUMBER,
    "cut_length": NUMBER,
    "strip": Optional(STRIP),
    "fin": Optional(FIN),
    "shape": Optional(TEXT),
    "connector": Optional(CONNECTOR),
}
JOB = {
    "format": OneOf("finwright-job"),
    "version": OneOf(1),
    "generator": Matching(r"finwright \d+\.\d+\.\d+.*"),
    "input": {"name": Matching(r"[^/\\]+"), "sha256": SHA},
    "template": {"name": Matching(r"[^/\\]+"), "sha256": SHA},
    "seed": COUNT,
    "scale": Either(NUMBER, TEXT),
    "joint": OneOf("lap", "hinge", "hub"),
    "material": {"name": TEXT, "thickness": NUMBER, "kerf": NUMBER, "clearance": NUMBER},
    "sheet_stock": [{"width": NUMBER, "height": NUMBER, "margin": NUMBER, "spacing": NUMBER, "count": Maybe(COUNT)}],
    "verdict": Maybe({}),
    "accepted_flexible": Maybe(TEXT),
    "findings": [{"severity": OneOf("error", "warning", "note"), "code": TEXT, "message": TEXT, "help": Maybe(TEXT), "place": Maybe({})}],
    "parts": [PART],
    "sheets": [
        {
            "id": TEXT,
            "width": NUMBER,
            "height": NUMBER,
            "files": {"dxf": TEXT, "svg": TEXT, "png": TEXT},
            "utilisation": NUMBER,
            "placements": [{"part": TEXT, "copy": COUNT, "x": NUMBER, "y": NUMBER, "angle_deg": NUMBER}],
        }
    ],
    "assembly": [{"step": COUNT, "part": TEXT, "copies": Optional(Row(COUNT, COUNT)), "from": Optional(OneOf("above", "below"))}],
    "hardware": Optional([HARDWARE]),
    "totals": {
        "parts": COUNT,
        "sheets": COUNT,
        "cut_length": NUMBER,
        "engrave_length": NUMBER,
        "seconds": NUMBER,
        "mass": NUMBER,
        "cost": Maybe(NUMBER),
    },
}
DEPTH = Either(NUMBER, [NUMBER])
STRUCTURE = {
    "format": OneOf("finwright-structure"),
    "version": OneOf(1),
    "name": TEXT,
    "units": OneOf("mm"),
    "positions": [Row(NUMBER, NUMBER, NUMBER)],
    "axes": [Row(NUMBER, NUMBER, NUMBER)],
    "faces": [[COUNT]],
    "depth": {"below": DEPTH, "above": DEPTH},
    "fins": Optional([Row(COUNT, COUNT)]),
    "strips": Optional([[COUNT]]),
    "fixed": Optional([COUNT]),
}


def mismatches(value: Any, shape: Any, place: str) -> list[str]:
    """Where a JSON value is not of the shape; keys that the shape does not name are welcome."""
    if isinstance(shape, (Maybe, Optional)):
        return [] if value is None else mismatches(value, shape.inner, place)
    if isinstance(shape, Either):
        return [] if any(not mismatches(value, inner, place) for inner in shape.inner) else [f"{place}: {value!r:.60} is none of the kinds allowed"]
    if isinstance(shape, OneOf):
        return [] if value in shape.words else [f"{place}: {value!r:.60} is not one of {shape.words}"]
    if isinstance(shape, Matching):
        return [] if isinstance(value, str) and re.fullmatch(shape.pattern, value) else [f"{place}: {value!r:.80} does not match {shape.pattern}"]
    if isinstance(shape, dict):
        return _object_mismatches(value, shape, place)
    if isinstance(shape, Row):
        if not isinstance(value, list) or len(value) != len(shape.inner):
            return [f"{place}: not a list of {len(shape.inner)}"]
        return [found for i, inner in enumerate(shape.inner) for found in mismatches(value[i], inner, f"{place}[{i}]")]
    if isinstance(shape, list):
        if not isinstance(value, list):
            return [f"{place}: not a list"]
        return [found for i, inner in enumerate(value) for found in mismatches(inner, shape[0], f"{place}[{i}]")]
    return [] if _is_plain(value, shape) else [f"{place}: {value!r:.60} is not a {shape}"]


def _object_mismatches(value: Any, shape: dict, place: str) -> list[str]:
    if not isinstance(value, dict):
        return [f"{place}: not an object"]
    found = []
    for key, inner in shape.items():
        if key in value:
            found += mismatches(value[key], inner, f"{place}.{key}")
        elif not isinstance(inner, Optional):
            found.append(f"{place}: no {key!r}")
    return found


def _is_plain(value: Any, kind: str) -> bool:
    number = isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300
    return {
        NUMBER: number,
        COUNT: number and isinstance(value, int) and value >= 0,
        TEXT: isinstance(value, str),
        TRUTH: isinstance(value, bool),
        ANY: True,
    }[kind]
