"""Checks finished job directories from outside: `check_job.py JOBDIR [...] [--same OTHERDIR]`; exits 1 on any miss."""

from __future__ import annotations

import argparse
import sys
import time
import traceback
from pathlib import Path
from typing import Callable

from connectors import check_connectors
from files import check_files, check_pictures, check_shape
from job import Job
from refold import check_refold
from report import Report
from setbacks import check_listed_setbacks
from sheets import check_sheets
from slits import check_slits


def check(folder: Path) -> Report:
    """All checks of one job directory; one that cannot run is a miss of its own."""
    report = Report()
    try:
        job = Job(folder)
    except (OSError, ValueError) as error:
        report.claim("files: job.json and structure.json", [str(error)])
        return report
    check_shape(job, report)
    if report.misses():
        return report
    in_space = () if job.is_coupon else (check_refold, check_slits, check_listed_setbacks, check_connectors)
    for step in (_open, check_files, check_pictures, *in_space, check_sheets):
        _run(step, job, report)
    return report


def _open(job: Job, report: Report) -> None:
    job.open()


def _run(step: Callable[[Job, Report], None], job: Job, report: Report) -> None:
    try:
        step(job, report)
    except Exception as error:  # whatever a broken job does to a reader is a finding about the job
        last = traceback.extract_tb(error.__traceback__)[-1]
        report.claim(f"{step.__name__}: could run", [f"{type(error).__name__}: {error} (line {last.lineno} of {Path(last.filename).name})"])


def check_same(folder: Path, other: Path) -> Report:
    """Two runs of one job are the same files with the same bytes."""
    mine, theirs = ({p.relative_to(f): p for p in f.rglob("*") if p.is_file()} for f in (folder, other))
    found = [f"{name} is in one of them only" for name in sorted(set(mine) ^ set(theirs))]
    found += [f"{name} differs" for name in sorted(set(mine) & set(theirs)) if mine[name].read_bytes() != theirs[name].read_bytes()]
    found += [] if mine else ["no files at all"]
    report = Report()
    report.claim("bytes: the same again", found, len(mine))
    return report


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("jobs", nargs="+", type=Path, metavar="JOBDIR")
    parser.add_argument("--same", type=Path, metavar="OTHERDIR", help="compare with another run of the same job, byte by byte")
    options = parser.parse_args()
    missed = 0
    for folder in options.jobs:
        start = time.monotonic()
        reports = [check(folder)] + ([check_same(folder, options.same)] if options.same else [])
        print(f"== {folder.name}")
        for report in reports:
            print(report.text())
            missed += len(report.misses())
        print(f"   {sum(len(r.misses()) for r in reports)} missed, {time.monotonic() - start:.1f} s")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
