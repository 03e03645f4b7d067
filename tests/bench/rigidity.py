"""The least resisted motions, ours against scipy on the same matrix, alternately in one run.

    cargo bench --bench rigidity --no-run      prints the program's path
    python tests/bench/rigidity.py PROGRAM 71 224

For each number of nodes per side: a patch of a torus, hinged fins, fin 0 held. scipy assembles K in
numpy, factorises with SuperLU in MMD order and runs eigsh in shift-invert mode for 4 modes to 1e-9.
"""

import json
import resource
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


def ours(program, n):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    line = subprocess.run([program, "--bench", str(n)], capture_output=True, text=True, check=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.loads(line), cpu, after.ru_maxrss / 1024


def main():
    program, sides = sys.argv[1], [int(n) for n in sys.argv[2:]]
    for n in sides:
        runs = 5 if n < 150 else 3
        pairs = []
        for _ in range(runs):
            line, cpu, memory = ours(program, n)
            seconds, sigma, fins = scipy_modes(n)
            pairs.append((line["seconds"], seconds, cpu))
        ratio = sorted(theirs / mine for mine, theirs, _ in pairs)[runs // 2]
        mine, theirs, cpu = (sorted(p[k] for p in pairs)[runs // 2] for k in range(3))
        print(f"{fins:8} fins: ours {mine:.3f} s (CPU {cpu:.3f} s, peak {memory:.0f} MiB), scipy {theirs:.3f} s, ratio {ratio:.2f}")
        print("  ours ", line["sigma"])
        print("  scipy", list(sigma), flush=True)


main()
