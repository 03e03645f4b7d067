"""Flat parts against their fins in space, and strips folded up again."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np
import shapely

from job import Job, Strip
from report import Report

CONGRUENT = 1e-3  # mm, any of the six distances between a fin's corners
FOLDED = 0.01  # mm, ends of axes after folding a whole strip
ANGLE = 1e-4  # degrees
EDGE = 2e-3  # mm, the outline against the edge of its fin

Array = np.ndarray


def check_refold(job: Job, report: Report) -> None:
    report.claim("fins: each on exactly one part", _ownership_problems(job), len(job.space.fins))
    for strip in job.strips.values():
        report.claim("refold: axes and folds listed", _listing_problems(strip))
        _check_fins(job, strip, report)
        _check_fold_angles(job, strip, report)
        _check_chain(job, strip, report)
        for fin in strip.splices:
            _check_splice(job, strip, fin, report)
    for name, part in job.parts.items():
        if part.get("fin"):
            axes = part["fin"]["axes"]
            flat = [np.array(axis[end], float) for axis in axes for end in ("bottom", "top")]
            _check_fin(job, name, [axis["node"] for axis in axes], flat, report)
            if sorted(axis["node"] for axis in axes) != sorted(part["fin"]["nodes"]):
                report.claim("refold: axes and folds listed", [f"{name}: axes are not those of its nodes"])
        if part.get("connector"):
            _check_connector(job, name, part["connector"], report)


def _ownership_problems(job: Job) -> list[str]:
    whole: Counter = Counter()
    halves: Counter = Counter()
    for strip in job.strips.values():
        cut = {(min(fin), max(fin)) for fin in strip.splices}
        whole.update(fin for fin in strip.fins() if fin not in cut)
        halves.update(cut)
    for part in job.parts.values():
        if part.get("fin"):
            i, j = part["fin"]["nodes"]
            whole[min(i, j), max(i, j)] += 1
    found = []
    for fin in job.space.fins:
        if (whole[fin], halves[fin]) not in ((1, 0), (0, 2)):
            found.append(f"fin {fin} is on {whole[fin]} parts whole and spliced on {halves[fin]}")
    strangers = (set(whole) | set(halves)) - set(job.space.fins)
    return found + [f"fin {fin} is on a part but not in the structure" for fin in sorted(strangers)]


def _listing_problems(strip: Strip) -> list[str]:
    found = []
    if len(strip.bottoms) != len(strip.nodes):
        found.append(f"{strip.id}: {len(strip.bottoms)} axes for {len(strip.nodes)} nodes")
    if strip.closed and strip.nodes[0] != strip.nodes[-1]:
        found.append(f"{strip.id}: closed, but its ends are different nodes")
    if (folds := _fold_places(strip)) is None:
        found.append(f"{strip.id}: folds at {[fold['node'] for fold in strip.folds]} for nodes {strip.nodes}")
    elif not set(range(1, len(strip.nodes) - 1)) <= set(folds):
        found.append(f"{strip.id}: an inner node without a fold")
    return found


def _fold_places(strip: Strip) -> list[int] | None:
    """Which place along the strip each fold belongs to: inner nodes, and an end that goes on to a splice."""
    places = [k for k in range(len(strip.nodes)) if None not in strip.sides(k)]
    if len(strip.folds) < len(places):
        places = list(range(1, len(strip.nodes) - 1))
    listed = [fold["node"] for fold in strip.folds]
    return places if [strip.nodes[k] for k in places] == listed else None


def _check_fins(job: Job, strip: Strip, report: Report) -> None:
    for k in range(len(strip.nodes) - 1):
        nodes = strip.nodes[k : k + 2]
        flat = [strip.bottoms[k], strip.tops[k], strip.bottoms[k + 1], strip.tops[k + 1]]
        _check_fin(job, strip.id, nodes, flat, report)
        # Away from the axes, where slits are, the outline runs along the fin's own edges; the notches for discs may reach farther.
        if job.connected & set(nodes):
            continue
        for ends in (strip.tops, strip.bottoms):
            middle = shapely.Point((ends[k] + ends[k + 1]) / 2)
            report.at_most("refold: outline along the fins", strip.outline.exterior.distance(middle), EDGE, f"{strip.id} fin {nodes}")


def _check_fin(job: Job, part: str, nodes: list[int], flat: list[Array], report: Report) -> None:
    i, j = nodes
    space = [job.space.bottoms[i], job.space.tops[i], job.space.bottoms[j], job.space.tops[j]]
    worst = max(abs(np.linalg.norm(flat[a] - flat[b]) - np.linalg.norm(space[a] - space[b])) for a, b in combinations(range(4), 2))
    report.at_most("refold: fins congruent", float(worst), CONGRUENT, f"{part} fin {nodes}")
    # Seen on the labelled face, travel x axis points at the reader; a mirrored part shows it the other way.
    travel, axis = (flat[2] + flat[3]) - (flat[0] + flat[1]), (flat[1] - flat[0]) + (flat[3] - flat[2])
    facing = travel[0] * axis[1] - travel[1] * axis[0] > 0
    report.claim("refold: labelled face in front", [] if facing else [f"{part}: fin {nodes} is mirrored"])


def _check_fold_angles(job: Job, strip: Strip, report: Report) -> None:
    for k, fold in zip(_fold_places(strip) or [], strip.folds):
        before, after = strip.sides(k)
        wanted = job.space.fold(before, strip.nodes[k], after)
        report.at_most("refold: fold angles", abs(fold["angle_deg"] - wanted), ANGLE, f"{strip.id} node {strip.nodes[k]}", "degrees")


def _check_chain(job: Job, strip: Strip, report: Report) -> None:
    places = _fold_places(strip)
    if len(strip.nodes) < 2 or places is None:
        return
    folds = {k: fold["angle_deg"] for k, fold in zip(places, strip.folds)}
    ends = _lifted(strip)
    nodes = strip.nodes
    target = np.stack([job.space.bottoms[nodes], job.space.tops[nodes]], axis=1)
    turn, shift = _rigid(ends[:2].reshape(-1, 3), target[:2].reshape(-1, 3))
    folded = [end @ turn.T + shift for end in ends[:2]]
    for k in range(1, len(nodes) - 1):
        bottom, top = folded[k]
        axis = (top - bottom) / np.linalg.norm(top - bottom)
        # Turning the next fin, +x, toward the normal, +z, is a turn about the axis, +y, by minus the angle.
        bend = _rotation(axis, -np.radians(folds.get(k, 0.0)))
        turn = bend @ turn
        shift = bottom - turn @ ends[k][0]
        folded.append(ends[k + 1] @ turn.T + shift)
    off = np.linalg.norm(np.array(folded) - target, axis=2)
    at = int(np.argmax(off.max(axis=1)))
    report.at_most("refold: strips folded in space", float(off.max()), FOLDED, f"{strip.id} node {nodes[at]}", count=len(nodes))


def _lifted(strip: Strip) -> Array:
    """The axis ends as points of space: node by (bottom, top) by xyz, the flat part lying in z = 0, labelled face up."""
    flat = np.stack([strip.bottoms, strip.tops], axis=1)
    return np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2)


def _rigid(source: Array, target: Array) -> tuple[Array, Array]:
    """The motion without mirroring that best brings the source onto the target."""
    from_centre, to_centre = source.mean(axis=0), target.mean(axis=0)
    u, _, vt = np.linalg.svd((source - from_centre).T @ (target - to_centre))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(vt.T @ u.T))])
    turn = vt.T @ flip @ u.T
    return turn, to_centre - turn @ from_centre


def _rotation(axis: Array, angle: float) -> Array:
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def _check_splice(job: Job, strip: Strip, fin: tuple[int, int], report: Report) -> None:
    """The halves of a spliced fin, each laid on the fin's quad by the axis it has, make up its middle once."""
    fin = (min(fin), max(fin))
    other = next((s for s in job.strips.values() if fin in [(min(f), max(f)) for f in s.splices] and s is not strip), strip)
    halves = [_on_quad(job, strip, fin), _on_quad(job, other, fin)]
    if other is strip or None in halves:
        report.claim("refold: splices", [f"{strip.id}: fin {fin} has no second half"] if other is strip else [])
        return
    i, j = fin
    corners = _quad(job, i, j)
    middle = shapely.Polygon(_middle(corners))
    covered = shapely.union_all(halves).intersection(middle).area / middle.area
    shared = halves[0].intersection(halves[1]).area / middle.area
    report.at_least("refold: splice halves cover the fin", covered, 0.98, f"{strip.id} fin {fin}", "part")
    report.at_most("refold: splice halves overlap", shared, 1e-3, f"{strip.id} fin {fin}", "part")


def _quad(job: Job, i: int, j: int) -> list[Array]:
    """Corners in the fin's plane, first axis up along +y: bottom i, bottom j, top j, top i."""
    up = job.space.axes[i]
    across = job.space.positions[j] - job.space.positions[i]
    across = across - (across @ up) * up
    across /= np.linalg.norm(across)
    frame = np.array([across, up])
    origin = job.space.bottoms[i]
    return [frame @ (point - origin) for point in (job.space.bottoms[i], job.space.bottoms[j], job.space.tops[j], job.space.tops[i])]


def _middle(corners: list[Array]) -> list[Array]:
    a, b, c, d = corners
    return [a + 0.3 * (b - a), a + 0.7 * (b - a), d + 0.7 * (c - d), d + 0.3 * (c - d)]


def _on_quad(job: Job, strip: Strip, fin: tuple[int, int]) -> shapely.Polygon | None:
    """The strip's outline moved so that its axis at the splice lies on the fin's axis."""
    at_start = strip.nodes[0] in fin and strip.across_splice(at_start=True) in fin
    k = 0 if at_start else len(strip.nodes) - 1
    node = strip.nodes[k]
    if node not in fin:
        return None
    a, b, c, d = _quad(job, *fin)
    bottom, top = (a, d) if node == fin[0] else (b, c)
    # The quad has travel from the lower to the higher node; the strip may run the other way, then its back shows.
    backward = at_start == (node == fin[0])
    source = np.array([strip.bottoms[k], strip.tops[k]])
    outline = np.asarray(strip.outline.exterior.coords)
    if backward:
        source, outline = source * [-1, 1], outline * [-1, 1]
    angle = np.arctan2(*(top - bottom)[::-1]) - np.arctan2(*(source[1] - source[0])[::-1])
    matrix = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return shapely.Polygon((outline - source[0]) @ matrix + bottom)


def _check_connector(job: Job, name: str, connector: dict, report: Report) -> None:
    """The fins stand about the connector as about the node; where the count of angles starts is free."""
    node = connector["node"]
    ends = job.slot_ends(connector)
    problems = [f"{name}: {part} does not end at node {node}" for part, to in ends if (part, to) not in job.ends.get(node, [])]
    in_slots = [[slot["fin"], slot["angle_deg"]] for slot in connector["slots"]]
    problems += [f"{name}: fins {connector['fins']}, slots {in_slots}"] * (sorted(connector["fins"]) != sorted(in_slots))
    problems += [f"{name}: {len(ends)} fins"] * (len(ends) != len(job.space.neighbours.get(node, [])))
    report.claim("connectors: fins of their node", problems)
    if not problems:
        off = [(slot["angle_deg"] - np.degrees(job.space.angle(node, to))) % 360 for slot, (_, to) in zip(connector["slots"], ends)]
        spread = max(abs((value - off[0] + 180) % 360 - 180) for value in off)
        report.at_most("connectors: angles", float(spread), ANGLE, name, "degrees")
