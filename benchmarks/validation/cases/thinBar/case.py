# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag of a bar about as thin as an element, wherever it lies in the mesh. N: tenths of an element over its diameter."""
from runner import foam
from runner.cases import Run
from support.compare import Comparison, relative, small
from support.files import blockMesh, bodies, control, even, field, fixed, merged, oneFluid

DENSITY, NU, SPEED = 1000, 1e-6, 1.0
ELEMENT, LENGTH, HEIGHT, END, BEGIN = 0.1, 8.0, 4.0, 10.0, 5.0
REAL, FACTOR = (1.0, 1.2), 2.5      # drag coefficients of round bars in streams; what a coarse mesh may make of them
PLACES = {"": (0.3, 0.2), "amid an element": (0.5, 0.5), "near a face": (0.7, 0.1)}      # of the axis from a node, in elements
SIZES = (3, 5, 7, 10, 14, 20, 30, 40)

title = f"""A round bar (a structure) across a stream of {SPEED:g} m/s, 2D, one fluid, rho {DENSITY}, nu {NU:g}, even square elements of {ELEMENT:g} m, {HEIGHT / ELEMENT:g} of them across the channel with slip walls; bar no-slip, in the variants slip: slip.
Up to 1.5 elements its surface is made of the plane faces of a hexagonal prism. Its axis lies 0.3 and 0.2 elements from a node, amid an element or (0.7, 0.1) near a face. Coefficient of 1/2 rho U^2 d, mean from {BEGIN:g} to {END:g} s. Reference: real bars
below the drag crisis, {REAL[0]:g} to {REAL[1]:g} (error: from the mean of both). Factor: how many times larger or smaller than the nearer of both; a bar that the stream does not know of has an infinite one."""

runs = [*(Run("flotsamFoam", n, place, quick=(n == 3 and place == "")) for place in PLACES for n in SIZES),
        *(Run("flotsamFoam", n, f"slip {place}".strip(), options={"wall": "slip"}) for place in ("", "amid an element") for n in SIZES[:6])]


def resolution(run):
    return f"{run.n / 10:g} elements a diameter"


def files(run, _folder):
    h, wall = ELEMENT, run.options.get("wall", "noSlip")
    x, z = (2 + part * h for part in PLACES[run.variant.removeprefix("slip").strip()])
    return merged(
        blockMesh(even(0, LENGTH, round(LENGTH / h)), even(0, h, 1), even(0, HEIGHT, round(HEIGHT / h)),
                  {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("wall", "z- z+"), "frontAndBack": ("empty", "y- y+")}),
        field("U", {"inlet": fixed(f"({SPEED:g} 0 0)"), "outlet": "zeroGradient", "sides": "slip", "frontAndBack": "empty"}, f"({SPEED:g} 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient", "frontAndBack": "empty"}), oneFluid(NU, DENSITY),
        bodies(f"structures {{ bar {{ shape {{ type cylinder; end1 ({x:.9g} 0 {z:.9g}); end2 ({x:.9g} {h:.9g} {z:.9g}); radius {run.n / 20 * h:.9g}; }} wall {wall}; }} }}"),
        control(END, 0.02))


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    scale = DENSITY / 2 * SPEED**2 * run.n / 10 * ELEMENT * ELEMENT
    drag = history.mean("bar", "fluidForce", BEGIN)[0] / scale
    swing = history["bar"].fluidForce[history.time > BEGIN, 0] / scale
    factor = max(drag / REAL[1], REAL[0] / drag) if drag > 0 else float("inf")
    return {"comparisons": [
        relative("drag coefficient", drag, sum(REAL) / 2, source="real bars, 1.0 to 1.2"),
        Comparison("factor between it and the real ones", max(factor, 1.0), target=FACTOR, errorUnit="", source="real bars, 1.0 to 1.2"),
        small("standard deviation of the drag coefficient", swing.std())]}
