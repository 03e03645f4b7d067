"""The sheets as pymupdf sees the pages of the PDF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pymupdf

from contract import LAYERS
from read_svg import right_colour
from segments import Drawing, bezier_points

MM = 25.4 / 72


def read_pdf(path: Path) -> list[Drawing]:
    with pymupdf.open(path) as document:
        return [_read_page(page) for page in document]


def _read_page(page: pymupdf.Page) -> Drawing:
    box = page.mediabox
    drawing = Drawing(box.width * MM, box.height * MM)
    if page.rotation or page.cropbox != box or box.x0 or box.y0:
        drawing.problems.append("the page is rotated, cropped or off its origin")
    if page.get_text().strip() or page.get_images():
        drawing.problems.append("the page has text or images")
    for path in page.get_drawings():
        layer = path.get("layer")
        if layer not in LAYERS:
            drawing.problems.append(f"a path on layer {layer!r}")
            continue
        if path["type"] != "s":
            drawing.problems.append(f"a path on {layer} is filled")
            continue
        if not right_colour(layer, path["color"]):
            drawing.problems.append(f"a path on {layer} has colour {path['color']}")
        drawing.thickest = max(drawing.thickest, path["width"] * MM)
        for points, closed in _chains(path):
            drawing.add(layer, _millimetres(points, drawing.height), closed)
    return drawing


def _millimetres(points: list, height: float) -> np.ndarray:
    placed = np.asarray(points) * MM
    placed[:, 1] = height - placed[:, 1]
    return placed


def _chains(path: dict) -> list[tuple[list, bool]]:
    """Joins the lines and curves of one PDF path where they follow each other."""
    chains: list[list] = []
    closed: list[bool] = []

    def extend(start: np.ndarray, more: list) -> None:
        if not chains or np.hypot(*(chains[-1][-1] - start)) > 1e-6:
            chains.append([start])
            closed.append(False)
        chains[-1].extend(more)

    for item in path["items"]:
        if item[0] == "l":
            extend(np.array(item[1]), [np.array(item[2])])
        elif item[0] == "c":
            corners = [np.array(point) for point in item[1:5]]
            extend(corners[0], bezier_points(*corners))
        else:
            shape = item[1].quad if item[0] == "re" else item[1]
            chains.append([np.array(point) for point in (shape.ul, shape.ur, shape.lr, shape.ll)])
            closed.append(True)
    if path.get("closePath") and chains:
        closed[-1] = True
    for i, chain in enumerate(chains):
        if len(chain) > 2 and np.hypot(*(chain[0] - chain[-1])) < 1e-6:
            closed[i] = True
    return list(zip(chains, closed))

