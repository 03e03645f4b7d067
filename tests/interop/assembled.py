"""The digital assembly: sections of fins and plates across each node axis, as the DXF cuts them and the structure places them.

A fin contains its node axis, so in a plane across the axis it is a row of bars of its thickness, exactly.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import shapely
from shapely import affinity

from bodies import check_bodies
from leaves import End, Span
from plates import Connector, Plates, slot_along
from report import Report

TOUCH = 1e-3  # mm, rounding of fins that are planar to 1e-4
SKIN = 0.01  # of a thickness, just inside a face
LEVELS = 9  # planes across an axis at which its fins are compared
ENGAGED = 0.6  # of a slot's length, filled by its fin


def check_assembled(plates: Plates, report: Report) -> None:
    for node, ends in plates.ends.items():
        _check_fins(plates, node, ends, report)
    for connector in plates.all():
        _check_stack(connector, report)
        for copy in range(len(connector.cut)):
            for end in plates.ends[connector.node]:
                _check_seat(plates, connector, copy, end, report)
            if connector.kind == "hub":
                _check_way_in(plates, connector, copy, report)
    check_bodies(plates, report)
    _check_steps(plates, report)
    _check_rods(plates, report)


def _bar(span: Span, thickness: float) -> shapely.Polygon:
    return shapely.box(span[0], -thickness / 2, span[1], thickness / 2)


def _check_fins(plates: Plates, node: int, ends: list[End], report: Report) -> None:
    """Fins of a node, each turned to its direction in space, at several heights."""
    low = min(end.region.bounds[1] for end in ends)
    high = max(end.region.bounds[3] for end in ends)
    for height in np.linspace(low, high, LEVELS + 2)[1:-1]:
        rows = [(end.part, _row(plates, end, float(height))) for end in ends]
        for (a, first), (b, second) in combinations(rows, 2):
            if not first.is_empty and not second.is_empty:
                shared = first.intersection(second).area
                report.at_most("assembly: fins of a node apart", shared, TOUCH, f"{a} and {b} at node {node}, height {height:.1f}", "mm2")


def _row(plates: Plates, end: End, height: float) -> shapely.Geometry:
    bars = shapely.union_all([_bar(span, plates.job.thickness) for span in end.spans(height)])
    return affinity.rotate(bars, plates.direction(end), origin=(0, 0))


def _check_seat(plates: Plates, connector: Connector, copy: int, end: End, report: Report) -> None:
    """One fin at one plate: clear of all its material, and centred in its slot with half the clearance on each side."""
    job, where = plates.job, f"{end.part} in {connector.part}/{copy + 1}"
    region = connector.region(copy, plates.direction(end))
    slot = slot_along(region) if end.part in connector.copies[copy]["fins"] else None
    # A clearance below nothing is a press fit: the fin is thicker than its slot by design.
    thickness = job.thickness + min(0.0, job.clearance)
    for side in (SKIN - 1, 0.0, 1 - SKIN):
        spans = end.spans(connector.face(copy, side))
        shared = sum(region.intersection(_bar(span, thickness)).area for span in spans)
        report.at_most("assembly: fins clear of plates", shared, TOUCH * thickness, where, "mm2")
        if end.part in connector.copies[copy]["fins"]:
            _check_slot(region, slot, spans, (job.thickness, job.clearance, where), report)


def _check_slot(region, slot: Span | None, spans: list[Span], asked: tuple[float, float, str], report: Report) -> None:
    thickness, clearance, where = asked
    inside = [(max(low, slot[0]), min(high, slot[1])) for low, high in spans] if slot else []
    inside = [span for span in inside if span[1] > span[0]]
    filled = sum(high - low for low, high in inside) / (slot[1] - slot[0]) if slot else 0.0
    report.at_least("assembly: fins fill their slots", filled, ENGAGED, where, "of the slot")
    for low, high in inside:
        # The ends of a slot are rounded: its walls are looked at in the middle half.
        quarter = (high - low) / 4
        for y in (-thickness / 2, thickness / 2):
            side = shapely.LineString([(low + quarter, y), (high - quarter, y)])
            air = side.distance(region) if clearance >= 0 else clearance / 2
            report.at_most("assembly: clearance beside fins", abs(air - clearance / 2), TOUCH, where)


def _check_way_in(plates: Plates, connector: Connector, copy: int, report: Report) -> None:
    """A disc is pushed on along the axis: below the lower one and above the upper one nothing stands in its way."""
    lower = copy == 0
    for end in plates.ends[connector.node]:
        region = connector.region(copy, plates.direction(end))
        inner = connector.face(copy, 1 - SKIN if lower else SKIN - 1)
        outer = end.region.bounds[1 if lower else 3]
        for height in np.linspace(inner, outer, LEVELS)[:-1]:
            shared = sum(region.intersection(_bar(span, plates.job.thickness)).area for span in end.spans(float(height)))
            place = f"{end.part} in the way of {connector.part}/{copy + 1} at {height:.1f}"
            report.at_most("assembly: discs go on along the axis", shared, TOUCH * plates.job.thickness, place, "mm2")


def _check_stack(connector: Connector, report: Report) -> None:
    """Plates of one node that lie over each other have room along the axis."""
    heights = [copy["height"] for copy in connector.copies]
    turned = [connector.region(k, connector.start) for k in range(len(connector.cut))]
    for a, b in combinations(range(len(heights)), 2):
        if turned[a].intersection(turned[b]).area > TOUCH:
            gap = abs(heights[a] - heights[b]) - connector.thickness
            report.at_least("assembly: plates apart along the axis", gap, -1e-6, f"{connector.part} {a + 1} and {b + 1}")
    if connector.kind == "hub":
        report.claim("assembly: copies from below", [] if heights == sorted(heights) and len(heights) == 2 else [f"{connector.part}: {heights}"])


def _check_steps(plates: Plates, report: Report) -> None:
    """Each copy in one step, those of a connector before or after what it holds."""
    step: dict[tuple[str, int], int] = {}
    found = []
    for entry in plates.job.manifest["assembly"]:
        first, last = entry.get("copies", [1, 1])
        for copy in range(first, last + 1):
            found += [f"{entry['part']}/{copy} stands in two steps"] * ((entry["part"], copy) in step)
            step[entry["part"], copy] = entry["step"]
    missing = set(plates.cut) ^ set(step)
    found += [f"{part}/{copy} is in no step or no part" for part, copy in sorted(missing)]
    for connector in plates.all() if not missing else ():
        found += _step_problems(plates, connector, step)
    report.claim("assembly: steps of fins and plates", found, len(step))


def _step_problems(plates: Plates, connector: Connector, step: dict[tuple[str, int], int]) -> list[str]:
    """A hub's upper disc goes in last; its lower disc before the fins, or strips, that nothing else holds: those without a slit."""
    ends = [end.part for end in plates.ends[connector.node]]
    held = sorted(step[part, 1] for part in ends)
    first, last = step[connector.part, 1], step[connector.part, len(connector.cut)]
    if connector.kind == "hinge":
        return [f"{connector.part}: its rod goes in before the last fin"] if first < held[-1] else []
    strips = plates.job.strips
    loose = [step[part, 1] for part in ends if part not in strips or not strips[part].slits]
    right = first < min(loose, default=last) and max(first, held[-1]) < last
    return [] if right else [f"{connector.part}: discs at steps {first} and {last}, fins at {held}"]


def _check_rods(plates: Plates, report: Report) -> None:
    """Each connector has one rod, thinner than its hole and as long as its plates need."""
    rods: dict[int, dict] = {}
    found = []
    for entry in plates.job.manifest.get("hardware") or []:
        if entry["kind"] == "rod":
            found += [f"{entry['quantity']} rods for {len(entry['nodes'])} nodes"] * (entry["quantity"] != len(entry["nodes"]))
            found += [f"node {node} has two rods" for node in entry["nodes"] if node in rods]
            rods.update(dict.fromkeys(entry["nodes"], entry))
    found += [f"node {node} has a rod and no connector" for node in sorted(set(rods) - set(plates.connectors))]
    for connector in plates.all():
        rod = rods.get(connector.node)
        span = max(c["height"] for c in connector.copies) - min(c["height"] for c in connector.copies) + connector.thickness
        if rod is None or rod["length"] < span or not rod["diameter"] < connector.hole:
            found.append(f"{connector.part}: {rod and (rod['diameter'], rod['length'])} through {span:.1f} mm and a hole of {connector.hole}")
    report.claim("connectors: rods", found, len(plates.connectors))
