# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag of a fixed sphere at Re = 1000 and 10,000, with its unsteady wake. N: elements a diameter."""
import numpy as np

from runner import foam, refinement
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, field, fixed, merged, oneFluid

CLIFT, BROWN = "Clift, Grace & Weber 1978", "Brown & Lawler 2003"
REYNOLDS = {"Re 1000": 1000, "Re 10000": 10000}
BASE, FAR = 4, 6                        # elements a diameter of the mesh that is refined; distance of inlet and sides
BEGIN, END = 15, 45                     # the mean is taken over [D/U]
BOXES = [((-1, -1, -1), (2, 1, 1)), ((-0.75, -0.75, -0.75), (1, 0.75, 0.75))]

title = f"""Fixed sphere of diameter 1 in a uniform stream of speed 1 whose wake sheds vortices; no element resolves the boundary layer on it (Re 10,000). Mesh of {BASE} elements a diameter up to 1.25 diameters from
the centre (3 behind), widening by 20 %, halved once (N = 8) and twice (16) around the sphere; slip sides at {FAR} diameters. maxCo 1; mean drag over {BEGIN} to {END} D/U. Published: correlations of
Clift, Grace & Weber 1978 and of Brown & Lawler 2003 (doi 10.1061/(ASCE)0733-9372(2003)129:3(222))."""

runs = [Run("flotsamFoam", n, name, quick=n == 4, timeLimit=3600) for name in REYNOLDS for n in (4, 8, 16)]


def resolution(run):
    return f"{run.variant}, {run.n} a diameter"


def _levels(run):
    return int(np.log2(run.n / BASE))


def files(run, _folder):
    h = 1 / BASE
    x = around(-FAR, -1.25, 3, 2 * FAR, h, 1.2)
    side = around(-FAR, -1.25, 1.25, FAR, h, 1.2)
    return merged(
        refinement.dictionaries(BOXES[:_levels(run)], "tan1 tan2 normal"),
        blockMesh(x, side, side, {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("patch", "y- y+ z- z+")}),
        field("U", {"inlet": fixed("(1 0 0)"), "outlet": "type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);", "sides": "slip"}, "(1 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient"}),
        oneFluid(1 / REYNOLDS[run.variant], 1),
        bodies("structures { sphere { shape { type sphere; radius 0.5; centre (0 0.0017 0.0011); } wall noSlip; } }"),
        control(END, 0.01, maxCo=1, maxDeltaT=0.2))


def prepare(run, do):
    do("blockMesh")
    refinement.refine(_levels(run), do)


def _clift(re):
    """Coefficient; valid for 260 < Re < 12,000."""
    w = np.log10(re)
    return 10**(1.6435 - 1.1242 * w + 0.1558 * w**2 if re < 1500 else -2.4571 + 2.5558 * w - 0.9295 * w**2 + 0.1049 * w**3)


def _brown(re):
    return 24 / re * (1 + 0.15 * re**0.681) + 0.407 / (1 + 8710 / re)


def errors(run, case):
    re = REYNOLDS[run.variant]
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    scale = 8 / np.pi
    drag = scale * history.mean("sphere", "fluidForce", BEGIN)[0]
    swing = scale * history["sphere"].fluidForce[history.time > BEGIN]
    return {"comparisons": [
        relative("drag coefficient", drag, _clift(re), 0.1, source=CLIFT),
        relative("drag coefficient", drag, _brown(re), source=BROWN),
        small("standard deviation of the drag coefficient", swing[:, 0].std()), small("standard deviation of the sideways coefficients", swing[:, 1:].std())]}
