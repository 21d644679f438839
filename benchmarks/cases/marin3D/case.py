# SPDX-License-Identifier: GPL-3.0-or-later
"""Dam break with a box (MARIN, SPHERIC test 2), half tank. N: cells over the box's 0.161 m."""
import os

import numpy as np

from runner import foam
from runner.cases import Target, series

title = """Kleefsman et al. 2005 (MARIN experiment, SPHERIC test 2): half tank with a symmetry plane, slip walls, uniform hexahedra with N cells over the box's 0.161 m,
to t = 3 s; exact cell fractions at the start. Errors against the experiment on its own clock, t = 0.02 .. 3 s: water heights H1 .. H4 (integral of alpha over
the column at x = 1.488, 0.992, 0.496, 2.638 m from the dry end; the file's header says why in this order) and pressures P1 to P4 on the box's front (z = 0.021 to 0.141 m),
P5 to P8 on its top. All solvers: function objects `sets`
and `probes` on cell values. Variant "no-slip": no-slip walls and box, which no mesh here resolves the layers of."""
figures = {**{f"H{i}": (f"H{i}, rms error", "m") for i in range(1, 5)}, **{f"P{i}": (f"P{i}, rms error", "Pa") for i in range(1, 9)},
           "peak": ("P1, peak before 1 s (experiment 9760)", "Pa"), "impulse": ("impulse of P1 over the experiment's", ""), "volumeError": ("volume drift", "")}
mainError, moreErrors = "H2", ["H4", "P1"]
targets = [Target("H2", 0.022, "H2 [m]", 4), Target("H4", 0.013, "H4 [m]", 4), Target("P1", 600, "P1 [Pa]", 4)]

NO_SLIP = "no-slip"
runs = [
    *series("flotsamFoam", [2, 3, 4], quick=1),
    *series("interFoam", [2, 3, 4, 5], quick=1),
    *series("interIsoFoam", [2, 3, 4], quick=1),
    *(run for solver in ("flotsamFoam", "interFoam") for run in series(solver, [2, 3, 4], quick=0, variant=NO_SLIP)),
]


def parameters(run):
    return {"maxCo": 0.5, "wall": "noSlip" if run.variant == NO_SLIP else "slip"}


def problem(variant):
    return variant


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


def errors(_run, case):
    experiment = foam.reference(root, "marinExperiment")    # noqa: F821
    experiment = experiment[(experiment[:, 0] > 0.02) & (experiment[:, 0] < 3)]
    t = experiment[:, 0]
    heights = np.array([[time] + [_depth(os.path.join(files, f"H{i}_alpha.water.xy")) for i in (1, 2, 3, 4)] for time, files in foam.sampled(case, "heights")])
    result = {f"H{i}": _rms(np.interp(t, heights[:, 0], heights[:, i]) - experiment[:, 8 + i]) for i in (1, 2, 3, 4)}
    probes = foam.table(case, "pressure/*/p")
    pressures = {f"P{i}": np.interp(t, probes[:, 0], probes[:, i]) for i in range(1, 9)}
    window = (t > 0.4) & (t < 1.5)
    volume = foam.table(case, "volume/*/*.dat")[:, 1]
    result.update({name: _rms(p - experiment[:, int(name[1])]) for name, p in pressures.items()})
    return {**result, "peak": float(probes[probes[:, 0] < 1, 1].max()),
            "impulse": float(np.trapz(pressures["P1"][window], t[window]) / np.trapz(experiment[window, 1], t[window])), "volumeError": float(volume[-1] / volume[0] - 1)}
