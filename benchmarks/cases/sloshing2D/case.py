# SPDX-License-Identifier: GPL-3.0-or-later
"""Standing wave in a tank, five periods: period and amplitude. N: cells over the length of the tank."""
import os

import numpy as np

from runner import foam
from runner.cases import series

LENGTH, DEPTH, AIR, GRAVITY, AMPLITUDE, THICKNESS = 0.2, 0.1, 0.05, 9.81, 0.005, 0.01      # [m], [m/s^2]
LENGTHENING = 1.000575      # period of the finite amplitude k a0 = 0.0785 over the linear one: Tadjbakhsh & Keller 1960

title = """First mode of a tank 0.2 m long, water 0.1 m, air 0.05 m, amplitude 0.005 m, slip walls, open top, five periods; N cells over the length, largest
time step 0.16 s/N (`dt x2`: twice that). a(t) = integral of alpha cos(pi x/L). Period: slope through ten zero crossings, against two-fluid linear theory
(0.52895 s) lengthened by 0.0575 % for the amplitude. Damping per period between the first and the fifth: exact viscous damping of slip walls is 0.026 %;
a negative figure is growth."""
figures = {"damping": ("amplitude lost per period", ""), "periodError": ("period, relative error", ""), "amplitude": ("amplitude after 5 periods over start", ""),
           "volumeError": ("volume drift", "")}
mainError, moreErrors = "damping", ["periodError"]
targets = {"periodError": (0.001, "period within 0.1 %")}

SIZES = [40, 80, 160]
runs = [
    *series("flotsamFoam", SIZES, quick=1),
    *series("flotsamFoam", SIZES, quick=0, variant="dt x2", options={"step": 0.32}),
    *series("interFoam", SIZES, quick=1),
    *series("interIsoFoam", SIZES, quick=1),
]


def parameters(run):
    return {"nx": run.n, "ny": 3 * run.n // 4, "maxStep": run.options.get("step", 0.16) / run.n, "ddt": "Euler"}


def prepare(_run, do):
    do("blockMesh")
    do("setAlphaField")
    do("postProcess", "-func", "writeCellCentres", "-time", "0")
    do(os.path.join(folder, "writeWeight"), str(LENGTH))       # noqa: F821 (folder is set by the runner)


def _linearPeriod():
    """Two fluids, pressure zero at the open top."""
    k = np.pi / LENGTH
    return 2 * np.pi / np.sqrt(GRAVITY * k * (1000 - 1) / (1000 / np.tanh(k * DEPTH) + np.tanh(k * AIR)))


def _peak(t, a, around, period):
    """Largest value near a time: polynomial through the samples there."""
    near = np.abs(t - around) < 0.06 * period
    fit = np.polyfit(t[near] - around, a[near], 4)
    return np.polyval(fit, np.linspace(-0.05, 0.05, 201) * period).max()


def errors(_run, case):
    series_ = foam.table(case, "mode/*/*.dat")
    t, a = series_[:, 0], series_[:, 1] * 2 / LENGTH / THICKNESS
    before = np.flatnonzero(a[:-1] * a[1:] < 0)
    crossing = (t[before] - a[before] * (t[before + 1] - t[before]) / (a[before + 1] - a[before]))[:10]
    period = 2 * np.polyfit(np.arange(len(crossing)), crossing, 1)[0]
    volume = foam.table(case, "volume/*/*.dat")[:, 1]
    fifth = _peak(t, a, 5 * period, period)
    return {"damping": float(1 - (fifth / _peak(t, a, period, period))**0.25), "periodError": float(period / (_linearPeriod() * LENGTHENING) - 1),
            "amplitude": float(fifth / AMPLITUDE), "volumeError": float(volume[-1] / volume[0] - 1)}
