# SPDX-License-Identifier: GPL-3.0-or-later
"""Lift and drag of what lies on the bed of a stream. N: elements over its height."""
from runner import foam
from runner.cases import Run
from support.compare import Comparison, relative, small
from support.files import around, blockMesh, bodies, control, even, field, fixed, gravity, merged, oneFluid

DENSITY, NU, G, SPEED, HEIGHT = 1000, 1e-6, 9.81, 0.3, 0.1
START, BEGIN, END = 0.1, 3.0, 6.0       # at rest until then, then the stream is let in within a second; means from, to [s]
FAR, WIDTH, DEPTH = 5, 8, 4             # way from the inlet (half of that to the outlet), width and depth of the channel [heights]
SCHMEECKLE = "Schmeeckle et al. 2007, cubes on a smooth bed"
BANDS = {"cube": (0.2, 0.6), "slab": (0.2, 0.6), "log": (0.6, 1.0), "joined cube": (0.6, 0.8)}     # of lift, of suction: see title

# length along and across the stream in heights; round: a cylinder across
SHAPES = {"cube": (1, 1, False), "slab": (2, 2, False), "log": (1, 4, True), "bar 2D": (1, 0, False), "log 2D": (1, 0, True), "joined cube": (1, 1, False)}

title = f"""A body of {HEIGHT:g} m height held on the slip bed of a channel, {WIDTH} heights wide (log: {2 * WIDTH}), {DEPTH} deep (2D: 10), slip sides and lid, one fluid, rho {DENSITY}, nu {NU:g}, {SPEED:g} m/s all over the depth: a cube, a slab of 2 x 2 heights and a round log of 4
heights across the stream in 3D, a square and a round bar in 2D. "joined cube" is a structure, which is joined to the bed: there is no pressure under it, its vertical force (less the weight of the water that it displaces) is the suction on its top.
Coefficients of 1/2 rho U^2: drag of the area across the stream, lift (force of the water less that at rest) of the area seen from above; means from {BEGIN:g} to {END:g} s. Published drag of cubes: Schmeeckle, Nelson & Shreve 2007
(doi 10.1029/2006JF000536, abstract), 1.36. Bands of the lift are what handbooks and reviews give, as recalled, not read: blocks 0.2 to 0.6, pipes and logs 0.6 to 1.0; suction on a cube's top in a uniform stream (Castro & Robins 1977) 0.6 to 0.8.
No published figure for 2D: there is no such stream, water goes around what is real."""

runs = [*(Run("flotsamFoam", n, shape, quick=(n == 4 and shape == "cube"), timeLimit=3600) for shape in ("cube", "joined cube") for n in (4, 6, 8)),
        *(Run("flotsamFoam", n, shape, timeLimit=3600) for shape in ("slab", "log") for n in (4, 6)),
        *(Run("flotsamFoam", n, shape) for shape in ("bar 2D", "log 2D") for n in (4, 8, 16))]


def resolution(run):
    return f"{run.variant}, {run.n} over the height"


def _isPlane(run):
    return run.variant.endswith("2D")


def _body(run, step):
    along, across, isRound = SHAPES[run.variant]
    width = step if _isPlane(run) else across * HEIGHT
    centre = f"(0 {step / 2 if _isPlane(run) else 0:.9g} {HEIGHT / 2:g})"
    shape = (f"shape {{ type cylinder; end1 (0 {-width / 2:.9g} 0); end2 (0 {width / 2:.9g} 0); radius {HEIGHT / 2:g}; }}" if isRound
             else f"shape {{ type box; size ({along * HEIGHT:g} {width:.9g} {HEIGHT:g}); }}")
    if run.variant == "joined cube":
        return f"structures {{ body {{ {shape} position {centre}; wall noSlip; }} }}"
    return f"wallPatches (bed); bodies {{ body {{ {shape} position {centre}; density 1200; releaseTime 1000; }} }}"


def files(run, _folder):
    along, across, _isRound = SHAPES[run.variant]
    step, size = HEIGHT / run.n, HEIGHT
    x = around(-FAR * size, -(1 + along / 2) * size, (1.5 + along / 2) * size, 2 * FAR * size, step, 1.2)
    z = around(0, 0, 1.5 * size, (10 if _isPlane(run) else DEPTH) * size, step, 1.2)
    beside = WIDTH / 2 * size * (2 if across > 2 else 1)
    y = even(0, step, 1) if _isPlane(run) else around(-beside, -(0.5 + across / 2) * size, (0.5 + across / 2) * size, beside, step, 1.2)
    sides = "frontAndBack" if _isPlane(run) else "sides"
    flow = {sides: "empty" if _isPlane(run) else "slip"}
    pressure = {sides: "empty" if _isPlane(run) else "zeroGradient"}
    inlet = f"type uniformFixedValue; uniformValue table ((0 (0 0 0)) ({START} (0 0 0)) ({START + 1} ({SPEED} 0 0)) (1000 ({SPEED} 0 0)));"
    return merged(
        blockMesh(x, y, z, {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "bed": ("wall", "z-"), "lid": ("patch", "z+"), sides: ("empty" if _isPlane(run) else "patch", "y- y+")}),
        field("U", {"inlet": inlet, "outlet": "zeroGradient", "bed": "slip", "lid": "slip", **flow}),
        field("p_rgh", {"inlet": "zeroGradient", "outlet": fixed(0), "bed": "zeroGradient", "lid": "zeroGradient", **pressure}),
        oneFluid(NU, DENSITY), gravity(z=-G), bodies(_body(run, step)), control(END, 0.02, maxDeltaT=0.05))


def _lift(run, value):
    quantity = "suction on the top" if run.variant == "joined cube" else "lift coefficient"
    if _isPlane(run):
        return small(quantity, value)
    low, high = BANDS[run.variant]
    beyond = max(low - value, value - high, 0.0)
    return Comparison(quantity, value, (low + high) / 2, beyond, 0.0, "", "", f"{low:g} to {high:g}, recalled; error: distance from these")


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    along, across, _isRound = SHAPES[run.variant]
    width = HEIGHT / run.n if _isPlane(run) else across * HEIGHT
    scale = DENSITY / 2 * SPEED**2 * HEIGHT * width
    force = history.mean("body", "fluidForce", BEGIN, END)
    atRest = history["body"].fluidForce[(history.time > 0) & (history.time < START), 2].mean()
    drag, lift = force[0] / scale, (force[2] - atRest) / (scale * along)
    swing = history["body"].fluidForce[history.time > BEGIN, 2] / (scale * along)
    isCube = run.variant in ("cube", "joined cube")
    return {"comparisons": [
        relative("drag coefficient", drag, 1.36, target=0.1, source=SCHMEECKLE) if isCube else small("drag coefficient", drag),
        _lift(run, lift), small("standard deviation of the lift coefficient", swing.std())]}
