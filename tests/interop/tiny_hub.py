"""A small job made by hand: a strip and a ring, opened, whose three ends stand in two discs at one node.

As in `tiny_job.py` all is worked out a second time and more simply: upright axes, windows without reliefs, notches by numbers.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, cos, degrees, hypot, radians, sin

from tiny_job import ABOVE, BELOW, CLEARANCE, KERF, THICKNESS, Corner, Path2, TinyJob, flattened, offset, placed, tiny_job

NODES = [(0.0, 0.0, 0.0), (70.0, 4.0, 5.0), (130.0, -6.0, 2.0), (-30.0, 75.0, 6.0), (-60.0, -50.0, -2.0)]
STRIPS = {"S01": [0, 1, 2], "S02": [0, 3, 4, 0]}
HUB, NAME = 0, "N0"
SPOKES = [("S01", 1), ("S02", 3), ("S02", 4)]  # counter-clockwise, by strip and the node they come from
INNER, LENGTH, RADIUS, HOLE = 8.0, 9.0, 20.2, 3.2
SETBACK, NOTCH = INNER + CLEARANCE / 2, (INNER + LENGTH - 0.05, RADIUS + 0.05)
LEVELS = (-10.5, 12.5)  # middles of the discs; every fin is higher and lower than both as far out as they reach
PLACES = [("S01", 1, 20.0, 40.0), ("S02", 1, 20.0, 100.0), (NAME, 1, 60.0, 200.0), (NAME, 2, 120.0, 200.0)]

Node = tuple[float, float, float]


@dataclass
class Shape:
    """What a planted fault may change of the job before it is drawn."""

    nodes: list[Node] = field(default_factory=lambda: list(NODES))
    setback: float = SETBACK
    floors: tuple[float, float] = (LEVELS[0] + THICKNESS / 2, LEVELS[1] - THICKNESS / 2)
    turned: float = 0.0  # degrees, the second window as it is cut

    def bearing(self, node: int) -> float:
        return degrees(atan2(self.nodes[node][1], self.nodes[node][0]))

    def angle(self, spoke: int) -> float:
        """On the disc, from its first fin."""
        return (self.bearing(SPOKES[spoke][1]) - self.bearing(SPOKES[0][1])) % 360

    def runs(self, name: str) -> list[float]:
        found = [0.0]
        for i, j in zip(STRIPS[name], STRIPS[name][1:]):
            (x, y, _), (to_x, to_y, _) = self.nodes[i], self.nodes[j]
            found.append(found[-1] + hypot(to_x - x, to_y - y))
        return found

    def fold(self, before: int, node: int, after: int) -> float:
        headings = [atan2(self.nodes[j][1] - self.nodes[i][1], self.nodes[j][0] - self.nodes[i][0]) for i, j in ((before, node), (node, after))]
        return -((degrees(headings[1] - headings[0]) + 180) % 360 - 180)


def tiny_hub(shape: Shape | None = None) -> TinyJob:
    shape = shape or Shape()
    job = tiny_job()
    contours = {name: [_outline(shape, name)] for name in STRIPS} | {NAME: _disc(shape)}
    parts = [*(_strip(shape, name, contours[name][0]) for name in STRIPS), _connector(shape, contours[NAME])]
    placements = [{"part": name, "copy": copy, "x": x, "y": y, "angle_deg": 30.0 * (copy - 1)} for name, copy, x, y in PLACES]
    inner: list[Path2] = []
    outer: list[Path2] = []
    for place in placements:
        first, *holes = contours[place["part"]]
        inner += [("CUT_INNER", placed(offset(hole, -KERF / 2), place), True) for hole in holes]
        outer.append(("CUT_OUTER", placed(offset(first, KERF / 2), place), True))
    job.paths = [*inner, *outer, job.paths[-1]]
    job.manifest.update(parts=parts, assembly=_assembly(), hardware=[{"kind": "rod", "diameter": 3.0, "length": 32, "quantity": 1, "nodes": [HUB]}])
    job.manifest["sheets"][0]["placements"] = placements
    job.manifest["totals"]["parts"] = 4
    fins = [[i, j] for nodes in STRIPS.values() for i, j in zip(nodes, nodes[1:])]
    job.structure.update(positions=shape.nodes, axes=[[0, 0, 1]] * 5, faces=[[0, 3, 4]], fins=fins, depth={"below": BELOW, "above": ABOVE}, fixed=[])
    return job


def _assembly() -> list[dict]:
    """Nothing but the discs holds these strips, so the lower one comes first."""
    strips = [{"step": k + 2, "part": name, "from": "above"} for k, name in enumerate(STRIPS)]
    return [{"step": 1, "part": NAME, "copies": [1, 1], "from": "below"}, *strips, {"step": 4, "part": NAME, "copies": [2, 2], "from": "above"}]


def _strip(shape: Shape, name: str, contour: list[Corner]) -> dict:
    nodes, closed = STRIPS[name], STRIPS[name][-1] == HUB
    axes = [{"node": i, "bottom": [x, shape.nodes[i][2] - BELOW], "top": [x, shape.nodes[i][2] + ABOVE]} for i, x in zip(nodes, shape.runs(name))]
    folds = [{"node": i, "angle_deg": shape.fold(before, i, after)} for before, i, after in zip(nodes, nodes[1:], nodes[2:])]
    setbacks = [shape.setback, shape.setback if closed else 0.0]
    strip = {"nodes": nodes, "closed": closed, "axes": axes, "folds": folds, "slits": [], "splices": [], "setbacks": setbacks}
    return _part(name, "strip", [contour]) | {"strip": strip}


def _connector(shape: Shape, contours: list[list[Corner]]) -> dict:
    slots = [
        {"fin": name, "to": to, "angle_deg": shape.angle(k), "width": THICKNESS + CLEARANCE, "length": LENGTH} for k, (name, to) in enumerate(SPOKES)
    ]
    held = [slot["fin"] for slot in slots]
    connector = {
        "node": HUB, "kind": "hub", "radius": RADIUS, "hole": HOLE, "thickness": THICKNESS, "slots": slots,
        "fins": [[slot["fin"], slot["angle_deg"]] for slot in slots],
        "copies": [{"height": height, "angle_deg": 0.0, "fins": list(held)} for height in LEVELS],
    }  # fmt: skip
    return _part(NAME, "connector", contours) | {"quantity": 2, "connector": connector}


def _part(name: str, kind: str, contours: list[list[Corner]]) -> dict:
    outline, *holes = (flattened(contour) for contour in contours)
    area = abs(_area(outline)) - sum(abs(_area(hole)) for hole in holes)
    return {"id": name, "kind": kind, "quantity": 1, "label": name, "outline": outline, "holes": holes, "area": area, "cut_length": 1.0}


def _area(points: list[list[float]]) -> float:
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2


def _outline(shape: Shape, name: str) -> list[Corner]:
    """Counter-clockwise: along the bottom and back along the top, with a notch for the ring at each end that is held."""
    nodes, runs = STRIPS[name], shape.runs(name)
    heights = [shape.nodes[i][2] for i in nodes]

    def edge(x: float, side: float) -> tuple[float, float]:
        k = max(k for k in range(len(runs) - 1) if k == 0 or runs[k] <= x)
        return x, heights[k] + (heights[k + 1] - heights[k]) * (x - runs[k]) / (runs[k + 1] - runs[k]) + side

    def along(side: float, floor: float) -> list[Corner]:
        near, far = NOTCH
        first = [edge(shape.setback, side), edge(near, side), (near, floor), (far, floor), edge(far, side)]
        end = runs[-1]
        last = [edge(end - far, side), (end - far, floor), (end - near, floor), edge(end - near, side), edge(end - shape.setback, side)]
        inner = [edge(x, side) for x in runs[1:-1]]
        return [(x, y, 0.0) for x, y in (*first, *inner, *(last if nodes[-1] == HUB else [edge(end, side)]))]

    return [*along(-BELOW, shape.floors[0]), *reversed(along(ABOVE, shape.floors[1]))]


def _disc(shape: Shape) -> list[list[Corner]]:
    """Rim, hole for the rod, windows."""
    half = (THICKNESS + CLEARANCE) / 2
    box = [(INNER, -half), (INNER + LENGTH, -half), (INNER + LENGTH, half), (INNER, half)]
    windows = []
    for k in range(len(SPOKES)):
        turn = radians(shape.angle(k) + (shape.turned if k == 1 else 0.0))
        windows.append([(x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn), 0.0) for x, y in box])
    return [_circle(RADIUS), _circle(HOLE / 2), *windows]


def _circle(radius: float) -> list[Corner]:
    return [(radius, 0.0, 1.0), (-radius, 0.0, 1.0)]
