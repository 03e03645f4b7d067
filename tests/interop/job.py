"""A job directory opened: the manifest, the structure, the parts and what each sheet's files show."""

from __future__ import annotations

import json
from dataclasses import dataclass
from math import cos, radians, sin
from pathlib import Path

import numpy as np
import shapely

from space import Space


@dataclass
class Strip:
    """A strip part; `nodes`, `bottoms` and `tops` run in the direction of travel."""

    id: str
    nodes: list[int]
    closed: bool
    bottoms: np.ndarray
    tops: np.ndarray
    folds: list[dict]
    slits: list[dict]
    splices: list[tuple[int, int]]
    setbacks: tuple[float, float]
    outline: shapely.Polygon

    def sides(self, k: int) -> tuple[int | None, int | None]:
        """The nodes before and after the k-th along the strip: its own, or the far end of a fin cut by a splice."""
        before = self.nodes[k - 1] if k > 0 else self.across_splice(at_start=True)
        after = self.nodes[k + 1] if k + 1 < len(self.nodes) else self.across_splice(at_start=False)
        return before, after

    def across_splice(self, at_start: bool) -> int | None:
        """The far node of the fin that a splice cuts beside the first or last axis; splices list it in the order of travel."""
        k = 0 if at_start else -1
        for i, j in self.splices:
            here, there = (j, i) if at_start else (i, j)
            # A ring cut beside the node it is opened at has that fin's nodes at both ends.
            if here == self.nodes[k] and (there != self.nodes[-1 - k] or self._goes_on(at_start)):
                return there
        return None

    def _goes_on(self, at_start: bool) -> bool:
        """Whether there is material just beyond the first or last axis."""
        bottom, top = (self.bottoms[0], self.tops[0]) if at_start else (self.bottoms[-1], self.tops[-1])
        up = (top - bottom) / np.linalg.norm(top - bottom)
        outward = np.array([-up[1], up[0]]) * (1 if at_start else -1)
        points = np.linspace(bottom, top, 9)[1:-1] + outward
        return bool(shapely.contains_xy(self.outline, points).any())

    def ends(self) -> list[tuple[int, int, int]]:
        """Where the strip ends at an axis and not at a splice: first (0) or last (1), which of its nodes, and the node before."""
        places = [(place, k, self.sides(k)) for place, k in ((0, 0), (1, len(self.nodes) - 1))]
        return [(place, k, sides[1 - place]) for place, k, sides in places if sides[place] is None and sides[1 - place] is not None]

    def slit_at(self, k: int) -> dict | None:
        """A closed strip has no slit where it was opened."""
        if self.closed and k in (0, len(self.nodes) - 1):
            return None
        return next((slit for slit in self.slits if slit["node"] == self.nodes[k]), None)

    def fins(self) -> list[tuple[int, int]]:
        pairs = list(zip(self.nodes, self.nodes[1:])) + self.splices
        return [(min(i, j), max(i, j)) for i, j in pairs]


class Job:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.manifest = json.loads((folder / "job.json").read_text("utf-8"))
        # A coupon is no part of a structure.
        self.is_coupon = self.manifest.get("kind") == "coupon"
        self.structure = None if self.is_coupon else json.loads((folder / "structure.json").read_text("utf-8"))

    def open(self) -> None:
        """Called when the manifest has been found to be of the right shape."""
        self.space = Space(self.structure) if self.structure else None
        self.parts = {part["id"]: part for part in self.manifest["parts"]}
        self.regions = {name: _region(part) for name, part in self.parts.items()}
        self.strips = {name: _strip(part) for name, part in self.parts.items() if part.get("strip")}
        self.ends = self._ends()
        self.connected = {part["connector"]["node"] for part in self.parts.values() if part.get("connector")}
        material = self.manifest["material"]
        self.thickness, self.kerf, self.clearance = (float(material[key]) for key in ("thickness", "kerf", "clearance"))

    def _ends(self) -> dict[int, list[tuple[str, int]]]:
        """By node the parts that end there, single fins and strips, each with the node at the other end of its fin."""
        found: dict[int, list[tuple[str, int]]] = {}
        for name, part in self.parts.items():
            i, j = (part.get("fin") or {"nodes": (None, None)})["nodes"]
            for node, other in ((i, j), (j, i)) if part.get("fin") else ():
                found.setdefault(node, []).append((name, other))
        for strip in self.strips.values():
            for _, k, other in strip.ends():
                found.setdefault(strip.nodes[k], []).append((strip.id, other))
        return found

    def slot_ends(self, connector: dict) -> list[tuple[str, int | None]]:
        """Which end stands in each slot. Jobs of single fins may leave `to` out: no fin has two ends at a node."""
        known = dict(self.ends.get(connector["node"], []))
        return [(slot["fin"], slot.get("to", known.get(slot["fin"]))) for slot in connector["slots"]]

    def file(self, name: str) -> Path:
        """Names of sheet files count from the job directory; a bare file name is looked for in sheets/."""
        return self.folder / name if "/" in name else self.folder / "sheets" / name

    def placed(self, placement: dict) -> shapely.Polygon:
        """A part's nominal region on its sheet: turned counter-clockwise, then moved."""
        turn = radians(placement["angle_deg"])
        matrix = np.array([[cos(turn), sin(turn)], [-sin(turn), cos(turn)]])
        shift = np.array([placement["x"], placement["y"]])
        return shapely.transform(self.regions[placement["part"]], lambda points: points @ matrix + shift)

    def stock(self, sheet: dict) -> dict:
        """The stock a sheet was cut from, by its size; of several of one size the one that asks least."""
        fits = [s for s in self.manifest["sheet_stock"] if abs(s["width"] - sheet["width"]) < 1e-6 and abs(s["height"] - sheet["height"]) < 1e-6]
        return min(fits, key=lambda s: (s["margin"], s["spacing"]))


def _region(part: dict) -> shapely.Polygon:
    return shapely.Polygon(part["outline"], part["holes"])


def _strip(part: dict) -> Strip:
    strip = part["strip"]
    return Strip(
        part["id"],
        strip["nodes"],
        strip["closed"],
        np.array([axis["bottom"] for axis in strip["axes"]], float),
        np.array([axis["top"] for axis in strip["axes"]], float),
        strip["folds"],
        strip["slits"],
        [tuple(splice["fin"]) for splice in strip["splices"]],
        tuple(strip.get("setbacks") or (0.0, 0.0)),
        _region(part),
    )
