"""A sheet as an SVG, by a small reader of paths."""

from __future__ import annotations

import re
from math import acos, cos, pi, radians, sin, sqrt
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from contract import LAYERS, RGB
from segments import Drawing, bezier_points, turned_points

LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
SHAPES = {"path", "polyline", "polygon", "line", "rect", "circle"}
SILENT = {"svg", "g", "title", "desc", "metadata", "defs", "namedview"}
TOKEN = re.compile(r"[MmLlHhVvZzCcAa]|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
NAMED = {"red": (1, 0, 0), "blue": (0, 0, 1), "lime": (0, 1, 0), "cyan": (0, 1, 1), "aqua": (0, 1, 1), "grey": (0.5,) * 3, "gray": (0.5,) * 3}


def read_svg(path: Path) -> Drawing:
    root = ElementTree.parse(path).getroot()
    drawing = Drawing(_millimetres(root.get("width", "")), _millimetres(root.get("height", "")))
    if drawing.width is None or drawing.height is None:
        drawing.problems.append("width and height are not in mm")
        return drawing
    box = [float(word) for word in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if word]
    if len(box) != 4 or abs(box[2] - drawing.width) > 1e-6 or abs(box[3] - drawing.height) > 1e-6:
        drawing.problems.append(f"viewBox {box}: a user unit is not 1 mm")
        return drawing
    _walk(root, None, {}, drawing, np.array(box[:2]))
    return drawing


def _walk(element, layer: str | None, style: dict[str, str], drawing: Drawing, origin: np.ndarray) -> None:
    tag = str(element.tag).rsplit("}", 1)[-1]
    style = {**style, **_style(element)}
    name = element.get(LABEL) or element.get("id")
    layer = name if name in LAYERS else layer
    if element.get("transform") is not None:
        drawing.problems.append(f"transform on <{tag}>")
    if tag in SHAPES:
        _add(element, tag, layer, style, drawing, origin)
    elif tag not in SILENT:
        drawing.problems.append(f"<{tag}>")
    for child in element:
        _walk(child, layer, style, drawing, origin)


def _add(element, tag: str, layer: str | None, style: dict[str, str], drawing: Drawing, origin: np.ndarray) -> None:
    if layer is None:
        drawing.problems.append(f"<{tag}> on no layer")
        return
    if style.get("fill") != "none":
        drawing.problems.append(f"<{tag}> on {layer} is filled")
    drawing.thickest = max(drawing.thickest, float(re.sub("mm$|px$", "", style.get("stroke-width", "1"))))
    colour = _colour(style.get("stroke", "none"))
    if colour is None or not right_colour(layer, colour):
        drawing.problems.append(f"<{tag}> on {layer} is {style.get('stroke', 'none')}")
    for points, closed in _shape(element, tag):
        placed = np.asarray(points, float) - origin
        placed[:, 1] = drawing.height - placed[:, 1]
        drawing.add(layer, placed, closed)


def right_colour(layer: str, colour: tuple[float, ...]) -> bool:
    """The exact primaries of the contract; any grey for the frame."""
    if layer == "SHEET":
        return max(colour) - min(colour) < 0.005 and 0.05 < colour[0] < 0.95
    return max(abs(a - b) for a, b in zip(colour, RGB[layer])) < 0.005


def _style(element) -> dict[str, str]:
    found = {key: element.get(key) for key in ("fill", "stroke", "stroke-width") if element.get(key) is not None}
    for entry in element.get("style", "").split(";"):
        key, _, value = entry.partition(":")
        if value:
            found[key.strip()] = value.strip()
    return found


def _colour(text: str) -> tuple[float, ...] | None:
    if re.fullmatch(r"#[0-9a-fA-F]{6}", text):
        return tuple(int(text[i : i + 2], 16) / 255 for i in (1, 3, 5))
    if re.fullmatch(r"#[0-9a-fA-F]{3}", text):
        return tuple(int(digit, 16) / 15 for digit in text[1:])
    if match := re.fullmatch(r"rgb\(\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*\)", text):
        return tuple(int(digits) / 255 for digits in match.groups())
    return NAMED.get(text)


def _millimetres(text: str) -> float | None:
    match = re.fullmatch(r"([\d.]+)mm", text)
    return float(match.group(1)) if match else None


def _shape(element, tag: str) -> list[tuple[list, bool]]:
    def number(key: str) -> float:
        return float(element.get(key, "0"))

    if tag == "path":
        return path_points(element.get("d", ""))
    if tag in ("polyline", "polygon"):
        numbers = [float(word) for word in re.split(r"[\s,]+", element.get("points", "").strip())]
        return [(list(zip(numbers[::2], numbers[1::2])), tag == "polygon")]
    if tag == "line":
        return [([(number("x1"), number("y1")), (number("x2"), number("y2"))], False)]
    if tag == "rect":
        x, y, w, h = (number(key) for key in ("x", "y", "width", "height"))
        return [([(x, y), (x + w, y), (x + w, y + h), (x, y + h)], True)]
    centre, start = np.array([number("cx"), number("cy")]), np.array([number("cx") + number("r"), number("cy")])
    return [(turned_points(start, centre, 2 * pi), True)]


def path_points(text: str) -> list[tuple[list, bool]]:
    """The subpaths of a path's `d`, flattened: M, L, H, V, C, A and Z, absolute or relative."""
    tokens, at, command, here, start = TOKEN.findall(text), 0, "", np.zeros(2), np.zeros(2)
    found: list[tuple[list, bool]] = []

    def take(count: int) -> list[float]:
        nonlocal at
        at += count
        return [float(token) for token in tokens[at - count : at]]

    while at < len(tokens):
        if tokens[at].isalpha():
            command = tokens[at]
            at += 1
        base = here if command.islower() else np.zeros(2)
        kind = command.upper()
        if kind == "Z":
            found[-1] = (found[-1][0], True)
            here = start
            continue
        if kind == "M":
            here = start = base + take(2)
            found.append(([here], False))
            command = "l" if command == "m" else "L"
            continue
        if found[-1][1]:
            found.append(([here], False))
        new, here = _piece(kind, here, base, take)
        found[-1][0].extend(new)
    return found


def _piece(kind: str, here: np.ndarray, base: np.ndarray, take) -> tuple[list, np.ndarray]:
    if kind == "L":
        end = base + take(2)
        return [end], end
    if kind == "H":
        end = np.array([base[0] + take(1)[0], here[1]])
        return [end], end
    if kind == "V":
        end = np.array([here[0], base[1] + take(1)[0]])
        return [end], end
    if kind == "C":
        one, two, end = (base + take(2) for _ in range(3))
        return bezier_points(here, one, two, end), end
    rx, ry, turn, large, sweep = take(5)
    end = base + take(2)
    return svg_arc(here, end, rx, ry, radians(turn), large != 0, sweep != 0), end


def svg_arc(start: np.ndarray, end: np.ndarray, rx: float, ry: float, turn: float, large: bool, sweep: bool) -> list:
    """An elliptical arc after SVG 1.1 F.6.5: turned and squeezed so that it becomes a circle of radius 1."""
    if rx == 0 or ry == 0:
        return [end]
    to_circle = np.diag([1 / rx, 1 / ry]) @ np.array([[cos(turn), sin(turn)], [-sin(turn), cos(turn)]])
    a, b = to_circle @ start, to_circle @ end
    chord = b - a
    half = np.hypot(*chord) / 2
    if half == 0:
        return [end]
    size = max(1.0, half)  # F.6.6: radii too small are grown
    side = 1 if large != sweep else -1
    centre = (a + b) / 2 + side * sqrt(max(0.0, size * size - half * half)) * np.array([-chord[1], chord[0]]) / (2 * half)
    first, last = a - centre, b - centre
    angle = acos(max(-1.0, min(1.0, float(first @ last) / (size * size))))
    angle = 2 * pi - angle if large else angle
    scale = max(rx, ry)
    round_points = turned_points(a * scale, centre * scale, angle if sweep else -angle)
    back = np.linalg.inv(to_circle) / scale
    return [*(back @ point for point in round_points[:-1]), end]
