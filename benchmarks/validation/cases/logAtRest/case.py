# SPDX-License-Identifier: GPL-3.0-or-later
"""A log afloat in still water stays where it is. N: elements over its diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import small
from support.files import blockMesh, bodies, control, even, field, gravity, level, merged, twoFluids

DIAMETER, LENGTH, END, SETTLED = 0.06, 0.24, 10.0, 5.0
PLACE = 0.0073      # [m] beside the tank's middle, where the diagonals are symmetric

title = """A round log of 0.06 m, half as heavy as water, released half immersed in a still tank of 0.6 m x 0.4 m (3D: 0.4 m wide, the log 0.24 m long), slip walls, for 10 s."""

runs = [Run("flotsamFoam", n, "2D", quick=(n == 3)) for n in (2, 3, 4, 6)] + [Run("flotsamFoam", n, "3D", timeLimit=1200) for n in (2, 3)]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    h = DIAMETER / run.n
    width = 0.4 if run.variant == "3D" else h
    length = LENGTH if run.variant == "3D" else width
    sides = "zeroGradient" if run.variant == "3D" else "empty"
    return merged(
        blockMesh(even(-0.3, 0.3, round(0.6 / h)), even(0, width, max(1, round(width / h))), even(-0.2, 0.2, round(0.4 / h)),
                  {"walls": ("wall", "x- x+ z-"), "atmosphere": ("patch", "z+"), "sides": ("wall" if run.variant == "3D" else "empty", "y- y+")}),
        field("U", {"walls": "slip", "atmosphere": "type pressureInletOutletVelocity; value uniform (0 0 0);", "sides": "slip" if run.variant == "3D" else "empty"}),
        field("p_rgh", {"walls": "type fixedFluxPressure; value uniform 0;", "atmosphere": "type totalPressure; p0 uniform 0;", "sides": sides}),
        field("alpha.water", {"walls": "zeroGradient", "atmosphere": "type inletOutlet; inletValue uniform 0; value uniform 0;", "sides": sides}),
        level("(0 0 1)"),
        twoFluids(), gravity(z=-9.81),
        bodies(f"""bodies
{{
    log
    {{
        shape    {{ type cylinder; end1 (0 {-length / 2:.9g} 0); end2 (0 {length / 2:.9g} 0); radius {DIAMETER / 2}; }}
        density  500;
        position ({-0.1 + PLACE} {width / 2:.9g} 0);
    }}
}}"""),
        control(END, 0.002, maxCo=1, maxDeltaT=0.0125))


def parameters(_run):
    return {}


def prepare(_run, do):
    do("blockMesh")
    do("setAlphaField")


def errors(_run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    log, late = history["log"], history.time >= SETTLED
    along = log.position[:, :2] - log.position[0, :2]
    return {"comparisons": [
        small("way along the water", np.linalg.norm(along, axis=1).max() / DIAMETER, 0.01, "diameters", "at rest"),
        small("its speed after 5 s", np.linalg.norm(log.velocity[late, :2], axis=1).max(), 1e-4, "m/s", "at rest"),
        small("its rotation after 5 s", np.linalg.norm(log.angularVelocity[late], axis=1).max(), 0.01, "rad/s", "at rest")]}
