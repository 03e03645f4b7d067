"""Plates in space that meet no node axis in common: discs and eye plates against those of other nodes, and against fins they do not hold."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import shapely

from leaves import Leaf
from plates import Connector, Plates
from report import Report

STEP = 1.0  # mm between the points of an edge that are looked at

Array = np.ndarray


@dataclass
class Body:
    """A flat plate placed in space: a region in the plane of the first two directions of its frame."""

    name: str
    nodes: set[int]
    region: shapely.Polygon
    origin: Array
    frame: Array
    thickness: float
    points: Array = field(init=False)

    def __post_init__(self) -> None:
        """Points of all edges at both faces and between."""
        edge = self.region.segmentize(STEP)
        flat = shapely.get_coordinates(edge) @ self.frame[:2]
        levels = [self.origin + side * self.thickness / 2 * self.frame[2] for side in (-1, 0, 1)]
        self.points = np.concatenate([flat + level for level in levels])
        self.low, self.high = self.points.min(axis=0), self.points.max(axis=0)

    def points_inside(self, other: Body) -> int:
        """How many points of another body's edges lie in this one."""
        near = other.points[((other.points > self.low) & (other.points < self.high)).all(axis=1)]
        seen = (near - self.origin) @ self.frame.T
        level = seen[np.abs(seen[:, 2]) < self.thickness / 2]
        return int(shapely.contains_xy(self.region, level[:, 0], level[:, 1]).sum())


def check_bodies(plates: Plates, report: Report) -> None:
    held = [_plate(plates, connector, copy) for connector in plates.all() for copy in range(len(connector.cut))]
    leaves = [_leaf(plates, leaf) for leaf in plates.leaves]
    for name, bodies in (("assembly: neighbours' plates apart", held), ("assembly: plates clear of other fins", leaves)):
        boxes = np.array([[body.low, body.high] for body in bodies])
        for k, plate in enumerate(held):
            near = ((boxes[:, 0] < plate.high) & (plate.low < boxes[:, 1])).all(axis=1)
            near[: k * (bodies is held)] = False  # looked at from the other one already
            others = [bodies[at] for at in np.flatnonzero(near) if not plate.nodes & bodies[at].nodes]
            inside = [(other, plate.points_inside(other) + other.points_inside(plate)) for other in others]
            report.claim(name, [f"{plate.name} and {other.name} ({count} points)" for other, count in inside if count], len(others))


def _plate(plates: Plates, connector: Connector, copy: int) -> Body:
    space, node = plates.job.space, connector.node
    frame = np.array([space.first[node], space.second[node], space.axes[node]])
    origin = space.positions[node] + connector.face(copy, 0.0) * space.axes[node]
    return Body(f"{connector.part}/{copy + 1}", {node}, connector.region(copy, 0.0), origin, frame, connector.thickness)


def _leaf(plates: Plates, leaf: Leaf) -> Body:
    space, node = plates.job.space, leaf.node
    up, away = space.axes[node], space.positions[leaf.other] - space.positions[node]
    out = away - (away @ up) * up
    out /= np.linalg.norm(out)
    frame = np.array([out, up, np.cross(out, up)])
    nodes = {node, leaf.other}
    return Body(f"{leaf.part} fin {sorted(nodes)}", nodes, leaf.region, space.positions[node], frame, plates.job.thickness)
