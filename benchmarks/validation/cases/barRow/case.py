# SPDX-License-Identifier: GPL-3.0-or-later
"""Row of round bars across a stream, as in a rack: drag of separated flow at a Reynolds number of 1e4. N: elements a diameter."""
import numpy as np

from runner import foam, refinement
from runner.cases import Run
from support.compare import relative, small
from support.files import blockMesh, bodies, control, even, field, fixed, merged, oneFluid

SOURCE = "Kirschmer 1926"
DENSITY, NU = 1000, 1e-6
COARSEST = 4                # elements a diameter far from the bar
END, BEGIN = 60, 20         # D/U: the mean is taken from BEGIN to END

#       diameter, pitch [m], velocity upstream [m/s]
ROWS = {"wide": (0.032, 0.1, 0.45), "narrow": (0.0217, 0.04, 0.25)}

title = """Row of round no-slip bars across a stream, 2D, one bar in a channel with slip walls; rho 1000, nu 1e-6. wide: the rack of tutorials/debrisRack, diameter 0.032 m, pitch 0.1 m,
0.45 m/s (Re 14,400, in the gap 21,000); narrow: the pipes of tutorials/slitDam, 0.0217 m, 0.04 m, 0.25 m/s (5,400; 11,900). N elements a diameter around the bar, by refineMesh from 4
elements upstream and far downstream on. Drag coefficient of 1/2 rho U^2 D, U the velocity in the gap, mean over 20 to 60 D/U. Published: loss of head of racks of round bars,
1.79 (s/b)^(4/3) U^2/2g with the velocity upstream, s the diameter and b the clearance, a fit to measurements of many racks (its spread is some 10 to 20 %; 2D wakes have more drag than real ones)."""

SPAN = 4                    # diameters, of the runs in 3D between planes of symmetry
runs = [*(Run("flotsamFoam", n, name, quick=n == 8, timeLimit=3600) for name in ROWS for n in (4, 8, 16, 32)),
        *(Run("flotsamFoam", n, name + " 3D", timeLimit=5400) for name in ROWS for n in (4, 8))]


def _row(run):
    return ROWS[run.variant.split()[0]]


def _is3D(run):
    return run.variant.endswith("3D")


def resolution(run):
    return f"{run.variant}, {run.n} a diameter"


def _levels(run):
    return int(np.log2(run.n / COARSEST))


def files(run, _folder):
    diameter, pitch, speed = _row(run)
    span, layers, ends = (SPAN * diameter, SPAN * COARSEST, "symmetryPlane") if _is3D(run) else (1, 1, "empty")
    h = diameter / COARSEST
    upstream, downstream = 20, 48
    boxes = [((-a * diameter, -b * diameter, -1), (c * diameter, b * diameter, 2)) for a, b, c in ((1.5, 1.2, 3.5), (1.1, 1, 2), (0.8, 0.8, 1.2))]
    return merged(
        blockMesh(even(-upstream * h, downstream * h, upstream + downstream), even(-pitch / 2, pitch / 2, round(pitch / h)), even(0, span, layers),
                  {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "walls": ("wall", "y- y+"), "back": (ends, "z-"), "front": (ends, "z+")}),
        refinement.dictionaries(boxes[:_levels(run)], "tan1 tan2 normal" if _is3D(run) else "tan1 tan2"),
        field("U", {"inlet": fixed(f"({speed} 0 0)"), "outlet": "type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);", "walls": "slip",
                    "back": ends, "front": ends}, f"({speed} 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "walls": "zeroGradient", "back": ends, "front": ends}), oneFluid(NU, DENSITY),
        bodies(f"structures {{ bar {{ shape {{ type cylinder; end1 (0 {0.013 * diameter} -0.1); end2 (0 {0.013 * diameter} 1.1); radius {diameter / 2}; }} wall noSlip; }} }}"),
        control(END * diameter / speed, 1e-3 * diameter / speed, maxDeltaT=0.2 * diameter / speed, maxCo=1))


def prepare(run, do):
    do("blockMesh")
    refinement.refine(_levels(run), do)


def _kirschmer(diameter, pitch):
    """Drag coefficient with the velocity in the gap: the head lost over the pitch."""
    clearance = pitch - diameter
    return 1.79 * (diameter / clearance)**(4 / 3) * (clearance / pitch)**2 * pitch / diameter


def errors(run, case):
    diameter, pitch, speed = _row(run)
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    span = SPAN * diameter if _is3D(run) else 1
    scale = DENSITY / 2 * (speed * pitch / (pitch - diameter))**2 * diameter * span
    begin = BEGIN * diameter / speed
    drag = history.mean("bar", "fluidForce", begin)[0] / scale
    swing = history["bar"].fluidForce[history.time > begin] / scale
    return {"comparisons": [relative("drag coefficient, velocity in the gap", drag, _kirschmer(diameter, pitch), 0.2, source=SOURCE),
                            small("standard deviation of the drag coefficient", swing[:, 0].std()), small("standard deviation of the lift coefficient", swing[:, 1].std())]}
