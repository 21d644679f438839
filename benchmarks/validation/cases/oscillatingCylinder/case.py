# SPDX-License-Identifier: GPL-3.0-or-later
"""Cylinder oscillating in fluid at rest, KC = 5, Re = 100 (Duetsch et al. 1998). N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, even, field, fixed, merged, oneFluid

SOURCE = "Duetsch et al. 1998, fig. 10, computed"
PERIOD, AMPLITUDE, PERIODS = 5.0, 5 / (2 * np.pi), 4       # diameter and largest speed are 1

title = """Cylinder moved as x = -A sin(2 pi t/T) through fluid at rest, KC = 5, Re = 100 (Duetsch, Durst, Becker & Lienhart 1998), 55 x 35 diameters, N elements
a diameter over the cylinder's way, 4 periods, the last one compared. Coefficients are of F/(rho U^2 D/2); published ones come from the digitised curve by the same formulae.
Noise: rms of the force less its Fourier series of 15 terms, over the largest force; default Courant numbers, so that the surface crosses many elements per period."""

runs = [Run("flotsamFoam", n, quick=n == 10, timeLimit=3600) for n in (10, 20, 40)]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    h, growth = 1 / run.n, 1 + 1.5 / run.n
    x = around(-27.5, -1.6, 1.6, 27.5, h, growth)
    y = around(-17.5, -0.9, 0.9, 17.5, h, growth)
    return merged(
        blockMesh(x, y, even(0, 1, 1), {"left": ("patch", "x-"), "right": ("patch", "x+"), "sides": ("patch", "y- y+"), "frontAndBack": ("empty", "z- z+")}),
        field("U", {"left": "zeroGradient", "right": "zeroGradient", "sides": "slip", "frontAndBack": "empty"}),
        field("p", {"left": fixed(0), "right": fixed(0), "sides": "zeroGradient", "frontAndBack": "empty"}), oneFluid(0.01, 1),
        bodies(f"""structures
{{
    cylinder
    {{
        shape {{ type cylinder; end1 (0 0 -0.1); end2 (0 0 1.1); radius 0.5; }}
        wall noSlip;
        motion {{ type oscillating; direction (-1 0 0); amplitude {AMPLITUDE:.10g}; period {PERIOD:g}; }}
    }}
}}"""),
        control(PERIODS * PERIOD, 0.005))


def _series(phase, f, terms):
    """Fourier coefficients (sine, cosine) of f over one period, least squares."""
    columns = [np.ones_like(phase)]
    for k in range(1, terms + 1):
        columns += [np.sin(2 * np.pi * k * phase), np.cos(2 * np.pi * k * phase)]
    matrix = np.stack(columns, axis=1)
    return np.linalg.lstsq(matrix, f, rcond=None)[0], matrix


def _seriesAt(coefficients, phase):
    value = coefficients[0]
    for k in range(1, (len(coefficients) + 1) // 2):
        value = value + coefficients[2 * k - 1] * np.sin(2 * np.pi * k * phase) + coefficients[2 * k] * np.cos(2 * np.pi * k * phase)
    return value


def _morison(phase, f):
    """Drag and inertia coefficients of F = -cD |u| u / 2 - cI (pi/4) du/dt with x = -A sin(2 pi phase), by least squares."""
    u = -np.cos(2 * np.pi * phase)
    acceleration = 2 * np.pi / PERIOD * np.sin(2 * np.pi * phase)
    matrix = np.stack([-np.abs(u) * u, -np.pi / 2 * acceleration], axis=1)
    return np.linalg.lstsq(matrix, f, rcond=None)[0]


def errors(_run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    last = history.time > (PERIODS - 1) * PERIOD
    phase, force = history.time[last] / PERIOD % 1, 2 * history["cylinder"].fluidForce[last, 0]
    order = np.argsort(phase)
    phase, force = phase[order], force[order]
    coefficients, matrix = _series(phase, force, 15)
    t, f = foam.reference(root, "forceDutsch")[:, [0, 2]].T      # noqa: F821; the figure's clock is that of x = -A sin(2 pi t/T)
    deviation = np.sqrt(np.mean((_seriesAt(coefficients, t) - f)**2))
    drag, inertia = _morison(phase, force)
    dragPublished, inertiaPublished = _morison(t, f)
    largest = np.abs(f).max()
    return {"comparisons": [
        small("force over the period, rms over the largest", deviation / largest, 0.02, source=SOURCE),
        relative("largest force coefficient", np.abs(matrix @ coefficients).max(), largest, 0.02, source=SOURCE),
        relative("drag coefficient (Morison)", drag, dragPublished, 0.02, source=SOURCE),
        relative("inertia coefficient (Morison)", inertia, inertiaPublished, 0.02, source=SOURCE),
        small("noise of the force", np.std(force - matrix @ coefficients) / largest, 0.01),
        small("sideways force over the largest", np.abs(history["cylinder"].fluidForce[last, 1]).max() * 2 / largest, source="symmetry")]}
