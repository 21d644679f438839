# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies on tethers and springs: to points, to structures that move, to each other. Lengths in units of the tank's width, as in parts.py."""
import math

import numpy as np
import parts


def tied(s):
    """2D, or 3D: two to five bodies afloat, below the water or above it, half of the tanks with a paddle or a gate that moves."""
    s.dim = parts.pick(s.rng, 2, 2, 3)
    parts.tank(s, height=(0.7, 1))
    s.openTop = s.rng.rand() < 0.7
    y = parts.pool(s, level=(0.4, 0.7))
    mover = _mover(s, y) if s.rng.rand() < 0.5 else None
    for _ in range(s.rng.randint(2, 6)):
        body = parts.body(s, elements=(2.5, 6), where=lambda r: _clear(s, mover, r))
        if body:
            parts.throw(s, body, parts.pick(s.rng, 0, s.rng.uniform(0, 1)), parts.pick(s.rng, 0, s.rng.uniform(0, 0.2) / body.radius))
            body.release = parts.pick(s.rng, 0, 0, 0.3)
    for k, body in enumerate(s.bodies):
        _line(s, k, body, mover)


def _clear(s, mover, r):
    """A place for a body of this radius, beyond the plate, which goes across the tank."""
    start = mover.position[0] + mover.radius + r if mover else 0
    return np.array([s.rng.uniform(start, 1), s.rng.uniform(0, s.size[1]), s.rng.uniform(0, s.size[2])])


def _mover(s, y):
    """A plate through the tank's depth or half of it, slow at first."""
    h = 1 / s.cells[0]
    a, b = s.rng.uniform(1.5, 3) * h, s.rng.uniform(0.2, 0.4) * s.size[1]
    rate = s.rng.uniform(0.2, 0.8)      # times sqrt(g/L)
    kind = parts.pick(s.rng, "oscillating", "flap", "linear")
    motion = {"oscillating": lambda L: f"type oscillating; direction (1 0 0); amplitude {0.08 * L:.9g}; frequency {rate * math.sqrt(parts.GRAVITY / L) / 2:.9g};",
              "flap": lambda L: f"type oscillating; axis (0 0 1); amplitudeDeg 20; frequency {rate * math.sqrt(parts.GRAVITY / L) / 2:.9g};",
              "linear": lambda L: f"type linear; velocity (0 {0.2 * rate * math.sqrt(parts.GRAVITY * L):.9g} 0);"}[kind]
    parts.plate(s, 0.25, min(y, s.size[1] - 0.6 * b), a, b)
    s.structures[0].motion = lambda L: motion(L) + f" rampTime {0.5 * math.sqrt(L / parts.GRAVITY):.9g};"
    s.forced = True
    s.what.append(kind)
    return s.structures[0]


def _line(s, k, body, mover):
    """Unstretched at the start: it holds no energy then. Stiff enough for the energy that there is to stretch it by a twentieth to all of the tank's width."""
    kind, end = parts.pick(s.rng, "tether", "tether", "linearSpring"), parts.pick(s.rng, "none", "point", "point", "body", "body", "mover")
    if end == "none" or (end == "body" and k == 0) or (end == "mover" and not mover):
        return
    place = lambda x: x + np.array([s.slant * x[1], 0, 0])      # noqa: E731
    other = s.bodies[k - 1].position if end == "body" else mover.position if end == "mover" else \
        np.array([s.rng.uniform(0, 1), s.rng.uniform(0, s.size[1]), s.size[2] / 2 if s.dim == 2 else s.rng.uniform(0, s.size[2])])
    arm = s.rng.uniform(0, 0.4) * body.thin * np.array([1, 0, 0])
    slack, stretch = parts.pick(s.rng, 1, s.rng.uniform(1, 1.5)), parts.log(s.rng, 0.05, 1)
    share = parts.log(s.rng, 1e-3, 1)       # of critical damping
    breaks = s.rng.rand() < 0.15

    def text(L, speed):
        a, b = place(body.position + arm) * L, place(other) * L
        mass = (body.density + s.rho[0]) * body.volume * L**3
        stiffness = mass * (speed / (stretch * L))**2
        ends = {"body": f"otherBody body{k - 1}; otherRefAttachmentPt", "mover": "anchorStructure structure0; anchor"}.get(end, "anchor")
        length = f"{'length' if kind == 'tether' else 'restLength'} {np.linalg.norm(a - b) * (slack if kind == 'tether' else 1):.9g};"
        return (f"line{k} {{ type {kind}; body body{k}; refAttachmentPt ({a[0]:.9g} {a[1]:.9g} {a[2]:.9g}); {ends} ({b[0]:.9g} {b[1]:.9g} {b[2]:.9g}); {length} "
                f"stiffness {stiffness:.6g}; damping {2 * share * math.sqrt(stiffness * mass):.6g}; {f'breakingForce {0.5 * stiffness * stretch * L:.6g};' * breaks} }}")
    s.restraints.append(text)
    s.what.append(f"{kind} to {end}")
