# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of any density that leave a channel through its end, whatever this prescribes, and others that come in late. Lengths in units of the tank's width, as
in parts.py."""
import math

import numpy as np
import parts

OUTLETS = ("level", "velocity", "overfall")


def passing(s):
    """2D, or 3D: up to six bodies on their way out, up to two that come in above the water; a third with one fluid below a lid."""
    s.dim = parts.pick(s.rng, 2, 2, 3)
    parts.tank(s, height=(0.35, 0.5), n=(36, 52))
    if s.dim == 3:
        _makeLong(s)
    s.slant, s.forced = 0, True
    s.outlet = parts.pick(s.rng, *OUTLETS)
    s.oneFluid = s.rng.rand() < 0.33 and s.outlet != "overfall"
    s.openTop = not s.oneFluid or s.outlet == "velocity"
    s.inflowDepth = s.size[1] * (1 if s.oneFluid else s.rng.uniform(0.3, 0.5))
    s.inflow = s.rng.uniform(0.2, 1.2) * math.sqrt(s.inflowDepth)
    s.liquid.append((parts.below(s.inflowDepth), np.array([s.inflow, 0, 0])))
    if not s.oneFluid and s.outlet == "overfall":
        slope = s.rng.uniform(0, 0.1)
        s.gravity = parts.GRAVITY * np.array([slope, -1, 0.0]) / math.hypot(slope, 1)
    if s.rng.rand() < 0.25:
        s.walls = "noSlip"
        s.options.append("wallLaw on;" + f" mixingDepth {s.inflowDepth * s.length:.4g};" * (s.rng.rand() < 0.5))
    if s.rng.rand() < 0.3:
        parts.post(s, 0.35, 0.5 * s.inflowDepth, s.rng.uniform(1, 2) / s.cells[0])
    _leavers(s)
    if not s.oneFluid:
        _late(s)
    s.what.append(s.outlet + ", one fluid" * s.oneFluid)


def _makeLong(s):
    """Cubes, 8 to 12 of them across."""
    s.cells = [s.rng.randint(26, 34), s.rng.randint(11, 14), s.rng.randint(8, 12)]
    s.size, s.ratio = np.array(s.cells) / s.cells[0], [1, 1, 1]


def _leavers(s):
    for _ in range(s.rng.randint(1, 6)):
        high = s.size[1] if s.oneFluid else 1.3 * s.inflowDepth
        body = parts.body(s, elements=(2.5, 7), where=lambda r: np.array([s.rng.uniform(0.45, 1 - r), s.rng.uniform(0, high), s.rng.uniform(0, s.size[2])]))
        if not body:
            continue
        parts.throw(s, body, parts.pick(s.rng, 0, s.rng.uniform(0, 0.5)), s.rng.uniform(0, 0.2) / body.radius)
        body.velocity[0] += s.inflow


def _late(s):
    """Two elements above the water at least, where there is room."""
    for _ in range(s.rng.randint(0, 3)):
        free = s.inflowDepth + 4 / s.cells[0]
        body = parts.body(s, elements=(2.5, 4), where=lambda r: np.array([s.rng.uniform(0.1, 0.6), s.rng.uniform(free + r, s.size[1]), s.rng.uniform(0, s.size[2])]))
        if body:
            body.release, body.entries = s.rng.uniform(0.1, 1), "beforeRelease absent;"
            parts.throw(s, body, s.rng.uniform(0, 0.5), 0)
