"""The structure in space: axis segments, fins, the angles between fins, the folds of a strip."""

from __future__ import annotations

from math import atan2, degrees, pi

import numpy as np

Array = np.ndarray


class Space:
    """structure.json, with the quantities that the flat parts are measured against."""

    def __init__(self, structure: dict) -> None:
        self.positions = np.array(structure["positions"], float)
        axes = np.array(structure["axes"], float)
        self.axes = axes / np.linalg.norm(axes, axis=1)[:, None]
        self.bottoms = self.positions - _per_node(structure["depth"]["below"], len(axes)) * self.axes
        self.tops = self.positions + _per_node(structure["depth"]["above"], len(axes)) * self.axes
        self.fins = _fins(structure)
        self.neighbours: dict[int, list[int]] = {}
        for i, j in self.fins:
            self.neighbours.setdefault(i, []).append(j)
            self.neighbours.setdefault(j, []).append(i)
        # Two directions across each axis; the second is a quarter turn counter-clockwise seen from the `above` end.
        least = np.eye(3)[np.argmin(np.abs(self.axes), axis=1)]
        first = np.cross(self.axes, least)
        self.first = first / np.linalg.norm(first, axis=1)[:, None]
        self.second = np.cross(self.axes, self.first)

    def segment_length(self, node: int) -> float:
        return float(np.linalg.norm(self.tops[node] - self.bottoms[node]))

    def angle(self, node: int, other: int) -> float:
        """Direction of the fin towards `other`, in radians about the axis, counter-clockwise seen from above."""
        run = self.positions[other] - self.positions[node]
        return atan2(float(run @ self.second[node]), float(run @ self.first[node]))

    def fold(self, before: int, node: int, after: int) -> float:
        """Degrees by which the fin after the node turns toward the labelled face, whose normal is travel x axis."""
        # Travel x axis lies to the right of the travel seen from above, so a turn to the right is positive.
        turned = self.angle(node, after) - (self.angle(node, before) + pi)
        return degrees(-((turned + pi) % (2 * pi) - pi))


def _per_node(depth: float | list[float], count: int) -> Array:
    return np.broadcast_to(np.asarray(depth, float), (count,))[:, None]


def _fins(structure: dict) -> list[tuple[int, int]]:
    given = structure.get("fins")
    if given is None:
        given = [(face[k - 1], face[k]) for face in structure["faces"] for k in range(len(face))]
    return sorted({(min(i, j), max(i, j)) for i, j in given})
