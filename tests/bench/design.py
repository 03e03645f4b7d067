"""The reference table of docs/design.md, by hand: `design.py BINARY SURFACES_DIR [--only WORD] [--check]`. Each surface twice, trimmed and
aligned, about 700 nodes; figures beside the prototype's (in brackets) and whether they keep to the limits: in band at least .02 below it,
largest turn at most 1.15 times its or 1 degree more, singular nodes a third more than its plus 2. `--check` measures each structure again
with tests/interop/design.py. Surfaces that are no files are made here."""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "interop"))

# In band, largest turn, singular nodes of the prototype; trimmed, aligned. None: it gives no figure.
TABLE: dict[str, tuple] = {
    "kogod": ((0.994, 4.9, 0), (1.0, 6.3, 0)),
    "facade_axes": ((0.981, 5.9, 1), (0.919, 14.3, 0)),
    "facade": (None, None),
    "hill": ((0.778, 5.1, 6), (0.758, 13.2, 12)),
    "ring_cap": ((0.814, 1.4, 0), (0.777, 0.5, 0)),
    "dome": ((0.997, 2.7, 4), (0.825, 2.6, 4)),
    "court": ((0.952, 2.6, 3), (0.883, 22.9, 8)),
    "torus_part": ((1.0, 3.6, 0), (1.0, 0.8, 0)),
    "ellipsoid": ((0.945, 2.6, 8), None),
    "inspired_mesh": ((0.948, 3.7, 4), (0.792, 25.2, 8)),
    "flat": (None, (1.0, 0.1, 0)),
    "disk": (None, (0.61, None, 4)),
    "sphere_cap": (None, (0.61, None, 4)),
    "folded_roof": ((None, 24.0, None), (None, 24.0, None)),
    "sphere": ((None, None, 32), None),
    "apse": (None, None),
}


def obj(points: list, faces: list) -> str:
    return "".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in points) + "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces)


def grid(columns: int, rows: int, place) -> str:
    at = lambda i, j: j * (columns + 1) + i
    points = [place(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    cells = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(rows) for i in range(columns)]
    return obj(points, [t for a, b, c, d in cells for t in ((a, b, c), (a, c, d))])


def rings(count: int, height) -> str:
    """A disk of radius 10 in rings of 6, 12, 18 ... vertices."""
    points, faces, first = [(0.0, 0.0, height(0.0))], [], [0]
    for ring in range(1, count + 1):
        first.append(len(points))
        for k in range(6 * ring):
            r, t = 10 * ring / count, math.tau * k / (6 * ring)
            points.append((r * math.cos(t), r * math.sin(t), height(r)))
        low = lambda k: first[ring - 1] + (k % (6 * (ring - 1)) if ring > 1 else 0)
        high = lambda k: first[ring] + k % (6 * ring)
        for sector in range(6):
            for k in range(ring):
                i, o = sector * (ring - 1) + k, sector * ring + k
                faces.append((low(i), high(o), high(o + 1)))
                if k + 1 < ring:
                    faces.append((low(i), high(o + 1), low(i + 1)))
    return obj(points, faces)


def closed(steps: int, radii: tuple) -> str:
    """An icosahedron cut finer and blown up."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    sides = "0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8 3 9 4 3 4 2 3 2 6 3 6 8 3 8 9 4 9 5 2 4 11 6 2 10 8 6 7 9 8 1"
    sides = [int(word) for word in sides.split()]
    number, points, faces = {}, [], []

    def vertex(p: tuple) -> int:
        r = math.sqrt(sum(x * x for x in p))
        key = tuple(round(x / r, 7) + 0.0 for x in p)
        if key not in number:
            number[key] = len(points)
            points.append(tuple(x / r * s for x, s in zip(p, radii)))
        return number[key]

    for k in range(0, len(sides), 3):
        a, b, c = (corners[side] for side in sides[k : k + 3])
        at = lambda i, j: vertex(tuple(a[m] + (b[m] - a[m]) * i / steps + (c[m] - a[m]) * j / steps for m in range(3)))
        for i in range(steps):
            for j in range(steps - i):
                faces.append((at(i, j), at(i + 1, j), at(i, j + 1)))
                if i + j + 1 < steps:
                    faces.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
    return obj(points, faces)


def torus(u: float, v: float) -> tuple:
    s, t = math.radians(-100 + 200 * u) / 2, math.radians(-65 + 130 * v)
    return ((14 + 6 * math.cos(t)) * math.sin(s), (14 + 6 * math.cos(t)) * math.cos(s), 6 * math.sin(t))


MADE = {
    "torus_part": lambda: grid(59, 21, torus),
    "ellipsoid": lambda: closed(19, (12.0, 9.0, 7.0)),
    "flat": lambda: grid(40, 25, lambda u, v: (20 * u, 12.5 * v, 0.0)),
    "disk": lambda: rings(22, lambda r: 0.0),
    "sphere_cap": lambda: rings(22, lambda r: math.sqrt(14 * 14 - r * r)),
    "folded_roof": lambda: grid(48, 30, lambda u, v: (24 * u, 15 * v, 4 - abs(8 * v - 4) + 0.8 * math.sin(math.pi * u))),
    "sphere": lambda: closed(8, (10.0, 10.0, 10.0)),
}


def measured(words: list[str]) -> tuple[int, str, str, float, float]:
    """Exit code, both outputs, processor seconds and megabytes of a command."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        child = subprocess.Popen(words, stdout=out, stderr=err)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), err.seek(0)
        return child.returncode, out.read(), err.read(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def limits(said: dict, aim: tuple | None) -> list[str]:
    """What a report misses of the prototype's figures."""
    band, turn, singular = aim or (None, None, None)
    missed = {
        "in band": band is not None and said["edge"]["in_band"] < band - 0.02,
        "turn": turn is not None and said["axis_turn_deg"]["max"] > max(1.15 * turn, turn + 1),
        "singular": singular is not None and len(said["singular"]) > singular * 4 / 3 + 2,
        "planarity": said["planarity_percent"]["after"]["max"] > 1e-6,
        "reversed": said["reversed"] != 0 or said["flipped"] != 0,
        "alignment": any(f["code"].startswith("design::alignment") for f in said["findings"]),
    }
    return [name for name, holds in missed.items() if holds]


def row(name: str, mode: str, said: dict, aim: tuple | None, seconds: float) -> str:
    band, turn, singular = aim or (None, None, None)
    beside = lambda value: "" if value is None else f"({value:g})"
    valences = [node["valence"] for node in said["singular"]]
    kinds = " ".join(f"{valences.count(k)}v{k}" for k in sorted(set(valences))) or "none"
    edge, wanted = said["edge"], said["edge"]["wanted"]
    lengths = "/".join(f"{edge[key] / wanted:.2f}" for key in ("p5", "median", "p95"))
    return (
        f"{name:13} {mode:8} {said['nodes']:4}/{said['fins']:4}  {kinds:12}{beside(singular):5} {lengths}  {edge['in_band']:.3f}{beside(band):8} "
        f"{said['axis_turn_deg']['max']:5.1f}{beside(turn):7} off {said['surface_distance']['max'] / wanted:.3f}  "
        f"angle {said['fin_angle_deg']['least']:3.0f}  {seconds:5.2f} s"
    )


def surfaces(folder: Path, place: Path) -> dict[str, Path]:
    found = {}
    for name in TABLE:
        near = [path for path in (folder / f"{name}.obj", folder.parent / "meshes" / f"{name}.obj") if path.is_file()]
        if name in MADE:
            near = [place / f"{name}.obj"]
            near[0].write_text(MADE[name]())
        if near:
            found[name] = near[0]
        else:
            print(f"{name}: no such file")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary", type=Path)
    parser.add_argument("surfaces", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--with", dest="extra", default="", help="more words for `finwright design`")
    options = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory() as scratch:
        place = Path(scratch)
        for name, path in surfaces(options.surfaces, place).items():
            if options.only not in name:
                continue
            closed_surface = name in ("ellipsoid", "sphere")
            for mode, aim in zip(("none", "boundary")[: 1 if closed_surface else 2], TABLE[name]):
                out = place / "out.json"
                words = [str(options.binary), "design", str(path), "--units", "m", "--nodes", "700", "--align", mode, "-o", str(out), "--json", "-q"]
                code, text, told, seconds, _ = measured(words + options.extra.split())
                if code != 0:
                    failed += 1
                    print(f"{name:13} {mode:8} FAIL ended with {code}: {' '.join(told.split())[:200]}", flush=True)
                    continue
                said = json.loads(text)
                missed = limits(said, aim)
                if options.check:
                    import design as again  # tests/interop/design.py

                    missed += again.differences(out, again.Surface(path, "m"), said)
                failed += bool(missed)
                print(row(name, mode, said, aim, seconds), "FAIL " + ", ".join(missed) if missed else "pass", flush=True)
    print(f"{failed} rows miss something")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
