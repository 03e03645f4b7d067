"""The drawn sheets: three formats agree, cut lines are where kerf and placement put them, nothing is too close."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from contract import LAYERS
from job import Job
from read_dxf import read_dxf
from read_pdf import read_pdf
from read_svg import read_svg
from report import Report
from segments import Drawing, drawn_apart, drawn_twice, length, lines

AGREE = 0.03  # mm, between two formats
STROKE = 0.025  # mm, the thickest line in SVG and PDF
PAGE = 0.01  # mm, page against sheet
CUT = 0.02  # mm, a cut line against the part grown or shrunk by half a kerf
SLACK = 1e-3  # mm, on spacing and margin
CLEAR = 0.2  # mm, an engraved line from a cut line


@dataclass
class Ring:
    """A cut contour that a placement asks for."""

    part: str
    layer: str
    polygon: shapely.Polygon


def check_sheets(job: Job, report: Report) -> None:
    pages = read_pdf(job.folder / "sheets" / "sheets.pdf")
    sheets = job.manifest["sheets"]
    report.claim("pdf: a page per sheet", [] if len(pages) == len(sheets) else [f"{len(pages)} pages, {len(sheets)} sheets"])
    for sheet, page in zip(sheets, pages):
        dxf = read_dxf(job.file(sheet["files"]["dxf"]), report)
        svg = read_svg(job.file(sheet["files"]["svg"]))
        _check_picture(svg, sheet, "svg", report)
        _check_picture(page, sheet, "pdf", report)
        for layer in LAYERS:
            for name, other in (("svg", svg), ("pdf", page)):
                _check_agree(dxf, other, layer, name, sheet["id"], report)
            twice = [f"{sheet['id']} {layer}: {text}" for text in drawn_twice(dxf.segments(layer))]
            report.claim("dxf: nothing drawn twice", twice)
        for name, drawing in (("dxf", dxf), ("svg", svg), ("pdf", page)):
            ranks = [LAYERS.index(layer) for layer in drawing.order if layer in LAYERS and layer != "SHEET"]
            report.claim(f"{name}: layers in drawing order", [] if ranks == sorted(ranks) else [f"{sheet['id']}: {drawing.order[:6]}"])
        _check_frame(dxf, sheet, report)
        placed = [(p["part"], job.placed(p)) for p in sheet["placements"]]
        _check_cuts(job, dxf, placed, sheet, report)
        _check_layout(job, dxf, sheet, report)
        _check_marks(dxf, placed, sheet, report)


def _check_picture(drawing: Drawing, sheet: dict, name: str, report: Report) -> None:
    report.claim(f"{name}: only thin plain strokes", [f"{sheet['id']}: {problem}" for problem in drawing.problems])
    report.at_most(f"{name}: stroke width", drawing.thickest, STROKE, sheet["id"])
    off = max(abs((drawing.width or 0) - sheet["width"]), abs((drawing.height or 0) - sheet["height"]))
    report.at_most(f"{name}: size is the sheet's", off, PAGE, sheet["id"])


def _check_agree(dxf: Drawing, other: Drawing, layer: str, name: str, place: str, report: Report) -> None:
    a, b = dxf.segments(layer), other.segments(layer)
    apart, where = drawn_apart(a, b)
    report.at_most(f"{name} = dxf: distance", apart, AGREE, f"{place} {layer} {where}", count=len(a))
    # A line drawn twice leaves the distance at 0; it shows in the length.
    total = max(length(a), 1.0)
    report.at_most(f"{name} = dxf: drawn length", abs(length(a) - length(b)) / total, 1e-3, f"{place} {layer}", "part")


def _check_frame(dxf: Drawing, sheet: dict, report: Report) -> None:
    points = dxf.points()
    size = np.array([sheet["width"], sheet["height"]])
    outside = max(0.0, float((-points).max()), float((points - size).max())) if len(points) else 0.0
    report.at_most("dxf: all lines on the sheet", outside, 1e-6, sheet["id"])


def _rings(job: Job, placed: list[tuple[str, shapely.Polygon]]) -> list[Ring]:
    rings = []
    for name, region in placed:
        grown = shapely.Polygon(region.exterior).buffer(job.kerf / 2, join_style="mitre", mitre_limit=5)
        rings.append(Ring(name, "CUT_OUTER", grown))
        for hole in region.interiors:
            shrunk = shapely.Polygon(hole).buffer(-job.kerf / 2, join_style="mitre", mitre_limit=5)
            rings.append(Ring(name, "CUT_INNER", shrunk))
    return rings


def _check_cuts(job: Job, dxf: Drawing, placed: list[tuple[str, shapely.Polygon]], sheet: dict, report: Report) -> None:
    rings = _rings(job, placed)
    report.claim(
        "cuts: kerf leaves one contour",
        [f"{ring.part}: {ring.layer} falls apart or gains holes" for ring in rings if ring.polygon.geom_type != "Polygon" or ring.polygon.interiors],
        len(rings),
    )
    for layer in ("CUT_OUTER", "CUT_INNER"):
        wanted = [ring for ring in rings if ring.layer == layer and ring.polygon.geom_type == "Polygon"]
        drawn = [shapely.Polygon(stroke.points) for stroke in dxf.layers.get(layer, []) if len(stroke.points) > 2]
        report.claim("cuts: one contour for each edge", _pairing_problems(wanted, drawn, f"{sheet['id']} {layer}"), len(wanted))
        edges = [np.asarray(ring.polygon.exterior.coords) for ring in wanted]
        asked = np.vstack([np.hstack([edge[:-1], edge[1:]]) for edge in edges]) if edges else np.zeros((0, 4))
        apart, where = drawn_apart(asked, dxf.segments(layer))
        report.at_most("cuts: kerf and placement", apart, CUT, f"{sheet['id']} {layer} {where}", count=len(wanted))


def _pairing_problems(wanted: list[Ring], drawn: list[shapely.Polygon], place: str) -> list[str]:
    """Each ring has a contour of its own with the same bounds and area."""
    found = [f"{place}: {len(drawn)} drawn, {len(wanted)} asked for"] if len(drawn) != len(wanted) else []
    if not wanted or not drawn:
        return found
    bounds, areas = shapely.bounds(np.array(drawn)), shapely.area(np.array(drawn))
    taken = np.zeros(len(drawn), bool)
    for ring in wanted:
        off = np.abs(bounds - np.array(ring.polygon.bounds)).max(axis=1) + 10.0 * taken
        at = int(np.argmin(off))
        if off[at] > CUT or abs(areas[at] - ring.polygon.area) > CUT * ring.polygon.length:
            found.append(f"{place}: no contour for {ring.part} (bounds differ by {off[at]:.3f} mm)")
        else:
            taken[at] = True
    return found


def _check_layout(job: Job, dxf: Drawing, sheet: dict, report: Report) -> None:
    stock = job.stock(sheet)
    outers = np.array([shapely.Polygon(stroke.points) for stroke in dxf.layers.get("CUT_OUTER", []) if len(stroke.points) > 2])
    holes = np.array([shapely.Polygon(stroke.points) for stroke in dxf.layers.get("CUT_INNER", []) if len(stroke.points) > 2])
    valid = shapely.is_valid(outers).all() and shapely.is_valid(holes).all()
    report.claim("layout: cut lines are simple", [] if valid else [f"{sheet['id']}: a cut line crosses itself"], len(outers) + len(holes))
    if not valid or not len(outers):
        return
    regions, loose = with_holes(outers, holes)
    report.claim("layout: holes lie inside parts", [f"{sheet['id']}: {text}" for text in loose], len(holes))
    i, j = shapely.STRtree(regions).query(regions, predicate="dwithin", distance=max(10.0, 2 * stock["spacing"]))
    i, j = i[i < j], j[i < j]
    if len(i):
        gaps = shapely.distance(regions[i], regions[j])
        worst = int(np.argmin(gaps))
        place = f"{sheet['id']} parts around {regions[i[worst]].centroid.wkt} and {regions[j[worst]].centroid.wkt}"
        report.at_least("layout: spacing", float(gaps[worst]), stock["spacing"] - SLACK, place, count=len(i))
    box = shapely.bounds(outers)
    size = np.array([sheet["width"], sheet["height"]])
    edge = float(min(box[:, :2].min(), (size - box[:, 2:]).min()))
    report.at_least("layout: margin", edge, stock["margin"] - SLACK, sheet["id"], count=len(outers))


def with_holes(outers: np.ndarray, holes: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Takes each hole out of the smallest outline around it, so that a part may lie in another's hole."""
    if not len(holes):
        return outers, []
    owner: dict[int, int] = {}
    for hole, outer in zip(*shapely.STRtree(outers).query(holes, predicate="within")):
        if hole not in owner or outers[outer].area < outers[owner[hole]].area:
            owner[hole] = outer
    inside: dict[int, list] = {}
    for hole, outer in owner.items():
        inside.setdefault(outer, []).append(holes[hole].exterior)
    regions = np.array([shapely.Polygon(outer.exterior, inside.get(i, [])) for i, outer in enumerate(outers)])
    return regions, [f"hole at {holes[k].centroid.wkt} in no part" for k in range(len(holes)) if k not in owner]


def _check_marks(dxf: Drawing, placed: list[tuple[str, shapely.Polygon]], sheet: dict, report: Report) -> None:
    """Every engraved or scored stroke lies in one part, clear of all cut lines."""
    strokes = [stroke for layer in ("ENGRAVE", "SCORE") for stroke in dxf.layers.get(layer, [])]
    if not strokes:
        return
    regions = np.array([region for _, region in placed])
    marks = np.array([shapely.LineString(np.vstack([s.points, s.points[:1]]) if s.closed else s.points) for s in strokes])
    inside = set(shapely.STRtree(regions).query(marks, predicate="within")[0].tolist())
    stray = [f"{sheet['id']}: a mark at {strokes[k].points[0].round(3).tolist()}" for k in range(len(marks)) if k not in inside]
    report.claim("marks: inside their part", stray, len(marks))
    cuts = np.vstack([dxf.segments("CUT_INNER"), dxf.segments("CUT_OUTER")])
    if len(cuts):
        which, _ = (found := shapely.STRtree(lines(cuts)).query_nearest(marks, all_matches=False, return_distance=True))[0]
        worst = int(np.argmin(found[1]))
        place = f"{sheet['id']} {strokes[which[worst]].points[0].round(3).tolist()}"
        report.at_least("marks: clear of cuts", float(found[1][worst]), CLEAR, place, count=len(marks))
