# SPDX-License-Identifier: GPL-3.0-or-later
"""Row of cylinders with slip walls across a nearly inviscid stream: no drag (d'Alembert). N: elements over the pitch."""
import os

import numpy as np

from runner import foam, refinement
from runner.cases import Run
from support.compare import small
from support.files import blockMesh, bodies, control, even, field, fixed, merged, oneFluid

SOURCE = "d'Alembert"
DIAMETER, PITCH, SPEED, DENSITY = 0.0217, 0.04, 0.25, 1000
SCALE = DENSITY / 2 * (SPEED * PITCH / (PITCH - DIAMETER))**2 * DIAMETER       # 1/2 rho U^2 D with the velocity in the gap, N/m
END, BEGIN = 1.5, 1.0                                                          # the last half second is evaluated

title = """Row of cylinders with slip walls across a stream, 2D: diameter 0.0217 m, pitch 0.04 m, 0.25 m/s, rho 1000, nu 1e-6 (Re 5400). One cylinder in a channel 0.4 m x 0.04 m
with slip walls, 0.3 mm off its middle; N elements over the pitch (refined: around the cylinder, by refineMesh, 4 elsewhere); mean force over 1 to 1.5 s. Drag of 1/2 rho U^2 D, with the velocity in the gap (0.546 m/s) 3.24 N/m.
An inviscid stream would leave none (d'Alembert); the viscous dissipation of the potential flow would make 0.003. Order: from the next coarser run on."""

SIZES = (4, 6, 8, 16)
REFINED = "refined"
BOXES = [((0.16, -1, -1), (0.25, 1, 2)), ((0.18, -1, -1), (0.22, 1, 2))]      # the cylinder's axis is at x = 0.2
runs = [*(Run("flotsamFoam", n, quick=n == 4, timeLimit=1200) for n in SIZES), *(Run("flotsamFoam", n, REFINED, timeLimit=1200) for n in (8, 16))]


def resolution(run):
    return f"{run.n} over the pitch{', refined' if run.variant else ''}, {run.n * DIAMETER / PITCH:.1f} a diameter"


def _levels(run):
    return int(np.log2(run.n / SIZES[0])) if run.variant == REFINED else 0


def files(run, _folder):
    n = run.n // 2**_levels(run)
    return merged(
        refinement.dictionaries(BOXES[:_levels(run)]),
        blockMesh(even(0, 0.4, 10 * n), even(-PITCH / 2, PITCH / 2, n), even(0, 1, 1),
                  {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "walls": ("wall", "y- y+"), "frontAndBack": ("empty", "z- z+")}),
        field("U", {"inlet": fixed(f"({SPEED} 0 0)"), "outlet": "zeroGradient", "walls": "slip", "frontAndBack": "empty"}, f"({SPEED} 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "walls": "zeroGradient", "frontAndBack": "empty"}), oneFluid(1e-6, DENSITY),
        bodies(f"structures {{ cylinder {{ shape {{ type cylinder; end1 (0.2 0.0003 -0.1); end2 (0.2 0.0003 1.1); radius {DIAMETER / 2}; }} wall slip; }} }}"),
        control(END, 0.002, maxDeltaT=0.02))


def prepare(run, do):
    do("blockMesh")
    refinement.refine(_levels(run), do)


def _drag(case):
    """Mean and standard deviation of the drag coefficient."""
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    drag = history["cylinder"].fluidForce[history.time > BEGIN, 0] / SCALE
    return drag.mean(), drag.std()


def errors(run, case):
    drag, swing = _drag(case)
    result = [small("drag coefficient, velocity in the gap", drag, 0.05, source=SOURCE), small("standard deviation of the drag coefficient", swing)]
    for n in [n for n in SIZES if n < run.n and not run.variant][-1:]:
        coarser = os.path.join(os.path.dirname(case), f"flotsamFoam_{n}")
        if os.path.isdir(coarser):
            result.append(small(f"order from N {n} on", np.log(_drag(coarser)[0] / drag) / np.log(run.n / n)))
    return {"comparisons": result}
