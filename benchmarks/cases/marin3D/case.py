# SPDX-License-Identifier: GPL-3.0-or-later
"""Dam break with a box (MARIN, SPHERIC test 2), half tank. N: cells over the box's 0.161 m."""
import os

import numpy as np

from runner import foam
from runner.cases import Target, series

title = """Kleefsman et al. 2005 (MARIN experiment, SPHERIC test 2): half tank with a symmetry plane, slip walls, uniform hexahedra with N cells over the box's 0.161 m,
to t = 3 s; exact cell fractions at the start. Errors against the experiment on its own clock, t = 0.02 .. 3 s: water heights H1 .. H4 (integral of alpha over
the column at x = 1.488, 0.992, 0.496, 2.638 m from the dry end; the file's header says why in this order) and pressures P1 to P4 on the box's front (z = 0.021 to 0.141 m),
P5 to P8 on its top; and against `reference.csv`, the mean of interFoam and interIsoFoam with 8 cells over the box (`makeReference`): what the problem as it is posed here
has for a solution. All solvers: function objects `sets` and `probes` on cell values. Variant "Co 1": ours with twice the time step.
Variant "no-slip": no-slip walls and box, which no mesh here resolves the layers of."""
EARLY = 1.2     # s: then the sheets behind the box fall
figures = {"fineH": ("heights against the fine runs, rms", "m"), "fineP": ("pressures against the fine runs, rms", "Pa"),
           "earlyH": ("the same until 1.2 s, heights", "m"), "earlyP": ("until 1.2 s, pressures", "Pa"),
           **{f"H{i}": (f"H{i}, rms error", "m") for i in range(1, 5)}, **{f"P{i}": (f"P{i}, rms error", "Pa") for i in range(1, 9)},
           "peak": ("P1, peak before 1 s (experiment 9760)", "Pa"), "impulse": ("impulse of P1 over the experiment's", ""), "volumeError": ("volume drift", "")}
mainError, moreErrors = "fineH", ["fineP", "earlyH", "earlyP", "H2", "H4", "P1"]
targets = [Target("H2", 0.022, "H2 [m]", 4), Target("H4", 0.013, "H4 [m]", 4), Target("P1", 600, "P1 [Pa]", 4)]

NO_SLIP = "no-slip"
runs = [
    *series("flotsamFoam", [2, 3, 4], quick=1),
    *series("flotsamFoam", [2, 3, 4], quick=0, variant="Co 1"),
    *series("interFoam", [2, 3, 4, 5], quick=1),
    *series("interIsoFoam", [2, 3, 4], quick=1),
    *(run for solver in ("flotsamFoam", "interFoam") for run in series(solver, [2, 3, 4], quick=0, variant=NO_SLIP)),
]


def parameters(run):
    return {"maxCo": 1 if run.variant == "Co 1" else 0.5, "wall": "noSlip" if run.variant == NO_SLIP else "slip"}


def problem(variant):
    return variant if variant == NO_SLIP else ""


def prepare(run, do):
    makeMesh = os.path.join(folder, "makeMesh")     # noqa: F821 (folder is set by the runner)
    do(makeMesh, str(run.n))
    do("blockMesh")
    do("postProcess", "-func", "writeCellCentres", "-time", "0")
    do(makeMesh, "--fill", str(run.n))


def _depth(file):
    """Water depth of a vertical: sum of alpha dz over its cells, 0 .. 1 m."""
    z, alpha = np.loadtxt(file).T[:2]
    edges = np.concatenate(([0], (z[1:] + z[:-1]) / 2, [1]))
    return np.sum(alpha * np.diff(edges))


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def gauges(case, t):
    """H1 .. H4 [m], then P1 .. P8 [Pa], at the times t, of a run: one row each."""
    heights = np.array([[time] + [_depth(os.path.join(files, f"H{i}_alpha.water.xy")) for i in (1, 2, 3, 4)] for time, files in foam.sampled(case, "heights")])
    pressures = foam.table(case, "pressure/*/p")
    return np.array([np.interp(t, of[:, 0], of[:, i]) for of, count in ((heights, 4), (pressures, 8)) for i in range(1, count + 1)])


def againstFineRuns(case):
    """Rms over all heights, and over all pressures, from 0.02 s to EARLY and to 3 s, against reference.csv."""
    fine = np.loadtxt(os.path.join(folder, "reference.csv"), delimiter=",").T    # noqa: F821
    t = fine[0]
    away = gauges(case, t) - fine[1:]
    return {f"{name}{quantity}": _rms(away[rows][:, (t > 0.02) & (t < end)])
            for name, end in (("early", EARLY), ("fine", 3)) for quantity, rows in (("H", slice(0, 4)), ("P", slice(4, 12)))}


def againstExperiment(case):
    experiment = foam.reference(root, "marinExperiment")    # noqa: F821
    experiment = experiment[(experiment[:, 0] > 0.02) & (experiment[:, 0] < 3)]
    t = experiment[:, 0]
    computed = gauges(case, t)
    result = {f"H{i}": _rms(computed[i - 1] - experiment[:, 8 + i]) for i in (1, 2, 3, 4)}
    result.update({f"P{i}": _rms(computed[3 + i] - experiment[:, i]) for i in range(1, 9)})
    probes = foam.table(case, "pressure/*/p")
    window = (t > 0.4) & (t < 1.5)
    volume = foam.table(case, "volume/*/*.dat")[:, 1]
    return {**result, "peak": float(probes[probes[:, 0] < 1, 1].max()),
            "impulse": float(np.trapz(computed[4][window], t[window]) / np.trapz(experiment[window, 1], t[window])), "volumeError": float(volume[-1] / volume[0] - 1)}


def errors(run, case):
    return {**againstExperiment(case), **({} if run.variant == NO_SLIP else againstFineRuns(case))}
