"""Connectors and what they hold: what job.json lists and what the DXF cuts, against the structure and the thickness."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np
import shapely

from assembled import check_assembled
from job import Job
from leaves import FAR, pieces_of
from plates import Connector, Plates, slot_along
from report import Report
from setbacks import check_end

ANGLE = 0.01  # degrees, a slot against its fin in space
MEASURED = 1e-3  # mm, a cut contour against what is listed
LENGTH = 0.01  # mm, the straight part of a slot's walls; rounding makes it look longer
CONGRUENT = 0.02  # mm, outlines of one shape
DISTINCT = 5e-3  # mm, outlines of two shapes
FLAT = 2e-3  # mm, by which flattened arcs narrow a web
WALL = 1e-5  # mm, how far inside its walls a slot's length is measured


def check_connectors(job: Job, report: Report) -> None:
    if not any(part.get("connector") or part.get("fin") for part in job.parts.values()):
        return
    report.claim("connectors: one set at each node", _set_problems(job), len(job.space.neighbours))
    stray = _stray_fins(job)
    report.claim("connectors: fins they hold", stray)
    _check_shapes(job, report)
    if stray:
        return
    plates = Plates(job)
    for at in plates.ends.values():
        for end in at:
            check_end(plates, end, report)
    for connector in plates.all():
        _check_listed(plates, connector, report)
        _check_web(job, connector, report)
        for copy in range(len(connector.cut)):
            _check_slots(plates, connector, copy, report)
    check_assembled(plates, report)


def _set_problems(job: Job) -> list[str]:
    """A connector where two or more fins meet and one of them is a single fin; strips may hold each other."""
    sets = Counter(part["connector"]["node"] for part in job.parts.values() if part.get("connector"))
    single = {node for part in job.parts.values() if part.get("fin") for node in part["fin"]["nodes"]}
    wanted = {node for node in single if len(job.space.neighbours[node]) > 1}
    found = [f"node {node} has {n} sets" for node, n in sorted(sets.items()) if n != 1]
    found += [f"node {node} has single fins and no connector" for node in sorted(wanted - set(sets))]
    lonely = {node for node in sets if len(job.space.neighbours.get(node, [])) < 2}
    return found + [f"node {node} has a connector and nothing to join" for node in sorted(lonely)]


def _stray_fins(job: Job) -> list[str]:
    """A connector names each end at its node once, in its list, its slots and its copies, and no other."""
    found = []
    for name, part in job.parts.items():
        if not (listed := part.get("connector")):
            continue
        wanted, in_slots = job.ends.get(listed["node"], []), job.slot_ends(listed)
        found += [f"{name}: slots {in_slots} for {wanted}"] * (Counter(in_slots) != Counter(wanted))
        at = Counter(fin for fin, _ in wanted)
        in_list, in_copies = Counter(fin for fin, _ in listed["fins"]), Counter(fin for copy in listed["copies"] for fin in copy["fins"])
        found += [f"{name}: fins {dict(in_list)} for {dict(at)}"] * (in_list != at)
        found += [f"{name}: {fin} is held by {in_copies[fin]} plates at {at[fin]} ends" for fin in at | in_copies if in_copies[fin] != 2 * at[fin]]
        found += [f"{name}: {len(listed['copies'])} copies of {part['quantity']}"] * (len(listed["copies"]) != part["quantity"])
    return found


def _check_shapes(job: Job, report: Report) -> None:
    """Fins of one shape have one outline, their first axes laid on each other, and fins of two shapes have two."""
    shapes: dict[str, list[shapely.Polygon]] = {}
    for part in job.parts.values():
        if part.get("fin"):
            shapes.setdefault(part["shape"], []).append(_laid(job, part))
    for name, outlines in shapes.items():
        worst = max(outlines[0].exterior.hausdorff_distance(other.exterior) for other in outlines)
        report.at_most("fins: one shape, one outline", worst, CONGRUENT, name, count=len(outlines))
    for (a, first), (b, second) in combinations([(name, outlines[0]) for name, outlines in shapes.items()], 2):
        if np.abs(np.subtract(first.bounds, second.bounds)).max() < DISTINCT:
            apart = first.exterior.hausdorff_distance(second.exterior)
            report.at_least("fins: two shapes, two outlines", apart, DISTINCT, f"{a} and {b}")


def _laid(job: Job, part: dict) -> shapely.Polygon:
    axis = part["fin"]["axes"][0]
    bottom, top = np.array(axis["bottom"], float), np.array(axis["top"], float)
    up = (top - bottom) / np.linalg.norm(top - bottom)
    frame = np.column_stack([[up[1], -up[0]], up])
    return shapely.transform(job.regions[part["id"]], lambda points: (points - bottom) @ frame)


def _check_listed(plates: Plates, connector: Connector, report: Report) -> None:
    job, where = plates.job, connector.part
    off = []
    for slot in connector.slots:
        turned = connector.start + slot["angle_deg"] - plates.direction(plates.end_in(connector, slot))
        off.append(abs((turned + 180) % 360 - 180))
        report.at_most("connectors: slot width as thickness asks", abs(slot["width"] - job.thickness - job.clearance), MEASURED, f"{where} {slot['fin']}")
    report.at_most("connectors: slot angles", max(off), ANGLE, where, "degrees", count=len(off))
    order = [slot["angle_deg"] for slot in connector.slots]
    turning = [] if order == sorted(order) and order[0] >= 0 and order[-1] < 360 else [f"{where}: {order}"]
    report.claim("connectors: fins counter-clockwise", turning)


def _check_web(job: Job, connector: Connector, report: Report) -> None:
    """Material between any two cuts, and between cuts and rim, at least as wide as the sheet is thick."""
    for region in connector.cut[:1] if connector.kind == "hub" else connector.cut:
        holes = [shapely.Polygon(hole) for hole in region.interiors]
        if gaps := [a.distance(b) for a, b in combinations(holes, 2)]:
            report.at_least("connectors: web between cuts", min(gaps), job.thickness - FLAT, connector.part, count=len(gaps))
        rim = min(hole.exterior.distance(region.exterior) for hole in holes)
        report.at_least("connectors: web to the rim", rim, job.thickness - FLAT, connector.part, count=len(holes))
        rod = next(hole for hole in holes if hole.contains(shapely.Point(0, 0)))
        off = max(abs(np.array(rod.bounds) - connector.hole / 2 * np.array([-1, -1, 1, 1])))
        report.at_most("connectors: rod hole about the axis", float(off), MEASURED, connector.part)
        reach = float(np.abs(np.hypot(*np.array(region.exterior.coords).T)).max()) if connector.kind == "hub" else -region.bounds[0]
        report.at_most("connectors: radius as listed", abs(reach - connector.radius), MEASURED, connector.part)
    if connector.kind == "hinge":
        _check_cheeks(job, connector, report)


def _check_cheeks(job: Job, connector: Connector, report: Report) -> None:
    """Beside the slot in the tail of an eye plate."""
    for region in connector.cut:
        # Opened by the web, a plate whose cheeks are as wide keeps them; the ends of its tail are rounded.
        half = (job.thickness - MEASURED) / 2
        opened = region.buffer(-half).buffer(half * 1.001)
        lost = max((piece.area for piece in pieces_of(region.difference(opened))), default=0.0)
        report.at_most("connectors: cheeks beside the slot", lost, half * half, connector.part, "mm2 narrower")


def _check_slots(plates: Plates, connector: Connector, copy: int, report: Report) -> None:
    """Each slot as cut in this copy, measured along the direction its fin has in space."""
    for slot in connector.slots:
        if slot["fin"] not in connector.copies[copy]["fins"]:
            continue
        where = f"{connector.part}/{copy + 1} {slot['fin']}"
        region = connector.region(copy, plates.direction(plates.end_in(connector, slot)))
        found = slot_along(region)
        if found is None:
            report.at_most("connectors: slot cut at its angle", float("inf"), ANGLE, where, "degrees")
            continue
        start, end = found
        sides = [_gap(region, start + share * (end - start)) for share in (0.25, 0.5, 0.75)]
        wide = max(abs(high - low - slot["width"]) for low, high in sides)
        far = start + 0.75 * (end - start)
        turned = max(abs(np.degrees(np.arctan2((low + high) / 2, far))) for low, high in sides)
        report.at_most("connectors: slot cut at its angle", float(turned), ANGLE, where, "degrees")
        report.at_most("connectors: slot cut as wide as listed", wide, MEASURED, where)
        report.at_most("connectors: slot cut as long as listed", abs(_straight(region, slot["width"], found) - slot["length"]), LENGTH, where)


def _gap(region: shapely.Polygon, x: float) -> tuple[float, float]:
    """The free interval across the x axis."""
    free = shapely.LineString([(x, -FAR), (x, FAR)]).difference(region)
    at = min(pieces_of(free), key=lambda piece: piece.distance(shapely.Point(x, 0)))
    return at.bounds[1], at.bounds[3]


def _straight(region: shapely.Polygon, width: float, slot: tuple[float, float]) -> float:
    """Length along which both walls stand the full width apart."""
    middle = (slot[0] + slot[1]) / 2
    lengths = []
    for y in (WALL - width / 2, width / 2 - WALL):
        free = shapely.LineString([(slot[0] - 1, y), (region.bounds[2], y)]).difference(region)
        at = min(pieces_of(free), key=lambda piece: piece.distance(shapely.Point(middle, y)))
        lengths.append(at.length)
    return min(lengths)
