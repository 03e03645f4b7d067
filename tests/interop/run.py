"""Makes jobs with a finwright binary and checks each from outside: `run.py BINARY [--meshes DIR]`; exits 1 on any failure."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import design
import nesting
from check_job import check_same
from nest_layout import faults as layout_faults
from planar import SAME, planarities

HERE = Path(__file__).resolve().parent
ACCEPT = ["--accept-flexible", "interop test"]
REFUSED = 3

# Further arguments of `make` for embedded examples that need them; all others are made as they are.
EXAMPLES: dict[str, list[str]] = {}

# Outside meshes, looked for in --meshes. One point or direction for all axes makes every fin planar; the choices below leave the
# widest smallest angle between fins. Where strips fold sharply the sheet is one that folds without breaking. YasIsland has nodes under
# 1 degree whatever the direction or point, conical1 under 5: they must be refused.
MESHES: dict[str, list[str]] = {
    "quad_dome.obj": ["--axes", "point:5,5,-0.44", "--units", "m", "--scale", "1:20"],
    "conical1.obj": ["--axes", "point:0.1,1.4,-2", "--units", "m", "--scale", "1:20"],
    "botanic-garden-bubble-0.obj": ["--axes", "point:-0.44,4.27,-1.67", "--units", "m", "--scale", "1:20", "-t", "petg-1"],
    "6-sub-lifted.obj": ["--axes", "0,0,-1", "--units", "m", "--scale", "1:14", "-t", "petg-1"],
    "YasIsland.obj": ["--axes", "0,0,1", "--units", "m", "--scale", "1:20"],
}

# Cases that must be refused even with a reason for being flexible: the check is then that no cut file exists.
REFUSALS: set[str] = {"mesh conical1", "mesh YasIsland"}

# The same meshes with fins made planar from their normals, at a scale and on a sheet on which they pass.
PLANARISED: dict[str, list[str]] = {
    "quad_dome.obj": ["--units", "m", "--scale", "1:20"],
    "conical1.obj": ["--units", "m", "--scale", "1:15"],
    "botanic-garden-bubble-0.obj": ["--units", "m", "--scale", "1:12", "-t", "petg-1"],
    "6-sub-lifted.obj": ["--units", "m", "--scale", "1:10", "-t", "petg-1"],
    "YasIsland.obj": ["--units", "m", "--scale", "1:10", "-t", "petg-1"],
    # Triangles: three strips meet everywhere. In higher fins discs have room at all of them, and it is a job of ten thousand parts.
    "inspired_mesh.obj": ["--units", "m", "--scale", "1:10", "-t", "petg-1", "--depth", "3,3"],
}
PLANAR_ENOUGH = 1e-4

# Single fins and connectors; all take a quarter of an hour, so that a run has the first two unless asked. Eight plates of 3 mm are more than the vault's axes hold.
CONNECTED: dict[str, list[str]] = {
    "hub five": ["five", "--joint", "hub"],
    "hinge three": ["three", "--joint", "hinge"],
    **{f"hub {name}": [name, "--joint", "hub"] for name in ("three", "vault", "dome")},
    **{f"hinge {name}": [name, "--joint", "hinge"] for name in ("five", "dome")},
    "hinge vault": ["vault", "--joint", "hinge", "-t", "pmma-cast-2"],
}

# The same of outside meshes: quad_dome has inner nodes with three fins, YasIsland with five.
CONNECTED_MESHES: dict[str, list[str]] = {
    "quad_dome.obj": ["--joint", "hub", "--units", "m", "--scale", "1:20"],
    "YasIsland.obj": ["--joint", "hub", "--units", "m", "--scale", "1:5", "-t", "pmma-xt-1.5"],
}


# Surfaces to design on, trimmed and aligned.
DESIGNED: list[tuple[str, list[str]]] = [("hill", []), ("dome-surface", ["--align", "boundary"]), ("court", ["--axes", "point:0,0,-3000"])]


@dataclass
class Case:
    name: str
    structure: list[str]
    arguments: list[str]


class Runner:
    def __init__(self, binary: Path, scratch: Path, extra: list[str]) -> None:
        self.binary, self.scratch, self.extra = binary, scratch, extra
        self.passed, self.failed = 0, []
        self.telling = threading.Lock()

    def note(self, name: str, holds: bool, text: str = "") -> None:
        with self.telling:
            print(f"{'PASS' if holds else 'FAIL'} {name}{'  ' + text if text else ''}", flush=True)
            if holds:
                self.passed += 1
            else:
                self.failed.append(name)

    def finwright(self, *words: str) -> subprocess.CompletedProcess:
        return subprocess.run([str(self.binary), *words], cwd=self.scratch, capture_output=True, text=True, check=False)

    def make(self, case: Case, folder: str) -> subprocess.CompletedProcess:
        return self.finwright("make", *case.structure, *case.arguments, *self.extra, "-q", "-o", folder)

    def run(self, case: Case, again: bool) -> None:
        """Makes the job, once more with a reason where the gate refuses it, and checks what was written."""
        start = time.monotonic()
        folder = case.name.replace(" ", "-")
        made = self.make(case, folder)
        how = ""
        if made.returncode == REFUSED:
            cut_files = [p.name for p in (self.scratch / folder).rglob("*") if p.suffix in (".dxf", ".svg", ".pdf")]
            self.note(f"{case.name}: refused without cut files", not cut_files, ", ".join(cut_files[:3]))
            if case.name in REFUSALS:
                return
            case.arguments = [*case.arguments, *ACCEPT]
            made, how = self.make(case, folder), "flexible accepted, "
        if made.returncode != 0:
            self.note(case.name, False, f"make ended with {made.returncode}: {made.stderr.strip()[-600:]}")
            return
        if case.name in REFUSALS:
            self.note(f"{case.name}: refused", False, "it was made")
            return
        built = time.monotonic() - start
        checked = subprocess.run([sys.executable, str(HERE / "check_job.py"), folder], cwd=self.scratch, capture_output=True, text=True, check=False)
        print(checked.stdout + checked.stderr, end="")
        self.note(case.name, checked.returncode == 0, f"{how}made in {built:.1f} s, checked in {time.monotonic() - start - built:.1f} s")
        if '"connector"' in (self.scratch / folder / "job.json").read_text("utf-8"):
            self.verify(case, folder)
        if again:
            self.compare(case, folder)

    def verify(self, case: Case, folder: str) -> None:
        verified = self.finwright("verify", folder, "-q")
        self.note(f"{case.name}: verify", verified.returncode == 0, verified.stderr.strip()[-300:])

    def coupon(self) -> None:
        """The kerf and fit coupon passes the same checks of its files and sheets."""
        made = self.finwright("coupon", "-q", "-o", "coupon")
        checked = subprocess.run([sys.executable, str(HERE / "check_job.py"), "coupon"], cwd=self.scratch, capture_output=True, text=True, check=False)
        print(checked.stdout + checked.stderr, end="")
        self.note("coupon", made.returncode == 0 and checked.returncode == 0, made.stderr.strip()[-300:])

    def planarise(self, mesh: Path) -> None:
        """Planarises a mesh and measures the written fins again: planar, and as planar as the command says."""
        for fins in ([], ["--boundary-fins"]):
            name = f"planarise {mesh.stem}{' all fins' if fins else ''}"
            out = self.scratch / f"{mesh.stem}-planar.json"
            ran = self.finwright("planarise", str(mesh), "--units", "m", *fins, "-o", str(out), "-q", "--json")
            if ran.returncode != 0:
                self.note(name, False, f"ended with {ran.returncode}: {ran.stderr.strip()[-300:]}")
                continue
            said = json.loads(ran.stdout)["figures"]["after"]["worst_percent"] / 100
            worst = float(planarities(out).max())
            self.note(name, worst <= PLANAR_ENOUGH and abs(worst - said) <= SAME, f"worst fin {100 * worst:.2e} %, said {100 * said:.2e} %")

    def design(self, name: str, words: list[str]) -> None:
        """Designs on an embedded surface and finds every figure of the report again from structure and surface."""
        label = " ".join(["design", name, *words])
        place = self.scratch / label.replace(" ", "-")
        surface, out = place.with_suffix(".obj"), place.with_suffix(".json")
        written = self.finwright("example", "write", name, "-o", str(surface))
        ran = self.finwright("design", str(surface), "--nodes", "400", *words, "-o", str(out), "-q", "--json")
        if written.returncode != 0 or ran.returncode != 0:
            self.note(label, False, (written.stderr + ran.stderr).strip()[-300:])
            return
        misses = design.differences(out, design.Surface(surface), json.loads(ran.stdout))
        self.note(label, not misses, "; ".join(misses))

    def compare(self, case: Case, folder: str) -> None:
        made = self.make(case, f"{folder}-again")
        if made.returncode != 0:
            self.note(f"{case.name}: same bytes again", False, f"make ended with {made.returncode}")
            return
        report = check_same(self.scratch / folder, self.scratch / f"{folder}-again")
        print(report.text())
        self.note(f"{case.name}: same bytes again", not report.misses())


def cases(runner: Runner, meshes: Path | None, connectors: bool) -> list[Case]:
    found = [Case("default", [], [])]
    listed = runner.finwright("example", "list")
    # Surfaces are for `design`, not for `make`.
    names = [line.split()[0] for line in listed.stdout.splitlines() if line.strip() and " surface: " not in line]
    runner.note("example list", listed.returncode == 0 and bool(names), ", ".join(names))
    for name in names:
        written = runner.finwright("example", "write", name, "-o", f"{name}.json")
        if written.returncode != 0:
            runner.note(f"example {name}", False, written.stderr.strip()[-300:])
            continue
        found.append(Case(f"example {name}", [f"{name}.json"], EXAMPLES.get(name, [])))
    found += [Case(f"fixture {Path(words[0]).stem}", words[:1], words[1:]) for words in fixture_commands()]
    for name, arguments in MESHES.items() if meshes else ():
        found.append(Case(f"mesh {Path(name).stem}", [str((meshes / name).resolve())], arguments))
    for name, arguments in PLANARISED.items() if meshes else ():
        found.append(Case(f"planarised {Path(name).stem}", [str((meshes / name).resolve())], arguments))
    chosen = list(CONNECTED.items())[: None if connectors else 2]
    quick = [] if runner.extra else ["--effort", "quick"]
    found += [Case(name, words[:1], [*words[1:], *quick]) for name, words in chosen]
    for name, arguments in CONNECTED_MESHES.items() if meshes and connectors else ():
        found.append(Case(f"hub mesh {Path(name).stem}", [str((meshes / name).resolve())], arguments))
    return found


def fixture_commands() -> list[list[str]]:
    """The words after `finwright make` of each command in fixtures/README.md, its files as they lie on this disk."""
    root = HERE.parent.parent
    lines = (root / "fixtures" / "README.md").read_text().splitlines()
    commands = [line.split()[2:] for line in lines if line.startswith("    finwright make ")]
    return [[str(root / word) if word.startswith("fixtures/") else word for word in words] for words in commands]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary", type=Path)
    parser.add_argument("--meshes", type=Path, metavar="DIR", help="also the outside meshes found there")
    parser.add_argument("--connectors", action="store_true", help="all single fins and connectors: a quarter of an hour")
    parser.add_argument("--only", default="", metavar="WORD", help="only cases whose name has WORD")
    parser.add_argument("--effort", choices=("quick", "normal", "thorough"), help="of the nesting")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="finwright-interop-") as scratch:
        extra = ["--effort", options.effort] if options.effort else []
        runner = Runner(options.binary.resolve(), Path(scratch), extra)
        chosen = [case for case in cases(runner, options.meshes, options.connectors) if options.only in case.name]
        meshes = [name for name in PLANARISED if options.meshes and options.only in f"planarise {name}"]
        # Each waits for programs of its own: as many at a time as there are cores; the long ones, which stand last, begin.
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            started = [pool.submit(runner.run, case, case.name == "default") for case in reversed(chosen)]
            started += [pool.submit(runner.planarise, (options.meshes / name).resolve()) for name in meshes]
            if options.only in "nest":
                started.append(pool.submit(nesting.checked, runner, layout_faults))
            for name, words in DESIGNED:
                if options.only in f"design {name}":
                    started.append(pool.submit(runner.design, name, words))
            if options.only in "coupon":
                started.append(pool.submit(runner.coupon))
            for task in started:
                task.result()
    for name in runner.failed:
        print(f"failed: {name}")
    print(f"{runner.passed} passed, {len(runner.failed)} failed")
    return 1 if runner.failed else 0


if __name__ == "__main__":
    sys.exit(main())
