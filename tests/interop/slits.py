"""Slits: as listed against what thickness, angles and clearance ask, and as measured in the outline against the list."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from math import cos, degrees, pi, sin

import numpy as np
import shapely

from job import Job, Strip
from report import Report

FORMULA = 1e-4  # mm, listed width and offset against the formula
ANGLE = 1e-4  # degrees
MEASURED = 1e-3  # mm, the outline against the list
REACH = 1e-6  # mm, by which two slits may fail to meet
REACH_MORE = 4.0  # mm, by which they may reach past each other
WALL = 1e-4  # mm, how straight a wall is

Array = np.ndarray
Place = tuple[Strip, int]  # a strip and which of its nodes is meant


class Node:
    """All that stands at one node axis: directions of fins and of overhanging ends, and the strips through it."""

    def __init__(self, job: Job, node: int, places: list[Place]) -> None:
        self.job, self.node, self.places = job, node, places
        self.arms = [job.space.angle(node, other) for other in job.space.neighbours.get(node, [])]
        for strip, k in places:
            if strip.slit_at(k) and None in strip.sides(k):
                self.arms.append(self._overhang(strip, k))

    def _overhang(self, strip: Strip, k: int) -> float:
        before, after = strip.sides(k)
        return self.job.space.angle(self.node, before if after is None else after) + pi

    def directions(self, strip: Strip, k: int) -> tuple[float, float]:
        """Of the strip's two arms, backward and forward; past its end the fin goes straight on."""
        before, after = strip.sides(k)
        back = self._overhang(strip, k) if before is None else self.job.space.angle(self.node, before)
        on = self._overhang(strip, k) if after is None else self.job.space.angle(self.node, after)
        return back, on

    def kink(self, strip: Strip, k: int) -> float:
        back, on = self.directions(strip, k)
        return abs((on - back) % (2 * pi) - pi)

    def reach(self, direction: float, arms: Sequence[float] | None = None) -> float:
        """How far from the axis an arm is free of its two neighbours among these arms, or among all that stand there."""
        gaps = sorted((other - direction) % (2 * pi) for other in (self.arms if arms is None else arms))
        gaps = [gap for gap in gaps if 1e-9 < gap < 2 * pi - 1e-9]
        if not gaps:
            return 0.0
        return max(_reach(gaps[0], self.job.thickness), _reach(2 * pi - gaps[-1], self.job.thickness))


def _reach(angle: float, thickness: float) -> float:
    if angle >= pi:
        return 0.0
    return max(0.0, (thickness + thickness * cos(angle)) / (2 * sin(angle)))


def check_slits(job: Job, report: Report) -> None:
    places: dict[int, list[Place]] = {}
    for strip in job.strips.values():
        for k, node in enumerate(strip.nodes):
            places.setdefault(node, []).append((strip, k))
    nodes = {node: Node(job, node, at) for node, at in places.items()}
    unheld = [finding["place"] for finding in job.manifest["findings"] if finding["code"] == "parts::strip_end_unheld"]
    for node in nodes.values():
        for strip, k in node.places:
            if slit := strip.slit_at(k):
                _check_listed(job, node, strip, k, slit, report)
                _check_outline(strip, k, slit, report)
        if node.node in job.connected:
            _check_in_discs(node, report)
        else:
            _check_node(node, [place for place in unheld if node.node in place["nodes"]], report)
    for strip in job.strips.values():
        for end in strip.ends():
            if not strip.slit_at(end[1]):
                _check_set_back(nodes[strip.nodes[end[1]]], strip, end, report)
        at = Counter(slit["node"] for slit in strip.slits)
        inner = strip.nodes[:-1] if strip.closed else strip.nodes
        found = [f"{strip.id}: {n} slits at node {node}" for node, n in at.items() if n > inner.count(node)]
        report.claim("slits: one on each strip at a node", found)
    _check_assembly(job, report)


def _check_listed(job: Job, node: Node, strip: Strip, k: int, slit: dict, report: Report) -> None:
    where = f"{strip.id} node {node.node}"
    partner = next(((s, m) for s, m in node.places if s.id == slit["partner"] and (s, m) != (strip, k) and s.slit_at(m)), None)
    if partner is None or partner[0].slit_at(partner[1])["partner"] != strip.id:
        report.claim("slits: partners", [f"{where}: {slit['partner']} has no slit for it there"])
        return
    other = partner[0].slit_at(partner[1])
    report.claim("slits: partners", [f"{where}: both open at the {slit['from']}"] if other["from"] == slit["from"] else [])
    back, on = node.directions(strip, k)
    least = job.thickness / (2 * cos(node.kink(*partner) / 2))
    # Only the partner comes into the slit; a third strip's end is set back from both.
    received = node.directions(*partner)
    half_back, half_on = max(least, node.reach(back, received)), max(least, node.reach(on, received))
    report.at_most("slits: width by formula", abs(slit["width"] - (half_back + half_on + job.clearance)), FORMULA, where)
    report.at_most("slits: offset by formula", abs(slit["offset"] - (half_on - half_back) / 2), FORMULA, where)
    arms = sorted(angle % (2 * pi) for angle in (back, on, *node.directions(*partner)))
    sector = min((b - a) % (2 * pi) for a, b in zip(arms, arms[1:] + arms[:1]))
    report.at_most("slits: crossing angle", abs(slit["crossing_deg"] - degrees(sector)), ANGLE, where, "degrees")
    beyond = slit["depth"] + other["depth"] - job.space.segment_length(node.node)
    report.at_least("slits: a pair reaches through", beyond, -REACH, where)
    report.at_most("slits: a pair reaches no farther", beyond, REACH_MORE, where)


def _check_outline(strip: Strip, k: int, slit: dict, report: Report) -> None:
    """Measures the slit in the outline, in a frame at the axis end it opens at: depth into the part, aside to the next node."""
    where = f"{strip.id} node {strip.nodes[k]} from the {slit['from']}"
    bottom, top = strip.bottoms[k], strip.tops[k]
    up = (top - bottom) / np.linalg.norm(top - bottom)
    aside = np.array([up[1], -up[0]])
    mouth, into = (top, -up) if slit["from"] == "top" else (bottom, up)
    ring = (np.asarray(strip.outline.exterior.coords)[:-1] - mouth) @ np.column_stack([into, aside])
    found = next(filter(None, (_gap(ring, share * slit["depth"], slit["offset"]) for share in (0.95, 0.8, 0.5))), None)
    if found is None:
        report.at_most("slits: width in the outline", float("inf"), MEASURED, f"{where}: no gap")
        return
    station, low, high = found
    report.at_most("slits: width in the outline", abs(high - low - slit["width"]), MEASURED, where)
    report.at_most("slits: offset in the outline", abs((low + high) / 2 - slit["offset"]), MEASURED, where)
    end = min(_wall_end(ring, side, station) for side in (low, high))
    report.at_most("slits: depth in the outline", abs(end - slit["depth"]), MEASURED, where)
    low, high = slit["offset"] - slit["width"] / 2, slit["offset"] + slit["width"] / 2
    corners = ((-1, low), (-1, high), (slit["depth"], high), (slit["depth"], low))
    slot = shapely.Polygon([mouth + d * into + a * aside for d, a in corners]).buffer(-MEASURED, join_style="mitre")
    report.claim("slits: free to the mouth", [f"{where}: material in the way"] if strip.outline.intersects(slot) else [])


def _gap(ring: Array, station: float, middle: float) -> tuple[float, float, float] | None:
    """The free interval around `middle` on the line across the slit at a depth; the depth first."""
    ends = np.roll(ring, -1, axis=0)
    cross = (ring[:, 0] < station) != (ends[:, 0] < station)
    a, b = ring[cross], ends[cross]
    met = np.sort(a[:, 1] + (station - a[:, 0]) / (b[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1]))
    at = int(np.searchsorted(met, middle))
    # Every crossing of the outline leads in or out, so a point with an even count on its left is free.
    return (station, float(met[at - 1]), float(met[at])) if 0 < at < len(met) and at % 2 == 0 else None


def _wall_end(ring: Array, side: float, station: float) -> float:
    """How deep the outline runs straight along the side of a slit, from a depth where it is known to."""
    ends = np.roll(ring, -1, axis=0)
    on = (np.abs(ring[:, 1] - side) < WALL) & (np.abs(ends[:, 1] - side) < WALL)
    low, high = np.minimum(ring[on, 0], ends[on, 0]), np.maximum(ring[on, 0], ends[on, 0])
    end = station
    for start, stop in sorted(zip(low, high)):
        if start <= end + WALL:
            end = max(end, float(stop))
    return end


def _check_set_back(node: Node, strip: Strip, end: tuple[int, int, int], report: Report) -> None:
    """An end that is not lapped stops short of whatever else meets at the axis."""
    place, k, before = end
    reach = node.reach(node.job.space.angle(node.node, before))
    if reach <= MEASURED or len(node.job.space.neighbours[node.node]) < 2:
        return
    bottom, top = strip.bottoms[k], strip.tops[k]
    up = (top - bottom) / np.linalg.norm(top - bottom)
    inward = np.array([up[1], -up[0]]) * (1 if place == 0 else -1)
    zone = shapely.Polygon([bottom - reach * inward, bottom + (reach - MEASURED) * inward, top + (reach - MEASURED) * inward, top - reach * inward])
    report.claim("slits: other ends set back", [f"{strip.id} reaches into node {node.node}"] if strip.outline.intersects(zone) else [])


def _check_in_discs(node: Node, report: Report) -> None:
    """Where discs stand, every strip ends, and none has a slit."""
    through = [strip.id for strip, k in node.places if None not in strip.sides(k)]
    lapped = [strip.id for strip, k in node.places if strip.slit_at(k)]
    problems = [f"node {node.node}: {name} goes through its discs" for name in through]
    report.claim("slits: every strip ends at discs", problems + [f"node {node.node}: {name} has a slit for discs" for name in lapped])


def _check_node(node: Node, unheld: list[dict], report: Report) -> None:
    lapped = [(strip, k) for strip, k in node.places if strip.slit_at(k)]
    through = [(strip, k) for strip, k in node.places if None not in strip.sides(k)]
    found = []
    if len(lapped) == 2:
        openings = sorted(strip.slit_at(k)["from"] for strip, k in lapped)
        found = [] if openings == ["bottom", "top"] else [f"node {node.node}: slits open at {openings}"]
    elif len(lapped) % 2:
        found = [f"node {node.node}: {len(lapped)} strips with a slit"]
    report.claim("slits: one top and one bottom", found)
    bare = [strip.id for strip, k in through if not strip.slit_at(k)]
    meets = len({strip.id for strip, _ in node.places}) > 1
    problems = [f"node {node.node}: {name} goes through without a slit" for name in bare] if len(through) > 1 else []
    loose = [strip.id for strip, k in node.places if None in strip.sides(k) and not strip.slit_at(k)]
    if meets and len(loose) > len(unheld):
        problems.append(f"node {node.node}: ends of {loose} are not held, said so by {len(unheld)} parts::strip_end_unheld")
    report.claim("slits: strips that meet are held", problems)


def _check_assembly(job: Job, report: Report) -> None:
    """Strips go in from above in the order of the steps: of two that cross, the earlier is open at the top."""
    step: dict[str, int] = {}
    for entry in job.manifest["assembly"]:
        step.setdefault(entry["part"], entry["step"])
    found = [f"{entry['part']} is no part" for entry in job.manifest["assembly"] if entry["part"] not in job.parts]
    found += [f"{name} is in no step" for name in job.strips if name not in step]
    steps = [entry["step"] for entry in job.manifest["assembly"]]
    if steps != sorted(steps) or (steps and steps[0] != 1):
        found.append("steps do not rise from 1")
    for strip in job.strips.values():
        for slit in strip.slits:
            mine, other = step.get(strip.id), step.get(slit["partner"])
            if mine is None or other is None:
                continue
            if mine == other or (mine < other) != (slit["from"] == "top"):
                found.append(f"{strip.id} (step {mine}) is open at the {slit['from']} for {slit['partner']} (step {other})")
    report.claim("assembly: earlier strips open at the top", found, len(step))
