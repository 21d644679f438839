# SPDX-License-Identifier: GPL-3.0-or-later
"""Bars that land flat, on an edge, on a corner and on one end, against the motion that the contact law gives."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import gas
from support.compare import small
from support.dashpot import dampingRatio

LENGTH, WIDTH, DENSITY, RADIUS = 0.05, 0.01, 590.0, 0.0025      # spheres touch each other: 10 rows of 2 x 2
STIFFNESS, RESTITUTION, GRAVITY, END = 4e4, 0.9, 9.81, 0.08
MASS = DENSITY * LENGTH * WIDTH**2
INERTIA = MASS * (LENGTH**2 + WIDTH**2) / 12    # about y: of a bar that lies along x
ON_FACE = 20                                    # spheres that touch in a flat landing, without the corners
CORNER = WIDTH / 16                             # radius of the spheres in the corners
DROPS = [0.02 + 1e-4 * i for i in range(9)]

title = """Nine bars of 0.05 x 0.01 x 0.01 m (590 kg/m3, 40 spheres, 8 in the corners) dropped from 0.02 to 0.0208 m on a wall without friction: flat, on a long edge, on the corner below
the centre, on one end, tilted by 20 degrees; spring 4e4 N/m, restitution 0.9, gas of 1e-4 kg/m3. Exact: a rigid bar on the springs and dashpots of those
spheres that touch, each a 20th of the spring and of the dashpot times the root of 20, corners 4 and 2 times that (docs/contact.md), integrated with a step of 1e-6 s. Speeds after the first landing,
over that of the landing: mean and scatter of the nine, each of which lands at another instant of a sub-step."""

runs = [Run("flotsamFoam", 1, name, quick=name == "flat") for name in ("flat", "edge", "corner", "end")]


def resolution(_run):
    return "16 x 12 x 10 cells"


def _centres():
    x = np.linspace(-1, 1, 10) * (LENGTH / 2 - RADIUS)
    y = np.array([-1, 1]) * (WIDTH / 2 - RADIUS)
    corner = np.array([LENGTH, WIDTH, WIDTH]) / 2 - CORNER
    return np.array([(a, b, c) for a in x for b in y for c in y] + [corner * (a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])


RADII = np.array([RADIUS] * 2 * ON_FACE + [CORNER] * 8)
STIFFENING = RADIUS / RADII


def _turn(attitude):
    """(axis, angle [rad])"""
    if attitude == "corner":
        corner = _centres()[-1]
        corner /= np.linalg.norm(corner)
        axis = np.cross(corner, (0, 0, -1))
        return axis / np.linalg.norm(axis), np.arccos(-corner[2])
    return {"flat": ((0, 0, 1), 0.0), "edge": ((1, 0, 0), np.pi / 4), "end": ((0, 1, 0), np.radians(20))}[attitude]


def _turned(attitude):
    """Centres of the spheres in space, from the bar's (Rodrigues)."""
    axis, angle = _turn(attitude)
    c = _centres()
    return c * np.cos(angle) + np.cross(axis, c) * np.sin(angle) + np.outer(c @ axis, axis) * (1 - np.cos(angle))


def files(run, _folder):
    (x, y, z), angle = _turn(run.variant)
    lowest = (_turned(run.variant)[:, 2] - RADII).min()
    places = [(a, b) for a in (-0.063, 0.001, 0.064) for b in (-0.04, 0.002, 0.042)]
    poses = " ".join(f"{{ position ({a:g} {b:g} {drop - lowest:.12g}); }}" for drop, (a, b) in zip(DROPS, places))
    text = f"""contact {{ default {{ stiffness {STIFFNESS:g}; restitution {RESTITUTION:g}; frictionAngle 0; }} }}
bodies
{{
    bar
    {{
        shape {{ type box; size ({LENGTH:g} {WIDTH:g} {WIDTH:g}); }}
        spheres {{ radius {RADIUS:g}; spacing {2 * RADIUS:g}; }}
        density {DENSITY:g};
        orientation {{ axis ({x:.12g} {y:.12g} {z:.12g}); angleDeg {np.degrees(angle):.12g}; }}
        poses ( {poses} );
    }}
}}"""
    return gas.files(((-0.1, 0.1), (-0.07, 0.07), (0, 0.1)), (16, 12, 10), (0, 0, -GRAVITY), text, END, 1e-3)


def _rate(state, spheres, spring, dashpot):
    """Height of the centre, its velocity, angle and angular velocity about y: their rates, and whether anything touches."""
    z, v, angle, spin = state
    x = spheres[:, 0] * np.cos(angle) + spheres[:, 2] * np.sin(angle)
    overlap = RADII - (z - spheres[:, 0] * np.sin(angle) + spheres[:, 2] * np.cos(angle))
    force = np.where(overlap > 0, np.maximum(0, STIFFENING * spring * overlap - np.sqrt(STIFFENING) * dashpot * (v - spin * x)), 0)
    return np.array([v, -GRAVITY + force.sum() / MASS, spin, -(x * force).sum() / INERTIA]), (overlap > 0).any()


def _exact(attitude, drop):
    """Velocity, angular velocity and time when the first landing is over."""
    spring = STIFFNESS / ON_FACE
    dashpot = 2 * dampingRatio(RESTITUTION) * np.sqrt(STIFFNESS * MASS) / np.sqrt(ON_FACE)
    spheres, step = _turned(attitude), 1e-6
    t = np.sqrt(2 * drop / GRAVITY)
    state, touches = np.array([(RADII - spheres[:, 2]).max(), -GRAVITY * t, 0.0, 0.0]), True
    while touches:
        a, _ = _rate(state, spheres, spring, dashpot)
        b, _ = _rate(state + step / 2 * a, spheres, spring, dashpot)
        state, t = state + step * b, t + step
        touches = _rate(state, spheres, spring, dashpot)[1]
    return state[1], state[3], t


def _found(bar, time, exactEnd):
    """The same at the first record after the landing in which nothing touches; and that record's time."""
    after = np.flatnonzero((time > exactEnd - 5e-4) & (bar.contacts < 0.5) & (bar.velocity[:, 2] > bar.velocity[:, 2].min() + 0.05))
    if not len(after):
        raise ValueError("a bar does not leave the wall")
    i = after[0]
    return bar.velocity[i, 2], bar.angularVelocity[i, 1], time[i]


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    rebounds, spins = [], []
    for i, drop in enumerate(DROPS):
        v, spin, end = _exact(run.variant, drop)
        own, ownSpin, at = _found(history[f"bar.{i}"], history.time, end)
        landing = np.sqrt(2 * GRAVITY * drop)
        rebounds.append(((own + GRAVITY * (at - end)) / landing, v / landing))
        spins.append((ownSpin * LENGTH / 2 / landing, spin * LENGTH / 2 / landing))
    found = []
    for name, pairs in (("speed of the centre", rebounds), ("speed of the ends by turning", spins)):
        own, exact = np.array(pairs).T
        found += [small(f"{name}, mean: off by", own.mean() - exact.mean(), 0.01, "", "exact"), small(f"{name}: exact", exact.mean()),
                  small(f"{name}, scatter (standard deviation)", (own - exact).std(), 0.02)]
    return {"comparisons": found}
