"""Real drawings through `finwright nest` and through ezdxf or svgelements: do both see the same?

    python corpus.py BINARY DIR [--only WORD] [--list KIND]

Run by hand on a folder of DXF and SVG files from anywhere. Of each file the closed lines are
compared: their number, the sum of their areas, the box around all of them (0.5 %). A file
agrees, differs with a word (a warning or an error that names what is missing), differs in
silence, or its reference is undecided (lines that meet three at a corner). Exits 1 on a
silent difference, a panic, or a run over 20 s.
"""

import argparse
import collections
import io
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import warnings

import ezdxf
import ezdxf.path
import ezdxf.recover
import svgelements
from ezdxf import units
from shapely import STRtree
from shapely.geometry import Point, Polygon

JOINED = 0.01  # mm: ends this near are one
SAGITTA = 0.01  # mm: how far flattened curves may be off
ENGRAVED = ("engrav", "etch")
# They say nothing of what is missing.
NO_WORD = ("does not say its unit", "fits no sheet", "cannot be placed")


class Lines:
    """Lines of a drawing, mm: rings, and open lines yet to be joined."""

    def __init__(self):
        self.rings, self.open, self.others = [], [], collections.Counter()

    def add(self, points, closed):
        points = [p for k, p in enumerate(points) if k == 0 or p != points[k - 1]]
        if not all(math.isfinite(c) for p in points for c in p):
            self.others["not finite"] += 1
        elif len(points) > 2 and (closed or math.dist(points[0], points[-1]) <= JOINED):
            self.rings.append(points)
        elif len(points) > 1 and not closed:
            self.open.append(points)

    def joined(self):
        """Rings, and whether some open lines meet three at a corner."""
        ends = [p for line in self.open for p in (line[0], line[-1])]
        cluster = list(range(len(ends)))

        def root(k):
            while cluster[k] != k:
                cluster[k] = cluster[cluster[k]]
                k = cluster[k]
            return k

        if ends:
            tree = STRtree([Point(p) for p in ends])
            for k, p in enumerate(ends):
                for near in tree.query(Point(p).buffer(JOINED), predicate="intersects"):
                    cluster[root(int(near))] = root(k)
        at = collections.defaultdict(list)
        for k in range(len(ends)):
            at[root(k)].append(k // 2)
        edges = {k: (root(2 * k), root(2 * k + 1)) for k in range(len(self.open))}
        seen = {}
        for k, (a, b) in list(edges.items()):
            key = (min(a, b), max(a, b), len(self.open[k]), round(length(self.open[k]), 2))
            if a == b or key in seen:  # drawn twice, or no line
                del edges[k]
            seen[key] = k
        degree = {n: [k for k in set(ks) if k in edges] for n, ks in at.items()}
        loose = [n for n, ks in degree.items() if len(ks) == 1]
        while loose:  # dead ends are no outline
            node = loose.pop()
            for k in list(degree[node]):
                for other in edges[k]:
                    degree[other] = [e for e in degree[other] if e != k]
                    if len(degree[other]) == 1:
                        loose.append(other)
                edges.pop(k)
        rings, undecided = list(self.rings), False
        while edges:
            start, (node, ahead) = next(iter(edges.items()))
            chain, way, simple = [], [(start, node)], True
            reached = {start}
            while way:  # the whole component
                k, _ = way.pop()
                chain.append(k)
                for n in edges[k]:
                    simple &= len(degree[n]) == 2
                    for e in degree[n]:
                        if e not in reached:
                            reached.add(e)
                            way.append((e, n))
            if simple:
                rings.append(self.walk(start, edges, degree))
            undecided |= not simple
            for k in chain:
                edges.pop(k)
        return rings, undecided

    def walk(self, start, edges, degree):
        points, k, node = [], start, edges[start][0]
        while True:
            a, b = edges[k]
            line = self.open[k] if a == node else self.open[k][::-1]
            points += line[:-1]
            node = b if a == node else a
            k = next(e for e in degree[node] if e != k) if len(set(degree[node])) > 1 else k
            if k == start:
                return points


def length(points):
    return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


def dxf(path):
    try:
        document = ezdxf.readfile(path)
    except (ezdxf.DXFError, UnicodeDecodeError):
        document, _ = ezdxf.recover.readfile(path)
    # Without a header ezdxf takes metres.
    says = b"$INSUNITS" in path.read_bytes()
    unit = document.header.get("$INSUNITS", 0) if says else 0
    mils = 9  # unknown to ezdxf
    factor = 0.0254 if unit == mils else units.conversion_factor(unit, 4) if unit else 1.0
    scale = float(factor)
    off = {
        layer.dxf.name.lower() for layer in document.layers if layer.is_off() or layer.is_frozen()
    }
    lines = Lines()

    def draw(entities, layer, depth):
        for entity in entities:
            own = entity.dxf.get("layer", "0")
            name = layer if own == "0" and layer else own
            if name.lower() in off or entity.dxf.get("invisible", 0):
                lines.others["hidden"] += 1
            elif entity.dxftype() == "INSERT" and depth < 32:
                inserts = entity.multi_insert() if entity.mcount > 1 else [entity]
                for insert in inserts:
                    draw(insert.virtual_entities(), name, depth + 1)
            elif not any(word in name.lower() for word in ENGRAVED):
                outline(entity)

    def outline(entity):
        kinds = ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE")
        if entity.dxftype() not in kinds or (
            entity.dxftype() == "POLYLINE" and not (entity.is_2d_polyline or entity.is_3d_polyline)
        ):
            lines.others[entity.dxftype()] += 1
            return
        made = ezdxf.path.make_path(entity)
        if len(made) == 0:
            return
        points = [p * scale for p in made.flattening(SAGITTA / scale, segments=8)]
        heights = [p.z for p in points]
        if max(heights) - min(heights) > 1e-3 * max(1.0, length([p.xyz for p in points])):
            lines.others["tilted"] += 1
            return
        closed = getattr(entity, "is_closed", False) or made.is_closed
        lines.add([(p.x, p.y) for p in points], bool(closed))

    draw(document.modelspace(), "", 0)
    return lines


def svg(path):
    # Animations would be taken for transformations.
    text = re.sub(rb"<animate[^>]*>(</animate\w*>)?", b"", path.read_bytes())
    drawing = svgelements.SVG.parse(io.BytesIO(text), reify=False, ppi=96)
    lines, mm = Lines(), 25.4 / 96
    for element in drawing.elements():
        if not isinstance(element, svgelements.Shape):
            continue
        if str(element.values.get("visibility")) in ("hidden", "collapse"):
            lines.others["hidden"] += 1
            continue
        if getattr(element.stroke, "hex", None) in ("#00ffff", "#808080"):
            continue
        # Arcs under a skew are wrong in svgelements 1.9.6, curves are right.
        outline = svgelements.Path(element)
        outline = svgelements.Path(outline.d(transformed=False))
        outline.approximate_arcs_with_cubics()
        outline = abs(outline * element.transform)
        for sub in outline.as_subpaths():
            points, closed = [], False
            for segment in sub:
                closed |= isinstance(segment, svgelements.Close)
                if isinstance(segment, svgelements.Move) or segment.end is None:
                    points += [segment.end] if segment.end is not None else []
                    continue
                straight = isinstance(segment, (svgelements.Line, svgelements.Close))
                steps = 1 if straight else 48
                points += [segment.point(k / steps) for k in range(1, steps + 1)]
            lines.add([(p.x * mm, p.y * mm) for p in points if p is not None], closed)
    return lines


def measured(rings):
    """Number, area and size of some rings, those drawn twice once."""
    single = {}
    for ring in rings:
        polygon = Polygon(ring)
        box = polygon.bounds
        if box[2] - box[0] > JOINED and box[3] - box[1] > JOINED and polygon.area > 1e-6:
            single[tuple(round(c, 1) for c in box) + (round(polygon.area, 0),)] = polygon
    boxes = [polygon.bounds for polygon in single.values()]
    if not boxes:
        return 0, 0.0, (0.0, 0.0)
    low, high = [[f(b[k] for b in boxes) for k in ks] for f, ks in ((min, (0, 1)), (max, (2, 3)))]
    return len(single), sum(p.area for p in single.values()), (high[0] - low[0], high[1] - low[1])


def same(ours, theirs):
    near = lambda a, b: abs(a - b) <= max(0.005 * max(abs(a), abs(b)), 0.02)  # noqa: E731
    return (
        ours[0] == theirs[0]
        and near(ours[1], theirs[1])
        and all(near(a, b) for a, b in zip(ours[2], theirs[2]))
    )


def finwright(binary, path, folder):
    """What is read, what is said, the exit code; on a sheet without room nothing is searched."""
    command = [binary, "nest", path, "--sheet", "10.01x10.01", "--json", "-o", folder]
    run = subprocess.run(command, capture_output=True, text=True, timeout=20, check=False)
    rings = []
    if run.stdout.startswith("{"):
        for part in json.loads(run.stdout).get("parts", []):
            rings += [part["outline"], *part["holes"]]
    return rings, run.stderr, run.returncode


def compared(binary, path, folder):
    """The kind of outcome, and a line about it."""
    try:
        rings, said, code = finwright(binary, path, folder)
    except subprocess.TimeoutExpired:
        return "hang", "over 20 s"
    if code not in (0, 1, 2, 3) or "panicked" in said:
        return "panic", said[-300:]
    try:
        lines = dxf(path) if path.suffix.lower() == ".dxf" else svg(path)
        theirs, undecided = lines.joined()
    except Exception as error:  # noqa: BLE001: what the reference cannot read it cannot judge
        first = said.strip().splitlines()[:1]
        return "no reference", f"{type(error).__name__}: {error} | {code} {first}"
    ours, theirs = measured(rings), measured(theirs)
    words = [line for line in said.splitlines() if line.startswith(("warning", "error"))]
    words = [word for word in words if not any(n in word for n in NO_WORD)]
    line = f"exit {code}: {ours} and {theirs} {dict(lines.others)} | {' | '.join(words)[:400]}"
    if same(ours, theirs):
        return "agrees" if ours[0] else "nothing closed, told" if words else "silent", line
    if words:
        return "told", line
    return "undecided" if undecided else "silent", line


def main():
    warnings.simplefilter("ignore")
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--list", default="silent,panic,hang")
    given = parser.parse_args()
    listed = given.list.split(",")
    counts = {kind: collections.Counter() for kind in (".dxf", ".svg")}
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(given.folder.iterdir()):
            suffix = path.suffix.lower()
            if suffix not in counts or given.only not in path.name:
                continue
            kind, line = compared(given.binary, path, folder)
            counts[suffix][kind] += 1
            if kind in listed or given.list == "all":
                print(f"{kind}: {path.name}: {line}", flush=True)
    for suffix, kinds in counts.items():
        print(suffix, sum(kinds.values()), dict(sorted(kinds.items())))
    bad = sum(kinds[kind] for kinds in counts.values() for kind in ("silent", "panic", "hang"))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
