"""A layout.json judged by shapely: overlap, spacing, margin, parts in holes.

    python nest_layout.py out/parts/layout.json ...

Prints the least distance on each sheet; exits 3 if anything is nearer than agreed.
"""

import json
import math
import sys

from shapely import STRtree
from shapely.geometry import Polygon, box

SLACK = 2e-6  # mm: coordinates are written to 1e-6


def placed(part, placement):
    angle = math.radians(placement["angle_deg"])
    sin, cos = math.sin(angle), math.cos(angle)

    def ring(points):
        return [
            (cos * x - sin * y + placement["x"], sin * x + cos * y + placement["y"])
            for x, y in points
        ]

    return Polygon(ring(part["outline"]), [ring(hole) for hole in part["holes"]])


def faults(layout):
    parts = {part["id"]: part for part in layout["parts"]}
    seen = set()
    for sheet in layout["sheets"]:
        names = [f"{p['part']}#{p['copy']}" for p in sheet["placements"]]
        for name in names:
            if name in seen:
                yield f"{name} is placed twice"
            seen.add(name)
        shapes = [placed(parts[p["part"]], p) for p in sheet["placements"]]
        margin, spacing = sheet["margin"], layout["spacing"]
        inner = box(margin, margin, sheet["width"] - margin, sheet["height"] - margin)
        for name, shape in zip(names, shapes):
            if not inner.buffer(SLACK).covers(shape):
                yield f"{sheet['id']}: {name} reaches into the margin"
        tree, least = STRtree(shapes), math.inf
        for i, shape in enumerate(shapes):
            for j in tree.query(shape.buffer(spacing + 1)):
                if j > i:
                    distance = shape.distance(shapes[j])
                    least = min(least, distance)
                    overlap = shape.intersection(shapes[j]).area
                    if distance < spacing - SLACK or overlap > 1e-6:
                        yield f"{sheet['id']}: {names[i]} and {names[j]}: {distance} mm"
        print(f"{sheet['id']}: {len(shapes)} parts, least distance {least:.6f}")
    expected = sum(part["quantity"] for part in layout["parts"])
    if len(seen) + len(layout["unplaced"]) < expected:
        yield f"{len(seen)} of {expected} parts are placed"


def main():
    worst = 0
    for path in sys.argv[1:]:
        with open(path) as file:
            for fault in faults(json.load(file)):
                print(f"{path}: {fault}")
                worst = 3
    sys.exit(worst)


if __name__ == "__main__":
    main()
