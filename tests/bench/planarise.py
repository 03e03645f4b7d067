"""Time and memory of `finwright planarise` on wavy grids, by hand: `planarise.py BINARY [FINS ...]`. CPU seconds of the whole command, reading
and writing included; the exponent is fitted over all sizes."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path


def mesh(fins: int) -> str:
    n = round(math.sqrt(fins / 2)) + 1
    rows = []
    for j in range(n):
        for i in range(n):
            z = 8 * math.sin(0.31 * i + 0.2 * j) + 5 * math.cos(0.23 * i - 0.37 * j) + 40 * math.sin(3 * i / n) * math.sin(2 * j / n)
            rows.append(f"v {50 * i} {50 * j + 4 * math.sin(0.4 * i)} {z}")
    for j in range(n - 1):
        rows += [f"f {j * n + i + 1} {j * n + i + 2} {(j + 1) * n + i + 2} {(j + 1) * n + i + 1}" for i in range(n - 1)]
    return "\n".join(rows) + "\n"


def measured(binary: str, path: Path) -> tuple[dict, float, float]:
    """What `planarise --json` says of a mesh, CPU seconds, and megabytes."""
    words = [binary, "planarise", str(path), "-o", str(path.with_suffix(".planar.json")), "-q", "--json"]
    with path.with_suffix(".said").open("w+") as said:
        child = subprocess.Popen(words, stdout=said, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return json.load(said), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def run(binary: str, fins: int) -> tuple[int, float]:
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "grid.obj"
        path.write_text(mesh(fins))
        data, seconds, megabytes = measured(binary, path)
    figures = data["figures"]
    print(
        f"{figures['fins']:7} fins  {seconds:7.2f} s  {megabytes:6.0f} MB  {len(data['history'])} systems  "
        f"worst {figures['before']['worst_percent']:.2f} % -> {figures['after']['worst_percent']:.1e} %",
        flush=True,
    )
    return figures["fins"], seconds


def main() -> None:
    sizes = [int(word) for word in sys.argv[2:]] or [1_000, 3_000, 10_000, 30_000, 100_000]
    points = [(math.log(fins), math.log(seconds)) for fins, seconds in (run(sys.argv[1], fins) for fins in sizes)]
    x, y = (sum(column) / len(points) for column in zip(*points))
    slope = sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)
    print(f"exponent {slope:.2f}")


if __name__ == "__main__":
    main()
