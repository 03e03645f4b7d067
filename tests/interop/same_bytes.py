"""Makes the same jobs with two versions of finwright and compares all that they leave: `same_bytes.py OLD NEW [--keep DIR]`.

Compared are every file, standard output, standard error and the exit code. A difference counts unless EXPECTED names its pattern together
with words of CHANGELOG.md that say why. With --keep what the old version made stays in DIR and is not made again next time. Ends with 1 on
any other difference."""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
QUICK = ["--effort", "quick"]
ACCEPT = ["--accept-flexible", "same bytes"]

# What may differ: a pattern in the bytes, and words of CHANGELOG.md that say why.
EXPECTED: dict[bytes, str] = {
    rb'"(fingerprint|sha256)": ?"[0-9a-f]{64}"': "`template.sha256` in `job.json` is that of the template's own text",
    rb'"(depth|reach|off|width|gap)_mm": ?[-0-9.e]+': "lengths in `verify --json` differ by 1e-6 mm",
    rb"(?m)^(hill|court|dome-surface) .*\n": "which `example list` and `example write` know",
    rb"note: lines by layer: .*\n.*\n": "says which layers became which operation",
}

# And numbers that are equal once rounded to 1e-9.
DRAWN = "coordinates of drawn parts moved by 1e-14 mm"

Case = tuple[str, list[list[str]]]


def made(name: str, *words: str, verify: bool = True) -> Case:
    """A job, and what `verify` says of it."""
    calls = [["make", *words, *QUICK, "-o", "job"]]
    return name, calls + ([["verify", "job", "--json"]] if verify else [])


def cases() -> list[Case]:
    examples = ["vault", "dome", "sphere-patch", "facade", "five", "three"]
    found = [made(f"lap {name}", name, *ACCEPT) for name in examples]
    found += [made(f"{joint} {name}", name, "--joint", joint, *ACCEPT) for joint in ("hub", "hinge") for name in ("three", "five")]
    found += [
        made(f"template {name}", "three", "-t", name)
        for name in ("pmma-cast-2", "pmma-xt-1.5", "petg-1", "birch-ply-3", "mdf-3", "card-1.5")
    ]
    found += [made(f"profile {name}", "three", "-t", f"{name}.toml") for name in ("lightburn", "rgb-lab", "snijlab", "epilog", "single-part")]
    found += [
        made("fixture mixed", "fixtures/mixed.obj", "--axes", "point:0,0,-900", *ACCEPT),
        made("fixture ring", "fixtures/ring.json", "-t", "petg-1"),
        made("fixture long spliced", "fixtures/long.json", "-t", "fixtures/small-bed.toml"),
        made("fixture bricks", "fixtures/bricks.obj", "--axes", "0,0,1"),
        made("fixture rhombs", "fixtures/rhombs.json", *ACCEPT),
        made("fixture single-part", "three", "-t", "fixtures/single-part.toml"),
        made("fixture snijlab", "three", "-t", "fixtures/snijlab.toml"),
        made("planarised", "fixtures/vault.obj", "--depth", "12,12", *ACCEPT),
        made("lap with hubs", "five", "--hubs", "4,7", *ACCEPT),
        made("hinge with hubs", "five", "--joint", "hinge", "--hubs", "4", *ACCEPT),
        ("thorough", [["make", "three", "--effort", "thorough", "-o", "job"], ["verify", "job", "--json"]]),
        made("scaled", "vault", "--scale", "1:2", "--fix", "lowest", "--seed", "3", *ACCEPT),
        made("replacement", "three", "--only", "S02,S03"),
        made("refused flexible", "three", "--joint", "hinge", "--fix", "none", verify=False),
        made("refused hub", "vault", "--joint", "hub", verify=False),
        made("refused template", "three", "-t", "fixtures/bad/nest/two-small-sheets.toml", verify=False),
        made("refused mesh", "fixtures/bad/structure/non_manifold_edge.json", "--json", verify=False),
        made("remedies", "three", "--joint", "hinge", "--apply-remedies", "--json"),
        ("coupon", [["coupon", "-o", "coupon"], ["verify", "coupon", "--json"], ["coupon", "--set", "6a,3b", "-o", "mine.toml"]]),
        ("check", [["check", name, "--json", *QUICK] for name in examples]),
        ("check node", [["check", "five", "--joint", "hub", "--node", "4", "--picture", "node.png", *QUICK]]),
        ("advise", [["check", "three", "--advise", "--json", *QUICK]]),
        ("rigidity", [["rigidity", name, "--joint", joint, "--json"] for name in examples for joint in ("lap", "hinge", "hub")]),
        ("rigidity text", [["rigidity", "three", "--joint", "hinge", "--remedies", "--picture", "sway.png"]]),
        ("planarise", [["planarise", "fixtures/vault.obj", "-o", "out.json", "--picture", "out.png", "--json"]]),
        ("nest drawing", [["nest", f"fixtures/{name}", *QUICK, "-o", name] for name in ("inkscape.svg", "inkscape.dxf", "closed_box.svg")]),
        ("nest parts", [["nest", "parts.json", *QUICK, "-o", "parts", "--json"], ["nest", "--check", "parts/layout.json"]]),
        ("nest strip", [["nest", "strip.json", "--work", "4", "-o", "strip", "--json"]]),
        ("lists", [["template", "list"], ["template", "show", "petg-1"], ["example", "list"], ["example", "write", "dome"]]),
    ]
    bad = sorted((ROOT / "fixtures/bad/structure").glob("*.json"))
    return [*found, ("bad structures", [["check", f"fixtures/bad/structure/{path.name}", "--json", *QUICK] for path in bad])]


def prepare(folder: Path, binary: Path) -> None:
    """What the calls name: the fixtures, templates with a profile, parts for `nest`."""
    (folder / "fixtures").symlink_to(ROOT / "fixtures")
    source = subprocess.run([binary, "template", "show", "pmma-cast-3"], capture_output=True, text=True, check=True).stdout
    for profile in ("lightburn", "rgb-lab", "snijlab", "epilog", "single-part"):
        (folder / f"{profile}.toml").write_text(f'{source}\n[output]\nprofile = "{profile}"\n')
    square = [[0, 0], [60, 0], [60, 40], [0, 40]]
    angle = [[0, 0], [90, 0], [90, 25], [25, 25], [25, 70], [0, 70]]
    hole = [[20, 10], [20, 30], [40, 30], [40, 10]]
    parts = [
        {"id": "plate", "quantity": 9, "outline": square, "holes": [hole], "rotations": [0, 180]},
        {"id": "angle", "quantity": 12, "outline": angle, "rotations": "free"},
    ]
    sheets = [{"width": 300, "height": 200, "margin": 5, "count": None}]
    (folder / "parts.json").write_text(
        json.dumps({"format": "finwright-parts", "version": 1, "spacing": 2, "sheets": sheets, "parts": parts})
    )
    items = [
        {"id": k, "demand": 6, "allowed_orientations": [0.0, 180.0], "shape": {"type": "simple_polygon", "data": [*ring, ring[0]]}}
        for k, ring in enumerate((square, angle))
    ]
    (folder / "strip.json").write_text(json.dumps({"name": "strip", "strip_height": 150.0, "items": items}))


def run(binary: Path, case: Case, folder: Path) -> None:
    """Runs the calls of a case in a folder of its own and keeps what they said beside what they wrote."""
    folder.mkdir(parents=True)
    prepare(folder, binary)
    for number, words in enumerate(case[1]):
        ended = subprocess.run([binary, *words], cwd=folder, capture_output=True, check=False)
        (folder / f"{number}.out").write_bytes(ended.stdout)
        (folder / f"{number}.err").write_bytes(ended.stderr)
        (folder / f"{number}.code").write_text(str(ended.returncode))
    (folder / "done").touch()


def files(folder: Path) -> dict[str, bytes]:
    # The fixtures are a link, which is not followed.
    found = (Path(root) / name for root, _, names in os.walk(folder) for name in names)
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


def compared(case: Case, old: Path, new: Path) -> dict[str, str | None]:
    """The files that differ, each with the words that say why, or None."""
    left, right = files(old), files(new)
    found: dict[str, str | None] = {}
    for name in sorted(left.keys() | right.keys()):
        one, other = left.get(name), right.get(name)
        if one != other:
            found[f"{case[0]}/{name}"] = reason(one, other) if one is not None and other is not None else None
    return found


def rounded(text: bytes) -> bytes:
    return re.sub(rb"\d+\.\d+", lambda number: b"%.9f" % float(number[0]), text)


def reason(one: bytes, other: bytes) -> str | None:
    changelog = " ".join((ROOT / "CHANGELOG.md").read_text().split())
    for pattern, words in EXPECTED.items():
        if words in changelog and re.sub(pattern, b"", one) == re.sub(pattern, b"", other):
            return words
    if DRAWN in changelog and rounded(one) == rounded(other):
        return DRAWN
    return None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep there what both versions made; the old one's is used again")
    parser.add_argument("--only", default="", metavar="WORD", help="only cases whose name has WORD")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="finwright-same-") as scratch:
        place = options.keep or Path(scratch)
        chosen = [case for case in cases() if options.only in case[0]]

        def both(case: Case) -> dict[str, str | None]:
            folders = [place / version / case[0].replace(" ", "-") for version in ("old", "new")]
            for binary, folder in zip((options.old.resolve(), options.new.resolve()), folders):
                if folder.parent.name == "old" and (folder / "done").exists():
                    continue
                shutil.rmtree(folder, ignore_errors=True)
                run(binary, case, folder)
            return compared(case, *folders)

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            differences = {name: why for found in pool.map(both, chosen) for name, why in found.items()}
    for name, why in differences.items():
        print(f"as said: {name}: {why}" if why else f"DIFFERS {name}")
    unexplained = sum(why is None for why in differences.values())
    calls = sum(len(case[1]) for case in chosen)
    print(f"{len(chosen)} cases, {calls} calls: {len(differences)} files differ, {unexplained} without a word")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
