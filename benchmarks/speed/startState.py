# SPDX-License-Identifier: GPL-3.0-or-later
"""Start of the dam break of any size: a collapsing column computed by interFoam on a coarse mesh and interpolated, so that the timed steps
are those of a developed flow. Meshes are cubes of n cells a direction on the unit square or cube; the interface is steepened in
proportion, so that it is as many cells wide on every mesh."""
import os
import shutil

import numpy as np

from runner import environment, foam
import steps

COARSE = {2: 100, 3: 32}            # cells a direction
COLUMN = (0.4, 0.6, 0.4)            # width, height, depth of the water at t = 0 [m]
TIME = 0.2                          # of the coarse run: the front is half way through the tank [s]
CASE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "damBreak")


def makeCase(folder, dim, n, solver, width=1):
    """Case folder with its mesh; the fields follow with writeFields. width: of the tank across the flow in 3D [m]."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(CASE, folder)
    os.makedirs(os.path.join(folder, "0"))
    entries = {"solver": solver, "n": n, "nz": n * width if dim == 3 else 1, "depth": width if dim == 3 else 1 / n, "front": "wall" if dim == 3 else "empty"}
    with open(os.path.join(folder, "system", "parameters"), "w", encoding="utf-8") as out:
        out.writelines(f"{name} {value};\n" for name, value in entries.items())
    steps.write(folder, 1, 1)
    steps.do(folder, "blockMesh")


def _shape(dim, n):
    return (n if dim == 3 else 1, n, n)     # z, y, x: the order of blockMesh's cells


def _columnState(dim, n):
    z, y, x = np.indices(_shape(dim, n)) + 0.5
    inside = (x < COLUMN[0] * n) & (y < COLUMN[1] * n) & ((z < COLUMN[2] * n) | (dim == 2))
    zero = np.zeros(inside.shape)
    return {"alpha.water": inside.astype(float), "p_rgh": zero, "U": np.stack([zero] * 3, -1)}


def writeFields(folder, state):
    for name, values in state.items():
        kind = "vector" if values.ndim == 4 else "scalar"
        flat = values.reshape(-1, 3) if kind == "vector" else values.ravel()
        lines = [f"({a:.7g} {b:.7g} {c:.7g})" for a, b, c in flat] if kind == "vector" else [f"{a:.7g}" for a in flat]
        with open(os.path.join(folder, "0.orig", name), encoding="utf-8") as file:
            text = file.read()
        head, tail = text.split("internalField", 1)
        with open(os.path.join(folder, "0", name), "w", encoding="utf-8") as out:
            out.write(f"{head}internalField nonuniform List<{kind}> {len(flat)}\n(\n" + "\n".join(lines) + "\n)" + tail[tail.index(";"):])


def _coarse(root, runs, dim):
    """State of the coarse run at TIME, computed once per folder of runs."""
    store = os.path.join(runs, f"start_{dim}D.npz")
    if not os.path.isfile(store):
        n = COARSE[dim]
        folder = os.path.join(runs, f"start_{dim}D")
        makeCase(folder, dim, n, "interFoam")
        writeFields(folder, _columnState(dim, n))
        with open(os.path.join(folder, "system", "steps"), "w", encoding="utf-8") as out:
            out.write(f"deltaT 1e-4; adjustTimeStep yes; maxCo 0.5; maxAlphaCo 0.5; endTime {TIME}; writeControl adjustableRunTime; writeInterval {TIME};\n")
        steps.do(folder, environment.program(root, "interFoam", False))
        fields = {name: foam.field(os.path.join(folder, f"{TIME:g}", name)) for name in ("U", "alpha.water", "p_rgh")}
        shape = _shape(dim, n)
        np.savez(store, **{name: v.reshape(shape + v.shape[1:]) for name, v in fields.items()})
    with np.load(store) as data:
        return {name: data[name] for name in data}


def _stretched(values, axis, n):
    """Linear between cell centres, constant beyond the outermost."""
    old = values.shape[axis]
    at = np.clip((np.arange(n) + 0.5) * old / n - 0.5, 0, old - 1)
    lower = np.minimum(at.astype(int), max(old - 2, 0))
    weight = (at - lower).reshape([-1 if k == axis else 1 for k in range(values.ndim)])
    return np.take(values, lower, axis) * (1 - weight) + np.take(values, np.minimum(lower + 1, old - 1), axis) * weight


def mirrored(fields):
    """A 3D state on twice the width: what a plane of symmetry at its end stands for."""
    result = {name: np.concatenate([values, values[::-1]]) for name, values in fields.items()}
    half = len(fields["U"])
    result["U"][half:, ..., 2] *= -1
    return result


def state(root, runs, dim, n):
    """Fields on n cells a direction, and the largest speed [m/s]."""
    fields = _coarse(root, runs, dim)
    fastest = np.sqrt((fields["U"]**2).sum(-1)).max()
    for name in fields:
        for axis in ((0, 1, 2) if dim == 3 else (1, 2)):
            fields[name] = _stretched(fields[name], axis, n)
    ratio = n / COARSE[dim]
    fields["alpha.water"] = np.clip((fields["alpha.water"] - 0.5) * max(ratio, 1) + 0.5, 0, 1)
    return fields, fastest
