"""`finwright planarise` against scipy on the same normal equations, by hand: `planarise_scipy.py BINARY [FINS ...]`.

Scipy takes the same Levenberg-Marquardt steps on the same rows: planarity, closeness, boundary, fairness along edges, staying and unit
axes, six unknowns a node. Each system is assembled anew, factored by SuperLU (symmetric mode, MMD on A + A^T) and solved; feet on the given
surface are not sought again, which is easier for scipy. CPU seconds of both; what finwright needs for files and checks alone, measured by
giving it its own result to planarise, is subtracted.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

sys.path.insert(0, str(Path(__file__).parent))
from planarise import measured, mesh  # noqa: E402

PLANARITY, CLOSENESS, RIM, FAIRNESS, STAY, STAY_AXES = 10.0, 0.5, 1.0, 0.05, 0.002, 0.05


def read(text: str) -> tuple[np.ndarray, np.ndarray]:
    words = [line.split() for line in text.splitlines()]
    positions = np.array([w[1:] for w in words if w[0] == "v"], float)
    faces = np.array([w[1:] for w in words if w[0] == "f"], int) - 1
    return positions, faces


class Rows:
    """The residuals and their derivatives, lengths in median fin lengths."""

    def __init__(self, positions: np.ndarray, faces: np.ndarray, height: float) -> None:
        sides = np.concatenate([faces[:, [k, (k + 1) % 4]] for k in range(4)])
        sides.sort(axis=1)
        self.edges, count = np.unique(sides, axis=0, return_counts=True)
        self.fins, rim = self.edges[count == 2], self.edges[count == 1]
        lengths = np.linalg.norm(np.subtract(*positions[self.fins.T]), axis=1)
        unit = np.median(lengths)
        self.x = positions / unit
        self.height = height / unit
        diagonals = np.cross(self.x[faces[:, 2]] - self.x[faces[:, 0]], self.x[faces[:, 3]] - self.x[faces[:, 1]])
        normals = np.zeros_like(self.x)
        np.add.at(normals, faces.ravel(), np.repeat(diagonals, 4, axis=0))
        self.normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        self.rim = np.unique(rim)
        along = np.zeros_like(self.x)
        for a, b in ((0, 1), (1, 0)):
            way = self.x[rim[:, b]] - self.x[rim[:, a]]
            np.add.at(along, rim[:, a], way * np.sign(way.sum(axis=1, keepdims=True)))
        out = np.cross(along, self.normals)[self.rim]
        self.out = out / np.linalg.norm(out, axis=1, keepdims=True)
        self.unknowns = 6 * len(self.x)
        self.constant = self.even(self.edges, FAIRNESS, FAIRNESS) + self.staying()

    def even(self, pairs: np.ndarray, by_move: float, by_turn: float) -> sp.csc_matrix:
        incidence = sp.csr_matrix(
            (np.tile([1.0, -1.0], len(pairs)), pairs.ravel(), np.arange(0, 2 * len(pairs) + 1, 2)), shape=(len(pairs), len(self.x))
        )
        weights = np.repeat([by_move**2, by_turn**2], 3)
        return sp.kron(incidence.T @ incidence, sp.diags(weights), format="csc")

    def staying(self) -> sp.csc_matrix:
        return sp.diags(np.tile(np.repeat([STAY**2, STAY_AXES**2], 3), len(self.x)), format="csc")

    def at(self, state: np.ndarray) -> tuple[np.ndarray, sp.csr_matrix]:
        x, e = state[:, :3], state[:, 3:]
        i, j = self.fins.T
        edge = x[j] - x[i]
        length = np.linalg.norm(edge, axis=1, keepdims=True)
        u = edge / length
        across = np.cross(e[i], e[j])
        value = (u * across).sum(axis=1, keepdims=True)
        weight = PLANARITY * self.height
        by_x = weight * (across - u * value) / length
        slopes = np.hstack([-by_x, weight * np.cross(e[j], u), by_x, weight * np.cross(u, e[i])])
        places = np.hstack([6 * i[:, None] + np.arange(6), 6 * j[:, None] + np.arange(6)])
        nodes = np.arange(len(x))
        blocks = [
            (weight * value[:, 0], slopes, places),
            ((e * e).sum(axis=1) - 1.0, 2.0 * e, 6 * nodes[:, None] + np.arange(3, 6)),
            (CLOSENESS * (self.normals * (x - self.x)).sum(axis=1), CLOSENESS * self.normals, 6 * nodes[:, None] + np.arange(3)),
            (RIM * (self.out * (x - self.x)[self.rim]).sum(axis=1), RIM * self.out, 6 * self.rim[:, None] + np.arange(3)),
        ]
        values = np.concatenate([block[0] for block in blocks])
        widths = np.concatenate([np.full(len(block[0]), block[1].shape[1]) for block in blocks])
        starts = np.concatenate([[0], np.cumsum(widths)])
        data = np.concatenate([block[1].ravel() for block in blocks])
        columns = np.concatenate([block[2].ravel() for block in blocks])
        return values, sp.csr_matrix((data, columns, starts), shape=(len(values), self.unknowns))

    def descend(self, systems: int) -> tuple[float, float]:
        """The energy before and after so many systems."""
        start = np.hstack([self.x, self.normals])
        state, damping, stiffen = start.copy(), 1e-3, 2.0

        def energy(state: np.ndarray, values: np.ndarray) -> float:
            change = (state - start).ravel()
            return float(values @ values + change @ (self.constant @ change))

        values, slopes = self.at(state)
        first = now = energy(state, values)
        for _ in range(systems):
            matrix = (slopes.T @ slopes).tocsc() + self.constant + damping * sp.identity(self.unknowns, format="csc")
            pull = slopes.T @ values + self.constant @ (state - start).ravel()
            factor = spla.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
            step = factor.solve(-pull)
            tried = state + step.reshape(-1, 6)
            values_there, slopes_there = self.at(tried)
            there = energy(tried, values_there)
            if there < now:
                kept = (now - there) / (step @ (damping * step - pull))
                damping *= max(0.1, 1.0 - (2.0 * kept - 1.0) ** 3)
                stiffen = 2.0
                state, values, slopes, now = tried, values_there, slopes_there, there
            else:
                damping *= stiffen
                stiffen *= 2.0
        return first, now


def main() -> None:
    for fins in [int(word) for word in sys.argv[2:]] or [10_000]:
        text = mesh(fins)
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / "grid.obj"
            path.write_text(text)
            said, whole, _ = measured(sys.argv[1], path)
            again, files, _ = measured(sys.argv[1], path.with_suffix(".planar.json"))
            assert not again["history"], "its own result was not planar"
            ours = whole - files
        systems = len(said["history"])
        positions, faces = read(text)
        began = time.process_time()
        first, last = Rows(positions, faces, 32.0).descend(systems)
        theirs = time.process_time() - began
        print(
            f"{said['figures']['fins']:7} fins  {systems} systems: finwright {ours:.2f} s (and {files:.2f} s for files and checks), scipy {theirs:.2f} s, {theirs / ours:.1f} times; "
            f"energy after the first step {said['history'][0]['energy']:.3f}, scipy {first:.1f} -> {last:.3f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
