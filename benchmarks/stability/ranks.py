# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes on several processes: how the mesh is divided, and whether they begin as one process does."""
import os

import numpy as np

from runner import foam
from support import files

STEPS = 5
# In the steps compared linear solves end at TOLERANCE, repeats of contact where they hardly change anything: what touches is compared as sharply as what does not
TOLERANCE = 1e-12
CONVERGED = f"tolerance {TOLERANCE:g}; maxIterations 2000; contactTolerance 1e-11; maxContactRepeats 200;"
# Largest relative difference that these solves explain. It goes with the tolerance (1e-8, 1e-10, 1e-12 tried): velocities 20 to 100 times the tolerance;
# pressures, which hold back errors of the velocities' divergence over steps that are short at the start, up to 2e4 times.
ALIKE = 1e-7
HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"


def launcher(n):
    return ["mpirun", "--oversubscribe", "--allow-run-as-root", "-np", str(n)]


def division(s, n, method=None):
    """(word, {path: text}): method of decomposePar and its files, from the scene's seed and number alone."""
    rng = np.random.RandomState(sum(map(ord, f"{s.seed}/{s.number}/{n}")) * 7919 % 2**32)
    word = METHODS[rng.randint(len(METHODS))] if method is None else method
    entries = {"x": f"method simple; coeffs {{ n ({n} 1 1); }}", "y": f"method simple; coeffs {{ n (1 {n} 1); }}", "scotch": "method scotch;"}
    if s.dim == 3:
        entries["z"] = f"method simple; coeffs {{ n (1 1 {n}); }}"
    made = {}
    if word not in entries:
        entries[word] = 'method manual; coeffs { dataFile "cellDecomposition"; }'
        rows = "\n".join(map(str, CELLS.get(word, blocks)(s, n, rng)))
        made["constant/cellDecomposition"] = HEADER.format(kind="labelList", name="cellDecomposition") + f"{int(np.prod(s.cells))}\n(\n{rows}\n)\n"
    made["system/decomposeParDict"] = files.dictionary("decomposeParDict", f"numberOfSubdomains {n};\n{entries[word]}")
    return word, made


# --- process of every cell, i fastest, as blockMesh counts them --------------------------------------------------------------

def _indices(s):
    nx, ny, nz = s.cells
    k, j, i = np.meshgrid(np.arange(nz), np.arange(ny), np.arange(nx), indexing="ij")
    return np.stack([a.reshape(-1) for a in (i, j, k)])


def blocks(s, n, _rng):
    """Halved along its longest side again and again."""
    where = _indices(s)
    owner = np.zeros(where.shape[1], int)

    def divide(cells, first, count):
        if count == 1:
            owner[cells] = first
            return
        d = np.ptp(where[:, cells], axis=1).argmax()
        order = cells[np.argsort(where[d, cells], kind="stable")]
        cut = len(order) * (count // 2) // count
        divide(order[:cut], first, count // 2)
        divide(order[cut:], first + count // 2, count - count // 2)

    divide(np.arange(where.shape[1]), 0, n)
    return owner


def slabs(s, n, rng):
    """Neighbouring slabs one cell thick somewhere in the tank, the rest in front of them and behind."""
    where = _indices(s)
    d = rng.randint(2)
    first = rng.randint(1, max(2, s.cells[d] - n))
    return np.clip(where[d] - first, 0, n - 1)


def crumbs(s, n, rng):
    """All processes but one have 5 to 20 cells, close together."""
    where = _indices(s)
    owner = np.zeros(where.shape[1], int)
    for rank in range(1, n):
        centre = np.array([rng.randint(c) for c in s.cells])
        far = np.abs(where - centre[:, None]).sum(axis=0) + 1000 * (owner > 0)
        owner[np.argsort(far, kind="stable")[:rng.randint(5, 21)]] = rank
    return owner


def scattered(s, n, rng):
    """Every cell on any process."""
    owner = rng.randint(n, size=_indices(s).shape[1])
    owner[:n] = np.arange(n)
    return owner


def cores(s, n, rng):
    """All processes but the first have the few cells around the middle of a structure or body, which may cover them all."""
    where = _indices(s)
    owner = np.zeros(where.shape[1], int)
    solids = (s.structures + s.bodies) or [None]
    for rank in range(1, n):
        x = solids[(rank - 1) % len(solids)]
        at = np.array([rng.rand() * c for c in s.cells]) if x is None else x.position * s.length / s.size * s.cells
        far = np.linalg.norm(where + 0.5 - at[:, None] - 0.01 * rank, axis=0) + 1000 * (owner > 0)
        owner[np.argsort(far, kind="stable")[:4]] = rank
    return owner


CELLS = {f.__name__: f for f in (blocks, slabs, crumbs, scattered, cores)}
METHODS = ["x", "y", "z", *CELLS]       # drawn; of a 2D mesh z is blocks


# --- comparison --------------------------------------------------------------------------------------------------------------

def beginning(s):
    """(first step, end time) of about STEPS steps, each of which may be longer than the one before by a fifth."""
    first = s.firstStep if s.fixedStep else min(s.firstStep, 0.2 * s.maxCo * s.h / s.speed)
    return first, first * (STEPS if s.fixedStep else sum(1.2**k for k in range(STEPS)))


def difference(s, root, one, several):
    """({quantity: relative difference}, steps of each) of two runs of the beginning. Relative to the largest value, and at least to what energy allows: water at rest
    moves by what the solves leave."""
    pressure = s.rho[0] * s.speed**2
    least = {"velocity": s.speed, "U": s.speed, "pointU": s.speed, "p_rgh": pressure, "pointP": pressure,
             "angularVelocity": s.speed / (s.length * s.size.max()), "fluidForce": pressure * s.h * (s.h if s.dim == 3 else s.size[2])}
    a, b = (foam.history(root, folder) for folder in (one, several))
    steps = (len(a.time) - 1, len(b.time) - 1)
    if steps[0] != steps[1]:
        return {}, steps
    found = {"time": _apart(a.time, b.time)}
    for name in a.bodies + a.structures:
        for quantity in ("position", "velocity", "angularVelocity", "fluidForce"):
            found[f"{name} {quantity}"] = _apart(getattr(a[name], quantity), getattr(b[name], quantity), max(_scale(a, quantity), least.get(quantity, 0)))
    for name in ("U", "p_rgh", "alpha.water", "pointU", "pointP", "pointAlpha"):
        paths = [os.path.join(folder, _last(folder), name) for folder in (one, several)]
        if os.path.isfile(paths[0]):
            found[name] = _apart(*map(foam.field, paths), least.get(name, 0))
    return found, steps


def _scale(history, quantity):
    """Largest value of all solids: one that hardly moves is not judged by itself."""
    return max(np.abs(getattr(history[name], quantity)).max() for name in history.bodies + history.structures)


def _last(folder):
    return max((t for t in os.listdir(folder) if t.replace(".", "").replace("e-", "").isdigit()), key=float)


def _apart(a, b, scale=0.0):
    a, b = np.asarray(a), np.asarray(b)
    scale = max(np.abs(a).max(initial=0), scale, 1e-300)
    return float(np.abs(a - b).max(initial=0) / scale)
