# SPDX-License-Identifier: GPL-3.0-or-later
"""Creeping flow across a square array of cylinders, exact solution: what gaps that few elements resolve make of the resistance. N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import blockMesh, bodies, control, even, field, fixed, merged, oneFluid

EXACT = {0.2: 51.53, 0.3: 102.88, 0.5: 532.55}          # force a length over mu U, by the share of the solid
DIAMETER, COUNT, DENSITY, NU, SPEED = 1.0, 5, 1000, 1e-2, 1e-3      # Reynolds number 0.1
AHEAD = 2                                               # pitches before the first cylinder and behind the last
LAYERS = 3                                              # of elements along the cylinders in 3D
STEP, END = 20, 100                                     # [s]; viscosity needs 1 s over a pitch
STAGGERED = {"share": 0.4, "count": 7, "Re": 100, "force": 662.1, "end": 18}     # force: own, 48 elements a diameter; end: in diameters over U

title = """Row of five no-slip cylinders along a channel whose slip walls are the planes of symmetry of a square array, one fluid, Re 0.1: the middle one feels what one of an endless array does. Shares of the solid of 0.2, 0.3
and 0.5: gaps of 0.98, 0.62 and 0.25 diameters; elements divide the pitch, so that N is met to 1/8 or less. Exact: force a length over mu U, U the superficial velocity, of Sangani & Acrivos 1982 (doi 10.1016/0301-9322(82)90029-5), from memory; on 16 elements
ours is within 0.3 % of each. 3D: the same, three layers of elements along the axes. Staggered: seven rows, every other one half a pitch aside, Re 100; mean of the three in the middle beside our own on 48 elements a diameter."""

runs = [Run("flotsamFoam", n, f"solid {share}{dim}", {"share": share, "is3D": bool(dim)}, quick=n == 8 and not dim)
        for share in EXACT for dim in ("", ", 3D") for n in (2, 3, 4, 6, *(() if dim else (8, 16))) if (n, share) != (2, 0.5)]
runs += [Run("flotsamFoam", n, "staggered", {"share": STAGGERED["share"], "is3D": False}) for n in (3, 4, 6, 8, 16)]


def _pitch(run):
    return DIAMETER * np.sqrt(np.pi / (4 * run.options["share"]))


def _across(run):
    return round(_pitch(run) * run.n / DIAMETER)


def _isStaggered(run):
    return run.variant == "staggered"


def _places(run):
    """Axes of the cylinders of each row, across the stream in pitches."""
    return [[-0.5, 0.5] if i % 2 else [0] for i in range(STAGGERED["count"])] if _isStaggered(run) else [[0]] * COUNT


def resolution(run):
    step = _pitch(run) / _across(run)
    return f"{run.variant}, {DIAMETER / step:.2f} a diameter, {(_pitch(run) - DIAMETER) / step:.2f} in a gap"


def files(run, _folder):
    pitch, is3D = _pitch(run), run.options["is3D"]
    step = pitch / _across(run)
    layers = LAYERS if is3D else 1
    length, offset = layers * step, 0.03 * step     # off the mesh's lines
    ends, slip, flat = ("patch", "slip", "zeroGradient") if is3D else ("empty", "empty", "empty")
    places = _places(run)
    count = len(places)
    row = "\n".join(f"cylinder{i}_{k} {{ shape {{ type cylinder; end1 ({(i + 0.5) * pitch + offset:.9g} {y * pitch:.9g} {-step:.9g}); end2 ({(i + 0.5) * pitch + offset:.9g} {y * pitch:.9g} {length + step:.9g}); radius {DIAMETER / 2}; }} wall noSlip; }}"
                    for i, ys in enumerate(places) for k, y in enumerate(ys))
    nu, inlet, times = NU, fixed(f"({SPEED} 0 0)"), control(END, STEP, adjust=False)
    if _isStaggered(run):
        unit = DIAMETER / SPEED
        nu = SPEED * DIAMETER / STAGGERED["Re"]
        inlet = f"type uniformFixedValue; uniformValue table ((0 (0 0 0)) ({unit:g} ({SPEED} 0 0)) ({100 * unit:g} ({SPEED} 0 0)));"
        times = control(STAGGERED["end"] * unit, 1e-3 * unit, maxDeltaT=0.2 * unit, maxCo=2)
    return merged(
        blockMesh(even(-AHEAD * pitch, (AHEAD + count) * pitch, (2 * AHEAD + count) * _across(run)), even(-pitch / 2, pitch / 2, _across(run)), even(0, length, layers),
                  {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("patch", "y- y+"), "ends": (ends, "z- z+")}),
        field("U", {"inlet": inlet, "outlet": "zeroGradient", "sides": "slip", "ends": slip}),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient", "ends": flat}),
        oneFluid(nu, DENSITY), bodies(f"structures\n{{\n{row}\n}}"), times)


def _staggeredForce(history, length):
    """Of a row, mean of the three in the middle and over the last third of the time."""
    middle = STAGGERED["count"] // 2
    names = [name for name in history.structures if abs(int(name[len("cylinder"):].split("_")[0]) - middle) <= 1]
    isLate = history.time > 0.7 * history.time[-1]
    steps = history.run["dt"][isLate]
    force = sum(history[name].fluidForce[isLate, 0] for name in names)
    return (force * steps).sum() / steps.sum() / 3 * STAGGERED["Re"] / (length * DENSITY * SPEED**2 * DIAMETER)


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    length = (LAYERS if run.options["is3D"] else 1) * _pitch(run) / _across(run)
    if _isStaggered(run):
        return {"comparisons": [relative("force a length over mu U", _staggeredForce(history, length), STAGGERED["force"], target=0.1, source="own, 48 a diameter")]}
    force = history[f"cylinder{COUNT // 2}_0"].fluidForce[:, 0] / (length * DENSITY * NU * SPEED)
    return {"comparisons": [relative("force a length over mu U", force[-1], EXACT[run.options["share"]], target=0.1, source="Sangani & Acrivos 1982"),
                            small("change in the last step, of the force", force[-1] / force[-2] - 1, 0.005)]}
