# SPDX-License-Identifier: GPL-3.0-or-later
"""The momentum theorem along a straight channel: what must hold its structures, from the fields at two sections and between them.

Pressure and momentum flux through the sections, weight of water and bodies along the bed, rate of change of the momentum
between them, and what bed and sides hold of the bodies (friction), all as they are in the run: steady flow is not assumed.
"""
from dataclasses import dataclass

import flotsam
import numpy as np

GRAVITY = 9.81


@dataclass
class Reach:
    """A channel of rectangular section, x along its bed, z normal to it from 0 to `height`, y from -width/2 to width/2 [m]."""
    begin: float        # sections upstream and downstream of the structures [m]
    end: float
    width: float
    height: float
    slope: float = 0.0
    lines: int = 28     # samples across a section


def _throughSection(case, time, x, reach):
    """Pressure force + momentum flux through a section [N]."""
    ny, nz = reach.lines, 80
    y = reach.width * ((np.arange(ny) + 0.5) / ny - 0.5)
    z = reach.height * (np.arange(nz) + 0.5) / nz
    points = [(x, a, b) for a in y for b in z]
    f = flotsam.sample(case, time, points, [flotsam.ALPHA, "U", "p"])
    density = 1 + 999 * np.clip(f[flotsam.ALPHA], 0, 1)
    return (f["p"] + density * f["U"][:, 0]**2).mean() * reach.width * reach.height


def _between(case, time, reach):
    """Mass [kg] and momentum along the channel [kg m/s] of the water between the sections."""
    f = flotsam.fields(case, time, [flotsam.ALPHA, "U", "solid"])
    chosen = (f["centre"][:, 0] > reach.begin) & (f["centre"][:, 0] < reach.end)
    mass = 1000 * (f["volume"] * (1 - f["solid"]) * f[flotsam.ALPHA])[chosen]
    return mass.sum(), mass @ f["U"][chosen, 0]


def wallForce(h, reach):
    """Force of bed and sides between the sections on the bodies there, along the channel over time [N]: what the structures do not hold of them.
    Bodies beyond the sections are left out: what they touch there holds nothing of this reach."""
    force = flotsam.sumForce(h, ["structures/" + n for n in h.structures], "contactForce")[:, 0]
    for name in h.bodies:
        body = h["bodies/" + name]
        x = body.position[:, 0]
        inside = h.isThere("bodies/" + name) & (x > reach.begin) & (x < reach.end)
        force = force + np.where(inside, body.contactForce[:, 0], 0.0)
    return force


def gainOfBodies(h, reach, start, end):
    """Momentum along the channel that the bodies gain between the sections from `start` to `end` [kg m/s]."""
    gain = 0.0
    for name in h.bodies:
        body = h["bodies/" + name]
        x = body.position[:, 0]
        inside = np.flatnonzero(h.isThere("bodies/" + name) & (h.time >= start) & (h.time <= end) & (x > reach.begin) & (x < reach.end))
        if len(inside):
            gain += body.mass * (body.velocity[inside[-1], 0] - body.velocity[inside[0], 0])
    return gain


def forceOnStructures(case, h, reach, times):
    """Mean force of water and bodies on the structures between the sections from the momentum between the first and the last of `times`, of
    bodies at rest (gainOfBodies has what others gain), and what enters through the upstream section (pressure and momentum flux): the largest
    of the terms whose difference the force is [N]."""
    up, down = ([_throughSection(case, t, x, reach) for t in times] for x in (reach.begin, reach.end))
    mass, momentum = np.array([_between(case, t, reach) for t in times]).T
    downSlope = GRAVITY * np.sin(np.arctan(reach.slope))
    bodies = sum(h["bodies/" + n].mass for n in h.bodies if h.isThere("bodies/" + n)[-1] and reach.begin < h["bodies/" + n].position[-1, 0] < reach.end)
    chosen = (h.time > times[0]) & (h.time <= times[-1] + 1e-9)
    held = wallForce(h, reach)[chosen].mean() if h.bodies else 0.0
    change = (momentum[-1] - momentum[0]) / (times[-1] - times[0])
    trapezoids = np.convolve(np.diff(times), [0.5, 0.5]) / (times[-1] - times[0])
    return (np.subtract(up, down) + mass * downSlope) @ trapezoids + bodies * downSlope + held - change, trapezoids @ up
