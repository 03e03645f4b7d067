"""A strip of a job made by hand, cut across the middle of one of its fins into two parts."""

from __future__ import annotations

import copy

import shapely

from tiny_job import KERF, Path2, TinyJob, offset, placed

BESIDE = 10.0  # mm by which the second part is moved away from the first
FAR = 1e3


def spliced(job: TinyJob, name: str, k: int, gap: float = 0.0) -> TinyJob:
    """Cuts the strip in its k-th fin; a gap is missing from the first part."""
    parts, placements = job.manifest["parts"], job.manifest["sheets"][0]["placements"]
    at = next(place for place, part in enumerate(parts) if part["id"] == name)
    whole = parts.pop(at)
    place = next(place for place in placements if place["part"] == name)
    placements.remove(place)
    job.paths = [path for path in job.paths if path[0] == "SHEET" or not _is_on(path, whole, place)]
    runs = [axis["bottom"][0] for axis in whole["strip"]["axes"]]
    cut = (runs[k] + runs[k + 1]) / 2
    nodes = range(len(runs))
    pieces = [_piece(whole, "a", nodes[: k + 1], (-FAR, cut - gap)), _piece(whole, "b", nodes[k + 1 :], (cut, FAR))]
    for shift, piece in zip((0.0, BESIDE), pieces):
        moved = {**place, "part": piece["id"], "x": place["x"] + shift}
        placements.append(moved)
        job.paths.insert(-1, ("CUT_OUTER", placed(offset([(x, y, 0.0) for x, y in piece["outline"]], KERF / 2), moved), True))
    parts[at:at] = pieces
    _renamed(parts, whole, pieces)
    steps = job.manifest["assembly"]
    step = next(step for step, entry in enumerate(steps) if entry["part"] == name)
    steps[step : step + 1] = [{**steps[step], "part": piece["id"]} for piece in pieces]
    job.manifest["assembly"] = [{**entry, "step": step + 1} for step, entry in enumerate(steps)]
    job.manifest["totals"]["parts"] += 1
    return job


def _is_on(path: Path2, part: dict, place: dict) -> bool:
    outline = shapely.Polygon([corner[:2] for corner in placed([(x, y, 0.0) for x, y in part["outline"]], place)]).buffer(KERF)
    return all(outline.contains(shapely.Point(corner[:2])) for corner in path[1])


def _piece(whole: dict, letter: str, inside: range, between: tuple[float, float]) -> dict:
    region = shapely.Polygon(whole["outline"]).intersection(shapely.box(between[0], -FAR, between[1], FAR))
    outline = [[x, y] for x, y in list(shapely.orient_polygons(region).exterior.coords)[:-1]]
    strip, first = whole["strip"], letter == "a"
    nodes, inner = strip["nodes"], range(1, len(strip["nodes"]) - 1)
    at = inside[-1] if first else inside[0] - 1
    cut = {
        "nodes": [nodes[k] for k in inside], "axes": [strip["axes"][k] for k in inside], "closed": False,
        "folds": [strip["folds"][k - 1] for k in inside if k in inner],
        "slits": [slit for slit in copy.deepcopy(strip["slits"]) if slit["node"] in [nodes[k] for k in inside]],
        "splices": [{"fin": [nodes[at], nodes[at + 1]]}],
    }  # fmt: skip
    if "setbacks" in strip:
        cut["setbacks"] = [strip["setbacks"][0], 0.0] if first else [0.0, strip["setbacks"][1]]
    name = whole["id"] + letter
    return {**whole, "id": name, "label": name, "outline": outline, "holes": [], "area": region.area, "strip": cut}


def _renamed(parts: list[dict], whole: dict, pieces: list[dict]) -> None:
    """Slits and connectors name the part that has the node, or the end."""
    for slit in (slit for part in parts if part.get("strip") for slit in part["strip"]["slits"] if slit["partner"] == whole["id"]):
        slit["partner"] = next(piece["id"] for piece in pieces if slit["node"] in piece["strip"]["nodes"])
    for connector in (part["connector"] for part in parts if part.get("connector")):
        for k, slot in enumerate(connector["slots"]):
            if slot["fin"] == whole["id"]:
                slot["fin"] = pieces[0 if slot["to"] == whole["strip"]["nodes"][1] else 1]["id"]
                connector["fins"][k][0] = slot["fin"]
                for plate in connector["copies"]:
                    plate["fins"][k] = slot["fin"]
