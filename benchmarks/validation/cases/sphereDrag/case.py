# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag of a fixed sphere in a uniform stream, Re = 1 to 300. N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, field, fixed, merged, oneFluid

#         Reynolds number: distance of the sides [diameters], end [D/U]
STREAMS = {"Re 1": (1, 40, 20), "Re 10": (10, 20, 20), "Re 50": (50, 15, 20), "Re 100": (100, 15, 20), "Re 300": (300, 12, 30)}

title = """Fixed sphere of diameter 1 in a uniform stream of speed 1, a quarter of it between two planes of symmetry (up to Re = 211 the flow is steady and
symmetric to the axis; at Re 300 the real wake sheds vortices, which the planes prevent in part). N elements a diameter up to 0.75 diameters from the centre (1.5 behind),
widening by 20 % an element; slip sides at 40 diameters (Re 1), 20, 15, 15, 12 (Re 300), inlet as far, outlet 1.5 times. maxCo 4. Published: correlation of Clift, Grace & Weber
1978 (Re 300: mean of Johnson & Patel 1999, 0.656, within 0.5 % of it); that of Schiller & Naumann lies 1 to 5 % beside it."""

runs = [*(Run("flotsamFoam", 8, name, quick=name == "Re 100", timeLimit=2400) for name in STREAMS), *(Run("flotsamFoam", 16, name, timeLimit=3600) for name in STREAMS)]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    number, far, end = STREAMS[run.variant]
    h = 1 / run.n
    x = around(-far, -0.75, 1.5, 1.5 * far, h, 1.2, 1.15)
    side = around(0, 0, 0.75, far, h, 1.2)
    return merged(
        blockMesh(x, side, side, {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("patch", "y+ z+"), "middle": ("symmetryPlane", "y-"),
                                  "middle2": ("symmetryPlane", "z-")}),
        field("U", {"inlet": fixed("(1 0 0)"), "outlet": "zeroGradient", "sides": "slip", "middle": "symmetryPlane", "middle2": "symmetryPlane"}, "(1 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient", "middle": "symmetryPlane", "middle2": "symmetryPlane"}),
        oneFluid(1 / number, 1), bodies("structures { sphere { shape { type sphere; radius 0.5; } wall noSlip; } }"),
        control(end, 0.01, maxCo=4, maxDeltaT=0.5))


def errors(run, case):
    number, _, end = STREAMS[run.variant]
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    table = foam.reference(root, "sphereDrag")      # noqa: F821
    clift, naumann = table[table[:, 0] == number][0, 1:]
    scale = 4 / (0.5 * np.pi / 4)           # a quarter of the sphere
    drag = scale * history.mean("sphere", "fluidForce", 0.9 * end)[0]
    before = scale * history.mean("sphere", "fluidForce", 0.8 * end, 0.9 * end)[0]
    return {"comparisons": [
        relative("drag coefficient", drag, clift, 0.02, source="Clift, Grace & Weber 1978"),
        relative("drag coefficient", drag, naumann, source="Schiller & Naumann"),
        small("change of drag in the last tenth of the run", drag / before - 1, 0.005)]}
