"""Strokes as straight segments: flattening of arcs and curves, how far two drawings differ, what is drawn twice."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import acos, atan, ceil, pi, sqrt

import numpy as np
import shapely

Array = np.ndarray

SAGITTA = 0.0005  # mm, how far a flattened arc may leave the true one
SAMPLE = 0.5  # mm, between the points at which two drawings are compared where their vertices differ


@dataclass
class Stroke:
    """One drawn path; the points of a closed one are not repeated."""

    points: Array
    closed: bool

    def segments(self) -> Array:
        ends = np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]
        starts = self.points if self.closed else self.points[:-1]
        return np.hstack([starts, ends])


@dataclass
class Drawing:
    """One sheet as one file shows it, in mm with y up from the lower left corner."""

    width: float | None
    height: float | None
    layers: dict[str, list[Stroke]] = field(default_factory=dict)
    order: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    thickest: float = 0.0

    def add(self, layer: str, points: list, closed: bool) -> None:
        kept = np.asarray(points, dtype=float).reshape(-1, 2)
        if closed and len(kept) > 1 and np.hypot(*(kept[0] - kept[-1])) < 1e-9:
            kept = kept[:-1]
        self.layers.setdefault(layer, []).append(Stroke(kept, closed))
        if not self.order or self.order[-1] != layer:
            self.order.append(layer)

    def segments(self, layer: str) -> Array:
        strokes = self.layers.get(layer, [])
        found = [stroke.segments() for stroke in strokes]
        return np.vstack(found) if found else np.zeros((0, 4))

    def points(self) -> Array:
        found = [stroke.points for strokes in self.layers.values() for stroke in strokes]
        return np.vstack(found) if found else np.zeros((0, 2))


def arc_points(start: Array, end: Array, bulge: float) -> list[Array]:
    """The points after `start` up to and with `end`, along the arc of a DXF bulge (positive: counter-clockwise)."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    chord = end - start
    length = np.hypot(*chord)
    if bulge == 0.0 or length == 0.0:
        return [end]
    centre = (start + end) / 2 + (1 - bulge * bulge) / (4 * bulge) * np.array([-chord[1], chord[0]])
    return [*turned_points(start, centre, 4 * atan(bulge))[:-1], end]


def turned_points(start: Array, centre: Array, angle: float) -> list[Array]:
    """The points after `start` on the circle about `centre`, through `angle` radians."""
    radius = float(np.hypot(*(start - centre)))
    step = 2 * acos(max(0.0, 1 - SAGITTA / radius)) if radius > SAGITTA else pi
    turns = np.arange(1, ceil(abs(angle) / step) + 1) * (angle / ceil(abs(angle) / step))
    x, y = start - centre
    return list(np.column_stack([centre[0] + x * np.cos(turns) - y * np.sin(turns), centre[1] + x * np.sin(turns) + y * np.cos(turns)]))


def bezier_points(p0: Array, p1: Array, p2: Array, p3: Array) -> list[Array]:
    """The points after `p0` along a cubic Bezier curve."""
    bend = max(np.hypot(*(p0 - 2 * p1 + p2)), np.hypot(*(p1 - 2 * p2 + p3)))
    count = max(1, ceil(sqrt(0.75 * bend / SAGITTA)))
    t = (np.arange(1, count + 1) / count)[:, None]
    return list((1 - t) ** 3 * p0 + 3 * t * (1 - t) ** 2 * p1 + 3 * t * t * (1 - t) * p2 + t**3 * p3)


def lines(segments: Array) -> Array:
    return shapely.linestrings(segments.reshape(-1, 2, 2))


def length(segments: Array) -> float:
    return float(np.hypot(segments[:, 2] - segments[:, 0], segments[:, 3] - segments[:, 1]).sum())


def drawn_apart(a: Array, b: Array) -> tuple[float, str]:
    """Hausdorff distance between two sets of segments, both ways, and where it is largest."""
    if len(a) == 0 and len(b) == 0:
        return 0.0, ""
    if len(a) == 0 or len(b) == 0:
        return float("inf"), "drawn in one of them only"
    return max(_one_way(a, b), _one_way(b, a), key=lambda found: found[0])


def _one_way(a: Array, b: Array) -> tuple[float, str]:
    # A segment whose ends lie on the ends of one segment of the other drawing is no farther from it than these ends are.
    nearest = shapely.STRtree(shapely.points((b[:, :2] + b[:, 2:]) / 2)).query_nearest(
        shapely.points((a[:, :2] + a[:, 2:]) / 2), all_matches=False
    )[1]
    twin = b[nearest]
    same = np.maximum(_gap(a[:, :2], twin[:, :2]), _gap(a[:, 2:], twin[:, 2:]))
    swapped = np.maximum(_gap(a[:, :2], twin[:, 2:]), _gap(a[:, 2:], twin[:, :2]))
    bound = np.minimum(same, swapped)
    matched = bound < 0.002
    worst, where = 0.0, ""
    if matched.any():
        at = int(np.argmax(np.where(matched, bound, -1)))
        worst, where = float(bound[at]), _place(a[at, :2])
    rest = a[~matched]
    if len(rest):
        points = _samples(rest)
        _, distances = shapely.STRtree(lines(b)).query_nearest(shapely.points(points), all_matches=False, return_distance=True)
        at = int(np.argmax(distances))
        if distances[at] > worst:
            worst, where = float(distances[at]), _place(points[at])
    return worst, where


def _gap(a: Array, b: Array) -> Array:
    return np.hypot(a[:, 0] - b[:, 0], a[:, 1] - b[:, 1])


def _place(point: Array) -> str:
    return f"({point[0]:.3f}, {point[1]:.3f})"


def _samples(segments: Array) -> Array:
    counts = np.maximum(1, np.ceil(_gap(segments[:, :2], segments[:, 2:]) / SAMPLE)).astype(int) + 1
    which = np.repeat(np.arange(len(segments)), counts)
    t = (np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)) / np.repeat(counts - 1, counts)
    return segments[which, :2] + t[:, None] * (segments[which, 2:] - segments[which, :2])


def drawn_twice(segments: Array, apart: float = 1e-4, shared: float = 1e-3) -> list[str]:
    """Segments that run along each other, closer than `apart` over more than `shared` mm, and segments without length."""
    span = segments[:, 2:] - segments[:, :2]
    size = np.hypot(span[:, 0], span[:, 1])
    found = [f"no length at {_place(segments[i, :2])}" for i in np.flatnonzero(size < 1e-6)]
    segments, span, size = segments[size >= 1e-6], span[size >= 1e-6], size[size >= 1e-6]
    if len(segments) < 2:
        return found
    bars = lines(segments)
    i, j = shapely.STRtree(bars).query(bars)
    keep = (i != j) & ((size[i] > size[j]) | ((size[i] == size[j]) & (i < j)))
    i, j = i[keep], j[keep]
    along = span[i] / size[i][:, None]
    start, end = segments[j, :2] - segments[i, :2], segments[j, 2:] - segments[i, :2]
    t0, t1 = (start * along).sum(1), (end * along).sum(1)
    h0 = along[:, 0] * start[:, 1] - along[:, 1] * start[:, 0]
    h1 = along[:, 0] * end[:, 1] - along[:, 1] * end[:, 0]
    low, high = np.maximum(0, np.minimum(t0, t1)), np.minimum(size[i], np.maximum(t0, t1))
    run = t1 - t0
    slope = np.divide(h1 - h0, run, out=np.zeros_like(run), where=np.abs(run) > 1e-12)
    aside = np.maximum(np.abs(h0 + slope * (low - t0)), np.abs(h0 + slope * (high - t0)))
    # A stroke shorter than `shared` counts when nearly all of it is covered.
    twice = (high - low > np.minimum(shared, 0.9 * size[j])) & (aside < apart)
    return found + [f"{high[k] - low[k]:.4f} mm drawn twice near {_place(segments[j[k], :2])}" for k in np.flatnonzero(twice)]
