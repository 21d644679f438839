# SPDX-License-Identifier: GPL-3.0-or-later
"""The momentum theorem along the flume: what must hold the pipes, from the fields at two sections and between them.

Pressure and momentum flux through the sections, weight of water and bars along the bed, rate of change of the momentum
between them, and what bed and sides hold of the bars (friction), all as they are in the run: steady flow is not assumed.
"""
import flotsam
import numpy as np

SECTIONS = -0.45, 0.15      # [m] upstream of the held bars, downstream of the pipes
GRAVITY = 9.81


def _throughSection(case, time, x, setup):
    """Pressure force + momentum flux through a section [N]."""
    ny, nz = 4 * int(setup["nPipes"]), 80
    y = setup["width"] * ((np.arange(ny) + 0.5) / ny - 0.5)
    z = setup["height"] * (np.arange(nz) + 0.5) / nz
    points = [(x, a, b) for a in y for b in z]
    f = flotsam.sample(case, time, points, [flotsam.ALPHA, "U", "p"])
    density = 1 + 999 * np.clip(f[flotsam.ALPHA], 0, 1)
    return (f["p"] + density * f["U"][:, 0]**2).mean() * setup["width"] * setup["height"]


def _between(case, time):
    """Mass [kg] and momentum along the flume [kg m/s] of the water between the sections."""
    f = flotsam.fields(case, time, [flotsam.ALPHA, "U", "solid"])
    chosen = (f["centre"][:, 0] > SECTIONS[0]) & (f["centre"][:, 0] < SECTIONS[1])
    mass = 1000 * (f["volume"] * (1 - f["solid"]) * f[flotsam.ALPHA])[chosen]
    return mass.sum(), mass @ f["U"][chosen, 0]


def wallForce(h):
    """Force of bed and sides on the bars along the flume over time [N]: what the pipes do not hold of them."""
    names = ["bodies/" + n for n in h.bodies] + ["structures/" + n for n in h.structures]
    return flotsam.sumForce(h, names, "contactForce")[:, 0]


def forceOnPipes(case, h, setup, times):
    """Mean force of water and bars on the pipes from the momentum between the first and the last of `times`, and what enters through the
    upstream section (pressure and momentum flux): the largest of the terms whose difference the force is [N]."""
    up, down = ([_throughSection(case, t, x, setup) for t in times] for x in SECTIONS)
    mass, momentum = np.array([_between(case, t) for t in times]).T
    downSlope = GRAVITY * np.sin(np.arctan(setup["slope"]))
    bars = sum(h["bodies/" + n].mass for n in h.bodies if SECTIONS[0] < h["bodies/" + n].position[-1, 0] < SECTIONS[1])
    chosen = h.time > times[0]
    held = wallForce(h)[chosen].mean() if h.bodies else 0.0
    change = (momentum[-1] - momentum[0]) / (times[-1] - times[0])
    trapezoids = np.convolve(np.diff(times), [0.5, 0.5]) / (times[-1] - times[0])
    return (np.subtract(up, down) + mass * downSlope) @ trapezoids + bars * downSlope + held - change, trapezoids @ up
