"""Planarity of the fins of a structure.json, by numpy from its definition in the contract: half the distance between the lines of the
diagonals over the largest distance between two corners."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

# Agreement with what finwright says, as a share of a fin's diameter.
SAME = 1e-6


def planarities(path: Path) -> np.ndarray:
    data = json.loads(path.read_text())
    positions, axes = np.array(data["positions"], float), np.array(data["axes"], float)
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    nodes = len(positions)
    below, above = (np.broadcast_to(np.array(data["depth"][side], float), nodes)[:, None] for side in ("below", "above"))
    low, high = positions - below * axes, positions + above * axes
    i, j = np.array(data["fins"]).T
    corners = np.stack([low[i], low[j], high[j], high[i]])
    normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
    lines = np.abs(np.einsum("ij,ij->i", corners[1] - corners[0], normal)) / np.linalg.norm(normal, axis=1)
    pairs = [(a, b) for a in range(4) for b in range(a)]
    diameter = np.max([np.linalg.norm(corners[a] - corners[b], axis=1) for a, b in pairs], axis=0)
    return lines / 2 / diameter
