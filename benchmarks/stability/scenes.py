# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes. scene(seed, number) is always the same; families take turns: number modulo their count.

Lengths of a scene are drawn in units of the tank's width and multiplied by `length` [m] once, at the end, so that also the size is random.
"""
import math
from dataclasses import dataclass, field

import numpy as np

GRAVITY = 9.81


@dataclass
class Solid:
    """A body or structure. shape: text of the dictionary; radius: of a sphere around it [m]; thin: its smallest extent [m]."""
    name: str
    shape: str
    position: np.ndarray
    radius: float
    thin: float
    volume: float = 0
    angle: float = 0
    axis: tuple = (0, 0, 1)
    density: float = 0
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    spin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    release: float = 0
    entries: str = ""       # of a structure


@dataclass
class Scene:
    number: int
    family: str
    dim: int = 2
    length: float = 1                   # width of the tank [m]
    size: np.ndarray = None             # of the box before it is slanted [m]
    cells: list = None
    ratio: list = None                  # largest over smallest cell along each axis
    moved: float = 0                    # random shift of inner points over their cell
    slant: float = 0                    # x += slant y
    gravity: np.ndarray = None
    rho: tuple = (1000, 1)              # liquid, gas
    mu: tuple = (1e-3, 1.8e-5)
    oneFluid: bool = False
    walls: str = "noSlip"
    openTop: bool = True
    inflow: float = 0                   # speed over the lowest part `inflowDepth` of the left side, which is then open on the right
    inflowDepth: float = 0
    liquid: list = field(default_factory=list)      # (function of points -> bool, velocity)
    structures: list = field(default_factory=list)
    bodies: list = field(default_factory=list)
    options: list = field(default_factory=list)     # entries of the dictionary flotsam
    maxCo: float = 0.5
    fixedStep: bool = False
    firstStep: float = 0                # [s]; 0: a tenth of what the Courant number allows
    forced: bool = False                # energy is put in
    endTime: float = 0
    speed: float = 0                    # that energy allows [m/s]
    what: list = field(default_factory=list)        # words for the table
    rng: object = None

    @property
    def h(self):
        """Smallest cell [m]."""
        return min(_smallest(self.size[d], self.cells[d], self.ratio[d]) for d in range(self.dim))


def _smallest(length, n, ratio):
    q = ratio**(1 / max(1, n - 1))
    return length * (1 - q) / (1 - q**n) if ratio != 1 else length / n


def _log(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _pick(rng, *values):
    return values[rng.randint(len(values))]


# --- tank, mesh, liquid -------------------------------------------------------------------------------------------------

def _tank(s, height=(0.5, 1.2), n=(24, 40)):
    rng = s.rng
    s.length = _log(rng, 0.05, 5)
    s.size = np.array([1, rng.uniform(*height), 0.1 if s.dim == 2 else rng.uniform(0.4, 0.8)])
    nx = rng.randint(*n) if s.dim == 2 else rng.randint(10, 15)
    s.cells = [nx, max(4, round(nx * s.size[1])), 1 if s.dim == 2 else max(4, round(nx * s.size[2]))]
    s.ratio = [1, 1, 1]
    s.gravity = np.array([0, -GRAVITY, 0.0])
    s.openTop = rng.rand() < 0.5
    s.walls = _pick(rng, "noSlip", "slip")
    s.maxCo = _pick(rng, 0.3, 0.5, 1)
    _mesh(s)


def _mesh(s):
    kind = _pick(s.rng, "even", "moved", "slanted", "graded", "moved and graded")
    if "moved" in kind:
        s.moved = s.rng.uniform(0.1, 0.22)
    if "slanted" in kind:
        s.slant = s.rng.uniform(-1, 1)
    if "graded" in kind:
        for d in range(s.dim):
            s.ratio[d] = _log(s.rng, 0.1, 10) if d < 2 else 1
    s.what.append(kind)


def _turnGravity(s):
    if s.rng.rand() < 0.25:
        s.gravity = np.zeros(3)
        s.what.append("no gravity")
        return
    v = np.r_[s.rng.normal(size=s.dim), np.zeros(3 - s.dim)]
    s.gravity = GRAVITY * v / np.linalg.norm(v)
    s.what.append("gravity turned")


def below(level, tilt=0.0):
    return lambda x: x[:, 1] < level + tilt * (x[:, 0] - 0.5)


def box(x0, x1, y0, y1):
    return lambda x: (x[:, 0] > x0) & (x[:, 0] < x1) & (x[:, 1] > y0) & (x[:, 1] < y1)


def ball(centre, radius):
    c = np.asarray(centre)
    return lambda x: ((x[:, :len(c)] - c)**2).sum(axis=1) < radius**2


def _pool(s, level=(0.3, 0.6), tilt=0.0):
    y = s.rng.uniform(*level) * s.size[1]
    s.liquid.append((below(y, tilt), np.zeros(3)))
    return y


# --- solids -------------------------------------------------------------------------------------------------------------

def _shape(s, big):
    """(text, radius around, thinnest, volume) of a solid of largest extent `big`, through the mesh in 2D; centred on its origin."""
    rng, depth = s.rng, s.size[2]
    if s.dim == 2:
        kind = _pick(rng, "box", "box", "cylinder", "union")
        if kind == "cylinder":
            r = big / 2
            return (lambda L: f"type cylinder; end1 (0 0 {-depth / 2 * L:.9g}); end2 (0 0 {depth / 2 * L:.9g}); radius {r * L:.9g};"), r, big, math.pi * r**2 * depth
        a = big / math.sqrt(1.25)
        b = a * _pick(rng, 1, 0.5, 0.5, 0.3)
        if kind == "box":
            return (lambda L: f"type box; size ({a * L:.9g} {b * L:.9g} {depth * L:.9g});"), math.hypot(a, b) / 2, b, a * b * depth
        c = a / 3           # a T: bar with a stem, the stem up to half a bar away
        text = (lambda L: f"type union; parts {{ bar {{ type box; size ({a * L:.9g} {c * L:.9g} {depth * L:.9g}); }} "
                f"stem {{ type box; size ({c * L:.9g} {c * 1.2 * L:.9g} {depth * L:.9g}); centre (0 {c * L:.9g} 0); }} }}")
        return text, 0.8 * a, c, a * c * depth + c * (1.1 * c) * depth
    kind = _pick(rng, "box", "sphere", "cylinder", "capsule")
    if kind == "sphere":
        return (lambda L: f"type sphere; radius {big / 2 * L:.9g};"), big / 2, big, math.pi / 6 * big**3
    if kind == "box":
        a = big / 1.3
        b, c = a * rng.uniform(0.4, 0.9), a * rng.uniform(0.4, 0.9)
        return (lambda L: f"type box; size ({a * L:.9g} {b * L:.9g} {c * L:.9g});"), math.sqrt(a * a + b * b + c * c) / 2, min(b, c), a * b * c
    r, half = big / 5, big / 2
    if kind == "capsule":
        half -= r
    volume = math.pi * r**2 * 2 * half + (4 / 3 * math.pi * r**3 if kind == "capsule" else 0)
    return (lambda L: f"type {kind}; end1 ({-half * L:.9g} 0 0); end2 ({half * L:.9g} 0 0); radius {r * L:.9g};"), math.hypot(big / 2, r), 2 * r, volume


def _cell(s):
    return max(s.size[d] / s.cells[d] for d in range(s.dim))


def _fits(s, x, radius, low, high):
    margin = radius * math.hypot(1, s.slant) * 1.02
    if any(x[d] - margin < 0 or x[d] + margin > s.size[d] for d in range(s.dim)) or not low <= x[1] <= high:
        return False
    real = _slanted(s, x)
    return all(np.linalg.norm((real - _slanted(s, o.position))[:s.dim]) > 1.02 * (radius + o.radius) for o in s.bodies + s.structures)


def _slanted(s, x):
    return x + np.array([s.slant * x[1], 0, 0])


def _body(s, low=0.0, high=1e9, elements=(2.5, 9), where=None):
    """A body somewhere between two heights that touches nothing; none where there is no room."""
    rng = s.rng
    big = min(rng.uniform(*elements) * _cell(s), 0.35 * min(s.size[:s.dim]))
    text, radius, thin, volume = _shape(s, big)
    for _ in range(200):
        x = np.array([rng.uniform(0, s.size[d]) for d in range(3)]) if where is None else where(radius)
        if s.dim == 2:
            x[2] = s.size[2] / 2
        if _fits(s, x, radius, low, high):
            break
    else:
        return None
    axis = (0, 0, 1) if s.dim == 2 else tuple(rng.normal(size=3).round(3))
    body = Solid(f"body{len(s.bodies)}", text, x, radius, thin, volume, angle=rng.uniform(-180, 180), axis=axis, density=s.rho[0] * _log(rng, 0.01, 20))
    s.bodies.append(body)
    return body


def _throw(s, body, speed, spin):
    v = np.r_[s.rng.normal(size=s.dim), np.zeros(3 - s.dim)]
    body.velocity = speed * v / np.linalg.norm(v)
    w = s.rng.normal(size=3) * ([0, 0, 1] if s.dim == 2 else 1)
    body.spin = spin * w / np.linalg.norm(w)


def _plate(s, x, y, a, b, entries="", angle=0.0, name=None):
    """Box structure a x b at (x, y), through the mesh in z."""
    depth = 1.2 * s.size[2]
    s.structures.append(Solid(name or f"structure{len(s.structures)}", lambda L: f"type box; size ({a * L:.9g} {b * L:.9g} {depth * L:.9g});",
                              np.array([x, y, s.size[2] / 2]), math.hypot(a, b) / 2, min(a, b), angle=angle, entries=f"wall {_pick(s.rng, 'slip', 'noSlip')}; {entries}"))


def _post(s, x, y, r, entries=""):
    depth = 1.2 * s.size[2]
    s.structures.append(Solid(f"structure{len(s.structures)}", lambda L: f"type cylinder; end1 (0 0 {-depth / 2 * L:.9g}); end2 (0 0 {depth / 2 * L:.9g}); radius {r * L:.9g};",
                              np.array([x, y, s.size[2] / 2]), r, 2 * r, entries=f"wall {_pick(s.rng, 'slip', 'noSlip')}; {entries}"))


# --- families -----------------------------------------------------------------------------------------------------------

def tank(s):
    """Liquid at rest or tilted, gravity any way."""
    _tank(s)
    _pool(s, tilt=_pick(s.rng, 0, 0.2, 1.0) * (1 if s.rng.rand() < 0.5 else -1))
    if s.rng.rand() < 0.5:
        s.openTop = False
        _turnGravity(s)


def damBreak(s):
    _tank(s)
    w, y = s.rng.uniform(0.15, 0.5), s.rng.uniform(0.3, 0.9) * s.size[1]
    s.liquid.append((box(-1, w, -1, y), np.zeros(3)))
    if s.rng.rand() < 0.3:
        s.liquid.append((box(1 - w / 2, 2, -1, y), np.zeros(3)))
    if s.rng.rand() < 0.3:
        s.liquid.append((below(0.08), np.zeros(3)))


def splash(s):
    """Drops and jets with speed onto a pool, onto walls or each other."""
    _tank(s)
    y = _pool(s, level=(0.1, 0.4)) if s.rng.rand() < 0.8 else 0
    for _ in range(s.rng.randint(1, 4)):
        r = s.rng.uniform(0.05, 0.15)
        c = [s.rng.uniform(r, 1 - r), s.rng.uniform(y + r, s.size[1] - r) if y + 2 * r < s.size[1] else y, s.size[2] / 2][:s.dim]
        v = np.r_[s.rng.normal(size=s.dim), np.zeros(3 - s.dim)] * s.rng.uniform(0, 3)
        s.liquid.append((ball(c, r), v))
    if s.rng.rand() < 0.2:
        s.openTop = False
        _turnGravity(s)


def channel(s):
    """Inflow over a weir, open at the end, floating bodies that may leave."""
    _tank(s, height=(0.3, 0.5), n=(40, 56))
    s.openTop, s.slant, s.walls = True, 0, _pick(s.rng, "noSlip", "slip")
    s.inflowDepth = s.rng.uniform(0.3, 0.6) * s.size[1]
    s.inflow = s.rng.uniform(0.3, 2) * math.sqrt(s.inflowDepth)     # times sqrt(g L): Froude number
    s.liquid.append((below(s.inflowDepth), np.zeros(3)))
    height = s.rng.uniform(0.2, 0.9) * s.inflowDepth
    s.forced = True
    _plate(s, s.rng.uniform(0.4, 0.7), height / 2 - 0.05, s.rng.uniform(0.3, 4) / s.cells[0], height + 0.1)
    for _ in range(s.rng.randint(0, 4)):
        body = _body(s, low=0.7 * s.inflowDepth, elements=(2.5, 5), where=lambda r: np.array([s.rng.uniform(r, 0.3), s.inflowDepth + s.rng.uniform(-0.3, 1) * r, 0]))
        if body:
            body.density = s.rho[0] * s.rng.uniform(0.2, 1.2)


def thrown(s):
    """Bodies thrown into water, spinning, at the surface and above it."""
    _tank(s, height=(0.8, 1.2))
    y = _pool(s)
    for _ in range(s.rng.randint(1, 5)):
        body = _body(s, low=0.8 * y)
        if body:
            _throw(s, body, s.rng.uniform(0, 2), _pick(s.rng, 0, 0, 1, 10) * s.rng.uniform(0, 2) / body.radius * 0.2)


def deep(s):
    """Bodies released below the surface and on the floor, stacked, in corners, heavy and light mixed."""
    _tank(s, height=(0.8, 1.2))
    y = _pool(s, level=(0.5, 0.85))
    column = s.rng.uniform(0.2, 0.8)
    for i in range(s.rng.randint(2, 6)):
        place = _pick(s.rng, "any", "corner", "stack")
        at = {"any": None, "corner": lambda r: np.array([_pick(s.rng, r * 1.05, 1 - r * 1.05), r * 1.05, s.size[2] / 2]),
              "stack": lambda r: np.array([column, s.rng.uniform(0, y), s.size[2] / 2])}[place]
        body = _body(s, high=y, where=at)
        if body and s.rng.rand() < 0.2:
            body.release = 0.3


def structures(s):
    """A collapse against plates thinner than an element, gaps below one, posts at walls; sometimes with bodies."""
    _tank(s)
    h = 1 / s.cells[0]
    s.liquid.append((box(-1, s.rng.uniform(0.2, 0.4), -1, s.rng.uniform(0.5, 0.9) * s.size[1]), np.zeros(3)))
    x, y, kind = s.rng.uniform(0.5, 0.8), 0.0, _pick(s.rng, "rack", "thin", "touching", "mixed")
    if kind in ("rack", "mixed"):
        d, gap = s.rng.uniform(1, 4) * h, s.rng.uniform(0.3, 2.5) * h
        y = s.rng.uniform(0, 1) * gap + d / 2
        while y + d / 2 < 0.8 * s.size[1]:
            _post(s, x, y, d / 2)
            y += d + gap
    if kind in ("thin", "mixed"):
        _plate(s, x - 0.12, 0.25 * s.size[1], s.rng.uniform(0.1, 0.9) * h, 0.3 * s.size[1], angle=s.rng.uniform(-90, 90))
    if kind in ("touching", "mixed"):
        _plate(s, x + 0.12, 0.1, s.rng.uniform(0.5, 5) * h, 0.2)
        _post(s, 1 - s.rng.uniform(-0.5, 1.5) * h, 0.4 * s.size[1], s.rng.uniform(1, 3) * h)
    s.what.append(kind)
    if s.rng.rand() < 0.5:
        _body(s, elements=(2.5, 5))


def moving(s):
    """Paddles and rotors in a tank."""
    _tank(s)
    y, h = _pool(s), 1 / s.cells[0]
    rate = s.rng.uniform(0.3, 1.5)          # times sqrt(g/L)
    kind = _pick(s.rng, "oscillating", "rotating", "linear")
    a, b = s.rng.uniform(0.8, 4) * h, s.rng.uniform(0.1, 0.5) * s.size[1]
    motion = {"oscillating": lambda L: f"type oscillating; direction (1 {s.slant:.4g} 0); amplitude {0.1 * L:.9g}; frequency {rate * math.sqrt(GRAVITY / L) / 2:.9g};",
              "rotating": lambda L: f"type rotating; axis (0 0 1); omega {4 * rate * math.sqrt(GRAVITY / L):.9g};",
              "linear": lambda L: f"type linear; velocity (0 {-0.3 * rate * math.sqrt(GRAVITY * L):.9g} 0);"}[kind]
    _plate(s, 0.5, y, a, b, entries="contact off;")
    s.structures[0].motion = motion
    s.forced, s.openTop = True, True
    s.what.append(kind)
    if s.rng.rand() < 0.3:
        _body(s, elements=(2.5, 5))


def oneFluid(s):
    """No surface: bodies in a closed box, or a stream through posts."""
    _tank(s)
    s.oneFluid = True
    s.openTop = s.rng.rand() < 0.3
    if s.rng.rand() < 0.5:
        s.slant, s.forced = 0, True
        s.inflowDepth, s.inflow = s.size[1], s.rng.uniform(0.2, 2)
        s.openTop = False
        for i in range(s.rng.randint(1, 4)):
            _post(s, 0.3 + 0.15 * i, s.rng.uniform(0.2, 0.8) * s.size[1], s.rng.uniform(1, 3) / s.cells[0])
    for _ in range(s.rng.randint(1, 4)):
        body = _body(s)
        if body:
            _throw(s, body, s.rng.uniform(0, 1), s.rng.uniform(0, 2))


OPTIONS = ["timeOrder 1;", "tauContFactor 0;", "tauContFactor 10;", "tauContWithTimeStep off;", "nitsche off;", "nitsche off; penalty 1;", "nitsche off; penalty 1e6;",
           "nitscheGamma 0;", "nitscheGamma 1;", "nitscheGamma 100;", "ghostVelocity 0.005;", "ghostVelocity 0.5;", "ghostConvection 0;", "ghostConvection 0.1;",
           "ghostPressure 0.005;", "ghostPressure 0.5;", "dualCellTransport off;", "interfaceWidth 0.15;", "interfaceWidth 0.5;", "interfaceWidth 1;", "mobility 0.1;",
           "transportCourant 0.3;", "transportCourant 1;", "densityClip 0;", "densityClip 0.05;", "balancedGravity off;", "gravityLayers 0;", "gravityLayers 20;",
           "gasDepth 1;", "gasDepth 2;", "gasDepth 4;", "gasDepth 8;", "tolerance 1e-3;", "tolerance 1e-8;", "restart 5;", "contactTolerance 0.1;", "maxContactRepeats 0;"]


def options(s):
    """One entry of the dictionary flotsam away from its default, in a scene of another family."""
    turn = s.number // len(FAMILIES)
    _pick(s.rng, damBreak, thrown, structures)(s)
    s.options.append(OPTIONS[turn % len(OPTIONS)])


def bigSteps(s):
    """Courant numbers of 1.5 to 5, a first step far too large, fixed steps."""
    _pick(s.rng, damBreak, splash, thrown, deep, structures)(s)
    s.maxCo = s.rng.uniform(1.5, 5)
    kind = _pick(s.rng, "large maxCo", "large first step", "fixed step")
    s.firstStep = {"large maxCo": 0, "large first step": _log(s.rng, 3, 100), "fixed step": s.maxCo}[kind]      # times h/speed
    s.fixedStep = kind == "fixed step"
    s.what.append(f"{kind}, maxCo {s.maxCo:.2g}")


def properties(s):
    """Density ratio 1 to 1e4, viscosities from none to syrup."""
    _pick(s.rng, tank, damBreak, splash, thrown, structures)(s)
    ratio = _pick(s.rng, 1, 1.2, 10, _log(s.rng, 1, 1e4), 1e4)
    s.rho = (1000, 1000 / ratio)
    liquid = _pick(s.rng, 1e-9, _log(s.rng, 1e-6, 1e3))
    s.mu = (liquid, liquid / _log(s.rng, 1e-2, 1e4))
    s.what.append(f"density ratio {ratio:.3g}, viscosities {s.mu[0]:.2g}, {s.mu[1]:.2g} Pa s")


def threeD(s):
    s.dim = 3
    _pick(s.rng, damBreak, splash, thrown, deep, structures)(s)


FAMILIES = {f.__name__: f for f in (tank, damBreak, splash, channel, thrown, deep, structures, moving, oneFluid, options, bigSteps, properties, threeD)}


def scene(seed, number):
    name = list(FAMILIES)[number % len(FAMILIES)]
    s = Scene(number, name, rng=np.random.RandomState((seed * 1000003 + number) % 2**32))
    FAMILIES[name](s)
    _finish(s)
    return s


def _finish(s):
    """Speeds and times, which are in units of sqrt(g L) and sqrt(L/g) so far; lengths in metres."""
    L = s.length
    unit = math.sqrt(GRAVITY * L)
    for body in s.bodies:
        body.velocity, body.spin, body.release = body.velocity * unit, body.spin * unit / L, body.release * L / unit
    s.inflow *= unit
    s.liquid = [(inside, v * unit) for inside, v in s.liquid]
    s.size = s.size * L
    height = float(np.abs(s.gravity) @ s.size) + abs(s.gravity[0] * s.slant * s.size[1])
    given = [np.linalg.norm(v) for _, v in s.liquid] + [np.linalg.norm(b.velocity) + np.linalg.norm(b.spin) * b.radius * L for b in s.bodies] + [2 * s.inflow, 0]
    s.speed = math.sqrt(2 * height + max(given)**2)
    if s.forced and s.family == "moving":
        s.speed *= 2
    if s.speed == 0:
        s.speed = 0.1 * unit
    s.endTime = s.rng.uniform(1.5, 3) * (L / unit if s.dim == 2 else 0.6 * L / unit)
    largest = s.maxCo * s.h / s.speed
    s.firstStep = s.firstStep * s.h / s.speed or 0.1 * largest
