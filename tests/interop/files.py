"""What lies in the directory: the files named, the manifest's shape and its bookkeeping, the pictures."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pymupdf

from contract import JOB, STRUCTURE, mismatches
from job import Job
from report import Report

ABSOLUTE = re.compile(rb"(?<![A-Za-z0-9+/.])(?:/(?:home|root|tmp|Users|var|mnt|work|opt|usr|private)/[A-Za-z0-9_.]|[A-Z]:\\\\?[A-Za-z]|file://)")


def check_shape(job: Job, report: Report) -> None:
    report.claim("files: job.json as agreed", mismatches(job.manifest, JOB, "job"))
    if not job.is_coupon:
        report.claim("files: structure.json as agreed", mismatches(job.structure, STRUCTURE, "structure"))


def check_files(job: Job, report: Report) -> None:
    wanted = ("parts.csv", "sheets/sheets.pdf") + (() if job.is_coupon else ("report.html",))
    missing = [name for name in wanted if not (job.folder / name).is_file()]
    named = [job.file(name) for sheet in job.manifest["sheets"] for name in sheet["files"].values()]
    missing += [str(path.relative_to(job.folder)) for path in named if not path.is_file()]
    present = {path for path in (job.folder / "sheets").glob("sheet-*.*")}
    extra = [f"{path.name} belongs to no sheet" for path in sorted(present - set(named))]
    report.claim("files: all there, none besides", missing + extra, len(named) + 3)
    report.claim("files: no absolute paths", _absolute_paths(job.folder))
    report.claim("files: ids and references", _reference_problems(job))
    report.claim("files: each copy placed once", _placement_problems(job), len(job.parts))
    report.claim("files: parts.csv has each part", _csv_problems(job))
    for part in job.parts.values():
        region = job.regions[part["id"]]
        sound = region.is_valid and region.area > 0
        report.claim("parts: outlines are simple", [] if sound else [f"{part['id']}: not a simple region"])
        # The listed area may be that of the true arcs, so flattening to 0.002 mm may differ along the outline's length.
        allowed = 0.002 * region.length
        report.at_most("parts: area as listed", abs(region.area - part["area"]) / allowed, 1, part["id"], "of 0.002 mm x outline")


def check_pictures(job: Job, report: Report) -> None:
    for sheet in job.manifest["sheets"]:
        picture = pymupdf.Pixmap(str(job.file(sheet["files"]["png"])))
        aspect = (picture.width / picture.height) / (sheet["width"] / sheet["height"])
        report.at_most("png: shape of the sheet", abs(aspect - 1), 2 / min(picture.width, picture.height), sheet["id"], "part")
        report.at_least("png: not blank", picture.color_count(), 2, sheet["id"], "colours")


def _absolute_paths(folder: Path) -> list[str]:
    found = []
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix != ".png":
            match = ABSOLUTE.search(path.read_bytes())
            if match:
                found.append(f"{path.relative_to(folder)} has {match.group().decode()!r}...")
    return found


def _reference_problems(job: Job) -> list[str]:
    manifest = job.manifest
    found = [f"part {name} stands {n} times" for name, n in Counter(part["id"] for part in manifest["parts"]).items() if n > 1]
    found += [f"sheet {name} stands {n} times" for name, n in Counter(sheet["id"] for sheet in manifest["sheets"]).items() if n > 1]
    for part in job.parts.values():
        if part["kind"] in ("strip", "fin", "connector") and not part.get(part["kind"]):
            found.append(f"{part['id']} is a {part['kind']} without its {part['kind']!r}")
        if part["kind"] in ("strip", "fin") and part["quantity"] != 1:
            found.append(f"{part['id']} has quantity {part['quantity']}")
    found += [f"no stock of the size of {sheet['id']}" for sheet in manifest["sheets"] if not _has_stock(job, sheet)]
    for stock in manifest["sheet_stock"]:
        used = sum(sheet["width"] == stock["width"] and sheet["height"] == stock["height"] for sheet in manifest["sheets"])
        if stock["count"] is not None and len(manifest["sheet_stock"]) == 1 and used > stock["count"]:
            found.append(f"{used} sheets of {stock['width']} x {stock['height']}, {stock['count']} in stock")
    totals = manifest["totals"]
    if totals["sheets"] != len(manifest["sheets"]):
        found.append(f"totals.sheets is {totals['sheets']}")
    if totals["parts"] not in (len(job.parts), sum(part["quantity"] for part in job.parts.values())):
        found.append(f"totals.parts is {totals['parts']}")
    return found


def _has_stock(job: Job, sheet: dict) -> bool:
    try:
        return bool(job.stock(sheet))
    except ValueError:
        return False


def _placement_problems(job: Job) -> list[str]:
    placed = Counter((p["part"], p["copy"]) for sheet in job.manifest["sheets"] for p in sheet["placements"])
    wanted = {(name, copy) for name, part in job.parts.items() for copy in range(1, part["quantity"] + 1)}
    found = [f"{part} copy {copy} is placed {n} times" for (part, copy), n in placed.items() if n > 1]
    found += [f"{part} copy {copy} is not placed" for part, copy in sorted(wanted - set(placed))]
    return found + [f"{part} copy {copy} is placed but not asked for" for part, copy in sorted(set(placed) - wanted)]


def _csv_problems(job: Job) -> list[str]:
    cells = set(re.split(r"[,;\t\r\n\"]+", (job.folder / "parts.csv").read_text("utf-8")))
    return [f"{name} is not in parts.csv" for name in job.parts if name not in cells]
