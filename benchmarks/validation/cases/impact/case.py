# SPDX-License-Identifier: GPL-3.0-or-later
"""Largest force of a log that strikes a pile under water, against spring, dashpot and added mass. N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.dashpot import dampingRatio, impactFactor
from support.files import around, blockMesh, bodies, control, even, field, fixed, merged, oneFluid

DENSITY, BODY, DIAMETER, PILE = 1000.0, 700.0, 1.0, 0.1     # liquid, log [kg/m3], diameters [m]
GAP, THROWN = 0.25, 1.0                                     # way to the pile [m], speed given [m/s]: the water takes its part of it at once
MASS, ADDED = (np.pi / 4 * DIAMETER**2 * rho for rho in (BODY, DENSITY))    # per metre of length; added mass of a circle, potential flow
LASTS = 0.05                                                # contact in water without dashpot [s]
STIFFNESS = (MASS + ADDED) * (np.pi / LASTS)**2

title = """A log of 1 m diameter and 700 kg/m3 is thrown across its axis at a pile of 0.1 m diameter, under water, 2D, slip walls, 20 x 20 m. The spring is so stiff that a contact of log and the water that
moves with it lasts 0.05 s. Exact (potential flow, the pile too thin to change it): largest force V sqrt(k (m + a)) phi, V the speed at the contact, a = rho pi D^2/4, phi of the dashpot's damping ratio
c/(2 sqrt(k (m + a))). `steps`: of the fluid within a contact; below some ten the water's part of the impact is spread over the step: the impulse stays, the peak comes down to that of the log alone."""

runs = [Run("flotsamFoam", n, f"restitution {e}, {steps:g} steps", {"e": e, "steps": steps}, quick=n == 8 and steps == 10 and e == 1)
        for n in (8, 16) for e in (1.0, 0.5) for steps in (40, 20, 10, 4, 1, 0.5)]


def resolution(run):
    return f"{run.n} a diameter"


def _step(run):
    return LASTS / run.options["steps"]


def files(run, _folder):
    h, growth = DIAMETER / run.n, 1 + 1.2 / run.n
    x, y = around(-10, -1, 1, 10, h, growth), around(-10, -0.8, 0.8, 10, h, growth)
    start, pile = -0.5 * DIAMETER - 0.5 * PILE - GAP, 0.003 * DIAMETER
    return merged(
        blockMesh(x, y, even(0, 1, 1), {"ends": ("patch", "x- x+"), "sides": ("patch", "y- y+"), "frontAndBack": ("empty", "z- z+")}),
        field("U", {"ends": "zeroGradient", "sides": "slip", "frontAndBack": "empty"}),
        field("p", {"ends": fixed(0), "sides": "zeroGradient", "frontAndBack": "empty"}), oneFluid(1e-6, DENSITY),
        bodies(f"""contact {{ default {{ stiffness {STIFFNESS:.9g}; restitution {run.options['e']:g}; frictionAngle 0; }} }}
structures {{ pile {{ shape {{ type cylinder; end1 (0 {pile} -0.1); end2 (0 {pile} 1.1); radius {PILE / 2}; }} }} }}
bodies
{{
    log
    {{
        shape {{ type cylinder; end1 (0 0 0); end2 (0 0 1); radius {DIAMETER / 2}; }}
        density {BODY};
        position ({start} {pile} 0.5);
        velocity ({THROWN} 0 0);
    }}
}}"""),
        control(0.75, _step(run), adjust=False))


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    log, pile = history["log"], history["pile"]
    struck = np.flatnonzero(np.abs(pile.peakContactForce[:, 0]) > 0)
    speed = log.velocity[struck[0] - 1, 0]
    damping = dampingRatio(run.options["e"])                    # of the log alone
    alone = impactFactor(damping) * speed * np.sqrt(STIFFNESS * MASS)
    inWater = impactFactor(damping * np.sqrt(MASS / (MASS + ADDED))) * speed * np.sqrt(STIFFNESS * (MASS + ADDED))
    peak = np.abs(pile.peakContactForce[:, 0]).max()
    impulse = np.sum(pile.contactForce[:, 0] * history.run["dt"])
    after = log.velocity[struck[-1], 0]
    target = 0.05 if run.options["steps"] >= 10 else None     # else the contact is shorter than what the fluid's steps follow
    return {"comparisons": [relative("largest force on the pile", peak, inWater, target, "N", "exact"),
                            relative("the same, over that of a log without water", peak, alone, None, "N", "exact"),
                            relative("impulse", impulse, (MASS + ADDED) * (speed - after), target, "N s", "exact"),
                            relative("largest mean over a step", np.abs(pile.contactForce[:, 0]).max(), peak, None, "N", "ours"),
                            small("log and pile feel the opposite, difference over the force", np.abs(log.peakContactForce + pile.peakContactForce).max() / peak, 1e-9)]}
