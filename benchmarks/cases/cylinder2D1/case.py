# SPDX-License-Identifier: GPL-3.0-or-later
"""Schaefer & Turek 2D-1: steady flow past a cylinder, Re = 20. N: cells a diameter (ours), cells per quarter of the cylinder (peers)."""
import glob
import os

import numpy as np

from runner import foam
from runner.cases import Target, series

DRAG, LIFT, PRESSURE = 5.57953523384, 0.010618948146, 0.11752016697    # featflow.de, DFG 2D-1
OURS = "flotsamFoam"

title = """Steady flow past a cylinder in a channel, Re = 20 (Schaefer & Turek 1996, case 2D-1; spectral reference values drag 5.57953523,
lift 0.01061895, pressure difference 0.11752017). Ours: the cylinder is cut out of a rectangular mesh with N cells a diameter, uniform over the height
and up to x = 0.5 m, or (`graded`) uniform in the square (0.1 .. 0.3)^2 only; run to t = 8 s from rest at maxCo 2 (`Co 8`: larger steps, a steady flow needs
no more). Peers: body-fitted O-grid with N cells per quarter of the cylinder (N 16: 64 around it), icoFoam to t = 8 s, simpleFoam to steady state."""
figures = {"dragError": ("drag, relative error", ""), "liftError": ("lift, relative error", ""), "pressureError": ("pressure difference, relative error", ""),
           "drag": ("drag coefficient", ""), "change": ("change of drag in the last second", "")}
mainError, moreErrors = "dragError", ["pressureError", "liftError"]
targets = [Target("dragError", 0.003, "drag", 20)]

runs = [
    *series(OURS, [10, 20, 40], quick=2, options={"mesh": "uniform"}),
    *series(OURS, [10, 20, 40], variant="graded", options={"mesh": "graded"}),
    *series(OURS, [10, 20, 40], variant="graded Co 8", options={"mesh": "graded", "maxCo": 8}),
    *series("simpleFoam", [16, 32, 64], quick=2),
    *series("icoFoam", [16, 32, 64], quick=1),
]


def _strip(length, step, growth):
    """(cells, ratio of the last to the first) of a strip whose cells widen from `step` by `growth` a cell."""
    n = max(1, round(np.log(1 + length * (growth - 1) / step) / np.log(growth)))
    return n, float(growth**(n - 1))


def _background(run):
    """Entries for flotsamFoam/system/blockMeshDict."""
    step = 0.1 / run.n
    growth = 1 + 1 / run.n
    if run.options["mesh"] == "uniform":
        x, y = (0.25, 0.5), (0.1, 0.3)
        left = (round(x[0] / step), 1)
        low, high = (round(0.1 / step), 1), (round(0.11 / step), 1)
        right = (11 * run.n // 2, 6)
    else:
        x, y = (0.1, 0.3), (0.1, 0.3)
        left = low = _strip(0.1, step, growth)
        high = _strip(0.11, step, growth)
        right = _strip(1.9, step, growth)
    return {"x1": x[0], "x2": x[1], "y1": y[0], "y2": y[1], "nx1": left[0], "gIn": 1 / left[1], "nx2": round((x[1] - x[0]) / step),
            "nx3": right[0], "gOut": right[1], "ny1": low[0], "gLow": 1 / low[1], "ny2": round((y[1] - y[0]) / step), "ny3": high[0], "gHigh": high[1]}


def parameters(run):
    if run.solver == OURS:
        return {"endTime": 8, "maxCo": run.options.get("maxCo", 2), **_background(run)}
    size = {"n": run.n, "nr": 5 * run.n // 4, "nx": 3 * run.n // 2}
    if run.solver == "simpleFoam":
        return {**size, "endTime": 5000, "maxStep": 1, "ddt": "steadyState", "convection": "bounded Gauss linear", "pRelTol": 0.05, "uRelTol": 0.1,
                "forceInterval": 50}
    return {**size, "endTime": 8, "maxStep": 0.16 / run.n, "ddt": "Euler", "convection": "Gauss linear", "pRelTol": 0.05, "uRelTol": 0, "forceInterval": 20}


def prepare(run, do):
    do("blockMesh")
    if run.solver == OURS:
        do("setExprBoundaryFields")


def _ours(case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    flotsam = foam.resultReader(root)       # noqa: F821
    scale = 2 / (0.2**2 * 0.1)
    end = history.time[-1]
    drag, lift = scale * history.mean("cylinder", "fluidForce", end - 1)[:2]
    before = scale * history.mean("cylinder", "fluidForce", end - 2, end - 1)[0]
    ends = flotsam.sample(case, "last", [[0.15, 0.2, 0.5], [0.25, 0.2, 0.5]], ["p"])["p"]
    return drag, lift, ends[0] - ends[1], drag / before - 1


def _peer(case):
    file = sorted(glob.glob(os.path.join(case, "postProcessing/coeffs/*/*.dat")))[-1]
    with open(file, encoding="utf-8") as text:
        head = [line for line in text if line.startswith("#")][-1].lstrip("# ").split()
    series_ = foam.table(case, "coeffs/*/*.dat")
    drag, lift = series_[:, head.index("Cd")], series_[-1, head.index("Cl")]
    wall = np.loadtxt(glob.glob(os.path.join(case, "postProcessing/surface/*/*.raw"))[0])
    angle = np.arctan2(wall[:, 1] - 0.2, wall[:, 0] - 0.2)

    def at(position):       # linear in the angle between face centres
        away = (angle - position + np.pi) % (2 * np.pi) - np.pi
        order = np.argsort(away)
        return np.interp(0, away[order], wall[order, 3])
    return drag[-1], lift, at(np.pi) - at(0), drag[-1] / drag[-2] - 1


def errors(run, case):
    drag, lift, difference, change = (float(v) for v in (_ours if run.solver == OURS else _peer)(case))
    return {"dragError": drag / DRAG - 1, "liftError": lift / LIFT - 1, "pressureError": difference / PRESSURE - 1, "drag": drag, "change": change}
