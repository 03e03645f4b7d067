"""A small job made by hand: three by three nodes with upright axes, six kinked strips, one sheet in all formats.

It stands for a correct maker. Everything is worked out here a second time and more simply than in the checks: upright
axes unfold to plan lengths and heights, and parts are polygons with arcs whose offset is taken corner by corner.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from math import acos, atan, atan2, cos, degrees, hypot, pi, radians, sin, tan
from pathlib import Path
from typing import Callable

import ezdxf
import pymupdf

THICKNESS, KERF, CLEARANCE = 3.0, 0.2, 0.1
WIDTH, HEIGHT, MARGIN, SPACING = 400.0, 300.0, 5.0, 2.0
BELOW, ABOVE, OVERHANG, HOLE = 14.0, 16.0, 9.0, 3.0
NODES = [
    (0.0, 0.0, 0.0), (62.0, 5.0, 4.0), (121.0, -2.0, 1.0),
    (-4.0, 58.0, 3.0), (58.0, 66.0, 9.0), (124.0, 61.0, 2.0),
    (2.0, 122.0, 0.0), (63.0, 119.0, 5.0), (118.0, 125.0, -1.0),
]  # fmt: skip
STRIPS = {
    "S01": [0, 1, 2], "S02": [3, 4, 5], "S03": [6, 7, 8],
    "S04": [0, 3, 6], "S05": [1, 4, 7], "S06": [2, 5, 8],
}  # fmt: skip
PLACES = {
    "S01": (20.0, 30.0, 0.0), "S02": (170.0, 80.0, 180.0), "S03": (20.0, 120.0, 0.0),
    "S04": (20.0, 165.0, 0.0), "S05": (20.0, 210.0, 0.0), "S06": (300.0, 20.0, 83.0),
}  # fmt: skip
COLOURS = {"ENGRAVE": (4, (0, 1, 1)), "SCORE": (3, (0, 1, 0)), "CUT_INNER": (5, (0, 0, 1)), "CUT_OUTER": (1, (1, 0, 0)), "SHEET": (8, (0.5,) * 3)}

Corner = tuple[float, float, float]  # x, y and the bulge of the edge that leaves it
Path2 = tuple[str, list[Corner], bool]  # layer, corners, closed
Places = dict[str, tuple[float, float, float]]
Reshape = Callable[[str, list[Corner]], list[Corner]]


@dataclass
class TinyJob:
    """The job before it is written; a planted fault changes it, or one of the texts when they are written."""

    manifest: dict
    structure: dict
    paths: list[Path2]
    dxf_scale: float = 1.0
    dxf_paths: list[Path2] | None = None
    svg_paths: list[Path2] | None = None
    pdf_paths: list[Path2] | None = None
    after: list[Callable[[Path], None]] = field(default_factory=list)

    def write(self, folder: Path) -> None:
        sheets = folder / "sheets"
        sheets.mkdir(parents=True)
        (folder / "job.json").write_text(json.dumps(self.manifest))
        (folder / "structure.json").write_text(json.dumps(self.structure))
        (folder / "report.html").write_text("<!doctype html><title>tiny</title>")
        (folder / "parts.csv").write_text("id,kind\n" + "".join(f"{part['id']},strip\n" for part in self.manifest["parts"]))
        _write_dxf(sheets / "sheet-01.dxf", self.dxf_paths or self.paths, self.dxf_scale)
        (sheets / "sheet-01.svg").write_text(_svg(self.svg_paths or self.paths))
        _write_pdf(sheets / "sheets.pdf", sheets / "sheet-01.png", self.pdf_paths or self.paths)
        for change in self.after:
            change(folder)


def tiny_job(reshape: Reshape | None = None, places: Places | None = None, kerf: float = KERF, hole_kerf: float = KERF) -> TinyJob:
    """The job; the arguments plant faults that all files then agree on."""
    contours = {name: reshape(name, _outline(name)) if reshape else _outline(name) for name in STRIPS}
    holes = {name: _hole(name) for name in STRIPS}
    parts = [_part(name, contours[name], holes[name]) for name in STRIPS]
    spots = {**PLACES, **(places or {})}
    placements = [{"part": name, "copy": 1, "x": x, "y": y, "angle_deg": turn} for name, (x, y, turn) in spots.items()]
    paths: list[Path2] = []
    for name, place in zip(STRIPS, placements):
        paths.append(("ENGRAVE", placed(_label(name), place), False))
        paths.append(("SCORE", placed(_score(name), place), False))
    for name, place in zip(STRIPS, placements):
        paths.append(("CUT_INNER", placed(offset(holes[name], -hole_kerf / 2), place), True))
        paths.append(("CUT_OUTER", placed(offset(contours[name], kerf / 2), place), True))
    paths.sort(key=lambda path: list(COLOURS).index(path[0]))
    paths.append(("SHEET", [(0, 0, 0), (WIDTH, 0, 0), (WIDTH, HEIGHT, 0), (0, HEIGHT, 0)], True))
    return TinyJob(_manifest(parts, placements), _structure(), paths)


def _structure() -> dict:
    faces = [[a, a + 1, a + 4, a + 3] for a in (0, 1, 3, 4)]
    return {
        "format": "finwright-structure", "version": 1, "name": "tiny", "units": "mm",
        "positions": [list(node) for node in NODES], "axes": [[0, 0, 1]] * 9, "faces": faces,
        "depth": {"below": BELOW, "above": [ABOVE] * 9}, "fixed": [0, 2, 6, 8],
    }  # fmt: skip


def _manifest(parts: list[dict], placements: list[dict]) -> dict:
    sheet = {
        "id": "sheet-01", "width": WIDTH, "height": HEIGHT, "utilisation": 0.3, "placements": placements,
        "files": {kind: f"sheets/sheet-01.{kind}" for kind in ("dxf", "svg", "png")},
    }  # fmt: skip
    return {
        "format": "finwright-job", "version": 1, "generator": "finwright 0.1.0",
        "input": {"name": "tiny.json", "sha256": "0" * 64}, "template": {"name": "pmma-cast-3", "sha256": "1" * 64},
        "seed": 1, "scale": "1:1", "joint": "lap",
        "material": {"name": "pmma", "thickness": THICKNESS, "kerf": KERF, "clearance": CLEARANCE},
        "sheet_stock": [{"width": WIDTH, "height": HEIGHT, "margin": MARGIN, "spacing": SPACING, "count": None}],
        "verdict": None, "accepted_flexible": None, "findings": [], "parts": parts, "sheets": [sheet],
        "assembly": [{"step": k + 1, "part": name} for k, name in enumerate(STRIPS)],
        "totals": {"parts": 6, "sheets": 1, "cut_length": 1, "engrave_length": 1, "seconds": 1, "mass": 1, "cost": None},
    }  # fmt: skip


# The plan of one strip: where its nodes come to lie, the angles at its nodes, its slits.


def runs_of(name: str) -> list[float]:
    nodes = [NODES[i] for i in STRIPS[name]]
    first = hypot(nodes[1][0] - nodes[0][0], nodes[1][1] - nodes[0][1])
    return [0.0, first, first + hypot(nodes[2][0] - nodes[1][0], nodes[2][1] - nodes[1][1])]


def _heading(i: int, j: int) -> float:
    return degrees(atan2(NODES[j][1] - NODES[i][1], NODES[j][0] - NODES[i][0]))


def _headings(name: str, node: int) -> tuple[float, float]:
    """Backward and forward from the node; an end runs straight on."""
    nodes = STRIPS[name]
    k = nodes.index(node)
    back = _heading(node, nodes[k - 1]) if k else _heading(node, nodes[1]) + 180
    on = _heading(node, nodes[k + 1]) if k < 2 else back + 180
    return back, on


def _crossing(name: str, node: int) -> str:
    return next(other for other, nodes in STRIPS.items() if node in nodes and other != name)


def _half_width(arm: float, across: tuple[float, float]) -> float:
    kink = abs((across[1] - across[0]) % 360 - 180)
    needed = [THICKNESS / 2 / cos(radians(kink / 2))]
    for other in across:
        between = abs((other - arm + 180) % 360 - 180)
        needed.append(THICKNESS / 2 / tan(radians(between / 2)))
    return max(needed)


def slit_of(name: str, node: int) -> dict:
    other = _crossing(name, node)
    back, on = _headings(name, node)
    across = _headings(other, node)
    half_back, half_on = _half_width(back, across), _half_width(on, across)
    angles = [abs((a - b + 180) % 360 - 180) for a in (back, on) for b in across]
    top = name in list(STRIPS)[:3]
    return {
        "node": node, "from": "top" if top else "bottom", "width": half_back + half_on + CLEARANCE,
        "depth": 15.3 if top else 15.1, "offset": (half_on - half_back) / 2, "crossing_deg": min(angles), "partner": other,
    }  # fmt: skip


def _fold(name: str) -> float:
    back, on = _headings(name, STRIPS[name][1])
    left = (on - back - 180 + 180) % 360 - 180
    return -left  # the labelled face is on the right of the travel, so a turn to the right is positive


def _part(name: str, contour: list[Corner], hole: list[Corner]) -> dict:
    nodes, runs = STRIPS[name], runs_of(name)
    axes = [{"node": i, "bottom": [x, NODES[i][2] - BELOW], "top": [x, NODES[i][2] + ABOVE]} for i, x in zip(nodes, runs)]
    flat, round_hole = flattened(contour), flattened(hole)
    return {
        "id": name, "kind": "strip", "quantity": 1, "label": name, "outline": flat, "holes": [round_hole],
        "area": abs(_area(flat)) - abs(_area(round_hole)), "cut_length": 1.0,
        "strip": {
            "nodes": nodes, "closed": False, "axes": axes, "folds": [{"node": nodes[1], "angle_deg": _fold(name)}],
            "slits": [slit_of(name, node) for node in nodes], "splices": [],
        },
    }  # fmt: skip


def _outline(name: str) -> list[Corner]:
    """Counter-clockwise: along the bottom, back along the top, a round-ended notch at each slit."""
    nodes, runs = STRIPS[name], runs_of(name)
    heights = [NODES[i][2] for i in nodes]
    top = name in list(STRIPS)[:3]

    def edge(x: float, side: float) -> float:
        k = 0 if x < runs[1] else 1
        return heights[k] + (heights[k + 1] - heights[k]) * (x - runs[k]) / (runs[k + 1] - runs[k]) + side

    xs = [-OVERHANG, runs[1], runs[2] + OVERHANG]
    below, above = [(x, edge(x, -BELOW), 0.0) for x in xs], [(x, edge(x, ABOVE), 0.0) for x in reversed(xs)]
    notches: list[Corner] = []
    for k, node in enumerate(nodes):
        slit = slit_of(name, node)
        left, right = runs[k] + slit["offset"] - slit["width"] / 2, runs[k] + slit["offset"] + slit["width"] / 2
        if top:
            end = heights[k] + ABOVE - slit["depth"]
            notches = [(right, edge(right, ABOVE), 0), (right, end, -1.0), (left, end, 0), (left, edge(left, ABOVE), 0), *notches]
        else:
            end = heights[k] - BELOW + slit["depth"]
            notches += [(left, edge(left, -BELOW), 0), (left, end, -1.0), (right, end, 0), (right, edge(right, -BELOW), 0)]
    return [*below, above[0], *notches, above[2]] if top else [below[0], *notches, below[2], *above]


def _hole(name: str) -> list[Corner]:
    x, y = runs_of(name)[1] / 2, _middle_height(name)
    return [(x - HOLE, y, 1.0), (x + HOLE, y, 1.0)]


def _middle_height(name: str) -> float:
    return (NODES[STRIPS[name][0]][2] + NODES[STRIPS[name][1]][2]) / 2


def _label(name: str) -> list[Corner]:
    x, y = runs_of(name)[1] / 2 + 8, _middle_height(name)
    return [(x, y, 0), (x + 2, y + 4, 0), (x + 4, y, 0), (x + 4 + STRIPS[name][0] / 4, y + 3, 0)]


def _score(name: str) -> list[Corner]:
    x, y = runs_of(name)[1] / 2 - 8, _middle_height(name)
    return [(x, y - 3, 0), (x, y + 3, 0)]


# Contours of lines and arcs.


def offset(contour: list[Corner], distance: float) -> list[Corner]:
    """Each corner moved to where its two shifted edges meet; arcs keep their angle. Positive grows a counter-clockwise contour."""
    moved = []
    for k, (x, y, bulge) in enumerate(contour):
        before, after = contour[k - 1], contour[(k + 1) % len(contour)]
        arriving = atan2(y - before[1], x - before[0]) + 2 * atan(before[2])
        leaving = atan2(after[1] - y, after[0] - x) - 2 * atan(bulge)
        middle = arriving + ((leaving - arriving + pi) % (2 * pi) - pi) / 2
        reach = distance / cos(middle - arriving)
        moved.append((x + reach * sin(middle), y - reach * cos(middle), bulge))
    return moved


def flattened(contour: list[Corner], sagitta: float = 0.002) -> list[list[float]]:
    points = []
    for (x, y, bulge), (to_x, to_y, _) in zip(contour, contour[1:] + contour[:1]):
        points.append([x, y])
        if bulge:
            mid_x, mid_y, lift = (x + to_x) / 2, (y + to_y) / 2, (1 - bulge**2) / (4 * bulge)
            centre = mid_x - lift * (to_y - y), mid_y + lift * (to_x - x)
            radius, angle = hypot(x - centre[0], y - centre[1]), 4 * atan(bulge)
            count = int(abs(angle) / (2 * acos(1 - sagitta / radius))) + 1
            first = atan2(y - centre[1], x - centre[0])
            turns = [first + angle * k / count for k in range(1, count)]
            points += [[centre[0] + radius * cos(turn), centre[1] + radius * sin(turn)] for turn in turns]
    return points


def placed(contour: list[Corner], place: dict) -> list[Corner]:
    c, s = cos(radians(place["angle_deg"])), sin(radians(place["angle_deg"]))
    return [(c * x - s * y + place["x"], s * x + c * y + place["y"], bulge) for x, y, bulge in contour]


def _area(points: list[list[float]]) -> float:
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2


# The three formats.


def _write_dxf(path: Path, paths: list[Path2], scale: float) -> None:
    document = ezdxf.new("R2000", units=4)
    document.header["$MEASUREMENT"] = 1
    for layer, (colour, _) in COLOURS.items():
        document.layers.add(layer, color=colour)
    for layer, corners, closed in paths:
        points = [(x * scale, y * scale, bulge) for x, y, bulge in corners]
        document.modelspace().add_lwpolyline(points, format="xyb", close=closed, dxfattribs={"layer": layer})
    document.saveas(path)


def _svg(paths: list[Path2]) -> str:
    rows = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:g}mm" height="{HEIGHT:g}mm" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" fill="none">']
    for layer, (_, rgb) in COLOURS.items():
        colour = "#" + "".join(f"{round(255 * value):02x}" for value in rgb)
        rows.append(f'<g id="{layer}" stroke="{colour}" stroke-width="0.02">')
        rows += [f'<path d="{_d(corners, closed)}"/>' for name, corners, closed in paths if name == layer]
        rows.append("</g>")
    return "\n".join([*rows, "</svg>"])


def _d(corners: list[Corner], closed: bool) -> str:
    words = [f"M{corners[0][0]:.6f},{HEIGHT - corners[0][1]:.6f}"]
    for (x, y, bulge), (to_x, to_y, _) in zip(corners, corners[1:] + corners[:1] if closed else corners[1:]):
        if bulge:
            radius = hypot(to_x - x, to_y - y) * (1 + bulge**2) / (4 * abs(bulge))
            # Counter-clockwise with y up is sweep 0 with y down.
            words.append(f"A{radius:.6f} {radius:.6f} 0 {int(abs(bulge) > 1)} {int(bulge < 0)} {to_x:.6f} {HEIGHT - to_y:.6f}")
        else:
            words.append(f"L{to_x:.6f} {HEIGHT - to_y:.6f}")
    return " ".join(words) + ("Z" if closed else "")


def _write_pdf(path: Path, picture: Path, paths: list[Path2]) -> None:
    point = 72 / 25.4
    with pymupdf.open() as document:
        page = document.new_page(width=WIDTH * point, height=HEIGHT * point)
        for layer, (_, rgb) in COLOURS.items():
            group = document.add_ocg(layer)
            shape = page.new_shape()
            for name, corners, closed in paths:
                if name == layer:
                    points = flattened(corners, 0.0005) if closed else corners
                    shape.draw_polyline([(p[0] * point, (HEIGHT - p[1]) * point) for p in points])
                    shape.finish(width=0.01 * point, color=rgb, closePath=closed, oc=group)
            shape.commit()
        document.save(path)
        page.get_pixmap(dpi=72).save(picture)
