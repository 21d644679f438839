# SPDX-License-Identifier: GPL-3.0-or-later
"""Bouncing spheres against the exact solution of the contact law."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import gas
from support.compare import relative, small
from support.dashpot import dampingRatio

RADIUS, DENSITY, DROP, STIFFNESS, GRAVITY, END = 0.01, 590.0, 0.05, 1000.0, 9.81, 0.55
DROPS = [DROP + 2e-4 * i for i in range(9)]
SMALLEST = 2e-4        # height [m] of a bounce that lasts a dozen time steps
MASS = 4 / 3 * np.pi * RADIUS**3 * DENSITY

title = """Nine spheres of 0.01 m radius (590 kg/m3) dropped from 0.05 to 0.0516 m on a wall, spring 1000 N/m, in a gas of 1e-4 kg/m3. Exact: parabolas, and a
spring and dashpot that never attract, the dashpot from the restitution by Schwager & Poeschel 2007 (docs/contact.md). The time step of the fluid is
1 ms at most; a contact lasts 4 to 5 ms, 40 sub-steps, and each sphere lands at another instant of one: a single bounce errs by some per cent with
that, so the error is that of the mean, and the scatter stands beside it."""

runs = [Run("flotsamFoam", 1, f"restitution {e}", {"e": e}, quick=e == 0.8) for e in (0.8, 0.5, 0.2)]


def resolution(_run):
    return "8 x 8 x 10 cells"


def files(run, _folder):
    places = " ".join(f"{{ position ({x:g} {y:g} {RADIUS + drop:g}); }}"
                      for drop, (x, y) in zip(DROPS, [(x, y) for x in (-0.026, 0.001, 0.026) for y in (-0.026, 0.002, 0.026)]))
    text = f"""contact {{ default {{ stiffness {STIFFNESS:g}; restitution {run.options['e']}; frictionAngle 30; }} }}
bodies {{ sphere {{ shape {{ type sphere; radius {RADIUS:g}; }} density {DENSITY:g}; poses ( {places} ); }} }}"""
    return gas.files(((-0.04, 0.04), (-0.04, 0.04), (0, 0.1)), (8, 8, 10), (0, 0, -GRAVITY), text, END, 1e-3)


def _contact(v, damping):
    """Speed, duration and gap at the end of a contact that begins with the speed v < 0: fourth order Runge-Kutta to zero force."""
    step, t, state = 2e-6, 0.0, np.array([0.0, v])

    def rate(s):
        return np.array([s[1], -GRAVITY + (-STIFFNESS * s[0] - damping * s[1]) / MASS])
    while True:
        a = rate(state)
        b = rate(state + 0.5 * step * a)
        c = rate(state + 0.5 * step * b)
        state = state + step / 6 * (a + 2 * b + 2 * c + rate(state + step * c))
        t += step
        if -STIFFNESS * state[0] - damping * state[1] <= 0:
            return state[1], t, state[0]
        if t > 0.05:        # too slow to leave: it stays
            return 0.0, t, 0.0


def _exact(e, drop):
    """(time, height) of the highest points of the gap after each contact, as long as they are above SMALLEST."""
    damping, tops = 2 * dampingRatio(e) * np.sqrt(STIFFNESS * MASS), []
    t, y, v = 0.0, drop, 0.0
    while True:
        landing = (v + np.sqrt(v**2 + 2 * GRAVITY * y)) / GRAVITY
        t, v = t + landing, v - GRAVITY * landing
        v, duration, y = _contact(v, damping)
        t += duration
        top = y + v**2 / (2 * GRAVITY)
        if top < SMALLEST or len(tops) == 3:
            return tops
        tops.append((t + v / GRAVITY, top))


def _tops(t, y):
    """The same of the computed path, by parabolas through the records of each flight's middle."""
    at = np.flatnonzero((y[1:-1] > y[:-2]) & (y[1:-1] >= y[2:]) & (y[1:-1] > 2e-5)) + 1
    found = []
    for i in at:
        c = np.polyfit(t[i - 1:i + 2] - t[i], y[i - 1:i + 2], 2)
        top = -c[1] / (2 * c[0])
        found.append((t[i] + top, np.polyval(c, top)))
    return found


def _ratios(drop, tops):
    """Root of each height over the one before."""
    return np.sqrt(np.divide([y for _, y in tops], [drop] + [y for _, y in tops[:-1]]))


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    t, e = history.time, run.options["e"]
    paths = [history[f"sphere.{i}"].position[:, 2] - RADIUS for i in range(len(DROPS))]
    found, mine, exact = [], [], []
    for y, drop in zip(paths, DROPS):
        expected = _exact(e, drop)
        tops = _tops(t, y)[:len(expected)]
        if len(tops) < len(expected):
            raise ValueError(f"sphere from {drop:g} m: {len(tops)} bounces, expected {len(expected)}")
        mine.append(np.column_stack([_ratios(drop, tops), [at for at, _ in tops]]))
        exact.append(np.column_stack([_ratios(drop, expected), [at for at, _ in expected]]))
    for i in range(min(len(bounces) for bounces in exact)):
        ratio, at = np.array([bounces[i] for bounces in mine]).T
        trueRatio, trueAt = np.array([bounces[i] for bounces in exact]).T
        found += [relative(f"root of the height of bounce {i + 1} over the one before, mean", ratio.mean(), trueRatio.mean(), 0.01, source="exact"),
                  small("the same, scatter (standard deviation over the mean)", (ratio / trueRatio).std(), 0.05),
                  relative(f"time of the top of bounce {i + 1}, mean", at.mean(), trueAt.mean(), 0.005, "s", "exact")]
    falling = t < np.sqrt(2 * DROP / GRAVITY) - 2e-3
    deviation = max(np.abs(y - drop + 0.5 * GRAVITY * t**2)[falling].max() for y, drop in zip(paths, DROPS))
    found.append(small("free fall, largest deviation", deviation, 1e-6, "m", "exact"))
    return {"comparisons": found}
