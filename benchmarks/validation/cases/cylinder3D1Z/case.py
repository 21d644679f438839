# SPDX-License-Identifier: GPL-3.0-or-later
"""Schaefer & Turek 3D-1Z: steady flow past a cylinder between the walls of a square duct, Re = 20. N: elements a diameter."""
from runner import foam
from runner.cases import Run
from support.compare import absolute, relative, small
from support.files import around, blockMesh, bodies, control, even, field, fixed, merged, oneFluid, parabola

SOURCE = "featflow.de, DFG 3D-1Z"
END = 4.0
SCALE = 2 / (0.2**2 * 0.1 * 0.41)

title = """Steady flow past a cylinder that spans a square duct, Re = 20 (Schaefer & Turek 1996, case 3D-1Z), cut out of a mesh with N elements a diameter
in 0.4 < x < 0.6, 0.1 < y < 0.3 (m) and 1.6 N over the duct's depth, wider elsewhere. Run to t = 4 s at maxCo 4 (a steady flow needs no more)."""

runs = [Run("flotsamFoam", n, quick=n == 8, timeLimit=3600) for n in (8, 12, 16, 20)]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    h, growth = 0.1 / run.n, 1 + 2 / run.n
    x = around(0, 0.4, 0.6, 2.5, h, growth)
    y = around(0, 0.1, 0.3, 0.41, h, growth)
    return merged(
        blockMesh(x, y, even(0, 0.41, round(1.6 * run.n)), {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "walls": ("wall", "y- y+ z- z+")}),
        field("U", {"inlet": fixed("(0.2 0 0)"), "outlet": "zeroGradient", "walls": "noSlip"}, "(0.2 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "walls": "zeroGradient"}),
        # 16 U y z (H - y)(H - z)/H^4 with U = 0.45 m/s
        parabola("vector(7.2*pos().y()*pos().z()*(0.41 - pos().y())*(0.41 - pos().z())/sqr(sqr(0.41)), 0, 0)"), oneFluid(0.001, 1),
        bodies("structures { cylinder { shape { type cylinder; end1 (0.5 0.2 -0.1); end2 (0.5 0.2 0.51); radius 0.05; } wall noSlip; } }"),
        control(END, 1e-3, maxCo=4, maxDeltaT=0.1))


def prepare(_run, do):
    do("blockMesh")
    do("setExprBoundaryFields")


def errors(_run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    drag, lift = SCALE * history.mean("cylinder", "fluidForce", END - 0.5)[:2]
    before = SCALE * history.mean("cylinder", "fluidForce", END - 1, END - 0.5)[0]
    return {"comparisons": [
        relative("drag coefficient", drag, 6.18533, 0.01, source=SOURCE),
        absolute("lift coefficient", lift, 0.009401, source=SOURCE),
        small("change of drag in the last half second", drag / before - 1, 1e-3)]}
