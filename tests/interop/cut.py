"""Parts as the laser leaves them: the contours that the DXF draws, without the kerf, back in part coordinates."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import shapely

from job import Job
from read_dxf import read_dxf
from report import Report
from segments import Drawing
from sheets import with_holes

Array = np.ndarray


def cut_regions(job: Job) -> dict[tuple[str, int], shapely.Polygon]:
    """Each copy of each part in part coordinates, as the drawn lines leave it when the kerf is burnt away."""
    found = {}
    for sheet in job.manifest["sheets"]:
        drawn = _drawn(read_dxf(job.file(sheet["files"]["dxf"]), Report()))
        bounds = shapely.bounds(drawn)
        for place in (place for place in sheet["placements"] if place["part"] in job.parts):
            wanted = np.array(job.placed(place).bounds) + np.array([-1, -1, 1, 1]) * job.kerf / 2
            at = int(np.argmin(np.abs(bounds - wanted).max(axis=1)))
            found[place["part"], place["copy"]] = _taken_back(_without_kerf(drawn[at], job.kerf), place)
    return found


def _drawn(drawing: Drawing) -> Array:
    outers, holes = ([shapely.Polygon(s.points) for s in drawing.layers.get(layer, []) if len(s.points) > 2] for layer in ("CUT_OUTER", "CUT_INNER"))
    return with_holes(np.array(outers), np.array(holes))[0]


def _without_kerf(region: shapely.Polygon, kerf: float) -> shapely.Polygon:
    outer = shapely.Polygon(region.exterior).buffer(-kerf / 2, join_style="mitre")
    holes = [shapely.Polygon(hole).buffer(kerf / 2, join_style="mitre").exterior for hole in region.interiors]
    return shapely.Polygon(outer.exterior, holes)


def _taken_back(region: shapely.Polygon, place: dict) -> shapely.Polygon:
    turn = radians(place["angle_deg"])
    matrix = np.array([[cos(turn), -sin(turn)], [sin(turn), cos(turn)]])
    shift = np.array([place["x"], place["y"]])
    return shapely.transform(region, lambda points: (points - shift) @ matrix)
