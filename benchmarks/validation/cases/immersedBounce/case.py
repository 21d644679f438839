# SPDX-License-Identifier: GPL-3.0-or-later
"""Steel spheres that bounce on a wall in a viscous liquid, experiments of Gondret et al. 2002. N: elements a diameter."""
from dataclasses import dataclass

import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, field, gravity, merged, oneFluid

SOURCE = "Gondret et al. 2002, experiment"
SOLID, RATIO, RESTITUTION = 7800.0, 8.083, 0.97     # density of the sphere [kg/m3], over that of the liquid; without liquid
GAP, FAR, NEAR = 4.0, 3.0, 0.3      # where the sphere is thrown; its speed is measured between these gaps [diameters]


@dataclass
class Bounce:
    """Speeds in m/s, heights (of the gap under the sphere) in m, times in s. Measured figures: the paper's paths of the sphere, from digitised points that others have published."""
    diameter: float     # [m]
    nu: float           # [m2/s]
    thrown: float       # so that it comes to the wall as fast as in the experiment
    speed: float        # measured before the wall
    heights: tuple      # measured, of the first bounces
    lasts: float        # the first bounce, measured
    end: float          # of the run after the contact


CASES = {"St 152": Bounce(0.003, 1.07e-5, 0.64, 0.586, (7.47e-3, 2.23e-3), 0.0832, 0.160), "St 27": Bounce(0.006, 1.036e-4, 0.60, 0.519, (1.97e-3,), 0.0425, 0.06)}

title = """A steel sphere falls on a wall in silicone oil and bounces (Gondret et al. 2002), Stokes numbers rho_p u D/(9 mu) of 152 and 27, restitution without liquid 0.97. It is thrown four diameters
above the wall (the liquid around it takes its part at once and is given on top) so that it comes to the wall as fast as the experiment's; box of 10 diameters. What the film between sphere and wall takes is not modelled:
the mesh resolves it down to an element."""

runs = [Run("flotsamFoam", n, name, {}, quick=n == 8 and name == "St 27", timeLimit=5400) for n in (8, 12) for name in CASES]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    c = CASES[run.variant]
    diameter = c.diameter
    h = diameter / run.n
    side = around(-5 * diameter, -0.75 * diameter, 0.75 * diameter, 5 * diameter, h, 1.2)
    height = around(0, 0, (GAP + 1.5) * diameter, (GAP + 5) * diameter, h, 1.2)
    thrown = c.thrown * (1 + 0.5 / RATIO)      # with the added mass of a sphere, half of what it displaces
    return merged(
        blockMesh(side, side, height, {"walls": ("wall", "x- x+ y- y+ z-"), "top": ("patch", "z+")}),
        field("U", {"walls": "noSlip", "top": "type pressureInletOutletVelocity; value uniform (0 0 0);"}),
        field("p_rgh", {"walls": "type fixedFluxPressure; value uniform 0;", "top": "type totalPressure; p0 uniform 0; value uniform 0;"}),
        oneFluid(c.nu, SOLID / RATIO), gravity(z=-9.81),
        bodies(f"""contact {{ default {{ restitution {RESTITUTION}; }} }}
bodies
{{
    sphere
    {{
        shape {{ type sphere; radius {diameter / 2}; }}
        density {SOLID};
        position (0 0 {(GAP + 0.5) * diameter});
        velocity (0 0 {-thrown});
    }}
}}"""),
        control(GAP * diameter / c.speed + c.end, 1e-5, maxDeltaT=5e-4))


def _landings(history):
    """First steps of the contacts."""
    touches = np.linalg.norm(history["sphere"].contactForce, axis=1) > 0
    return np.flatnonzero(touches[1:] & ~touches[:-1]) + 1


def _meanSpeed(history, gap, diameter):
    """Before the first contact, as measured: between two gaps [m/s]."""
    far, near = np.interp([-FAR * diameter, -NEAR * diameter], -gap, history.time[:len(gap)])
    return (FAR - NEAR) * diameter / (near - far)


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    c = CASES[run.variant]
    sphere, landings = history["sphere"], _landings(history)
    gap = sphere.position[:, 2] - 0.5 * c.diameter
    first, second = landings[0], landings[1]
    found = [relative("speed before the wall", _meanSpeed(history, gap[:first], c.diameter), c.speed, 0.02, "m/s", SOURCE),
             relative("height of the first bounce", gap[first:second].max(), c.heights[0], 0.1, "m", SOURCE),
             relative("its duration", history.time[second] - history.time[first], c.lasts, 0.1, "s", SOURCE)]
    if len(c.heights) > 1:
        found.append(relative("height of the second bounce", gap[second:landings[2]].max(), c.heights[1], 0.1, "m", SOURCE))
    found.append(small("sideways drift over the diameter", np.abs(sphere.position[:, :2]).max() / c.diameter, 0.05, source="symmetry"))
    return {"comparisons": found}
