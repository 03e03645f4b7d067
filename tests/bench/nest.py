"""`finwright nest` against spyrrow on strip packing, by hand: `nest.py BINARY DIR [--seconds 30] [--seeds 3] [INSTANCE ...]`.

Both run at the same time on the same machine, one thread each, for the same wall time, so that load hits both alike; density in per cent
(parts' closed area over the strip's), CPU seconds beside it. DIR holds strip-packing instances (`"strip_height"`, `"items"`).
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

STRIPS = ["swim", "shirts", "trousers", "jakobs1", "mao", "dagli", "shapes0"]

PEER = """
import json, sys, spyrrow
data = json.load(open(sys.argv[1]))
items = []
for item in data["items"]:
    shape = item["shape"]["data"]
    ring = shape["outer"] if isinstance(shape, dict) else shape
    items.append(spyrrow.Item(str(item["id"]), [tuple(p) for p in ring], item.get("demand", 1), item.get("allowed_orientations")))
instance = spyrrow.StripPackingInstance("x", data["strip_height"], items)
config = spyrrow.StripPackingConfig(early_termination=False, total_computation_time=int(sys.argv[2]), num_workers=1, seed=int(sys.argv[3]),
                                    min_items_separation=data.get("spacing") or None)
print(instance.solve(config).density)
"""


def started(words: list[str]) -> subprocess.Popen:
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


def ended(child: subprocess.Popen) -> tuple[str, float]:
    said = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit(f"{child.args} ended with {child.returncode}")
    return said, usage.ru_utime + usage.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("binary")
    parser.add_argument("folder", type=Path)
    parser.add_argument("instances", nargs="*", default=STRIPS)
    parser.add_argument("--seconds", type=int, default=30)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first-seed", type=int, default=0)
    options = parser.parse_args()
    means: list[tuple[float, float]] = []
    with tempfile.TemporaryDirectory() as scratch:
        for name in options.instances:
            path = options.folder / f"{name}.json"
            found: tuple[list[float], list[float]] = ([], [])
            for seed in range(options.first_seed, options.first_seed + options.seeds):
                ours = started([options.binary, "nest", str(path), "--time-limit", str(options.seconds), "--seed", str(seed), "--json", "-q", "-o", f"{scratch}/{name}"])
                theirs = started([sys.executable, "-c", PEER, str(path), str(options.seconds), str(seed)])
                said, cpu = ended(ours)
                density, peer_cpu = ended(theirs)
                found[0].append(100 * json.loads(said)["density"])
                found[1].append(100 * float(density))
                print(f"  {name} seed {seed}: {found[0][-1]:.2f} [{cpu:.0f}]  spyrrow {found[1][-1]:.2f} [{peer_cpu:.0f}]", flush=True)
            means.append((statistics.mean(found[0]), statistics.mean(found[1])))
            spread = [max(side) - min(side) for side in found]
            print(f"| {name} | {means[-1][0]:.2f} ± {spread[0] / 2:.2f} | {means[-1][1]:.2f} ± {spread[1] / 2:.2f} |", flush=True)
    print(f"| mean | {statistics.mean(a for a, _ in means):.2f} | {statistics.mean(b for _, b in means):.2f} |")


main()
