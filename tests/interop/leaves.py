"""Fins of flat parts, single or in strips, as seen from a node axis: x from the axis into the fin, y up the axis from the node."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from job import Job, Strip

FAR = 1e4  # mm, farther than any part
ROOM = 2.0  # mm around a fin of a strip that are looked at with it

Array = np.ndarray
Span = tuple[float, float]  # from and to, by the distance from the node axis


@dataclass
class Leaf:
    """The fin from `node` to `other`, in the frame of the axis of `node`."""

    part: str
    node: int
    other: int
    region: shapely.Polygon

    def spans(self, height: float) -> list[Span]:
        """Where the plane across the axis at this height cuts the fin; it contains the axis, so this is exact."""
        cut = self.region.intersection(shapely.LineString([(-FAR, height), (FAR, height)]))
        return sorted((piece.bounds[0], piece.bounds[2]) for piece in pieces_of(cut) if piece.length > 0)


@dataclass
class End(Leaf):
    """A leaf whose part ends at the axis, with the setback that is listed for it."""

    setback: float


def fin_ends(job: Job, part: dict, region: shapely.Polygon) -> list[End]:
    """Both ends of a single fin."""
    axes = part["fin"]["axes"]
    ends = []
    for k, (axis, other) in enumerate((axes, axes[::-1])):
        turned = _turned(job, region, (axis["node"], axis["bottom"], axis["top"]), k)
        ends.append(End(part["id"], axis["node"], other["node"], turned, part["fin"]["setbacks"][k]))
    return ends


def strip_ends(job: Job, strip: Strip, region: shapely.Polygon) -> list[End]:
    """The ends of a strip at node axes, each with its last fin alone."""
    ends = []
    for place, k, other in strip.ends():
        ends.append(End(strip.id, strip.nodes[k], other, _fin_of(job, strip, (k, place, other), region, ROOM), strip.setbacks[place]))
    return ends


def strip_leaves(job: Job, strip: Strip, region: shapely.Polygon) -> list[Leaf]:
    """All fins of a strip, each from its first node; a half beside a splice from the node it has."""
    last = len(strip.nodes) - 1
    seen = [(k, 0, strip.nodes[k + 1]) for k in range(last)]
    seen += [(k, place, other) for k, place in ((0, 1), (last, 0)) if (other := strip.across_splice(at_start=place == 1)) is not None]
    return [Leaf(strip.id, strip.nodes[k], other, _fin_of(job, strip, (k, place, other), region, 0.0)) for k, place, other in seen]


def far_corners(job: Job, node: int, other: int) -> Array:
    """Bottom and top of the other axis of a fin, from space, in the frame of its node."""
    away = np.array([job.space.bottoms[other], job.space.tops[other]]) - job.space.positions[node]
    heights = away @ job.space.axes[node]
    return np.column_stack([np.sqrt(np.maximum(0.0, (away * away).sum(axis=1) - heights**2)), heights])


def near_corners(job: Job, node: int) -> Array:
    """Bottom and top of a node axis in its own frame."""
    ends = np.array([job.space.bottoms[node], job.space.tops[node]]) - job.space.positions[node]
    return np.column_stack([np.zeros(2), ends @ job.space.axes[node]])


def _fin_of(job: Job, strip: Strip, fin: tuple[int, int, int], region: shapely.Polygon, behind: float) -> shapely.Polygon:
    """A strip in the frame of its k-th axis, looking on (place 0) or back (1), without its other fins, but with what is just behind the axis."""
    k, place, other = fin
    turned = _turned(job, region, (strip.nodes[k], strip.bottoms[k], strip.tops[k]), place)
    (low, high), (far_low, far_high) = near_corners(job, strip.nodes[k]), far_corners(job, strip.nodes[k], other)
    up = (far_high - far_low) / np.linalg.norm(far_high - far_low)
    return turned.intersection(shapely.Polygon([low - [behind, ROOM], far_low - ROOM * up, far_high + ROOM * up, high + [-behind, ROOM]]))


def _turned(job: Job, region: shapely.Polygon, axis: tuple[int, Array, Array], place: int) -> shapely.Polygon:
    """A part in the frame of one of its axes; the fin lies after the axis (place 0) or before it (1)."""
    node, bottom, top = axis[0], np.array(axis[1], float), np.array(axis[2], float)
    up = (top - bottom) / np.linalg.norm(top - bottom)
    inward = np.array([up[1], -up[0]]) * (1 if place == 0 else -1)
    foot = bottom + up * np.linalg.norm(job.space.positions[node] - job.space.bottoms[node])
    frame = np.column_stack([inward, up])
    return shapely.transform(region, lambda points: (points - foot) @ frame)


def pieces_of(shape: shapely.Geometry) -> list[shapely.Geometry]:
    return list(getattr(shape, "geoms", [shape]))
