"""Ends of fins and strips: cut back as far as others at the node ask and the list says, along the fin's own edges between."""

from __future__ import annotations

import numpy as np
import shapely

from job import Job
from leaves import End, far_corners, near_corners, strip_ends
from plates import Plates, least_setback
from report import Report

MEASURED = 1e-3  # mm, a cut contour against what is listed
EDGE = 2e-3  # mm, a fin's edge against the edge of its quad
SHARES = np.linspace(0.05, 0.95, 19)  # of an edge, where it is looked at
BESIDE = 1.0  # mm beyond a cut, with its relief, from where an edge is looked at


def check_listed_setbacks(job: Job, report: Report) -> None:
    """What a strip lists for ends that no disc holds: the distance at the height of the node, none for an overhang or a splice."""
    for strip in job.strips.values():
        if job.parts[strip.id]["strip"].get("setbacks") is None:
            report.claim("slits: setbacks listed", [f"{strip.id} has none"] if job.connected else [])
            continue
        ends = strip_ends(job, strip, strip.outline)
        for end, (_, k, _) in zip(ends, strip.ends()):
            if end.node in job.connected:
                continue
            spans = end.spans(0.0)
            start = max(0.0, spans[0][0]) if spans else float("inf")
            if strip.slit_at(k):  # It runs past its axis, where the slit may be.
                start = 0.0
            report.at_most("slits: setbacks of ends as listed", abs(start - end.setback), MEASURED, f"{strip.id} at node {end.node}")
        at_splices = {0, 1} - {place for place, _, _ in strip.ends()}
        report.claim("slits: setbacks listed", [f"{strip.id}: {strip.setbacks} beside a splice" for place in at_splices if strip.setbacks[place] != 0.0])


def check_end(plates: Plates, end: End, report: Report) -> None:
    """A single fin's end, or a strip's in discs."""
    job, where = plates.job, f"{end.part} at node {end.node}"
    others = [job.space.angle(end.node, other) - job.space.angle(end.node, end.other) for other in job.space.neighbours[end.node] if other != end.other]
    needed = max((least_setback(float(np.degrees(angle)), job.thickness) for angle in others), default=0.0)
    start = end.region.bounds[0]
    report.at_least("fins: setback over the least", start - needed, -MEASURED, where)
    report.at_least("fins: setback listed over the least", end.setback - needed, -MEASURED, where)
    report.at_most("fins: setback as listed", abs(start - end.setback), MEASURED, where)
    apart = shapely.distance(end.region.boundary, shapely.points(_edge_points(plates, end)))
    if len(apart):
        report.at_most("fins: outline along the fin's edges", float(apart.max()), EDGE, where, count=len(apart))


def _edge_points(plates: Plates, end: End) -> np.ndarray:
    """Points of a fin's lower and upper edge in the frame of the end, away from all that is cut at its two axes."""
    near, far = near_corners(plates.job, end.node), far_corners(plates.job, end.node, end.other)
    points = (near + SHARES[:, None, None] * (far - near)).reshape(-1, 2)
    up = (far[1] - far[0]) / np.linalg.norm(far[1] - far[0])
    from_far = (far[0] - points) @ [up[1], -up[0]]
    return points[(points[:, 0] > _cut_to(plates, end)) & (from_far > _cut_at_far(plates, end))]


def _cut_to(plates: Plates, end: End) -> float:
    """How far from the axis notches for rings reach; eye plates stand in the end edge, not in these."""
    radii = [connector.radius for connector in plates.connectors.get(end.node, []) if connector.kind == "hub"]
    return max([end.setback, *radii]) + BESIDE


def _cut_at_far(plates: Plates, end: End) -> float:
    """The same at the other axis of the fin; half the fin is missing where the strip is spliced."""
    other = [e for e in plates.ends.get(end.other, []) if (e.part, e.other) == (end.part, end.node)]
    if other:
        return _cut_to(plates, other[0])
    strip = plates.job.strips[end.part]
    if any(set(fin) == {end.node, end.other} for fin in strip.splices):
        return 2 / 3 * float(np.linalg.norm(plates.job.space.positions[end.other] - plates.job.space.positions[end.node]))
    slits = [slit for slit in strip.slits if slit["node"] == end.other]
    return max((abs(slit["offset"]) + slit["width"] / 2 for slit in slits), default=0.0) + BESIDE
