"""The least resisted motions, ours against scipy on the same matrix, alternately in one run.

    cargo bench --bench rigidity --no-run      prints the program's path
    python tests/bench/rigidity.py PROGRAM 71 224

For each number of nodes per side: a patch of a torus, hinged fins, fin 0 held. scipy assembles K in
numpy, factorises with SuperLU in MMD order and runs eigsh in shift-invert mode for 4 modes to 1e-9.
Both begin at the points of the fins and end at the singular values, both to residuals of 1e-9. Neither
start of a program is counted: both live through all runs, and the first pair is left out. A pause
stands before each, because threads of numpy's BLAS that wait for work keep a core busy for a while.
"""

import json
import os
import subprocess
import sys
import time

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigsh, splu


def torus(n):
    size = n - 1.0
    i, j = np.arange(n * n) % n, np.arange(n * n) // n
    u, v = i / size - 0.5, 1.6 * (j / size - 0.5)
    out = np.c_[np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)]
    ring = np.c_[np.cos(u), np.sin(u), 0 * u]
    place = (ring + out * 0.5) * size
    at = np.arange(n * n)
    steps = np.stack([np.where(i + 1 < n, at + 1, -1), np.where(j + 1 < n, at + n, -1)], 1).reshape(-1)
    fins = np.stack([np.repeat(at, 2), steps], 1)[steps >= 0]
    return place - out * 0.25, place + out * 0.25, fins


def resistance(n):
    """K and D of the pin form."""
    a, b, fins = torus(n)
    points = np.concatenate([np.stack([a[fins[:, k]], b[fins[:, k]]], 1) for k in (0, 1)], 1)
    points -= points.mean(1, keepdims=True)
    points /= np.sqrt((points**2).sum((1, 2)))[:, None, None]
    moved = np.zeros((len(fins), 12, 6))
    for k in range(3):
        moved[:, k::3, k] = 1
    for k, (p, q) in enumerate(((1, 2), (2, 0), (0, 1))):
        moved[:, p::3, 3 + k], moved[:, q::3, 3 + k] = -points[:, :, q], points[:, :, p]
    q = np.linalg.qr(moved)[0]
    block = np.eye(12) - q @ q.transpose(0, 2, 1)
    block[0] = np.eye(12)
    unknowns = (6 * fins[:, :, None] + np.arange(6)).reshape(-1, 12)
    rows, columns = np.repeat(unknowns, 12, 1), np.tile(unknowns, 12)
    k = sp.coo_matrix((block.reshape(-1), (rows.reshape(-1), columns.reshape(-1)))).tocsc()
    count = np.bincount(fins.reshape(-1), minlength=n * n).astype(float)
    return k, np.repeat(count, 6), len(fins)


def scipy_modes(n):
    begun = time.perf_counter()
    k, d, fins = resistance(n)
    root = sp.diags(1 / np.sqrt(d))
    k = (root @ k @ root + 1e-13 * sp.identity(len(d))).tocsc()
    factor = splu(k, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = LinearOperator(k.shape, factor.solve)
    values = eigsh(k, 4, sigma=0, OPinv=inverse, tol=1e-9, return_eigenvectors=False)
    return time.perf_counter() - begun, np.sqrt(np.abs(np.sort(values) - 1e-13)), fins


class Ours:
    """Our program, alive all the while as this one is."""

    def __init__(self, program):
        self.child = subprocess.Popen([program, "--bench", "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def cpu(self):
        """Processor seconds so far."""
        fields = open(f"/proc/{self.child.pid}/stat").read().rsplit(") ", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def peak(self):
        """Most memory so far, MiB."""
        status = open(f"/proc/{self.child.pid}/status").read()
        return int(status.split("VmHWM:")[1].split()[0]) / 1024

    def modes(self, n):
        before = self.cpu()
        print(n, file=self.child.stdin, flush=True)
        line = json.loads(self.child.stdout.readline())
        return line["seconds"], line["sigma"], self.cpu() - before


PAUSE = 0.3


def middle(values):
    return sorted(values)[len(values) // 2]


def main():
    ours = Ours(sys.argv[1])
    for n in map(int, sys.argv[2:]):
        runs = 15 if n < 150 else 5
        pairs = []
        for run in range(runs + 1):
            time.sleep(PAUSE)
            mine, sigma, cpu = ours.modes(n)
            time.sleep(PAUSE)
            theirs, known, fins = scipy_modes(n)
            # The first pair finds the machine cold, and is not counted.
            if run > 0:
                pairs.append((mine, theirs, cpu))
        mine, theirs, cpu = zip(*pairs)
        ratios = [b / a for a, b in zip(mine, theirs)]
        print(f"{fins:8} fins, {runs} pairs, load {os.getloadavg()[0]:.1f}, peak {ours.peak():.0f} MiB")
        print(f"  median: ours {middle(mine):.3f} s (CPU {middle(cpu):.2f} s), scipy {middle(theirs):.3f} s, ratio {middle(ratios):.2f}")
        print(f"  least:  ours {min(mine):.3f} s, scipy {min(theirs):.3f} s, ratio {min(theirs) / min(mine):.2f}")
        print("  ours ", sigma)
        print("  scipy", list(map(float, known)), flush=True)


main()
