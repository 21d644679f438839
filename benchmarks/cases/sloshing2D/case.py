# SPDX-License-Identifier: GPL-3.0-or-later
"""Standing wave in a tank, five periods: period and amplitude. N: cells over the length of the tank."""
import os

import numpy as np

from runner import foam, refinement, waves
from runner.cases import Run, Target, series

LENGTH, DEPTH, AIR, GRAVITY, AMPLITUDE, THICKNESS = 0.2, 0.1, 0.05, 9.81, 0.005, 0.01      # [m], [m/s^2]
LENGTHENING, FIFTH_OVER_FIRST = 1.0006, 1.00065  # without viscosity: period over the linear one, amplitude after five periods over after one: ./standingWave

title = """First mode of a tank 0.2 m long, water 0.1 m, air 0.05 m, amplitude 0.005 m, slip walls, open top, five periods; N cells over the length, largest
time step 0.16 s/N (`dt x2`: twice that; `refined`: mesh of N/2, or N/4, refined by refineMesh to N in a band of 0.07 m, and 0.04 m, around the surface, with that mesh's step). a(t) = integral of alpha cos(pi x/L). Period: slope through ten zero crossings, against two-fluid linear theory
(0.52895 s) lengthened by 0.06 % for the amplitude. Damping per period between the first and the fifth, beyond what the same wave does without viscosity: it
begins as a cosine at rest, and free second harmonics make its fifth peak 0.065 % higher than the first (`standingWave`). Exact viscous damping of slip walls is
0.026 %; a negative figure is growth."""
figures = {"damping": ("amplitude lost per period", ""), "periodError": ("period, relative error", ""), "amplitude": ("amplitude after 5 periods over start", ""),
           "volumeError": ("volume drift", "")}
mainError, moreErrors = "damping", ["periodError"]
targets = [Target("periodError", 0.001, "period", 80, ""), *[Target("damping", 0, "no growth", n, "", isLeast=True) for n in (40, 80, 160)]]

SIZES = [40, 80, 160]
REFINED = "refined"
BANDS = [((-1, 0.06, -1), (1, 0.13, 1)), ((-1, 0.08, -1), (1, 0.12, 1))]
runs = [
    *series("flotsamFoam", SIZES, quick=1),
    *series("flotsamFoam", SIZES, quick=0, variant="dt x2", options={"step": 0.32}),
    *(Run("flotsamFoam", 40 * 2**levels, REFINED, {"levels": levels}) for levels in (1, 2)),
    *series("interFoam", SIZES, quick=1),
    *series("interIsoFoam", SIZES, quick=1),
]


def _levels(run):
    return run.options.get("levels", 0)


def parameters(run):
    n = run.n // 2**_levels(run)
    return {"nx": n, "ny": 3 * n // 4, "maxStep": run.options.get("step", 0.16) / n, "ddt": "Euler"}


def files(run, _folder):
    return refinement.dictionaries(BANDS[:_levels(run)])


def prepare(run, do):
    do("blockMesh")
    refinement.refine(_levels(run), do)
    do("setAlphaField")
    do("postProcess", "-func", "writeCellCentres", "-time", "0")
    do(os.path.join(folder, "writeWeight"), str(LENGTH))       # noqa: F821 (folder is set by the runner)


def _linearPeriod():
    """Two fluids, pressure zero at the open top."""
    k = np.pi / LENGTH
    return 2 * np.pi / np.sqrt(GRAVITY * k * (1000 - 1) / (1000 / np.tanh(k * DEPTH) + np.tanh(k * AIR)))


def errors(_run, case):
    series_ = foam.table(case, "mode/*/*.dat")
    t, a = series_[:, 0], series_[:, 1] * 2 / LENGTH / THICKNESS
    period = waves.period(t, a)
    volume = foam.table(case, "volume/*/*.dat")[:, 1]
    first, fifth = (waves.peak(t, a, n * period, period) for n in (1, 5))
    return {"damping": float(1 - (fifth / first / FIFTH_OVER_FIRST)**0.25), "periodError": float(period / (_linearPeriod() * LENGTHENING) - 1),
            "amplitude": float(fifth / AMPLITUDE), "volumeError": float(volume[-1] / volume[0] - 1)}
