"""Connectors and the ends of fins and strips that stand in them, as the DXF cuts them."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np
import shapely
from shapely import affinity

from cut import cut_regions
from job import Job
from leaves import End, Leaf, fin_ends, pieces_of, strip_ends, strip_leaves

NONE = 1e-3  # mm, a length that rounding makes


@dataclass
class Connector:
    """The plates of one node. Angles are in degrees on the part."""

    part: str
    node: int
    kind: str
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
    """All connectors by their nodes, all single fins and the held ends of strips by the nodes they end at."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.cut = cut_regions(job)
        self.ends: dict[int, list[End]] = {}
        self.leaves: list[Leaf] = []
        self.connectors: dict[int, list[Connector]] = {}
        for part in job.parts.values():
            if part.get("connector"):
                connector = self._connector(part)
                self.connectors.setdefault(connector.node, []).append(connector)
        for part in job.parts.values():
            if part.get("fin"):
                ends = fin_ends(job, part, self.cut[part["id"], 1])
                self._add(ends, ends[:1])
        for strip in job.strips.values():
            region = self.cut[strip.id, 1]
            self._add([end for end in strip_ends(job, strip, region) if end.node in self.connectors], strip_leaves(job, strip, region))

    def _add(self, ends: list[End], leaves: list[Leaf]) -> None:
        self.leaves += leaves
        for end in ends:
            self.ends.setdefault(end.node, []).append(end)

    def direction(self, end: End) -> float:
        """Of a fin about its node in space, degrees."""
        return float(np.degrees(self.job.space.angle(end.node, end.other)))

    def end_in(self, connector: Connector, slot: dict) -> End:
        return next(end for end in self.ends[connector.node] if (end.part, end.other) == (slot["fin"], slot["to"]))

    def all(self) -> list[Connector]:
        return [connector for at in self.connectors.values() for connector in at]

    def _connector(self, part: dict) -> Connector:
        listed = part["connector"]
        slots = [{**slot, "to": to} for slot, (_, to) in zip(listed["slots"], self.job.slot_ends(listed))]
        start = float(np.degrees(self.job.space.angle(listed["node"], slots[0]["to"]))) - slots[0]["angle_deg"]
        cut = [self.cut[part["id"], copy + 1] for copy in range(part["quantity"])]
        return Connector(
            part["id"], listed["node"], listed["kind"], slots, listed["copies"],
            listed["thickness"], listed["hole"], listed["radius"], cut, start,
        )  # fmt: skip


def least_setback(angle: float, thickness: float) -> float:
    """Distance from the axis at which a fin clears another at this angle, in degrees: (t + t cos b) / (2 sin b)."""
    b = radians(min(angle % 360, -angle % 360))
    return max(0.0, (thickness + thickness * cos(b)) / (2 * sin(b))) if 0 < b < pi - 1e-12 else 0.0


def slot_along(region: shapely.Polygon) -> tuple[float, float] | None:
    """From and to of the slot that the x axis meets after the hole for the rod; it may be open outward."""
    reach = float(region.bounds[2])
    free = shapely.LineString([(0, 0), (reach, 0)]).difference(region)
    pieces = sorted(piece.bounds for piece in pieces_of(free) if piece.length > NONE)
    return (pieces[1][0], pieces[1][2]) if len(pieces) > 1 else None
