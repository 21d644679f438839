# SPDX-License-Identifier: GPL-3.0-or-later
"""Collapse of a water column (Martin & Moyce 1952, height 2a), front until T = t sqrt(2g/a) = 4.1. N: cells per column width a."""
import os

import numpy as np

from runner import foam
from runner.cases import Run, Target, series

COLUMN, GRAVITY = 0.05715, 9.81     # a [m], [m/s^2]
TOE = 0.01                          # share of the water beyond the toe
READ_WITH = [8, 16, 32, 64]     # N with whose cells reference.csv has the front

title = """Water column of width a = 0.05715 m and height 2a in a tank 6a x 2.25a, slip walls, open top; N cells over a. Errors: rms over T = 0.8 .. 4
against `reference.csv`, the mean of interFoam and interIsoFoam at N = 64 and Courant number 0.25. Toe: x beyond which 1 % of the water lies. Front: outermost alpha = 0.5 in the bottom row
of cells; a film thinner than half a cell is ahead of it, so the reference is read from its alpha averaged over cells of the run's size (against the fine
front it would itself err by 0.047 / 0.015 a at N = 16 / 32). The two peers differ by 0.0005 a in the toe, 0.002 to 0.004 a in the front. The experiment does not discriminate: slip walls lead it by a constant in time; shown
is the mean deviation after the clock has been shifted by the best constant. Meshes are the same for all solvers (ours splits each cell into two triangles).
Variant "no-slip": no-slip walls, against `referenceNoSlip.csv`: interFoam with N = 64, its 160 rows of cells graded down to 0.0016 a at the bottom, where the layer is 0.01 a thick."""
figures = {"toeError": ("toe against the common fine grid, rms", "a"), "frontError": ("front likewise, read with the same cells", "a"),
           "experiment": ("front against the experiment, clock fitted", "a"), "clockShift": ("clock shift", "T"), "volumeError": ("volume drift", "")}
mainError = "toeError"
targets = [Target("toeError", 0.01, "toe [a]", 32, ""), Target("frontError", 0.01, "front [a]", 32, "")]

NO_SLIP = "no-slip"
SIZES = [8, 16, 32, 48]
runs = [
    *series("flotsamFoam", SIZES, quick=2),
    *series("flotsamFoam", SIZES[:3], quick=0, variant="Co 1", options={"maxCo": 1}),
    *series("interFoam", SIZES, quick=2),
    *series("interIsoFoam", SIZES, quick=2),
    Run("interFoam", 16, "Co 1", {"maxCo": 1}),
    *(run for solver in ("flotsamFoam", "interFoam", "interIsoFoam") for run in series(solver, SIZES[:3], quick=0, variant=NO_SLIP)),
    *(run for solver in ("flotsamFoam", "interFoam", "interIsoFoam") for run in series(solver, [16, 32], quick=0, variant="Co 0.125", options={"maxCo": 0.125})),
]


def parameters(run):
    return {"nx": 6 * run.n, "ny": 9 * run.n // 4, "grading": 1, "maxCo": run.options.get("maxCo", 0.5), "wall": "noSlip" if run.variant == NO_SLIP else "slip"}


def problem(variant):
    return variant if variant == NO_SLIP else ""


def prepare(_run, do):
    do("blockMesh")
    do("setFields")


def shares(folder, n):
    """T and alpha of the cells, rows from the bottom, at every written time."""
    times = (t for t in os.listdir(folder) if t[0].isdigit() and not t.endswith(".orig") and float(t) > 0)
    return [(float(t) * np.sqrt(2 * GRAVITY / COLUMN), foam.field(os.path.join(folder, t, "alpha.water")).reshape(9 * n // 4, 6 * n))
            for t in sorted(times, key=float)]


def toe(alpha, n):
    """x/a beyond which the share TOE of the water lies: its volume lies evenly in each column of cells."""
    columns = alpha.sum(axis=0)
    beyond = np.r_[0, np.cumsum(columns[::-1])] / columns.sum()
    return np.interp(TOE, beyond, np.arange(6 * n, -1, -1) / n)


def front(alpha, n, readWith):
    """x/a of the outermost alpha = 0.5 in the bottom row of cells, linear between cell centres; n cells per a, averaged over those of readWith per a."""
    c = n // readWith
    bottom = alpha[:c].mean(axis=0).reshape(-1, c).mean(axis=1)
    i = min(np.flatnonzero(bottom >= 0.5).max(), len(bottom) - 2)
    return (i + 0.5 + (bottom[i] - 0.5) / (bottom[i] - bottom[i + 1])) / readWith


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def _experiment(t, x):
    """(rms, shift) with the best constant shift of the experiment's clock."""
    measured = foam.reference(root, "frontMartinMoyce")    # noqa: F821 (root is set by the runner)
    measured = measured[measured[:, 0] < 4.1]
    return min((_rms(np.interp(measured[:, 0] - s, t, x) - measured[:, 1]), float(s)) for s in np.linspace(-0.1, 0.6, 141))


def _fine(n, name):
    """T, toe and front of the reference `name`; the front as read with n cells per a, between sizes linear in 1/n."""
    fine = np.loadtxt(os.path.join(folder, name), delimiter=",")     # noqa: F821
    fronts = [np.interp(1 / n, 1 / np.array(READ_WITH[::-1]), row[::-1]) for row in fine[:, 2:]]
    return fine[:, 0], fine[:, 1], np.array(fronts)


def errors(run, case):
    n = run.n
    written = shares(case, n)
    t, x = np.array([t for t, _ in written]), np.array([front(alpha, n, n) for _, alpha in written])
    at = np.arange(0.8, 4.05, 0.1)
    fineT, fineToe, fineFront = _fine(n, "referenceNoSlip.csv" if run.variant == NO_SLIP else "reference.csv")
    experiment, shift = _experiment(t, x)
    volume = foam.table(case, "volume/*/*.dat")[-1, 1]
    return {"toeError": _rms(np.interp(at, t, [toe(alpha, n) for _, alpha in written]) - np.interp(at, fineT, fineToe)),
            "frontError": _rms(np.interp(at, t, x) - np.interp(at, fineT, fineFront)), "experiment": experiment, "clockShift": shift,
            "volumeError": volume / (2 * COLUMN**2 * 0.25 * COLUMN) - 1}
