"""A sheet as ezdxf's strict reader sees it."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import ezdxf

from contract import DXF_COLOURS, LAYERS
from report import Report
from segments import Drawing, arc_points


def read_dxf(path: Path, report: Report) -> Drawing:
    """Reads the file, judges what only a DXF can have wrong, and returns its geometry."""
    state = path.stat()
    drawing, claims = _read(path, state.st_mtime_ns, state.st_size)
    for name, problems in claims.items():
        report.claim(name, problems)
    return drawing


@lru_cache(maxsize=None)
def _read(path: Path, _changed: int, _size: int) -> tuple[Drawing, dict[str, list[str]]]:
    """Read once, for several checks ask: ezdxf takes its time."""
    document = ezdxf.readfile(path)
    audit = document.audit()
    drawing = Drawing(None, None)
    for entity in document.modelspace():
        _add(drawing, entity)
    extra = [block.name for block in document.blocks if not block.is_any_layout]
    paper = [layout.name for layout in document.layouts if not layout.is_modelspace and len(layout)]
    drawing.problems += [f"block {name}" for name in extra] + [f"something on paper {name}" for name in paper]
    open_cuts = [
        f"{path.name}: {layer} near ({stroke.points[0][0]:.3f}, {stroke.points[0][1]:.3f})"
        for layer in ("CUT_INNER", "CUT_OUTER")
        for stroke in drawing.layers.get(layer, [])
        if not stroke.closed
    ]
    return drawing, {
        "dxf: audit errors": [f"{path.name}: {error.message}" for error in audit.errors],
        "dxf: audit fixes": [f"{path.name}: {fix.message}" for fix in audit.fixes],
        "dxf: millimetres declared": _unit_problems(path),
        "dxf: layers and colours": _layer_problems(document, path.name),
        "dxf: polylines and lines only": [f"{path.name}: {problem}" for problem in drawing.problems],
        "dxf: cuts are closed": open_cuts,
    }


def _add(drawing: Drawing, entity) -> None:
    kind, dxf = entity.dxftype(), entity.dxf
    if dxf.layer not in LAYERS:
        drawing.problems.append(f"{kind} on layer {dxf.layer!r}")
    if dxf.get("color", 256) not in (256, DXF_COLOURS.get(dxf.layer)) or dxf.hasattr("true_color"):
        drawing.problems.append(f"{kind} on {dxf.layer} with a colour of its own")
    if kind == "LINE":
        drawing.add(dxf.layer, [(dxf.start.x, dxf.start.y), (dxf.end.x, dxf.end.y)], False)
        heights = [dxf.start.z, dxf.end.z]
    elif kind == "LWPOLYLINE":
        vertices = [(x, y, bulge) for x, y, _, _, bulge in entity.get_points()]
        _add_polyline(drawing, dxf.layer, vertices, entity.closed)
        heights = [dxf.elevation]
    elif kind == "POLYLINE" and entity.is_2d_polyline and not dxf.flags & 6:
        vertices = [(v.dxf.location.x, v.dxf.location.y, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
        _add_polyline(drawing, dxf.layer, vertices, entity.is_closed)
        heights = [v.dxf.location.z for v in entity.vertices]
    else:
        drawing.problems.append(f"{kind} on {dxf.layer}")
        return
    if any(heights) or tuple(dxf.get("extrusion", (0, 0, 1))) != (0, 0, 1):
        drawing.problems.append(f"{kind} off the plane of the sheet")


def _add_polyline(drawing: Drawing, layer: str, vertices: list, closed: bool) -> None:
    points = [vertices[0][:2]]
    following = vertices[1:] + vertices[:1] if closed else vertices[1:]
    for (x, y, bulge), (to_x, to_y, _) in zip(vertices, following):
        points += arc_points((x, y), (to_x, to_y), bulge)
    drawing.add(layer, points[:-1] if closed else points, closed)


def _unit_problems(path: Path) -> list[str]:
    """Looks at the bytes: ezdxf fills in header variables that a file lacks."""
    rows = [row.strip() for row in path.read_text("utf-8").splitlines()]
    declared = {}
    for name, good in (("$INSUNITS", "4"), ("$MEASUREMENT", "1")):
        if name in rows:
            declared[name] = rows[rows.index(name) + 2]
            if declared[name] != good:
                return [f"{path.name}: {name} is {declared[name]}"]
    return [] if declared else [f"{path.name}: neither $INSUNITS nor $MEASUREMENT"]


def _layer_problems(document, name: str) -> list[str]:
    used = {entity.dxf.layer for entity in document.modelspace()}
    found = []
    for layer in sorted(used & set(LAYERS)):
        if not document.layers.has_entry(layer):
            found.append(f"{name}: layer {layer} is not in the layer table")
            continue
        colour = document.layers.get(layer).dxf.color
        if colour != DXF_COLOURS[layer]:
            found.append(f"{name}: layer {layer} has colour {colour}, not {DXF_COLOURS[layer]}")
    if "CUT_OUTER" not in used:
        found.append(f"{name}: nothing on CUT_OUTER")
    return found
