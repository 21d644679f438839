# SPDX-License-Identifier: GPL-3.0-or-later
"""Bars that pile up and rock on each other in a flow. Lengths in units of the tank's width, as in parts.py."""
import math

import numpy as np
import parts


def jam(s):
    """3D: bars of 3 to 5 elements a side at a rack of pipes, in a corner, or stacked in shallow water."""
    _mesh(s)
    s.maxBodyCo, s.contact = 3, "restitution 0.2; frictionAngle 30;"
    kind = parts.pick(s.rng, _channel, _channel, _corner, _stack)
    kind(s)
    s.what.append(kind.__name__[1:])


def _mesh(s):
    """Cubes: bars are as many elements thick in any direction. Narrow and long, or wide and short."""
    rng = s.rng
    s.dim, s.ratio = 3, [1, 1, 1]
    y, z = rng.randint(14, 19), parts.pick(rng, rng.randint(14, 43), rng.randint(30, 43))
    s.cells = [int(np.clip(rng.uniform(9000, 17000) / (y * z), 24, 48)), y, z]
    s.size = np.array(s.cells) / s.cells[0]
    s.length = parts.log(rng, 0.003, 0.01) * s.cells[0]
    s.moved = parts.pick(rng, 0, 0, 0.1)
    s.walls = parts.pick(rng, "slip", "slip", "noSlip")
    s.gravity = np.array([0, -parts.GRAVITY, 0.0])
    s.maxCo = rng.uniform(1, 2)
    s.duration = (15, 20)


def _tilt(s, slope):
    s.gravity = parts.GRAVITY * np.array([slope, -1, 0.0]) / math.hypot(slope, 1)


def _channel(s):
    """A stream through a rack of pipes."""
    s.forced = True
    _tilt(s, s.rng.uniform(0, 0.3))
    s.inflowDepth = s.rng.uniform(0.4, 0.6) * s.size[1]
    s.inflow = s.rng.uniform(0.5, 1.5) * math.sqrt(s.inflowDepth)
    s.liquid.append((parts.below(s.inflowDepth), np.array([s.inflow, 0, 0])))
    end = s.rng.uniform(0.65, 0.8)
    _rack(s, end)
    _bars(s, (0, end - 2.5 / s.cells[0]), (0.3 * s.inflowDepth, s.size[1]))


def _corner(s):
    """Water and bars run down a slope to a wall, or to a rack in front of it."""
    _tilt(s, s.rng.uniform(0.3, 1))
    level = s.rng.uniform(0.15, 0.35) * s.size[1]
    s.liquid.append((parts.below(level), np.zeros(3)))
    end = parts.pick(s.rng, 1, 0.8)
    if end < 1:
        _rack(s, end)
    _bars(s, (0, end - 2.5 / s.cells[0]), (0, s.size[1]))


def _stack(s):
    """Bars fall on each other into water about as deep as they are thick."""
    s.liquid.append((parts.below(s.rng.uniform(2, 8) / s.cells[0]), np.zeros(3)))
    _tilt(s, s.rng.uniform(0, 0.2))
    _bars(s, (0, 1), (0, s.size[1]))


def _rack(s, x):
    """Upright pipes across the flow; gaps less than a bar's thickness."""
    h = 1 / s.cells[0]
    d, gap = s.rng.uniform(3, 5) * h, s.rng.uniform(2, 3) * h
    n = max(1, int((s.size[2] - 0.5 * gap) / (d + gap)))
    high, wall = 0.6 * s.size[1], parts.pick(s.rng, "slip", "noSlip")
    for i in range(n):
        z = 0.5 * s.size[2] + (i - 0.5 * (n - 1)) * (d + gap)
        text = lambda L: (f"type cylinder; end1 (0 {-high * L:.9g} 0); end2 (0 {high * L:.9g} 0); "      # noqa: E731
                          f"radius {0.5 * d * L:.9g};")
        s.structures.append(parts.Solid(f"pipe{i}", text, np.array([x, 0.5 * s.size[1], z]), 0.5 * d, d, entries=f"wall {wall};"))


def _bars(s, x, y):
    """5 to 10 bars, where there is room, with centres between these places, half of them let go later."""
    wanted, tries = s.rng.randint(5, 11), 3000
    boxes, gap = [], 0.3 / s.cells[0]
    for _ in range(wanted):
        half = _halfSizes(s)
        for left in np.linspace(1, 0, tries):
            box = _Box(s.rng, half, left, [s.rng.uniform(*x), s.rng.uniform(*y), s.rng.uniform(0, s.size[2])])
            if box.isBetween([x[0], 0, 0], [x[1], *s.size[1:]], gap) and not any(box.touches(o, gap) for o in boxes):
                boxes.append(box)
                s.bodies.append(_bar(s, box))
                break


def _halfSizes(s):
    """Square or rectangular section, 3 to 10 sides long, but shorter than the tank is wide."""
    a = s.rng.uniform(3, 5)
    b = parts.pick(s.rng, a, a, s.rng.uniform(3, 5))
    longest = 0.85 * s.cells[2]
    return 0.5 * np.array([a, b, min(a * s.rng.uniform(3, 10), max(longest, 3 * a))]) / s.cells[0]


def _bar(s, box):
    a, b, c = 2 * box.half
    text = lambda L: f"type box; size ({a * L:.9g} {b * L:.9g} {c * L:.9g});"       # noqa: E731
    body = parts.Solid(f"bar{len(s.bodies)}", text, box.centre, float(np.linalg.norm(box.half)), min(a, b), a * b * c,
                       angle=box.angle, axis=box.axis, density=s.rho[0] * s.rng.uniform(0.4, 0.9))
    body.velocity = np.array([s.inflow, 0, 0])
    body.release = parts.pick(s.rng, 0, s.rng.uniform(0, 4))
    return body


class _Box:
    """Turned mostly about the vertical: across the tank, some along it. `turned`: by how much, 1 to 0, as room is left."""

    def __init__(self, rng, half, turned, centre):
        self.half, self.centre = half, np.array(centre)
        self.axis = tuple((np.array([0, 1, 0]) + 0.05 * turned * rng.normal(size=3)).round(3))
        self.angle = rng.normal(0, 10) * turned + parts.pick(rng, 0, 0, 0, 90)
        self.axes = _rotation(np.array(self.axis), math.radians(self.angle))     # columns: the box's own axes

    def _extent(self, n):
        """Half of its extent along n."""
        return np.abs(n @ self.axes) @ self.half

    def isBetween(self, low, high, margin):
        reach = np.abs(self.axes) @ self.half + margin
        return (self.centre - reach > low).all() and (self.centre + reach < high).all()

    def touches(self, other, margin):
        """By the axes that may separate two boxes."""
        edges = [np.cross(a, b) for a in self.axes.T for b in other.axes.T]
        for n in [*self.axes.T, *other.axes.T, *edges]:
            length = np.linalg.norm(n)
            if length > 1e-6 and abs(n @ (self.centre - other.centre)) > self._extent(n) + other._extent(n) + margin * length:
                return False
        return True


def _rotation(axis, angle):
    """Rodrigues' formula."""
    n = axis / np.linalg.norm(axis)
    k = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
