# SPDX-License-Identifier: GPL-3.0-or-later
"""Collapsing water column: front (Martin & Moyce 1952, Koshizuka & Oka 1996) and height at the back wall. N: elements over the column's width."""
import os

import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import small
from support.files import blockMesh, column, control, even, gravity, merged, openTank, twoFluids

COLUMN, GRAVITY = 0.05715, 9.81
UNIT = np.sqrt(COLUMN / (2 * GRAVITY))      # of time [s]
END = 4.9

title = """Water column of width a = 0.05715 m and height 2a in a tank 9a x 2.25a with an open top, 2D, N cells over a; slip or no-slip walls; to T = t sqrt(2g/a) = 4.9. Differences
from the digitised experiments, rms. The experiments' gates and their wetting make the clock uncertain (slip walls lead Martin & Moyce by 0.37 in T at any resolution): shown also with the
experiment's clock shifted by the constant that fits best. The error against a common fine grid is in the benchmark damBreak2D."""

runs = [Run("flotsamFoam", n, wall, {"wall": wall}, quick=(n == 16 and wall == "slip"), timeLimit=2400) for n in (16, 32) for wall in ("slip", "noSlip")]


def resolution(run):
    return f"{run.n} over a"


def files(run, _folder):
    a, n = COLUMN, run.n
    half = 0.5 * a / n
    function = """    {name} {{ type sets; libs (sampling); writeControl adjustableRunTime; writeInterval {every:.9g}; setFormat raw; interpolationScheme cell;
        fields (alpha.water); sets ( line {{ type midPoint; axis {axis}; start ({start}); end ({end}); }} ); }}"""
    every = 0.05 * UNIT
    lines = [function.format(name="front", every=every, axis="x", start=f"0 {half:.9g} 0.005", end=f"{9 * a:.9g} {half:.9g} 0.005"),
             function.format(name="back", every=every, axis="y", start=f"{half:.9g} 0 0.005", end=f"{half:.9g} {2.25 * a:.9g} 0.005")]
    return merged(
        blockMesh(even(0, 9 * a, 9 * n), even(0, 2.25 * a, 9 * n // 4), even(0, 0.01, 1),
                  {"walls": ("wall", "x- x+ y-"), "top": ("patch", "y+"), "frontAndBack": ("empty", "z- z+")}),
        openTank(run.options["wall"], top="top", empty=["frontAndBack"]),
        column(a, 2 * a),
        twoFluids(), gravity(y=-GRAVITY), control(END * UNIT, 1e-4, functions="\n".join(lines)))


def prepare(_run, do):
    do("blockMesh")
    do("setFields")


def _lines(case, name):
    for time, folder in foam.sampled(case, name):
        yield time / UNIT, np.loadtxt(os.path.join(folder, os.listdir(folder)[0])).T[:2]


def _front(case):
    result = []
    for t, (x, alpha) in _lines(case, "front"):
        i = min(np.flatnonzero(alpha >= 0.5).max(), len(alpha) - 2)
        result.append((t, (x[i] + (x[i + 1] - x[i]) * (alpha[i] - 0.5) / (alpha[i] - alpha[i + 1])) / COLUMN))
    return np.array(result).T


def _height(case):
    """Integral of alpha along the back wall over 2a."""
    return np.array([(t, alpha.sum() * (y[1] - y[0]) / (2 * COLUMN)) for t, (y, alpha) in _lines(case, "back")]).T


def _deviation(series, table):
    """(rms, rms with the best shift, shift) of a series against points."""
    t, f = table[table[:, 0] < END - 0.6].T[:2]

    def rms(shift):
        return float(np.sqrt(np.mean((np.interp(t - shift, *series) - f)**2)))
    shifts = np.linspace(-0.6, 0.6, 241)
    best = min(shifts, key=rms)
    return rms(0), rms(best), float(best)


def errors(_run, case):
    front, height = _front(case), _height(case)
    found = []
    for name, series, file in (("front, Martin & Moyce a = 2.25 in", front, "frontMartinMoyce"), ("front, Martin & Moyce a = 1.125 in", front, "frontMartinMoyceSmall"),
                               ("front, Koshizuka & Oka", front, "frontKoshizukaOka"), ("height at the back wall, Koshizuka & Oka", height, "heightKoshizukaOka")):
        rms, best, shift = _deviation(series, foam.reference(root, file))      # noqa: F821 (root is set by the runner)
        unit = "a" if name.startswith("front") else "2a"
        found += [small(name + ", rms", rms, unit=unit), small(f"the same, clock shifted by {shift:+.2f}", best, 0.1 if unit == "a" else 0.03, unit=unit)]
    return {"comparisons": found}
