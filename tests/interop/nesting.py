"""Drawings by other programs through `finwright nest`: made with ezdxf and by hand, read back with ezdxf and shapely."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import ezdxf
from ezdxf import units
from shapely.geometry import LineString, Polygon

INCH = 25.4
FIXTURES = Path(__file__).resolve().parent.parent.parent / "fixtures"


def drawing(path: Path) -> None:
    """In inches: a stadium with a round hole and an engraved line, and a plate of four single lines on layer 0."""
    document = ezdxf.new("R2010")
    document.units = units.IN
    space = document.modelspace()
    space.add_lwpolyline([(0, 0, 0), (4, 0, 1), (4, 2, 0), (0, 2, 1)], format="xyb", close=True, dxfattribs={"layer": "Outlines"})
    space.add_circle((1, 1), 0.5, dxfattribs={"layer": "Outlines"})
    space.add_line((2.5, 1), (3.5, 1), dxfattribs={"layer": "notes"})
    corners = [(6, 0), (8, 0), (8, 3), (6, 3)]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        space.add_line(a, b)
    document.saveas(path)


def svg(path: Path) -> None:
    """In millimetres by viewBox, with curves and a transform."""
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="100mm" viewBox="0 0 400 200">'
        '<g transform="translate(20 20) scale(2)" fill="none" stroke="black">'
        '<path d="M 0 0 H 40 A 10 10 0 0 1 40 20 H 0 Z"/><rect x="5" y="5" width="10" height="10"/></g></svg>'
    )


def area(vertices: list[tuple[float, float, float]]) -> float:
    """Of a closed line with bulges: the polygon and the segments of circles on its sides."""
    total = Polygon([(x, y) for x, y, _ in vertices]).area if len(vertices) > 2 else 0.0
    orientation = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(vertices, vertices[1:] + vertices[:1]))
    for a, b in zip(vertices, vertices[1:] + vertices[:1]):
        angle = 4 * math.atan(a[2])
        if angle:
            radius = math.dist(a[:2], b[:2]) / 2 / math.sin(abs(angle) / 2)
            segment = radius**2 / 2 * (abs(angle) - math.sin(abs(angle)))
            total += segment if angle * (orientation or angle) > 0 else -segment
    return total


def areas(dxf: Path) -> tuple[list[float], int, list[float]]:
    """Areas of closed lines in mm², how many have arcs, and lengths of open lines."""
    document = ezdxf.readfile(dxf)
    assert document.units == units.MM, "not in millimetres"
    closed, curved, opened = [], 0, []
    for entity in document.modelspace():
        if entity.dxf.layer == "SHEET":
            continue
        vertices = [(v.dxf.location.x, v.dxf.location.y, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
        if entity.is_closed:
            closed.append(area(vertices))
            curved += any(v[2] for v in vertices)
        else:
            opened.append(LineString([v[:2] for v in vertices]).length)
    return sorted(closed), curved, opened


def drawn_by_boxes(path: Path) -> list[float]:
    """Areas of the paths of a boxes.py drawing in mm² (viewBox in mm): M, H, V, C and Z, all absolute; curves in 64 steps."""
    found = []
    for path_data in re.findall(r'<path d="([^"]+)"', path.read_text()):
        points: list[complex] = []
        for letter, numbers in re.findall(r"([MHVCZ])([^MHVCZ]*)", path_data):
            values = [float(number) for number in numbers.split()]
            if letter == "M":
                points.append(complex(*values))
            elif letter == "H":
                points.append(complex(values[0], points[-1].imag))
            elif letter == "V":
                points.append(complex(points[-1].real, values[0]))
            elif letter == "C":
                a, (b, c, d) = points[-1], (complex(*values[k : k + 2]) for k in (0, 2, 4))
                steps = [k / 64 for k in range(1, 65)]
                points += [(1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d for t in steps]
        found.append(abs(sum((p.conjugate() * q).imag for p, q in zip(points, points[1:] + points[:1]))) / 2)
    return sorted(found)


def near(found: list[float], wanted: list[float], slack: float) -> bool:
    return len(found) == len(wanted) and all(math.isclose(a, b, rel_tol=slack) for a, b in zip(found, sorted(wanted)))


def moved(ring: list[list[float]], by: list[float]) -> list[list[float]]:
    return [[x - by[0], y - by[1]] for x, y in ring]


def stock_kept(given: dict, layout: dict) -> list[str]:
    """Remnants come back in their shape, locked parts where they were, and no part is lost."""
    faults = []
    edges = [Polygon(sheet["outline"], sheet["holes"]) for sheet in layout["sheets"] if "outline" in sheet]
    placed = [placement for sheet in layout["sheets"] for placement in sheet["placements"]]
    for sheet in given["sheets"]:
        if "outline" in sheet:
            low = [min(point[axis] for point in sheet["outline"]) for axis in (0, 1)]
            wanted = Polygon(moved(sheet["outline"], low), [moved(hole, low) for hole in sheet["holes"]])
            if not any(edge.symmetric_difference(wanted).area < 1e-2 for edge in edges):
                faults.append("the remnant was not used")
        for locked in sheet.get("placements", []):
            if {**locked, "locked": True} not in placed:
                faults.append(f"{locked} was moved")
    count = sum(part.get("quantity", 1) for part in given["parts"])
    if len(placed) != count:
        faults.append(f"{len(placed)} of {count} parts are placed")
    return faults


def reused(runner, layouts) -> None:
    """Remnants and locked parts in; the free space of that layout as remnants again."""
    given = json.loads((FIXTURES / "remnants.json").read_text())
    ran = runner.finwright("nest", str(FIXTURES / "remnants.json"), "-o", "remnants", "-q")
    if ran.returncode != 0:
        runner.note("nest remnants.json", False, ran.stderr.strip()[-300:])
        return
    layout = json.loads((runner.scratch / "remnants" / "layout.json").read_text())
    faults = list(layouts(layout)) + stock_kept(given, layout)
    runner.note("nest remnants.json", not faults, "; ".join(faults[:3]))
    free = [region for sheet in layout["sheets"] for region in sheet["free"]]
    disc = next(part for part in given["parts"] if part["id"] == "disc")
    small = {**disc, "id": "small", "quantity": 6, "outline": [[x / 3, y / 3] for x, y in disc["outline"]]}
    again = {"format": "finwright-parts", "version": 1, "sheets": [{**region, "margin": 3, "count": 1} for region in free], "parts": [small]}
    path = runner.scratch / "again.json"
    path.write_text(json.dumps(again))
    ran = runner.finwright("nest", str(path), "-o", "again", "-q")
    if ran.returncode != 0:
        runner.note("nest free space", False, ran.stderr.strip()[-300:])
        return
    layout = json.loads((runner.scratch / "again" / "layout.json").read_text())
    faults = list(layouts(layout))
    if not any(sheet["placements"] for sheet in layout["sheets"]):
        faults.append("nothing lies on the free space")
    runner.note("nest free space", not faults, "; ".join(faults[:3]))


def box(runner, layouts) -> None:
    """A box by boxes.py, whose lines loop at inner corners: all six sides are placed and cut as drawn."""
    ran = runner.finwright("nest", str(FIXTURES / "closed_box.svg"), "--sheet", "200x120", "-o", "box", "-q")
    if ran.returncode != 0:
        runner.note("nest closed_box.svg", False, ran.stderr.strip()[-300:])
        return
    faults = list(layouts(json.loads((runner.scratch / "box" / "layout.json").read_text())))
    closed = sorted(area for sheet in (runner.scratch / "box" / "sheets").glob("*.dxf") for area in areas(sheet)[0])
    wanted = drawn_by_boxes(FIXTURES / "closed_box.svg")
    if len(wanted) != 6 or not near([abs(a) for a in closed], wanted, 1e-5):
        faults.append(f"drawn: {closed}; wanted {wanted}")
    runner.note("nest closed_box.svg", not faults, "; ".join(faults[:3]))


def checked(runner, layouts) -> None:
    """Runs the cases; `layouts` judges a layout.json by shapely."""
    box(runner, layouts)
    reused(runner, layouts)
    dxf, drawn = runner.scratch / "parts.dxf", runner.scratch / "parts.svg"
    drawing(dxf)
    svg(drawn)
    stadium = (4 * 2 + math.pi) * INCH**2
    circle, plate = math.pi * 0.25 * INCH**2, 6 * INCH**2
    rounded = 40 * 20 + math.pi * 50
    cases = [
        ("parts.json", [], None),
        (str(dxf), ["--sheet", "400x300"], ([stadium, circle, plate], 2, [INCH])),
        (str(drawn), ["--sheet", "200x100"], ([rounded, 100.0], 1, [])),
    ]
    for source, words, wanted in cases:
        source = source if wanted else str(FIXTURES / source)
        folder = f"nest-{Path(source).suffix[1:]}"
        ran = runner.finwright("nest", source, *words, "-o", folder, "-q")
        if ran.returncode != 0:
            runner.note(f"nest {source}", False, ran.stderr.strip()[-300:])
            continue
        layout = runner.scratch / folder / "layout.json"
        faults = list(layouts(json.loads(layout.read_text())))
        if wanted:
            closed, curved, opened = areas(runner.scratch / folder / "sheets" / "sheet-01.dxf")
            if not near(closed, wanted[0], 1e-7) or curved != wanted[1] or not near(opened, wanted[2], 1e-6):
                faults.append(f"drawn: {closed}, {curved} with arcs, open {opened}; wanted {wanted}")
        said = runner.finwright("nest", "--check", str(layout), "-q")
        if said.returncode != 0:
            faults.append(f"--check: {said.stderr.strip()[-200:]}")
        runner.note(f"nest {Path(source).name}", not faults, "; ".join(faults[:3]))
