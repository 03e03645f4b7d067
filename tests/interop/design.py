"""What `finwright design --json` says of a structure, found again by numpy from the structure and its surface alone: Euler number, valences,
lengths, planarity, distance to the surface, and the turn of axes where the surface brings its own. `design.py STRUCTURE SURFACE.obj REPORT`
prints the differences; lengths in mm, the surface in the unit given as a fourth argument (mm)."""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path

import numpy as np
from planar import planarities

UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0}
BAND = (0.7, 1.4)
# Agreement: lengths as a share of the wanted fin, planarity in percent, angles in degrees.
SAME_LENGTH, SAME_PERCENT, SAME_DEG = 1e-6, 1e-8, 1e-3


class Surface:
    """Triangles of an OBJ file, polygons from their first corner or, with five corners and more, from their middle."""

    def __init__(self, path: Path, unit: str = "mm") -> None:
        points, normals, faces, self.axes = [], [], [], None
        of_vertex: dict[int, int] = {}
        for line in path.read_text().splitlines():
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append([float(x) * UNITS[unit] for x in words[1:4]])
            elif words[0] == "vn":
                normals.append([float(x) for x in words[1:4]])
            elif words[0] == "f":
                corners = [word.split("/") for word in words[1:]]
                face = [int(c[0]) - 1 if int(c[0]) > 0 else len(points) + int(c[0]) for c in corners]
                for vertex, corner in zip(face, corners):
                    if len(corner) > 2 and corner[2]:
                        of_vertex[vertex] = int(corner[2]) - 1
                faces.append(face)
        triangles = []
        for face in faces:
            if len(face) == 4:
                a, b, c, d = (np.array(points[k]) for k in face)
                short = np.linalg.norm(a - c) <= np.linalg.norm(b - d)
                triangles += [[face[0], face[1], face[2]], [face[0], face[2], face[3]]] if short else [[face[0], face[1], face[3]], [face[1], face[2], face[3]]]
            elif len(face) == 3:
                triangles.append(face)
            else:
                points.append(np.mean([points[k] for k in face], axis=0).tolist())
                triangles += [[a, b, len(points) - 1] for a, b in zip(face, face[1:] + face[:1])]
        self.points, self.triangles = np.array(points), np.array(triangles)
        if normals and len(of_vertex) == len(points):
            axes = np.array([normals[of_vertex[k]] for k in range(len(points))])
            self.axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)

    def euler(self) -> int:
        edges = {tuple(sorted(pair)) for t in self.triangles.tolist() for pair in zip(t, t[1:] + t[:1])}
        return len(set(self.triangles.ravel().tolist())) - len(edges) + len(self.triangles)

    def nearest(self, p: np.ndarray) -> tuple[float, int, np.ndarray]:
        """Distance, triangle and shares of its corners of the point nearest to `p`: inside each triangle, or on one of its sides."""
        a, b, c = (self.points[self.triangles[:, k]] for k in range(3))
        best = (np.inf, 0, np.zeros(3))
        normal = np.cross(b - a, c - a)
        area = np.einsum("ij,ij->i", normal, normal)
        shares = np.stack([np.einsum("ij,ij->i", np.cross(v - u, p - u), normal) / area for u, v in ((b, c), (c, a), (a, b))], axis=1)
        inside = np.all(shares >= 0, axis=1)
        height = np.abs(np.einsum("ij,ij->i", p - a, normal)) / np.sqrt(area)
        if inside.any():
            k = int(np.argmin(np.where(inside, height, np.inf)))
            best = (float(height[k]), k, shares[k])
        for i, (u, v) in enumerate(((a, b), (b, c), (c, a))):
            t = np.clip(np.einsum("ij,ij->i", p - u, v - u) / np.einsum("ij,ij->i", v - u, v - u), 0, 1)
            far = np.linalg.norm(u + t[:, None] * (v - u) - p, axis=1)
            k = int(np.argmin(far))
            if far[k] < best[0]:
                share = np.zeros(3)
                share[i], share[(i + 1) % 3] = 1 - t[k], t[k]
                best = (float(far[k]), k, share)
        return best


def found(structure: Path, surface: Surface, wanted: float) -> dict:
    """The figures of `design --json`, as far as structure and surface tell them."""
    data = json.loads(structure.read_text())
    points, faces, fins = np.array(data["positions"]), data["faces"], data["fins"]
    edges = Counter(tuple(sorted(pair)) for face in faces for pair in zip(face, face[1:] + face[:1]))
    rim = {node for edge, count in edges.items() if count == 1 for node in edge}
    valence = Counter(node for edge in edges for node in edge)
    lengths = np.array([np.linalg.norm(points[a] - points[b]) for a, b in edges if a not in rim and b not in rim])
    inside = [face for face in faces if not any(edges[tuple(sorted(pair))] == 1 for pair in zip(face, face[1:] + face[:1]))]
    nearest = [surface.nearest(p) for p in points]
    distances = np.array([near[0] for near in nearest])
    result = {
        "nodes": len(points),
        "fins": len(fins),
        "faces": len(faces),
        "euler": len(points) - len(edges) + len(faces),
        "surface_euler": surface.euler(),
        "most_faces_at_an_edge": max(edges.values()),
        "quads_inside": all(len(face) == 4 for face in inside),
        "quads": all(len(face) == 4 for face in faces),
        "singular": sorted((node, count) for node, count in valence.items() if node not in rim and count != 4),
        "in_band": float(np.mean((lengths >= BAND[0] * wanted) & (lengths <= BAND[1] * wanted))),
        "median": float(np.median(lengths)),
        "planarity_percent": float(100 * planarities(structure).max()),
        "distance": float(distances.max()),
        "turn_deg": None,
    }
    if surface.axes is not None:
        axes = np.array(data["axes"])
        turn = []
        for axis, (_, triangle, shares) in zip(axes, nearest):
            aim = shares @ surface.axes[surface.triangles[triangle]]
            turn.append(np.degrees(np.arctan2(np.linalg.norm(np.cross(axis, aim)), axis @ aim)))
        result["turn_deg"] = float(np.max(turn))
    return result


def differences(structure: Path, surface: Surface, report: dict) -> list[str]:
    """Where a report is not what was found, and what does not hold."""
    wanted = report["edge"]["wanted"]
    own = found(structure, surface, wanted)
    said = {key: report[key] for key in ("nodes", "fins", "faces", "euler")}
    said["singular"] = sorted((node["node"], node["valence"]) for node in report["singular"])
    misses = [f"{key}: {own[key]}, said {value}" for key, value in said.items() if own[key] != value]
    near = [
        ("in_band", report["edge"]["in_band"], 1e-9),
        ("planarity_percent", report["planarity_percent"]["after"]["max"], SAME_PERCENT),
        ("distance", report["surface_distance"]["max"], SAME_LENGTH * wanted),
        ("turn_deg", report["axis_turn_deg"]["max"], SAME_DEG),
    ]
    misses += [f"{key}: {own[key]}, said {value}" for key, value, slack in near if own[key] is not None and abs(own[key] - value) > slack]
    claims = {
        "Euler number is not the surface's": own["euler"] != own["surface_euler"],
        "an edge has more than two faces": own["most_faces_at_an_edge"] > 2,
        "a face inside is no quad": not own["quads_inside"],
        "a fin is not planar to 1e-6 %": own["planarity_percent"] > 1e-6,
        "triangles were flipped or faces reversed": report["flipped"] != 0 or report["reversed"] != 0,
    }
    return misses + [claim for claim, holds in claims.items() if holds]


def main() -> int:
    structure, surface, report = (Path(word) for word in sys.argv[1:4])
    misses = differences(structure, Surface(surface, *sys.argv[4:5]), json.loads(report.read_text()))
    print("\n".join(misses) or "agrees")
    return 1 if misses else 0


if __name__ == "__main__":
    sys.exit(main())
