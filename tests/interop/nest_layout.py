"""A layout.json judged by shapely: overlap, spacing, margin, parts in holes, edges of remnants, free space.

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
        edge = box(0, 0, sheet["width"], sheet["height"])
        if "outline" in sheet:
            edge = Polygon(sheet["outline"], sheet["holes"])
        for name, shape in zip(names, shapes):
            off = edge.boundary.distance(shape)
            if not edge.covers(shape) or off < margin - SLACK:
                yield f"{sheet['id']}: {name} is {off} mm from the edge"
        free = [Polygon(r["outline"], r["holes"]) for r in sheet["free"]]
        for region, said in zip(free, sheet["free"]):
            covered = sum(region.intersection(shape).area for shape in shapes)
            if not region.is_valid or covered > 1e-2 or region.difference(edge).area > 1e-2:
                yield f"{sheet['id']}: free space that is not: {covered} mm2 of parts"
            if abs(region.area - said["area"]) > 1e-2:
                yield f"{sheet['id']}: free space of {region.area}, not {said['area']}"
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
