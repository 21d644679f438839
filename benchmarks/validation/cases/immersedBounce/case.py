# SPDX-License-Identifier: GPL-3.0-or-later
"""Steel spheres that bounce on a wall in a viscous liquid, experiments of Gondret et al. 2002. N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, field, gravity, merged, oneFluid

SOURCE = "Gondret et al. 2002, experiment"
SOLID, RATIO, RESTITUTION = 7800.0, 8.083, 0.97     # density of the sphere [kg/m3], over that of the liquid; without liquid
#        diameter [m], kinematic viscosity, speed that the sphere is thrown with [m/s], gap there [diameters], end [s]
CASES = {"St 152": (0.003, 1.07e-5, 0.64, 4.0, 0.165), "St 27": (0.006, 1.036e-4, 0.56, 4.0, 0.085)}

title = """A steel sphere falls on a wall in silicone oil and bounces (Gondret et al. 2002), Stokes numbers rho_p u D/(9 mu) of 152 and 27, restitution without liquid 0.97. It is thrown six and four diameters
above the wall with the experiment's speed there (the water around it takes its part at once and is given on top); box of 6.6 diameters. What the film between sphere and wall takes is not modelled:
the mesh resolves it down to an element. Time counts from the first contact."""

runs = [Run("flotsamFoam", n, name, {}, quick=n == 8 and name == "St 27", timeLimit=5400) for n in (8, 12, 16) for name in CASES]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    diameter, nu, speed, gap, end = CASES[run.variant]
    h = diameter / run.n
    side = around(-5 * diameter, -0.75 * diameter, 0.75 * diameter, 5 * diameter, h, 1.2)
    height = around(0, 0, (gap + 1.5) * diameter, (gap + 5) * diameter, h, 1.2)
    thrown = speed * (1 + 0.5 / RATIO)      # with the added mass of a sphere, half of what it displaces
    return merged(
        blockMesh(side, side, height, {"walls": ("wall", "x- x+ y- y+ z-"), "top": ("patch", "z+")}),
        field("U", {"walls": "noSlip", "top": "type pressureInletOutletVelocity; value uniform (0 0 0);"}),
        field("p_rgh", {"walls": "type fixedFluxPressure; value uniform 0;", "top": "type totalPressure; p0 uniform 0; value uniform 0;"}),
        oneFluid(nu, SOLID / RATIO), gravity(z=-9.81),
        bodies(f"""contact {{ default {{ restitution {RESTITUTION}; }} }}
bodies
{{
    sphere
    {{
        shape {{ type sphere; radius {diameter / 2}; }}
        density {SOLID};
        position (0 0 {(gap + 0.5) * diameter});
        velocity (0 0 {-thrown});
    }}
}}"""),
        control(gap * diameter / speed + end, 1e-5, maxDeltaT=5e-4))


def parameters(_run):
    return {}


def prepare(_run, do):
    do("blockMesh")


def _landings(history):
    """First steps in contact."""
    touches = np.linalg.norm(history["sphere"].contactForce, axis=1) > 0
    return np.flatnonzero(touches[1:] & ~touches[:-1]) + 1


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    diameter, _, speed, _, _ = CASES[run.variant]
    sphere, landings = history["sphere"], _landings(history)
    gap, z = sphere.position[:, 2] - 0.5 * diameter, sphere.velocity[:, 2]
    first = landings[0]
    t, measured = foam.reference(root, "gondretSt" + run.variant.split()[1]).T      # noqa: F821
    after = t > 0
    second = landings[landings > first + 5][0]
    found = [relative("speed before the wall", -z[first - 1], speed, 0.03, "m/s", SOURCE),
             relative("height of the first bounce", gap[first:second].max(), measured[after & (t < 0.08)].max(), 0.1, "m", SOURCE),
             relative("its duration", history.time[second] - history.time[first], {"St 152": 0.0832, "St 27": 0.0425}[run.variant], 0.1, "s", SOURCE)]
    if run.variant == "St 152":
        third = landings[landings > second + 5][0]
        found.append(relative("height of the second bounce", gap[second:third].max(), measured[t > 0.085].max(), 0.1, "m", SOURCE))
    computed = np.interp(t[after], history.time - history.time[first], gap)
    found.append(small("gap after the contact, rms over the diameter", float(np.sqrt(np.mean((computed - measured[after])**2))) / diameter, None, source=SOURCE))
    found.append(small("sideways drift over the diameter", np.abs(sphere.position[:, :2]).max() / diameter, 0.05, source="symmetry"))
    return {"comparisons": found}
