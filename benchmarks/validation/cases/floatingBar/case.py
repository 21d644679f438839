# SPDX-License-Identifier: GPL-3.0-or-later
"""Draft and attitude of floating bars of several sections and densities. N: elements over the shorter side."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import floating
from support.compare import absolute, relative, small
from support.files import around, blockMesh, bodies, control, even, gravity, level, merged, openTank, stlBox, twoFluids

SIDE, END, LAST = 0.02, 5.0, 0.5
#            width [m], relative density, turn at the start [degrees]
SECTIONS = {"square 0.59": (0.02, 0.59, 35), "square 0.85": (0.02, 0.85, 25), "square 0.25": (0.02, 0.25, 10), "square 0.15": (0.02, 0.15, 25),
            "plank 2:1 0.59": (0.04, 0.59, 25)}
FROM_STL = {"square 0.85, STL": "square 0.85"}     # the same bar as a triangulated surface
OF_PARTS = {"square 0.85, union": "square 0.85"}   # as two lapped boxes

title = """Bars with a square section of 0.02 m and a plank of 0.04 m x 0.02 m, 2D, named with the relative density, released turned in a liquid of water's density and a thousand times its
viscosity, at rest after 5 s. Theory: the attitude of least potential energy that the turn at the start leads to, at which the displaced liquid weighs as much as the bar: a square floats on
a flat side for s < 0.211 and s > 0.789, corner down for 0.281 < s < 0.719 and askew between (E. N. Gilbert, Am. Math. Monthly 98 (1991) 201). N elements over 0.02 m. "STL": the bar is read from
an STL file; "union": it is one of two boxes that lap."""

runs = [Run("flotsamFoam", n, name, quick=(n == 6 and name == "square 0.59"), timeLimit=2400) for n in (6, 10) for name in [*SECTIONS, *FROM_STL, *OF_PARTS]]


def resolution(run):
    return f"{run.n} over 0.02 m"


def section(run):
    return SECTIONS[{**FROM_STL, **OF_PARTS}.get(run.variant, run.variant)]


def shape(run, width):
    if run.variant in FROM_STL:
        return {"constant/triSurface/bar.stl": stlBox((width, SIDE, 0.05))}, 'type stl; file "bar.stl";'
    if run.variant in OF_PARTS:
        part = "{{ type box; centre ({0:g} 0 0); size ({1:g} {2:g} 0.05); }}"
        return {}, f"type union; parts {{ left {part.format(-0.2 * width, 0.6 * width, SIDE)} right {part.format(0.15 * width, 0.7 * width, SIDE)} }}"
    return {}, f"type box; size ({width:g} {SIDE:g} 0.05);"


def files(run, _folder):
    width, density, turn = section(run)
    shapeFiles, shapeEntries = shape(run, width)
    h = SIDE / run.n
    x = around(-0.2, -0.04, 0.04, 0.2, h, 1.04)
    y = around(-0.1, -0.03, 0.03, 0.06, h, 1.2)
    depth = floating.equilibrium(width, SIDE, density, np.radians(turn))[1]
    return merged(
        shapeFiles,
        blockMesh(x, y, even(0, 0.05, 1), {"walls": ("wall", "x- x+ y-"), "atmosphere": ("patch", "y+"), "frontAndBack": ("empty", "z- z+")}),
        openTank("noSlip", empty=["frontAndBack"]),
        level("(0 1 0)"),
        twoFluids(nuWater=1e-3), gravity(y=-9.81),
        bodies(f"""bodies
{{
    bar
    {{
        shape       {{ {shapeEntries} }}
        density     {1000 * density:g};
        position    (0 {0.002 - depth:.6g} 0.025);
        orientation {{ axis (0 0 1); angleDeg {turn:g}; }}
    }}
}}"""),
        control(END, 0.001, maxDeltaT=0.005, writeInterval=0.1))


def prepare(_run, do):
    do("blockMesh")
    do("setAlphaField")


def errors(run, case):
    width, density, turn = section(run)
    history, flotsam = foam.history(root, case), foam.resultReader(root)        # noqa: F821 (root is set by the runner)
    angle, depth = floating.equilibrium(width, SIDE, density, np.radians(turn))
    q, centre = (history.mean("bar", name, END - LAST) for name in ("orientation", "position"))
    found = 2 * np.arctan2(q[3], q[0])
    level = np.mean([flotsam.waterLevel(case, t, [-0.15, 0.15], up=1) for t in flotsam.times(case) if t >= END - LAST])
    draft = level - centre[1] + floating.lowest(width, SIDE, found)
    late = history.time >= END - LAST
    return {"comparisons": [
        absolute("turn", np.degrees(found), np.degrees(angle), 2, "degrees", "least potential energy"),
        relative("draft of the lowest point", draft, depth + floating.lowest(width, SIDE, angle), 0.02, "m", "Archimedes", scale=SIDE),
        relative("upward force of the fluid", history.mean("bar", "fluidForce", END - LAST)[1], 9.81 * history["bar"].mass, 0.01, "N", "weight"),
        small("heave in the last half second", np.ptp(history["bar"].position[late, 1]) / SIDE, 0.01, "sides", "at rest"),
        small("turning in the last half second", np.degrees(np.ptp(2 * np.arctan2(history["bar"].orientation[late, 3], history["bar"].orientation[late, 0]))), 1,
              "degrees", "at rest")]}
