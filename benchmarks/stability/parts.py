# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of random scenes: tank and mesh, liquid, bodies and structures. Lengths in units of the tank's width."""
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
    entries: str = ""
    isLate: bool = False                # put into the state of a run that is stopped


@dataclass
class Scene:
    number: object      # its name; an int in the families that take turns
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
    outlet: str = "overfall"            # level: that of inflowDepth is kept; velocity: that of the inlet is prescribed
    liquid: list = field(default_factory=list)      # (function of points -> bool, velocity)
    structures: list = field(default_factory=list)
    bodies: list = field(default_factory=list)
    restraints: list = field(default_factory=list)  # function of length and speed -> text
    options: list = field(default_factory=list)     # entries of the dictionary flotsam
    maxCo: float = 0.5
    maxBodyCo: float = 0.5
    contact: str = ""   # entries of the contact law; none: drawn
    duration: tuple = (1.5, 3)          # range of the end time [sqrt(L/g)]; 3D: 0.6 of it
    fixedStep: bool = False
    firstStep: float = 0                # [s]; 0: a tenth of what the Courant number allows
    forced: bool = False                # energy is put in
    endTime: float = 0
    speed: float = 0                    # that energy allows [m/s]
    what: list = field(default_factory=list)        # words for the table
    files: dict = field(default_factory=dict)       # of the case: path, text
    rng: object = None
    # families refined and mixed: caseVariants.py
    element: str = "hex"                # prism, tet, dual (of tetrahedra), snap
    halved: list = field(default_factory=list)      # (centre, half sizes, box or ball, directions): cells that refineMesh halves, one after the other
    snapped: tuple = None               # (foot, top, radius) of a round pier cut out by snappyHexMesh
    blocks: list = field(default_factory=list)      # (low, high) cut out of the mesh
    blockWall: str = "noSlip"
    blockType: str = "wall"             # of their patch
    finer: float = 1                    # smallest cell over the structured mesh's
    discharge: list = field(default_factory=list)   # (share of the end time, factor of `inflow` from then on)
    isFull: bool = False                # two fluids, but no gas
    stop: float = 0                     # share of the end time; 0: one run
    ranks: tuple = (1, 1)               # processes before the stop, and after it

    @property
    def h(self):
        """Smallest cell [m]."""
        return self.finer * min(smallest(self.size[d], self.cells[d], self.ratio[d]) for d in range(self.dim))


def smallest(length, n, ratio):
    q = ratio**(1 / max(1, n - 1))
    return length * (1 - q) / (1 - q**n) if ratio != 1 else length / n


def log(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def pick(rng, *values):
    return values[rng.randint(len(values))]


# --- tank, mesh, liquid -------------------------------------------------------------------------------------------------

def tank(s, height=(0.5, 1.2), n=(24, 40)):
    rng = s.rng
    s.length = log(rng, 0.05, 5)
    s.size = np.array([1, rng.uniform(*height), 0.1 if s.dim == 2 else rng.uniform(0.4, 0.8)])
    nx = rng.randint(*n) if s.dim == 2 else rng.randint(10, 15)
    s.cells = [nx, max(4, round(nx * s.size[1])), 1 if s.dim == 2 else max(4, round(nx * s.size[2]))]
    s.ratio = [1, 1, 1]
    s.gravity = np.array([0, -GRAVITY, 0.0])
    s.openTop = rng.rand() < 0.5
    s.walls = pick(rng, "noSlip", "slip")
    s.maxCo = pick(rng, 0.3, 0.5, 1)
    mesh(s)


def mesh(s):
    kind = pick(s.rng, "even", "moved", "slanted", "graded", "moved and graded")
    if "moved" in kind:
        s.moved = s.rng.uniform(0.1, 0.22)
    if "slanted" in kind:
        s.slant = s.rng.uniform(-1, 1)
    if "graded" in kind:
        for d in range(s.dim):
            s.ratio[d] = log(s.rng, 0.1, 10) if d < 2 else 1
    s.what.append(kind)


def turnGravity(s):
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


def pool(s, level=(0.3, 0.6), tilt=0.0):
    y = s.rng.uniform(*level) * s.size[1]
    s.liquid.append((below(y, tilt), np.zeros(3)))
    return y


def stream(s, depth, froude):
    """Water of a random depth that streams along x through the open box, and out over an edge or at a level. depth: over the box's height; froude: speed over the root of the depth."""
    s.slant, s.forced, s.openTop = 0, True, True
    s.inflowDepth = s.rng.uniform(*depth) * s.size[1]
    s.inflow = s.rng.uniform(*froude) * math.sqrt(s.inflowDepth)
    s.outlet = pick(s.rng, "overfall", "level")
    s.liquid.append((below(s.inflowDepth), np.array([s.inflow, 0, 0])))


# --- solids -------------------------------------------------------------------------------------------------------------

def through(depth, r):
    """Text of a cylinder through the mesh in z."""
    return lambda L: f"type cylinder; end1 (0 0 {-depth / 2 * L:.9g}); end2 (0 0 {depth / 2 * L:.9g}); radius {r * L:.9g};"


def shape(s, big):
    """(text, radius around, thinnest, volume) of a solid of largest extent `big`, through the mesh in 2D; centred on its origin."""
    rng, depth = s.rng, s.size[2]
    if s.dim == 2:
        kind = pick(rng, "box", "box", "cylinder", "union")
        if kind == "cylinder":
            r = big / 2
            return through(depth, r), r, big, math.pi * r**2 * depth
        a = big / math.sqrt(1.25)
        b = a * pick(rng, 1, 0.5, 0.5, 0.3)
        if kind == "box":
            return (lambda L: f"type box; size ({a * L:.9g} {b * L:.9g} {depth * L:.9g});"), math.hypot(a, b) / 2, b, a * b * depth
        c = a / 3           # a T: bar with a stem, the stem up to half a bar away
        text = (lambda L: f"type union; parts {{ bar {{ type box; size ({a * L:.9g} {c * L:.9g} {depth * L:.9g}); }} "
                f"stem {{ type box; size ({c * L:.9g} {c * 1.2 * L:.9g} {depth * L:.9g}); centre (0 {c * L:.9g} 0); }} }}")
        return text, 0.8 * a, c, a * c * depth + c * (1.1 * c) * depth
    kind = pick(rng, "box", "sphere", "cylinder", "capsule")
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


def cell(s):
    return max(s.size[d] / s.cells[d] for d in range(s.dim))


def fits(s, x, radius, low, high):
    margin = radius * math.hypot(1, s.slant) * 1.02
    if any(x[d] - margin < 0 or x[d] + margin > s.size[d] for d in range(s.dim)) or not low <= x[1] <= high:
        return False
    real = slanted(s, x)
    return all(np.linalg.norm((real - slanted(s, o.position))[:s.dim]) > 1.02 * (radius + o.radius) for o in s.bodies + s.structures)


def slanted(s, x):
    return x + np.array([s.slant * x[1], 0, 0])


def body(s, low=0.0, high=1e9, elements=(2.5, 9), where=None):
    """A body somewhere between two heights that touches nothing; none where there is no room."""
    rng = s.rng
    big = min(rng.uniform(*elements) * cell(s), 0.35 * min(s.size[:s.dim]))
    text, radius, thin, volume = shape(s, big)
    for _ in range(200):
        x = np.array([rng.uniform(0, s.size[d]) for d in range(3)]) if where is None else where(radius)
        if s.dim == 2:
            x[2] = s.size[2] / 2
        if fits(s, x, radius, low, high):
            break
    else:
        return None
    axis = (0, 0, 1) if s.dim == 2 else tuple(rng.normal(size=3).round(3))
    body = Solid(f"body{len(s.bodies)}", text, x, radius, thin, volume, angle=rng.uniform(-180, 180), axis=axis, density=s.rho[0] * log(rng, 0.01, 20))
    s.bodies.append(body)
    return body


def throw(s, body, speed, spin):
    v = np.r_[s.rng.normal(size=s.dim), np.zeros(3 - s.dim)]
    body.velocity = speed * v / np.linalg.norm(v)
    w = s.rng.normal(size=3) * ([0, 0, 1] if s.dim == 2 else 1)
    body.spin = spin * w / np.linalg.norm(w)


def plate(s, x, y, a, b, entries="", angle=0.0, name=None):
    """Box structure a x b at (x, y), through the mesh in z."""
    depth = 1.2 * s.size[2]
    s.structures.append(Solid(name or f"structure{len(s.structures)}", lambda L: f"type box; size ({a * L:.9g} {b * L:.9g} {depth * L:.9g});",
                              np.array([x, y, s.size[2] / 2]), math.hypot(a, b) / 2, min(a, b), angle=angle,
                              entries=f"wall {pick(s.rng, 'slip', 'noSlip')}; {entries}"))


def post(s, x, y, r, entries=""):
    s.structures.append(Solid(f"structure{len(s.structures)}", through(1.2 * s.size[2], r),
                              np.array([x, y, s.size[2] / 2]), r, 2 * r, entries=f"wall {pick(s.rng, 'slip', 'noSlip')}; {entries}"))
