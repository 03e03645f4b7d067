"""Faults planted in jobs with hubs made by a finwright binary, of single fins and of strips: `python selftest.py BINARY` runs them too."""

from __future__ import annotations

import json
import shutil
import subprocess
from math import cos, radians, sin
from pathlib import Path
from typing import Callable

import ezdxf
import numpy as np

from connectors import check_connectors
from job import Job
from report import Report

Array = np.ndarray
Move = Callable[[Array], Array]  # of points in part coordinates
Fault = tuple[str, Callable[[Path, dict], None], str]

NODE_FINS = 4  # at the least, of the connector that is spoilt


def redrawn(folder: Path, manifest: dict, part: dict, move: Move) -> None:
    """Moves corners of a part in job.json and in every copy that the DXF draws."""
    box = np.array(part["outline"])
    low, high = box.min(axis=0) - 1, box.max(axis=0) + 1
    part["outline"] = move(np.array(part["outline"])).tolist()
    part["holes"] = [move(np.array(hole)).tolist() for hole in part["holes"]]
    for sheet in manifest["sheets"]:
        places = [place for place in sheet["placements"] if place["part"] == part["id"]]
        if not places:
            continue
        path = folder / sheet["files"]["dxf"]
        document = ezdxf.readfile(path)
        for line in document.modelspace().query("POLYLINE"):
            points = np.array([vertex.dxf.location.vec2 for vertex in line.vertices])
            for place in places if line.dxf.layer.startswith("CUT") else ():
                turn, shift = _turn(place)
                flat = (points - shift) @ turn
                if (flat > low).all() and (flat < high).all():
                    for vertex, point in zip(line.vertices, move(flat) @ turn.T + shift):
                        vertex.dxf.location = (*point, 0)
        document.saveas(path)


def _turn(place: dict) -> tuple[Array, Array]:
    angle = radians(place["angle_deg"])
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]]), np.array([place["x"], place["y"]])


def spoilt(manifest: dict) -> dict:
    return next(part for part in manifest["parts"] if part.get("connector") and len(part["connector"]["fins"]) >= NODE_FINS)


def end_at(manifest: dict) -> tuple[dict, int, dict]:
    """A fin or strip of the spoilt connector, which of its ends is there, and the connector."""
    connector = spoilt(manifest)["connector"]
    part = next(part for part in manifest["parts"] if part["id"] == connector["fins"][1][0])
    return part, 0 if listing(part)["nodes"][0] == connector["node"] else 1, connector


def listing(part: dict) -> dict:
    return part.get("fin") or part["strip"]


def in_end(part: dict, end: int, move: Move) -> Move:
    """A move in the frame of one end: from the axis into the part, and up the axis from its bottom."""
    axis = listing(part)["axes"][-end]
    bottom, top = np.array(axis["bottom"], float), np.array(axis["top"], float)
    up = (top - bottom) / np.linalg.norm(top - bottom)
    frame = np.column_stack([np.array([up[1], -up[0]]) * (1 if end == 0 else -1), up])
    return lambda points: move((points - bottom) @ frame) @ frame.T + bottom


def slot_turned(_: Path, manifest: dict) -> None:
    spoilt(manifest)["connector"]["slots"][1]["angle_deg"] += 0.5


def fins_swapped(_: Path, manifest: dict) -> None:
    connector = spoilt(manifest)["connector"]
    for entries, keys in ((connector["fins"], (0,)), (connector["slots"], {"fin", "to"} & set(connector["slots"][1]))):
        for key in keys:
            entries[1][key], entries[2][key] = entries[2][key], entries[1][key]


def notch_moved(folder: Path, manifest: dict) -> None:
    """The notch for the upper ring, 0.5 mm toward the axis."""
    part, end, connector = end_at(manifest)
    slot = connector["slots"][1]
    near, far = connector["radius"] - slot["length"] / 2, connector["radius"] + 1

    def move(points: Array) -> Array:
        notch = (points[:, 0] > near) & (points[:, 0] < far) & (points[:, 1] > 15)
        return points - np.outer(notch, [0.5, 0])

    redrawn(folder, manifest, part, in_end(part, end, move))


def window_narrowed(folder: Path, manifest: dict) -> None:
    part = spoilt(manifest)
    slot = part["connector"]["slots"][1]
    angle = radians(slot["angle_deg"])
    frame = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])

    def move(points: Array) -> Array:
        flat = points @ frame
        inside = (flat[:, 0] > 4) & (flat[:, 0] < part["connector"]["radius"] - 1) & (np.abs(flat[:, 1]) < slot["width"] / 2 + 0.2)
        flat[:, 1] -= 0.05 * np.sign(flat[:, 1]) * inside
        return flat @ frame.T

    redrawn(folder, manifest, part, move)


def reaching(by: float, listed: bool) -> Callable[[Path, dict], None]:
    """The end of a fin or strip so much nearer to the axis."""

    def plant(folder: Path, manifest: dict) -> None:
        part, end, _ = end_at(manifest)
        setbacks = listing(part)["setbacks"]
        start = setbacks[end]
        redrawn(folder, manifest, part, in_end(part, end, lambda points: points - np.outer(points[:, 0] < start + 0.3, [by, 0])))
        setbacks[end] -= by * listed

    return plant


def shape_shared(_: Path, manifest: dict) -> None:
    """Two fins of different length under one name."""
    fins = sorted((part for part in manifest["parts"] if part.get("fin")), key=lambda part: part["area"])
    fins[0]["shape"] = fins[-1]["shape"]


def plate_raised(_: Path, manifest: dict) -> None:
    spoilt(manifest)["connector"]["copies"][0]["height"] += 0.5


def step_forgotten(_: Path, manifest: dict) -> None:
    manifest["assembly"].pop(0)


def connector_missing(_: Path, manifest: dict) -> None:
    manifest["parts"].remove(spoilt(manifest))


LISTED: list[Fault] = [
    ("slot turned by 0.5 degrees", slot_turned, "connectors: slot angles"),
    ("two fins swapped", fins_swapped, "connectors: slot angles"),
]
AT_ENDS: list[Fault] = [
    *LISTED,
    ("notch moved by 0.5 mm", notch_moved, "assembly: fins clear of plates"),
    ("window narrowed by 0.1 mm", window_narrowed, "connectors: slot cut as wide as listed"),
    ("window narrowed, its fin tight", window_narrowed, "assembly: clearance beside fins"),
    ("end reaches in by 1 mm", reaching(1.0, listed=False), "fins: setback as listed"),
    ("setback under the least", reaching(4.0, listed=True), "fins: setback over the least"),
    ("disc 0.5 mm too high", plate_raised, "assembly: fins clear of plates"),
    ("part in no step", step_forgotten, "assembly: steps of fins and plates"),
]
OF_FINS: list[Fault] = [
    ("two shapes under one name", shape_shared, "fins: one shape, one outline"),
    ("node without its connector", connector_missing, "connectors: one set at each node"),
]
JOBS: dict[str, tuple[list[str], list[Fault]]] = {
    "fins in hubs": (["three", "--joint", "hub"], [*AT_ENDS, *OF_FINS]),
    "strips in hubs": (["five", "--effort", "quick"], AT_ENDS),
}


def planted(right: Path, folder: Path, plant: Callable[[Path, dict], None]) -> None:
    shutil.copytree(right, folder)
    manifest = json.loads((folder / "job.json").read_text("utf-8"))
    plant(folder, manifest)
    (folder / "job.json").write_text(json.dumps(manifest), "utf-8")


def misses(folder: Path) -> list[str]:
    job, report = Job(folder), Report()
    job.open()
    check_connectors(job, report)
    return report.misses()


def facts(binary: Path, scratch: Path) -> dict[str, bool]:
    """What should hold, by a sentence that says so."""
    found: dict[str, bool] = {}
    for job, (words, faults) in JOBS.items():
        right = scratch / job.replace(" ", "-")
        made = subprocess.run([str(binary), "make", *words, "-q", "-o", str(right)], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            found[f"{job}: made ({made.stderr.strip()[-200:]})"] = False
            continue
        before = misses(right)
        found[f"{job}: a right job passes{': ' * bool(before)}{', '.join(before)}"] = not before
        found[f"{job}: verify ends with 0"] = _verified(binary, right) == 0
        for number, (name, plant, expected) in enumerate(faults):
            folder = scratch / f"{right.name}-fault-{number:02}"
            planted(right, folder, plant)
            found[f"{job}: {name}: {expected} is missed"] = expected in misses(folder) and expected not in before
            if (name, plant, expected) in LISTED:
                found[f"{job}: {name}: verify ends with 3"] = _verified(binary, folder) == 3
    return found


def _verified(binary: Path, folder: Path) -> int:
    return subprocess.run([str(binary), "verify", str(folder), "-q"], capture_output=True, check=False).returncode
