# SPDX-License-Identifier: GPL-3.0-or-later
"""What users do besides: trees among sticks, structures that close on bodies and sweep them, gas of any depth or none, runs that are stopped, continued on other processes
and given further bodies, numerics that are switched. Lengths in units of the tank's width, as in parts.py."""
import math

import numpy as np
import parts
import shapes

SWITCHES = ("timeOrder 1;", "dualCellTransport off; interfaceWidth 0.75;", "wallGamma 0;", "carryRemainder off;", "separation 0;", "separation 1; wallInflow 0;", "contactTrial 0;",
            "profileKeeping 0;", "forceTolerance 0.01;", "tauFactor 1;", "viscousResidual off;", "penaltyRate 1e9;", "tauContBulk 1;", "surfaceTimeOrder 1;", "gasDepth 2;", "wallLaw on;",
            "timeOrder 1; surfaceTimeOrder 1;", "tauContBulk 0;", "mobility 1;", "transportCourant 0.2;", "contactTolerance 0.3;", "tauContWithTimeStep off;", "gravityLayers 2;", "wallInflow 0;")


def mixed(s):
    """Five kinds in turn."""
    kind = KINDS[int(s.number[len("mixed"):]) % len(KINDS)]
    kind(s)
    s.what.append(kind.__name__[1:])


def _tank(s, **sizes):
    """In 3D with cells 0.7 times as large as in the families that take turns."""
    parts.tank(s, **sizes)
    if s.dim == 3:
        s.cells = [round(1.4 * n) for n in s.cells]


# --- very unequal bodies --------------------------------------------------------------------------------------------------

def _unequal(s):
    """3D: a tree or two, 10 to 15 elements long, sticks of 1.5 to 3 elements, a heavy block; densities 0.15 to 3."""
    s.dim, s.ratio, s.slant = 3, [1, 1, 1], 0
    s.cells = [s.rng.randint(22, 28), s.rng.randint(11, 14), s.rng.randint(13, 17)]
    s.size = np.array(s.cells) / s.cells[0]
    s.length = parts.log(s.rng, 1, 30)
    s.gravity = np.array([0, -parts.GRAVITY, 0.0])
    s.walls, s.maxCo, s.duration = parts.pick(s.rng, "slip", "noSlip"), parts.pick(s.rng, 0.5, 1), (2.5, 4)
    level = s.rng.uniform(0.3, 0.5) * s.size[1]
    s.liquid.append((parts.below(level), np.zeros(3)))
    if s.rng.rand() < 0.6:
        s.liquid.append((parts.box(-1, 0.25, -1, 0.8 * s.size[1]), np.zeros(3)))
    h, taken = 1 / s.cells[0], []
    for _ in range(s.rng.randint(1, 3)):
        l = s.rng.uniform(9, 12) * h
        made = shapes.branches(s, s.rng.uniform(1.6, 2.4) * h, l)
        _put(s, made, level, taken, np.array([0.52 * l + h, 0.3 * l + h, 0.45 * l + h]), s.rng.uniform(-20, 20))
    for _ in range(s.rng.randint(5, 11)):
        half, r = s.rng.uniform(0.75, 1.5) * h, s.rng.uniform(0.25, 0.5) * h
        text = lambda L, a=half, b=r: f"type cylinder; end1 ({-a * L:.9g} 0 0); end2 ({a * L:.9g} 0 0); radius {b * L:.9g};"     # noqa: E731
        around = math.hypot(half, r)
        _put(s, (text, around, 2 * r, 2 * math.pi * r**2 * half), level, taken, np.full(3, around), s.rng.uniform(-180, 180))
    if s.rng.rand() < 0.5:
        a = s.rng.uniform(2, 4) * h
        text = lambda L: f"type box; size ({a * L:.9g} {a * L:.9g} {a * L:.9g});"       # noqa: E731
        _put(s, (text, a * math.sqrt(0.75), a, a**3), level, taken, np.full(3, a * math.sqrt(0.75)), s.rng.uniform(-180, 180))


def _put(s, made, level, taken, reach, angle):
    """Where its box, of half sizes `reach`, is free: a tree's ball would not fit into the tank. taken: boxes so far."""
    text, radius, thin, volume = made
    for _ in range(400):
        x = np.array([s.rng.uniform(0, 1), s.rng.uniform(0.5 * level, s.size[1]), s.rng.uniform(0, s.size[2])])
        if (x > reach).all() and (x < s.size - reach).all() and all((abs(x - y) > reach + r).any() for y, r in taken):
            break
    else:
        return
    taken.append((x, reach))
    s.bodies.append(parts.Solid(f"body{len(s.bodies)}", text, x, radius, thin, volume, angle=angle, axis=(0, 1, 0),
                                density=s.rho[0] * parts.pick(s.rng, 0.15, 0.15, 0.6, 0.9, 3)))


# --- structures that move ---------------------------------------------------------------------------------------------------

def _gates(s):
    """A gate comes down among bodies, an arm sweeps them, a piston pushes them; none leaves less room than the largest body needs."""
    s.dim = parts.pick(s.rng, 2, 2, 3)
    _tank(s, height=(0.6, 0.9))
    s.slant, s.forced, s.openTop, s.duration = 0, True, True, (3, 5)
    level = parts.pool(s, level=(0.35, 0.6))
    move = parts.pick(s.rng, _gate, _arm, _piston)
    move(s, level)
    s.what.append(move.__name__[1:])


def _some(s, where, low=0.0, high=1e9, elements=(2.5, 4)):
    for _ in range(s.rng.randint(2, 6)):
        body = parts.body(s, elements=elements, low=low, high=high, where=where)
        if body:
            body.density = s.rho[0] * parts.log(s.rng, 0.15, 3)


def _anywhere(s, x=(0, 1), y=(0, 1)):
    return lambda r: np.array([s.rng.uniform(*x), s.rng.uniform(y[0], y[1]) * s.size[1], s.rng.uniform(0, s.size[2])])


def _gate(s, _level):
    """From above the bodies down to a gap of two and a half of the widest."""
    _some(s, _anywhere(s), high=0.5 * s.size[1])
    widest = 2 * max((b.radius for b in s.bodies), default=0.05)
    start = max([0.55 * s.size[1]] + [b.position[1] + 1.1 * b.radius for b in s.bodies])
    end, high = 2.5 * widest, 0.5 * s.size[1]
    rate, t = s.rng.uniform(0.1, 0.4), s.rng.uniform(0, 0.3)
    parts.plate(s, 0.5, start + high / 2, s.rng.uniform(2, 3) / s.cells[0], high)
    down = max(0.0, start - end)

    def motion(L):
        unit = math.sqrt(L / parts.GRAVITY)
        return f"type tabulated; displacement (({t * unit:.9g} (0 0 0)) ({(t + 1e-3 + down / rate) * unit:.9g} (0 {-down * L:.9g} 0)));"
    s.structures[-1].motion = motion


def _arm(s, level):
    """Turns about the middle of the tank or goes to and fro; between its tips and the walls there is room for any body."""
    half = 1.5 / s.cells[0]
    y = s.rng.uniform(0.8, 1.2) * level
    room = min(y, s.size[1] - y, 0.5)
    reach = 0.5 * room
    where = lambda r: (lambda x: x if abs(x[1] - y) > r + 1.5 * half and 2.4 * r < room - reach else np.full(3, -1.0))(_anywhere(s)(r))    # noqa: E731
    _some(s, where, elements=(2, 3.5))
    parts.plate(s, 0.5, y, 2 * reach, 2 * half)
    omega = s.rng.uniform(0.5, 2)
    kind = parts.pick(s.rng, "rotating", "oscillating")

    def motion(L):
        unit = math.sqrt(L / parts.GRAVITY)
        way = f"omega {omega / unit:.9g};" if kind == "rotating" else f"amplitudeDeg 50; frequency {omega / unit / 6:.9g};"
        return f"type {kind}; axis (0 0 1); {way} rampTime {0.3 * unit:.9g};"
    s.structures[-1].motion = motion


def _piston(s, level):
    """From the left wall to the right, as far as there is room for all bodies in one row twice. Its rear stays outside: a slit that opens behind it would suck gas in with any speed."""
    thick = 3 / s.cells[0]
    _some(s, _anywhere(s, x=(thick, 1)), high=1.3 * level)
    for body in [b for b in s.bodies if b.position[0] - b.radius < 1.2 * thick]:
        s.bodies.remove(body)
    for k, body in enumerate(s.bodies):
        body.name = f"body{k}"
    while s.bodies and 0.85 - thick < 2 * sum(2 * b.radius for b in s.bodies):
        s.bodies.pop()
    room = 1 - thick - 2 * sum(2 * b.radius for b in s.bodies)
    way, rate = max(0.15, min(0.5, room)), s.rng.uniform(0.1, 0.4)
    parts.plate(s, 0.5 * (thick - 1.2 * way), 0.5 * s.size[1], thick + 1.2 * way, 1.2 * s.size[1])

    def motion(L):
        unit = math.sqrt(L / parts.GRAVITY)
        return f"type linear; velocity ({rate * L / unit:.9g} 0 0); rampTime {0.2 * unit:.9g}; timeEnd {(0.2 + way / rate) * unit:.9g};"
    s.structures[-1].motion = motion


# --- gas --------------------------------------------------------------------------------------------------------------------

def _gas(s):
    """Hardly any gas, none, much; gas computed in few rings of elements alone."""
    s.dim = parts.pick(s.rng, 2, 2, 3)
    kind = parts.pick(s.rng, "rings", "deep", "nearlyFull", "full")
    _tank(s, height=(2, 3) if kind == "deep" and s.dim == 2 else (0.6, 1.1), n=(24, 36) if kind != "deep" else (14, 20))
    s.openTop = s.rng.rand() < 0.5 if kind in ("rings", "deep") else False
    share = {"rings": (0.2, 0.5), "deep": (0.08, 0.2), "nearlyFull": (0.9, 0.995), "full": (1.1, 1.2)}[kind]
    level, s.isFull = s.rng.uniform(*share) * s.size[1], kind == "full"
    s.liquid.append((parts.below(level), np.zeros(3)))
    if kind in ("rings", "deep") and s.rng.rand() < 0.6:
        s.liquid.append((parts.box(-1, 0.3, -1, min(0.9 * s.size[1], 2.5 * level)), np.zeros(3)))
    if kind == "rings" or s.rng.rand() < 0.3:
        s.options.append(f"gasDepth {parts.pick(s.rng, 1, 2, 3, 5)};")
    for _ in range(s.rng.randint(1, 5)):
        body = parts.body(s, elements=(2.5, 6))
        if body:
            body.density = s.rho[0] * parts.log(s.rng, 0.05, 5)
            parts.throw(s, body, s.rng.uniform(0, 1), s.rng.uniform(0, 0.2) / body.radius)
    s.what.append(kind)


def _besidePosts(s, r):
    """Posts go through the tank."""
    for _ in range(20):
        x = np.array([s.rng.uniform(0, s.size[d]) for d in range(3)])
        if all(np.hypot(*(x - p.position)[:2]) > 1.1 * (r + p.radius) for p in s.structures):
            return x
    return np.full(3, -1.0)


# --- stopped and continued -----------------------------------------------------------------------------------------------------

def _continued(s):
    """Stopped somewhere, gone on with by one process or two, some bodies put in then; streams with a discharge that jumps."""
    s.dim = parts.pick(s.rng, 2, 2, 3)
    _tank(s, height=(0.45, 0.8), n=(24, 36))
    (_jumpingStream if s.rng.rand() < 0.5 else _collapse)(s)
    if s.rng.rand() < 0.4:
        x = s.rng.uniform(0.55, 0.7)
        parts.post(s, x, 0.3 * s.size[1], s.rng.uniform(1, 2) / s.cells[0])
    areAllLate = s.rng.rand() < 0.4
    for _ in range(s.rng.randint(2, 6)):
        body = parts.body(s, elements=(2.5, 5), where=lambda r: _besidePosts(s, r))
        if body:
            body.density = s.rho[0] * parts.log(s.rng, 0.15, 3)
            body.isLate = areAllLate or s.rng.rand() < 0.4
            if body.isLate and not areAllLate:      # where bodies are by then nobody knows
                body.entries, body.release = "beforeRelease absent;", s.rng.uniform(0.3, 1)
            body.velocity = np.array([s.inflow, 0, 0]) if body.position[1] < s.inflowDepth else body.velocity
    s.stop = s.rng.uniform(0.2, 0.7)
    s.ranks = parts.pick(s.rng, (1, 1), (1, 2), (2, 1), (2, 2))
    s.forced |= any(b.isLate for b in s.bodies)
    s.what.append(f"{s.ranks[0]} to {s.ranks[1]} processes, {sum(b.isLate for b in s.bodies)} late")


def _collapse(s):
    s.liquid.append((parts.box(-1, s.rng.uniform(0.2, 0.4), -1, s.rng.uniform(0.5, 0.9) * s.size[1]), np.zeros(3)))
    s.liquid.append((parts.below(s.rng.uniform(0.05, 0.3) * s.size[1]), np.zeros(3)))


def _jumpingStream(s):
    """Discharge off and on, doubled, halved, at once."""
    parts.stream(s, depth=(0.3, 0.45), froude=(0.3, 0.8))
    times = np.sort(s.rng.uniform(0, 1, size=s.rng.randint(1, 5)))
    s.discharge = [(t, parts.pick(s.rng, 0, 0.5, 1, 2)) for t in times]
    s.what.append("discharge " + " ".join(f"{q:g}" for _, q in s.discharge))


# --- numerics ---------------------------------------------------------------------------------------------------------------

def _switches(s):
    """One or two entries away from their defaults, long steps, in a dam break or a stream with bodies and a post."""
    s.dim = parts.pick(s.rng, 2, 2, 3)
    _tank(s, height=(0.45, 0.8), n=(24, 36))
    if s.rng.rand() < 0.5:
        _jumpingStream(s)
    else:
        _collapse(s)
    parts.post(s, s.rng.uniform(0.55, 0.7), 0.3 * s.size[1], s.rng.uniform(1, 2.5) / s.cells[0])
    for _ in range(s.rng.randint(2, 6)):
        body = parts.body(s, elements=(2.5, 5), where=lambda r: _besidePosts(s, r))
        if body:
            body.density = s.rho[0] * parts.log(s.rng, 0.15, 3)
    turn = int(s.number[len("mixed"):]) // len(KINDS)
    s.options.append(SWITCHES[2 * turn % len(SWITCHES)])
    if s.rng.rand() < 0.5:
        s.options.append(SWITCHES[(2 * turn + 1) % len(SWITCHES)])
    steps = parts.pick(s.rng, "usual", "usual", "maxCo 2", "fixed 4")
    if steps == "maxCo 2":
        s.maxCo, s.maxBodyCo = 2, 2
    elif steps == "fixed 4":
        s.maxCo, s.fixedStep, s.firstStep = 4, True, 4
    s.what.append(steps)


KINDS = (_unequal, _gates, _gas, _continued, _switches)
