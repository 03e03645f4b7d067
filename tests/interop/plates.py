"""Single fins and connectors as flat plates: their regions as the DXF will cut them, and sections across a node axis."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np
import shapely
from shapely import affinity

from job import Job
from read_dxf import read_dxf
from report import Report
from segments import Drawing
from sheets import with_holes

FAR = 1e4  # mm, farther than any part
NONE = 1e-3  # mm, a length that rounding makes

Array = np.ndarray
Span = tuple[float, float]  # from and to, by the distance from the node axis


@dataclass
class End:
    """A fin seen from the axis of one of its nodes: x from the axis into the fin, y along the axis from the node up."""

    part: str
    node: int
    other: int
    region: shapely.Polygon
    setback: float

    def spans(self, height: float) -> list[Span]:
        """Where the plane across the axis at this height cuts the fin; it contains the axis, so this is exact."""
        cut = self.region.intersection(shapely.LineString([(-FAR, height), (FAR, height)]))
        return sorted((piece.bounds[0], piece.bounds[2]) for piece in pieces_of(cut) if piece.length > 0)


@dataclass
class Connector:
    """The plates of one node. Angles are in degrees on the part."""

    part: str
    node: int
    kind: str
    fins: dict[str, float]
    slots: list[dict]
    copies: list[dict]
    thickness: float
    hole: float
    radius: float
    cut: list[shapely.Polygon]
    start: float  # direction in space of angle 0, degrees

    def region(self, copy: int, direction: float) -> shapely.Polygon:
        """Material of a copy, turned so that this direction of space, in degrees, runs along x."""
        return affinity.rotate(self.cut[copy], self.start + self.copies[copy]["angle_deg"] - direction, origin=(0, 0))

    def face(self, copy: int, side: float) -> float:
        """Height of a face, side -1 or 1, or of a level between them."""
        return self.copies[copy]["height"] + side * self.thickness / 2


class Plates:
    """All single fins by the nodes they end at, all connectors by their nodes."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.cut = cut_regions(job)
        self.ends: dict[int, list[End]] = {}
        self.connectors: dict[int, list[Connector]] = {}
        for part in job.parts.values():
            if part.get("fin"):
                for end in _ends(job, part, self.cut[part["id"], 1]):
                    self.ends.setdefault(end.node, []).append(end)
            if part.get("connector"):
                connector = self._connector(part)
                self.connectors.setdefault(connector.node, []).append(connector)

    def direction(self, end: End) -> float:
        """Of a fin about its node in space, degrees."""
        return float(np.degrees(self.job.space.angle(end.node, end.other)))

    def held(self, connector: Connector) -> dict[str, End]:
        return {end.part: end for end in self.ends.get(connector.node, []) if end.part in connector.fins}

    def all(self) -> list[Connector]:
        return [connector for at in self.connectors.values() for connector in at]

    def _connector(self, part: dict) -> Connector:
        listed = part["connector"]
        node, (first, angle) = listed["node"], listed["fins"][0]
        ends = {end: other for i, j in [self.job.parts[first]["fin"]["nodes"]] for end, other in ((i, j), (j, i))}
        start = float(np.degrees(self.job.space.angle(node, ends[node]))) - angle
        cut = [self.cut[part["id"], copy + 1] for copy in range(part["quantity"])]
        return Connector(
            part["id"], node, listed["kind"], dict(listed["fins"]), listed["slots"], listed["copies"],
            listed["thickness"], listed["hole"], listed["radius"], cut, start,
        )  # fmt: skip


def _ends(job: Job, part: dict, region: shapely.Polygon) -> list[End]:
    axes = part["fin"]["axes"]
    ends = []
    for k, (axis, other) in enumerate((axes, axes[::-1])):
        bottom, top = np.array(axis["bottom"], float), np.array(axis["top"], float)
        up = (top - bottom) / np.linalg.norm(top - bottom)
        inward = np.array([up[1], -up[0]]) * (1 if k == 0 else -1)
        foot = bottom + up * np.linalg.norm(job.space.positions[axis["node"]] - job.space.bottoms[axis["node"]])
        frame = np.column_stack([inward, up])
        turned = shapely.transform(region, lambda points, foot=foot, frame=frame: (points - foot) @ frame)
        ends.append(End(part["id"], axis["node"], other["node"], turned, part["fin"]["setbacks"][k]))
    return ends


def cut_regions(job: Job) -> dict[tuple[str, int], shapely.Polygon]:
    """Each copy of each part in part coordinates, as the drawn lines leave it when the kerf is burnt away."""
    found = {}
    for sheet in job.manifest["sheets"]:
        drawn = _drawn(read_dxf(job.file(sheet["files"]["dxf"]), Report()))
        bounds = shapely.bounds(drawn)
        for place in (place for place in sheet["placements"] if place["part"] in job.parts):
            wanted = np.array(job.placed(place).bounds) + np.array([-1, -1, 1, 1]) * job.kerf / 2
            at = int(np.argmin(np.abs(bounds - wanted).max(axis=1)))
            found[place["part"], place["copy"]] = _taken_back(_without_kerf(drawn[at], job.kerf), place)
    return found


def _drawn(drawing: Drawing) -> Array:
    outers, holes = ([shapely.Polygon(s.points) for s in drawing.layers.get(layer, []) if len(s.points) > 2] for layer in ("CUT_OUTER", "CUT_INNER"))
    return with_holes(np.array(outers), np.array(holes))[0]


def _without_kerf(region: shapely.Polygon, kerf: float) -> shapely.Polygon:
    outer = shapely.Polygon(region.exterior).buffer(-kerf / 2, join_style="mitre")
    holes = [shapely.Polygon(hole).buffer(kerf / 2, join_style="mitre").exterior for hole in region.interiors]
    return shapely.Polygon(outer.exterior, holes)


def _taken_back(region: shapely.Polygon, place: dict) -> shapely.Polygon:
    turn = radians(place["angle_deg"])
    matrix = np.array([[cos(turn), -sin(turn)], [sin(turn), cos(turn)]])
    shift = np.array([place["x"], place["y"]])
    return shapely.transform(region, lambda points: (points - shift) @ matrix)


def least_setback(angle: float, thickness: float) -> float:
    """Distance from the axis at which a fin clears another at this angle, in degrees: (t + t cos b) / (2 sin b)."""
    b = radians(min(angle % 360, -angle % 360))
    return max(0.0, (thickness + thickness * cos(b)) / (2 * sin(b))) if 0 < b < pi - 1e-12 else 0.0


def pieces_of(shape: shapely.Geometry) -> list[shapely.Geometry]:
    return list(getattr(shape, "geoms", [shape]))


def slot_along(region: shapely.Polygon) -> tuple[float, float] | None:
    """From and to of the slot that the x axis meets after the hole for the rod; it may be open outward."""
    reach = float(region.bounds[2])
    free = shapely.LineString([(0, 0), (reach, 0)]).difference(region)
    pieces = sorted(piece.bounds for piece in pieces_of(free) if piece.length > NONE)
    return (pieces[1][0], pieces[1][2]) if len(pieces) > 1 else None
