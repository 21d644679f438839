# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies and structures of many shapes: logs with root wads and branches, crates, concave and convex polyhedra, decks on piers.
Lengths in units of the tank's width, as in parts.py."""
import math

import numpy as np
import parts

DENSITY = (0.3, 1.3)        # of the liquid's


def shapes(s):
    """3D: up to eleven such bodies in a dam break, in a stream, or dropped into a pool, mostly with a structure."""
    _mesh(s)
    kind = parts.pick(s.rng, _damBreak, _stream, _pool)
    kind(s)
    s.what.append(kind.__name__[1:])


def _mesh(s):
    rng = s.rng
    s.dim, s.ratio = 3, [1, 1, 1]
    s.cells = [rng.randint(24, 34), rng.randint(12, 18), rng.randint(12, 18)]
    s.size = np.array(s.cells) / s.cells[0]
    s.length = parts.log(rng, 0.2, 10)
    s.moved = parts.pick(rng, 0, 0, 0.15)
    s.walls = parts.pick(rng, "slip", "noSlip")
    s.gravity = np.array([0, -parts.GRAVITY, 0.0])
    s.maxCo = parts.pick(rng, 0.5, 1, 2)
    s.duration = (4, 6)


def _damBreak(s):
    width, level = s.rng.uniform(0.3, 0.45), s.rng.uniform(0.5, 0.85) * s.size[1]
    s.liquid.append((parts.box(-1, width, -1, level), np.zeros(3)))
    if s.rng.rand() < 0.4:
        s.liquid.append((parts.below(0.1 * s.size[1]), np.zeros(3)))
    _structure(s, s.rng.uniform(0.65, 0.75))
    _bodies(s, lambda: [s.rng.uniform(0, 0.55), s.rng.uniform(0, s.size[1]), s.rng.uniform(0, s.size[2])])


def _stream(s):
    s.forced = True
    slope = s.rng.uniform(0, 0.2)
    s.gravity = parts.GRAVITY * np.array([slope, -1, 0.0]) / math.hypot(slope, 1)
    s.inflowDepth = s.rng.uniform(0.4, 0.6) * s.size[1]
    s.inflow = s.rng.uniform(0.3, 1.2) * math.sqrt(s.inflowDepth)
    s.liquid.append((parts.below(s.inflowDepth), np.array([s.inflow, 0, 0])))
    _structure(s, s.rng.uniform(0.6, 0.7))
    for body in _bodies(s, lambda: [s.rng.uniform(0, 0.45), s.inflowDepth * s.rng.uniform(0.5, 1.3), s.rng.uniform(0, s.size[2])]):
        body.velocity = np.array([s.inflow, 0, 0])


def _pool(s):
    s.openTop = s.rng.rand() < 0.5
    level = parts.pool(s, level=(0.2, 0.6))
    if s.rng.rand() < 0.5:
        _structure(s, s.rng.uniform(0.4, 0.6))
    for body in _bodies(s, lambda: [s.rng.uniform(0, 1), s.rng.uniform(0.7 * level, s.size[1]), s.rng.uniform(0, s.size[2])]):
        parts.throw(s, body, s.rng.uniform(0, 1), s.rng.uniform(0, 0.3) / body.radius)


def _bodies(s, where):
    made = []
    for _ in range(s.rng.randint(5, 12)):
        h = 1 / s.cells[0]
        text, radius, thin, volume = parts.pick(s.rng, *BODIES)(s, s.rng.uniform(1, 2.5) * h, s.rng.uniform(3.5, 8) * h)
        for _ in range(300):
            x = np.array(where())
            isClear = all(abs(x[0] - o.position[0]) > radius + o.radius for o in s.structures)     # they go across the tank
            if not isClear or not parts.fits(s, x, radius, 0, 1e9):
                continue
            body = parts.Solid(f"body{len(s.bodies)}", text, x, radius, thin, volume, angle=s.rng.uniform(-180, 180),
                               axis=tuple(s.rng.normal(size=3).round(3)), density=s.rho[0] * s.rng.uniform(*DENSITY))
            s.bodies.append(body)
            made.append(body)
            break
    return made


# --- bodies: (text, radius around, thinnest, volume) from a thickness and a length ----------------------------------------

def _union(*pieces):
    return lambda L: "type union; parts { " + " ".join(f"p{k} {{ {p(L)} }}" for k, p in enumerate(pieces)) + " }"


def _round(kind, a, b, radius):
    """From a to b."""
    return lambda L: f"type {kind}; end1 {_vector(a, L)}; end2 {_vector(b, L)}; radius {radius * L:.9g};"


def _box(size, centre=(0, 0, 0)):
    return lambda L: f"type box; size {_vector(size, L)}; centre {_vector(centre, L)};"


def _ball(centre, radius):
    return lambda L: f"type sphere; radius {radius * L:.9g}; centre {_vector(centre, L)};"


def _vector(v, L):
    return "(" + " ".join(f"{x * L:.9g}" for x in v) + ")"


def rootWad(s, t, l):
    r = t / 2
    wad = s.rng.uniform(1.8, 2.5) * r
    text = _union(_round("cylinder", (-l / 2, 0, 0), (l / 2, 0, 0), r), _round("cylinder", (l / 2 - t, 0, 0), (l / 2, 0, 0), wad))
    return text, math.hypot(l / 2, wad), t, math.pi * (r**2 * l + (wad**2 - r**2) * t)


def branches(s, t, l):
    r, arm = t / 2, 0.3 * l
    pieces = [_round("capsule", (-l / 2, 0, 0), (l / 2, 0, 0), r)]
    for _ in range(s.rng.randint(1, 4)):
        at, up, turn = s.rng.uniform(-0.4, 0.4) * l, s.rng.uniform(0.3, 1.2), s.rng.uniform(0, 2 * math.pi)
        tip = (at + arm * math.cos(up), arm * math.sin(up) * math.cos(turn), arm * math.sin(up) * math.sin(turn))
        pieces.append(_round("capsule", (at, 0, 0), tip, 0.7 * r))
    return _union(*pieces), 0.75 * l + r, 1.4 * r, math.pi * r**2 * (l + 0.5 * arm * (len(pieces) - 1))


def jack(_s, t, l):
    text = _union(_box((l, t, t)), _box((t, l, t)), _box((t, t, l)))
    return text, math.hypot(l, 1.5 * t) / 2, t, 3 * t * t * l


def crate(s, t, l):
    """A box without a lid."""
    l = 0.7 * l
    t = min(t, 0.25 * l)
    high = s.rng.uniform(0.4, 0.8) * l
    w, side = (l - t) / 2, 0.5 * (high + t)
    pieces = [_box((l, t, l))] + [_box((t, high, l), (x, side - t / 2, 0)) for x in (-w, w)] + [_box((l, high, t), (0, side - t / 2, z)) for z in (-w, w)]
    return _union(*pieces), math.hypot(l / math.sqrt(2), high), t, t * l * (l + 4 * high)


def dumbbell(s, t, l):
    r = s.rng.uniform(0.8, 1.3) * t
    a = max(l / 2 - r, 0.3 * r)
    text = _union(_ball((-a, 0, 0), r), _ball((a, 0, 0), r), _round("cylinder", (-a, 0, 0), (a, 0, 0), t / 2))
    return text, a + r, t, 8 / 3 * math.pi * r**3 + math.pi * t**2 / 4 * max(0, 2 * a - 2 * r)


def disc(_s, t, l):
    r = 0.3 * l
    return _round("cylinder", (-t / 2, 0, 0), (t / 2, 0, 0), r), math.hypot(r, t), min(t, 2 * r), math.pi * r**2 * t


def polyhedron(s, _t, l):
    """An icosahedron, or an octahedron, of three half axes."""
    g = (1 + math.sqrt(5)) / 2
    points, faces = parts.pick(s.rng, (
        [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)],
        [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
         (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]),
        ([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)],
         [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]))
    points = np.array(points) / np.linalg.norm(points[0])
    half = 0.4 * l * np.array([1, s.rng.uniform(0.6, 1), s.rng.uniform(0.6, 1)])
    return _stl(s, points * half, faces), half.max(), 1.2 * half.min(), 2.5 * half.prod()


def angle(s, t, l):
    """An L-shaped profile, concave."""
    a, b = 0.6 * l, min(max(t, 0.15 * l), 0.25 * l)
    outline = np.array([(b, b), (b, a), (0, a), (0, 0), (a, 0), (a, b)]) - 0.3 * a       # from the re-entrant corner on, which sees all others
    deep = s.rng.uniform(0.4, 1) * a / 2
    n = len(outline)
    points = [(x, y, z) for z in (-deep, deep) for x, y in outline]
    faces = [(0, k + 1, k) for k in range(1, n - 1)] + [(n, n + k, n + k + 1) for k in range(1, n - 1)]
    faces += [f for k in range(n) for m in [(k + 1) % n] for f in ((k, m, m + n), (k, m + n, k + n))]
    return _stl(s, np.array(points), faces), math.hypot(a, deep), b, (2 * a - b) * b * 2 * deep


def _stl(s, points, faces):
    """A file in units of the tank's width."""
    name = f"shape{len(s.files)}.stl"
    volume = sum(np.dot(points[a], np.cross(points[b], points[c])) for a, b, c in faces)
    assert abs(volume) > 0, name
    if volume < 0:
        faces = [face[::-1] for face in faces]
    rows = [f"solid {name}"]
    for face in faces:
        rows.append("facet normal 0 0 0\nouter loop")
        rows += [f"vertex {points[k][0]:.12g} {points[k][1]:.12g} {points[k][2]:.12g}" for k in face]
        rows.append("endloop\nendfacet")
    s.files[f"constant/triSurface/{name}"] = "\n".join([*rows, f"endsolid {name}"]) + "\n"
    return lambda L: f"type stl; file \"{name}\"; scale {L:.9g};"


BODIES = (rootWad, rootWad, branches, branches, jack, crate, dumbbell, disc, polyhedron, polyhedron, angle)


# --- structures -----------------------------------------------------------------------------------------------------------

def _structure(s, x):
    kind = parts.pick(s.rng, _none, _deck, _pier, _sill, _grille)
    kind(s, x)
    s.what.append(kind.__name__[1:])


def _none(_s, _x):
    pass


def _put(s, text, at, thin, reach):
    """reach: its extent along the tank from its place."""
    s.structures.append(parts.Solid(f"structure{len(s.structures)}", text, np.array(at), reach, thin,
                                    entries=f"wall {parts.pick(s.rng, 'slip', 'noSlip')};"))


def _deck(s, x):
    """A bridge: plate from side to side, on a pier or two that it rests on."""
    h, y = 1 / s.cells[0], s.rng.uniform(0.3, 0.6) * s.size[1]
    t, wide = s.rng.uniform(1, 3) * h, s.rng.uniform(3, 6) * h
    _put(s, _box((wide, t, 1.2 * s.size[2])), [x, y, s.size[2] / 2], t, wide / 2)
    for k in range(s.rng.randint(1, 3)):
        r = s.rng.uniform(1, 2) * h
        _put(s, _round("cylinder", (0, -y, 0), (0, 0.05 * h, 0), r), [x, y - t / 2, s.size[2] * (0.3 + 0.4 * k)], 2 * r, r)


def _pier(s, x):
    """Round-nosed, as high as the tank."""
    h = 1 / s.cells[0]
    r, l = s.rng.uniform(1, 2.5) * h, s.rng.uniform(2, 6) * h
    high = 1.2 * s.size[1]
    nose = _round("cylinder", (-l / 2, -high / 2, 0), (-l / 2, high / 2, 0), r)
    tail = _round("cylinder", (l / 2, -high / 2, 0), (l / 2, high / 2, 0), r)
    _put(s, _union(nose, _box((l, high, 2 * r)), tail), [x, s.size[1] / 2, s.size[2] / 2], 2 * r, l / 2 + r)


def _sill(s, x):
    """A wedge on the bed, as an STL."""
    a, b, w = s.rng.uniform(3, 8) / s.cells[0], s.rng.uniform(1.5, 5) / s.cells[0], 0.6 * s.size[2]
    deep = 0.02
    points = np.array([(px, py, pz) for pz in (-w, w) for px, py in ((-a, -deep), (a, -deep), (0, b))])
    faces = [(0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]
    _put(s, _stl(s, points, faces), [x, 0, s.size[2] / 2], b, a)


def _grille(s, x):
    """Inclined bars with a cross beam that they go through."""
    h = 1 / s.cells[0]
    r, gap = s.rng.uniform(0.5, 1.5) * h, s.rng.uniform(1.5, 3) * h
    lean, high = s.rng.uniform(-0.3, 0.3), 1.3 * s.size[1]
    z = gap / 2 + r
    while z + r < s.size[2]:
        _put(s, _round("cylinder", (-lean * high / 2, -high / 2, 0), (lean * high / 2, high / 2, 0), r), [x, s.size[1] / 2, z], 2 * r, abs(lean) * high / 2 + r)
        z += gap + 2 * r
    _put(s, _box((2.2 * r, 2.2 * r, 1.2 * s.size[2])), [x, s.size[1] / 2, s.size[2] / 2], 2.2 * r, 1.1 * r)
