# SPDX-License-Identifier: GPL-3.0-or-later
"""Schaefer & Turek 2D-2: vortex street behind a cylinder in a channel, Re = 100. N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative
from support.files import around, blockMesh, bodies, control, even, field, fixed, merged, oneFluid, parabola

SOURCE = "featflow.de, DFG 2D-2, finest series"
DIAMETER, MEAN_SPEED, END, WINDOW = 0.1, 1.0, 7.0, 1.7        # the last five periods are evaluated
PUBLISHED_STROUHAL = 0.301841

title = """Vortex street behind a cylinder in a channel, Re = 100 (Schaefer & Turek 1996, case 2D-2), cut out of a rectangular mesh with N elements a
diameter in 0.1 < x < 0.5, 0.1 < y < 0.3 (m), wider elsewhere. From a parabola everywhere to t = 7 s at maxCo 1; extrema of Fourier series
(three terms, fitted to the end of the run)."""

runs = [Run("flotsamFoam", n, quick=n == 10, timeLimit=3600) for n in (10, 20, 30)]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    h, growth = DIAMETER / run.n, 1 + 1 / run.n
    x = around(0, 0.1, 0.5, 2.2, h, growth, 1 + 0.5 / run.n)
    y = around(0, 0.1, 0.3, 0.41, h, growth)
    return merged(
        blockMesh(x, y, even(0, 1, 1), {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "walls": ("wall", "y- y+"), "frontAndBack": ("empty", "z- z+")}),
        field("U", {"inlet": fixed("(1 0 0)"), "outlet": "zeroGradient", "walls": "noSlip", "frontAndBack": "empty"}, "(1 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "walls": "zeroGradient", "frontAndBack": "empty"}),
        parabola("vector(6*pos().y()*(0.41 - pos().y())/sqr(0.41), 0, 0)"), oneFluid(0.001, 1),
        bodies("structures { cylinder { shape { type cylinder; end1 (0.2 0.2 -0.1); end2 (0.2 0.2 1.1); radius 0.05; } wall noSlip; } }"),
        control(END, 1e-3, maxCo=1))


def prepare(_run, do):
    do("blockMesh")
    do("setExprBoundaryFields")


def _street(t, drag, lift):
    """(frequency, drag, lift) of the street, the forces over one period: Fourier series of three terms, fitted. Noise from step to step has local maxima of its own."""
    def series(f, signal):
        phase = 2 * np.pi * f * t[:, None] * np.arange(1, 4)
        basis = np.hstack([np.ones((len(t), 1)), np.cos(phase), np.sin(phase)])
        coefficients, _, _, _ = np.linalg.lstsq(basis, signal, rcond=None)
        return coefficients, np.sqrt(np.mean((basis @ coefficients - signal)**2))
    tried = PUBLISHED_STROUHAL * MEAN_SPEED / DIAMETER * np.linspace(0.8, 1.2, 801)
    best = tried[np.argmin([series(f, lift)[1] for f in tried])]
    phase = np.linspace(0, 2 * np.pi, 721)[:, None] * np.arange(1, 4)
    basis = np.hstack([np.ones((721, 1)), np.cos(phase), np.sin(phase)])
    return best, basis @ series(best, drag)[0], basis @ series(best, lift)[0]


def errors(_run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    late = history.time > END - WINDOW
    t, (drag, lift) = history.time[late], 2 / (MEAN_SPEED**2 * DIAMETER) * history["cylinder"].fluidForce[late, :2].T
    frequency, drag, lift = _street(t, drag, lift)
    return {"comparisons": [
        relative("largest drag coefficient", drag.max(), 3.227393, 0.01, source=SOURCE),
        relative("smallest drag coefficient", drag.min(), 3.164263, 0.01, source=SOURCE),
        relative("lift coefficient, crest to trough", lift.max() - lift.min(), 2.007871, 0.02, source=SOURCE),
        relative("Strouhal number", DIAMETER / MEAN_SPEED * frequency, PUBLISHED_STROUHAL, 0.005, source=SOURCE)]}
