# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes. scene(seed, number) is always the same; families take turns: number modulo their count. Families apart have names
as numbers: jam0, jam1, ...

Lengths of a scene are drawn in units of the tank's width and multiplied by `length` [m] once, at the end, so that also the size is random.
"""
import math

import jam
import mixed
import numpy as np
import parts
import passing
import refined
import shapes
import tied


def tank(s):
    """Liquid at rest or tilted, gravity any way."""
    parts.tank(s)
    parts.pool(s, tilt=parts.pick(s.rng, 0, 0.2, 1.0) * (1 if s.rng.rand() < 0.5 else -1))
    if s.rng.rand() < 0.5:
        s.openTop = False
        parts.turnGravity(s)


def damBreak(s):
    parts.tank(s)
    w, y = s.rng.uniform(0.15, 0.5), s.rng.uniform(0.3, 0.9) * s.size[1]
    s.liquid.append((parts.box(-1, w, -1, y), np.zeros(3)))
    if s.rng.rand() < 0.3:
        s.liquid.append((parts.box(1 - w / 2, 2, -1, y), np.zeros(3)))
    if s.rng.rand() < 0.3:
        s.liquid.append((parts.below(0.08), np.zeros(3)))


def splash(s):
    """Drops and jets with speed onto a pool, onto walls or each other."""
    parts.tank(s)
    y = parts.pool(s, level=(0.1, 0.4)) if s.rng.rand() < 0.8 else 0
    for _ in range(s.rng.randint(1, 4)):
        r = s.rng.uniform(0.05, 0.15)
        c = [s.rng.uniform(r, 1 - r), s.rng.uniform(y + r, s.size[1] - r) if y + 2 * r < s.size[1] else y, s.size[2] / 2][:s.dim]
        v = np.r_[s.rng.normal(size=s.dim), np.zeros(3 - s.dim)] * s.rng.uniform(0, 3)
        s.liquid.append((parts.ball(c, r), v))
    if s.rng.rand() < 0.2:
        s.openTop = False
        parts.turnGravity(s)


def channel(s):
    """Inflow over a weir, open at the end, floating bodies that may leave."""
    parts.tank(s, height=(0.3, 0.5), n=(40, 56))
    s.openTop, s.slant, s.walls = True, 0, parts.pick(s.rng, "noSlip", "slip")
    s.inflowDepth = s.rng.uniform(0.3, 0.6) * s.size[1]
    s.inflow = s.rng.uniform(0.3, 2) * math.sqrt(s.inflowDepth)     # times sqrt(g L): Froude number
    s.liquid.append((parts.below(s.inflowDepth), np.zeros(3)))
    height = s.rng.uniform(0.2, 0.9) * s.inflowDepth
    s.forced = True
    parts.plate(s, s.rng.uniform(0.4, 0.7), height / 2 - 0.05, s.rng.uniform(0.3, 4) / s.cells[0], height + 0.1)
    for _ in range(s.rng.randint(0, 4)):
        body = parts.body(s, low=0.7 * s.inflowDepth, elements=(2.5, 5),
                          where=lambda r: np.array([s.rng.uniform(r, 0.3), s.inflowDepth + s.rng.uniform(-0.3, 1) * r, 0]))
        if body:
            body.density = s.rho[0] * s.rng.uniform(0.2, 1.2)


def thrown(s):
    """Bodies thrown into water, spinning, at the surface and above it."""
    parts.tank(s, height=(0.8, 1.2))
    y = parts.pool(s)
    for _ in range(s.rng.randint(1, 5)):
        body = parts.body(s, low=0.8 * y)
        if body:
            parts.throw(s, body, s.rng.uniform(0, 2), parts.pick(s.rng, 0, 0, 1, 10) * s.rng.uniform(0, 2) / body.radius * 0.2)


def deep(s):
    """Bodies released below the surface and on the floor, stacked, in corners, heavy and light mixed."""
    parts.tank(s, height=(0.8, 1.2))
    y = parts.pool(s, level=(0.5, 0.85))
    column = s.rng.uniform(0.2, 0.8)
    for i in range(s.rng.randint(2, 6)):
        place = parts.pick(s.rng, "any", "corner", "stack")
        at = {"any": None, "corner": lambda r: np.array([parts.pick(s.rng, r * 1.05, 1 - r * 1.05), r * 1.05, s.size[2] / 2]),
              "stack": lambda r: np.array([column, s.rng.uniform(0, y), s.size[2] / 2])}[place]
        body = parts.body(s, high=y, where=at)
        if body and s.rng.rand() < 0.2:
            body.release = 0.3


def structures(s):
    """A collapse against plates thinner than an element, gaps below one, posts at walls; sometimes with bodies."""
    parts.tank(s)
    h = 1 / s.cells[0]
    s.liquid.append((parts.box(-1, s.rng.uniform(0.2, 0.4), -1, s.rng.uniform(0.5, 0.9) * s.size[1]), np.zeros(3)))
    x, y, kind = s.rng.uniform(0.5, 0.8), 0.0, parts.pick(s.rng, "rack", "thin", "touching", "mixed")
    if kind in ("rack", "mixed"):
        d, gap = s.rng.uniform(1, 4) * h, s.rng.uniform(0.3, 2.5) * h
        y = s.rng.uniform(0, 1) * gap + d / 2
        while y + d / 2 < 0.8 * s.size[1]:
            parts.post(s, x, y, d / 2)
            y += d + gap
    if kind in ("thin", "mixed"):
        parts.plate(s, x - 0.12, 0.25 * s.size[1], s.rng.uniform(0.1, 0.9) * h, 0.3 * s.size[1], angle=s.rng.uniform(-90, 90))
    if kind in ("touching", "mixed"):
        parts.plate(s, x + 0.12, 0.1, s.rng.uniform(0.5, 5) * h, 0.2)
        parts.post(s, 1 - s.rng.uniform(-0.5, 1.5) * h, 0.4 * s.size[1], s.rng.uniform(1, 3) * h)
    s.what.append(kind)
    if s.rng.rand() < 0.5:
        parts.body(s, elements=(2.5, 5))


def moving(s):
    """Paddles and rotors in a tank."""
    parts.tank(s)
    y, h = parts.pool(s), 1 / s.cells[0]
    rate = s.rng.uniform(0.3, 1.5)          # times sqrt(g/L)
    kind = parts.pick(s.rng, "oscillating", "rotating", "linear")
    a, b = s.rng.uniform(0.8, 4) * h, s.rng.uniform(0.1, 0.5) * s.size[1]
    motion = {"oscillating": lambda L: f"type oscillating; direction (1 {s.slant:.4g} 0); amplitude {0.1 * L:.9g}; "
              f"frequency {rate * math.sqrt(parts.GRAVITY / L) / 2:.9g};",
              "rotating": lambda L: f"type rotating; axis (0 0 1); omega {4 * rate * math.sqrt(parts.GRAVITY / L):.9g};",
              "linear": lambda L: f"type linear; velocity (0 {-0.3 * rate * math.sqrt(parts.GRAVITY * L):.9g} 0);"}[kind]
    parts.plate(s, 0.5, y, a, b, entries="contact off;")
    s.structures[0].motion = motion
    s.forced, s.openTop = True, True
    s.what.append(kind)
    if s.rng.rand() < 0.3:
        parts.body(s, elements=(2.5, 5))


def oneFluid(s):
    """No surface: bodies in a closed box, or a stream through posts."""
    parts.tank(s)
    s.oneFluid = True
    s.openTop = s.rng.rand() < 0.3
    if s.rng.rand() < 0.5:
        s.slant, s.forced = 0, True
        s.inflowDepth, s.inflow = s.size[1], s.rng.uniform(0.2, 2)
        s.openTop = False
        for i in range(s.rng.randint(1, 4)):
            parts.post(s, 0.3 + 0.15 * i, s.rng.uniform(0.2, 0.8) * s.size[1], s.rng.uniform(1, 3) / s.cells[0])
    for _ in range(s.rng.randint(1, 4)):
        body = parts.body(s)
        if body:
            parts.throw(s, body, s.rng.uniform(0, 1), s.rng.uniform(0, 2))


OPTIONS = [
    "timeOrder 1;", "tauContFactor 0;", "tauContFactor 10;", "tauContWithTimeStep off;", "nitsche off;", "nitsche off; penalty 1;",
    "nitsche off; penalty 1e6;", "nitscheGamma 0;", "nitscheGamma 1;", "nitscheGamma 100;", "ghostVelocity 0.005;", "ghostVelocity 0.5;",
    "ghostConvection 0;", "ghostConvection 0.1;", "ghostPressure 0.005;", "ghostPressure 0.5;", "dualCellTransport off;",
    "interfaceWidth 0.15;", "interfaceWidth 0.5;", "interfaceWidth 1;", "mobility 0.1;", "transportCourant 0.3;", "transportCourant 1;",
    "densityClip 0;", "densityClip 0.05;", "balancedGravity off;", "gravityLayers 0;", "gravityLayers 20;", "gasDepth 1;", "gasDepth 2;",
    "gasDepth 4;", "gasDepth 8;", "tolerance 1e-3;", "tolerance 1e-8;", "restart 5;", "contactTolerance 0.1;", "maxContactRepeats 0;"
]


def options(s):
    """One entry of the dictionary flotsam away from its default, in a scene of another family."""
    turn = s.number // len(FAMILIES)
    parts.pick(s.rng, damBreak, thrown, structures)(s)
    s.options.append(OPTIONS[turn % len(OPTIONS)])


def bigSteps(s):
    """Courant numbers of 1.5 to 5, a first step far too large, fixed steps."""
    parts.pick(s.rng, damBreak, splash, thrown, deep, structures)(s)
    s.maxCo = s.rng.uniform(1.5, 5)
    kind = parts.pick(s.rng, "large maxCo", "large first step", "fixed step")
    s.firstStep = {"large maxCo": 0, "large first step": parts.log(s.rng, 3, 100), "fixed step": s.maxCo}[kind]      # times h/speed
    s.fixedStep = kind == "fixed step"
    s.what.append(f"{kind}, maxCo {s.maxCo:.2g}")


def properties(s):
    """Density ratio 1 to 1e4, viscosities from none to syrup."""
    parts.pick(s.rng, tank, damBreak, splash, thrown, structures)(s)
    ratio = parts.pick(s.rng, 1, 1.2, 10, parts.log(s.rng, 1, 1e4), 1e4)
    s.rho = (1000, 1000 / ratio)
    liquid = parts.pick(s.rng, 1e-9, parts.log(s.rng, 1e-6, 1e3))
    s.mu = (liquid, liquid / parts.log(s.rng, 1e-2, 1e4))
    s.what.append(f"density ratio {ratio:.3g}, viscosities {s.mu[0]:.2g}, {s.mu[1]:.2g} Pa s")


def threeD(s):
    s.dim = 3
    parts.pick(s.rng, damBreak, splash, thrown, deep, structures)(s)


FAMILIES = {f.__name__: f for f in (tank, damBreak, splash, channel, thrown, deep, structures, moving, oneFluid, options, bigSteps, properties, threeD)}

APART = {"jam": jam.jam, "shapes": shapes.shapes, "passing": passing.passing, "tied": tied.tied,
         "refined": refined.refined, "mixed": mixed.mixed}      # do not take turns: more than a minute each, and the numbers of the others stay


def familyOf(number):
    if isinstance(number, int):
        return list(FAMILIES)[number % len(FAMILIES)]
    return number.rstrip("0123456789")


def chosen(numbers, family):
    """Names of the scenes of a family among these numbers; without one of all that take turns."""
    if family in APART:
        return [f"{family}{n}" for n in numbers]
    return [n for n in numbers if family in (None, familyOf(n))]


def _start(seed, number):
    """Of the random numbers."""
    if isinstance(number, int):
        return (seed * 1000003 + number) % 2**32
    family = familyOf(number)
    return [seed, 1 + list(APART).index(family), int(number[len(family):])]


def scene(seed, number):
    name = familyOf(number)
    s = parts.Scene(number, name, rng=np.random.RandomState(_start(seed, number)))
    {**FAMILIES, **APART}[name](s)
    _finish(s)
    return s


def _finish(s):
    """Speeds and times, which are in units of sqrt(g L) and sqrt(L/g) so far; lengths in metres."""
    L = s.length
    unit = math.sqrt(parts.GRAVITY * L)
    for body in s.bodies:
        body.velocity, body.spin, body.release = body.velocity * unit, body.spin * unit / L, body.release * L / unit
    s.inflow *= unit
    s.liquid = [(inside, v * unit) for inside, v in s.liquid]
    s.size = s.size * L
    height = float(np.abs(s.gravity) @ s.size) + abs(s.gravity[0] * s.slant * s.size[1])
    given = [np.linalg.norm(v) for _, v in s.liquid] + [2 * s.inflow * max([1] + [q for _, q in s.discharge]), 0]
    given += [np.linalg.norm(b.velocity) + np.linalg.norm(b.spin) * b.radius * L for b in s.bodies]
    s.speed = math.sqrt(2 * height + max(given)**2)
    if s.forced and s.family == "moving":
        s.speed *= 2
    if s.speed == 0:
        s.speed = 0.1 * unit
    s.endTime = s.rng.uniform(*s.duration) * (L / unit if s.dim == 2 else 0.6 * L / unit)
    largest = s.maxCo * s.h / s.speed
    s.firstStep = s.firstStep * s.h / s.speed or 0.1 * largest
