"""Shows that the checks pass a right job and find each planted fault: `python selftest.py [BINARY]`.

With a finwright binary, also in a job of single fins and hubs that it makes.
"""

from __future__ import annotations

import argparse
import copy
import sys
import tempfile
from pathlib import Path
from typing import Callable

import ezdxf
import pymupdf

from check_job import check, check_same
from report import Report
from selftest_connectors import facts as connector_facts
from selftest_held import FAULTS as HELD_FAULTS
from tiny_hub import tiny_hub
from tiny_job import STRIPS, Corner, Path2, TinyJob, runs_of, slit_of, tiny_job
from tiny_splice import spliced

Fault = tuple[str, Callable[[], TinyJob], str]


def slit_reshaped(name: str, node: int, shift: float = 0.0, narrower: float = 0.0, deeper: float = 0.0):
    """Moves the corners of one slit in the outline."""
    slit, run = slit_of(name, node), runs_of(name)[STRIPS[name].index(node)]
    middle, half = run + slit["offset"], slit["width"] / 2

    def reshape(part: str, contour: list[Corner]) -> list[Corner]:
        if part != name:
            return contour
        inner = {k for k, corner in enumerate(contour) if corner[2] or contour[k - 1][2]}
        down = -deeper if slit["from"] == "top" else deeper
        moved = []
        for k, (x, y, bulge) in enumerate(contour):
            if abs(abs(x - middle) - half) < 1e-6:
                x += shift - narrower / 2 * (1 if x > middle else -1)
                y += down if k in inner else 0
            moved.append((x, y, bulge))
        return moved

    return reshape


def slit_listed(job: TinyJob, name: str, node: int, **change: float) -> TinyJob:
    slit = next(slit for slit in part_of(job, name)["strip"]["slits"] if slit["node"] == node)
    for key, by in change.items():
        slit[key] += by
    return job


def part_of(job: TinyJob, name: str) -> dict:
    return next(part for part in job.manifest["parts"] if part["id"] == name)


def changed(change: Callable[[TinyJob], object]) -> Callable[[], TinyJob]:
    def make() -> TinyJob:
        job = tiny_job()
        change(job)
        return job

    return make


def edited(file: str, change: Callable[[str], str]) -> Callable[[], TinyJob]:
    """A text file changed after it was written."""

    def edit(folder: Path) -> None:
        path = folder / file
        text = path.read_text()
        new = change(text)
        assert new != text, f"the fault did not change {file}"
        path.write_text(new)

    return changed(lambda job: job.after.append(edit))


def redrawn(change: Callable) -> Callable[[], TinyJob]:
    """The DXF opened with ezdxf and changed."""

    def edit(folder: Path) -> None:
        path = folder / "sheets/sheet-01.dxf"
        document = ezdxf.readfile(path)
        change(document, document.modelspace())
        document.saveas(path)

    return changed(lambda job: job.after.append(edit))


def mirrored_part() -> TinyJob:
    """Outline, axes and slits of S05 as its back shows them, and drawn like that."""

    def flip(part: str, contour: list[Corner]) -> list[Corner]:
        if part != "S05":
            return contour
        bulges = [corner[2] for corner in contour]
        return [(130 - x, y, bulges[k - 1]) for k, (x, y, _) in reversed(list(enumerate(contour)))]

    job = tiny_job(reshape=flip)
    for axis in part_of(job, "S05")["strip"]["axes"]:
        axis["bottom"][0], axis["top"][0] = 130 - axis["bottom"][0], 130 - axis["top"][0]
    return job


def mirrored_drawing() -> TinyJob:
    job = tiny_job()
    middle = 85.0

    def flip(path: Path2) -> Path2:
        layer, corners, closed = path
        is_s01 = layer != "SHEET" and all(y < 56 and x < 200 for x, y, _ in corners)
        return (layer, [(2 * middle - x, y, -bulge) for x, y, bulge in corners], closed) if is_s01 else path

    job.paths = [flip(path) for path in job.paths]
    return job


def two_parts() -> TinyJob:
    job = tiny_job()
    twin = copy.deepcopy(part_of(job, "S01"))
    twin["id"] = "S07"
    job.manifest["parts"].append(twin)
    return job


def bulges_flipped() -> TinyJob:
    job = tiny_job()
    job.dxf_paths = [(layer, [(x, y, -b if layer == "CUT_OUTER" else b) for x, y, b in corners], closed) for layer, corners, closed in job.paths]
    return job


def without_layer(job: TinyJob, layer: str) -> list[Path2]:
    return [path for path in job.paths if path[0] != layer]


def fold_flipped(job: TinyJob) -> None:
    part_of(job, "S02")["strip"]["folds"][0]["angle_deg"] *= -1


def slit_unlisted(job: TinyJob) -> None:
    part_of(job, "S02")["strip"]["slits"].pop(1)


def openings_swapped(job: TinyJob) -> None:
    steps = job.manifest["assembly"]
    steps[0]["part"], steps[3]["part"] = steps[3]["part"], steps[0]["part"]


def node_moved(job: TinyJob) -> None:
    job.structure["positions"][4][2] += 0.02


def fins_stretched(part: str, contour: list[Corner]) -> list[Corner]:
    """The ends are right and the edge between them is not."""
    return [(x, y + (0.05 if k == 1 and part == "S01" else 0), bulge) for k, (x, y, bulge) in enumerate(contour)]


def label_over_edge(job: TinyJob) -> None:
    job.paths.insert(0, ("ENGRAVE", [(60, 30, 0), (60, 60, 0)], False))


def other_scale(job: TinyJob) -> None:
    job.pdf_paths = [(layer, [(x * 1.001, y * 1.001, b) for x, y, b in corners], closed) for layer, corners, closed in job.paths]


def overlapping(job: TinyJob) -> None:
    x, y, _ = next(corners for layer, corners, _ in job.paths if layer == "ENGRAVE")[0]
    job.paths[:0] = [("ENGRAVE", [(x, y - 1, 0), (x, y - 4, 0)], False), ("ENGRAVE", [(x, y - 3, 0), (x, y - 6, 0)], False)]


def blank_picture(folder: Path) -> None:
    picture = pymupdf.Pixmap(pymupdf.csRGB, pymupdf.IRect(0, 0, 400, 300), False)
    picture.clear_with(255)
    picture.save(folder / "sheets/sheet-01.png")


def open_contour(_, space) -> None:
    space.query("LWPOLYLINE[layer=='CUT_OUTER']").first.closed = False


def without_units(text: str) -> str:
    """Cuts $INSUNITS and $MEASUREMENT, each two tags of two lines, out of the header."""
    rows = text.splitlines()
    for name in ("$INSUNITS", "$MEASUREMENT"):
        at = rows.index(name)
        del rows[at - 1 : at + 3]
    return "\n".join(rows) + "\n"


def slit_deeper(job: TinyJob) -> TinyJob:
    """Both the list and the drawing have the slit 0.5 mm shallower, so the pair no longer reaches through."""
    return slit_listed(job, "S01", 1, depth=-0.5)


NARROW = dict(narrower=0.3)
FAULTS: list[Fault] = [
    ("DXF scaled by 25.4", changed(lambda job: setattr(job, "dxf_scale", 25.4)), "svg = dxf: distance"),
    ("PDF larger by 0.1 %", changed(other_scale), "pdf = dxf: distance"),
    ("slit moved in the outline", lambda: tiny_job(slit_reshaped("S01", 1, shift=0.05)), "slits: offset in the outline"),
    ("slit moved and listed so", lambda: slit_listed(tiny_job(slit_reshaped("S01", 1, shift=0.05)), "S01", 1, offset=0.05), "slits: offset by formula"),
    ("slit too narrow", lambda: tiny_job(slit_reshaped("S05", 7, **NARROW)), "slits: width in the outline"),
    ("slit too narrow and listed so", lambda: slit_listed(tiny_job(slit_reshaped("S05", 7, **NARROW)), "S05", 7, width=-0.3), "slits: width by formula"),
    ("slit too shallow", lambda: tiny_job(slit_reshaped("S05", 4, deeper=-0.1)), "slits: depth in the outline"),
    ("slits that do not meet", lambda: slit_deeper(tiny_job(slit_reshaped("S01", 1, deeper=-0.5))), "slits: a pair reaches through"),
    ("slit not listed", changed(slit_unlisted), "slits: one top and one bottom"),
    ("slit not cut", lambda: tiny_job(lambda n, c: [p for k, p in enumerate(c) if n != "S01" or not 6 < k < 11]), "slits: width in the outline"),
    ("angle of crossing wrong", changed(lambda job: slit_listed(job, "S03", 7, crossing_deg=1)), "slits: crossing angle"),
    ("part mirrored", mirrored_part, "refold: labelled face in front"),
    ("drawing of a part mirrored", mirrored_drawing, "cuts: kerf and placement"),
    ("kerf inward", lambda: tiny_job(kerf=-0.2), "cuts: kerf and placement"),
    ("kerf left out", lambda: tiny_job(kerf=0), "cuts: kerf and placement"),
    ("whole kerf instead of half", lambda: tiny_job(kerf=0.4), "cuts: one contour for each edge"),
    ("holes grown", lambda: tiny_job(hole_kerf=-0.2), "cuts: kerf and placement"),
    ("contour drawn twice", changed(lambda job: job.paths.insert(-2, job.paths[-2])), "dxf: nothing drawn twice"),
    ("marks overlapping in part", changed(overlapping), "dxf: nothing drawn twice"),
    ("contour twice in the SVG", changed(lambda job: setattr(job, "svg_paths", job.paths + [job.paths[-2]])), "svg = dxf: drawn length"),
    ("part nudged into another", lambda: tiny_job(places={"S04": (20.0, 150.0, 0.0)}), "layout: spacing"),
    ("parts too close", lambda: tiny_job(places={"S04": (20.0, 154.0, 0.0)}), "layout: spacing"),
    ("margin violated", lambda: tiny_job(places={"S05": (13.0, 210.0, 0.0)}), "layout: margin"),
    ("placement turned the other way", changed(lambda job: job.manifest["sheets"][0]["placements"][5].update(angle_deg=-83.0)), "cuts: kerf and placement"),
    ("part not placed", changed(lambda job: job.manifest["sheets"][0]["placements"].pop()), "files: each copy placed once"),
    ("fold sign flipped", changed(fold_flipped), "refold: strips folded in space"),
    ("fold sign flipped, angles", changed(fold_flipped), "refold: fold angles"),
    ("fin on two parts", two_parts, "fins: each on exactly one part"),
    ("splice halves apart", lambda: spliced(tiny_job(), "S03", 1, gap=3.0), "refold: splice halves cover the fin"),
    ("fin on no part", changed(lambda job: job.manifest["parts"].pop(2)), "fins: each on exactly one part"),
    ("node moved by 0.02 mm", changed(node_moved), "refold: fins congruent"),
    ("fin edge off by 0.05 mm", lambda: tiny_job(fins_stretched), "refold: outline along the fins"),
    ("order of two strips swapped", changed(openings_swapped), "assembly: earlier strips open at the top"),
    ("arc bulges flipped", bulges_flipped, "svg = dxf: distance"),
    ("layer missing in the SVG", changed(lambda job: setattr(job, "svg_paths", without_layer(job, "SCORE"))), "svg = dxf: distance"),
    ("layer missing in the PDF", changed(lambda job: setattr(job, "pdf_paths", without_layer(job, "CUT_INNER"))), "pdf = dxf: distance"),
    ("layer not in the DXF table", redrawn(lambda doc, _: doc.layers.remove("SCORE")), "dxf: layers and colours"),
    ("layer of another colour", redrawn(lambda doc, _: setattr(doc.layers.get("CUT_INNER"), "color", 2)), "dxf: layers and colours"),
    ("layer of another name", redrawn(lambda _, space: space.add_line((50, 90), (55, 90), {"layer": "0"})), "dxf: polylines and lines only"),
    ("units missing", edited("sheets/sheet-01.dxf", without_units), "dxf: millimetres declared"),
    ("units are inches", redrawn(lambda doc, _: doc.header.__setitem__("$INSUNITS", 1)), "dxf: millimetres declared"),
    ("text in the DXF", redrawn(lambda _, space: space.add_text("S01", dxfattribs={"layer": "ENGRAVE"})), "dxf: polylines and lines only"),
    ("block in the DXF", redrawn(lambda doc, _: doc.blocks.new("PART")), "dxf: polylines and lines only"),
    ("contour left open", redrawn(open_contour), "dxf: cuts are closed"),
    ("layers out of order", changed(lambda job: job.paths.reverse()), "dxf: layers in drawing order"),
    ("thick strokes", edited("sheets/sheet-01.svg", lambda text: text.replace('"0.02"', '"0.1"')), "svg: stroke width"),
    ("SVG in pixels", edited("sheets/sheet-01.svg", lambda text: text.replace("mm", "")), "svg: only thin plain strokes"),
    ("SVG with a transform", edited("sheets/sheet-01.svg", lambda text: text.replace("<g ", '<g transform="scale(1)" ', 1)), "svg: only thin plain strokes"),
    ("SVG filled", edited("sheets/sheet-01.svg", lambda text: text.replace('fill="none"', 'fill="black"')), "svg: only thin plain strokes"),
    ("label over an edge", changed(label_over_edge), "marks: inside their part"),
    ("picture blank", changed(lambda job: job.after.append(blank_picture)), "png: not blank"),
    ("home folder in the report", edited("report.html", lambda text: text + "/home/someone/vault.json"), "files: no absolute paths"),
    ("a key missing", changed(lambda job: job.manifest["material"].pop("kerf")), "files: job.json as agreed"),
    ("a number as text", changed(lambda job: job.manifest["totals"].update(mass="1 kg")), "files: job.json as agreed"),
]


def _checked(job: TinyJob, folder: Path) -> Report:
    job.write(folder)
    return check(folder)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary", type=Path, nargs="?", metavar="BINARY")
    binary = parser.parse_args().binary
    passed, failed = 0, []
    with tempfile.TemporaryDirectory() as scratch:
        tiny_job().write(Path(scratch, "right"))
        tiny_job().write(Path(scratch, "again"))
        right = check(Path(scratch, "right"))
        same = check_same(Path(scratch, "right", "sheets"), Path(scratch, "again", "sheets"))
        # ezdxf stamps the time, so these two runs differ: a natural fault for the comparison of bytes.
        others = {
            "with a splice": spliced(tiny_job(), "S03", 1),
            "with ends in discs": tiny_hub(),
            **{f"with fin {k} of a ring in discs spliced": spliced(tiny_hub(), "S02", k) for k in range(3)},
        }
        reports = {name: _checked(job, Path(scratch, name)) for name, job in others.items()}
        facts = {
            "a right job passes": not right.misses(),
            **{f"a right job {name} passes": not report.misses() for name, report in reports.items()},
            "unequal bytes are found": bool(same.misses()),
            **(connector_facts(binary.resolve(), Path(scratch)) if binary else {}),
        }
        for name, holds in facts.items():
            print(f"{'holds ' if holds else 'FAILS '} {name}")
            passed, failed = (passed + 1, failed) if holds else (passed, [*failed, name])
        for report in (right, *reports.values()):
            if report.misses():
                print(report.text())
        for number, (name, make, expected) in enumerate([*FAULTS, *HELD_FAULTS]):
            folder = Path(scratch, f"fault-{number:02}")
            make().write(folder)
            misses = check(folder).misses()
            found = expected in misses
            print(f"{'found ' if found else 'MISSED'} {name:<34} {expected}  (all: {len(misses)})")
            passed, failed = (passed + 1, failed) if found else (passed, [*failed, f"{name}: {misses}"])
    for name in failed:
        print(f"FAILED {name}")
    print(f"{passed} passed, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
