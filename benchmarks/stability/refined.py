# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that nobody drew for the scene: hanging nodes, prisms, tetrahedra, polyhedra, flat and tall cells, snappyHexMesh; buildings, piers and steps cut out of the mesh, which
bodies hit. Lengths in units of the tank's width, as in parts.py."""
import math

import numpy as np
import parts

ELEMENTS = ("hex", "hex", "hex", "hex", "prism", "tet", "dual", "snap")


def refined(s):
    """2D or 3D: a dam break, a pool or a stream, two to six bodies."""
    s.dim, element = parts.pick(s.rng, 2, 2, 3), parts.pick(s.rng, *ELEMENTS)
    if element in ("tet", "dual", "snap"):
        s.dim = 3
    parts.tank(s, height=(0.45, 0.9), n=(26, 40))
    if s.dim == 3:
        s.cells = [round(1.4 * n) for n in s.cells]
    s.element, s.duration = element, (3, 6)
    s.what.append(element)
    if element in ("dual", "snap"):
        s.moved, s.slant = 0, 0
    s.moved = min(s.moved, 0.15)
    _squeeze(s)
    {"hex": _halve, "snap": _snap}.get(element, lambda _: None)(s)
    if element not in ("snap", "dual") and s.rng.rand() < 0.65:      # polyDualMesh makes cells turned inside out at the blocks' edges
        _blocks(s)
    flow = parts.pick(s.rng, _damBreak, _pool, _stream)
    flow(s)
    s.what.append(flow.__name__[1:])


# --- meshes ---------------------------------------------------------------------------------------------------------------

def _squeeze(s):
    """Cells 4 to 10 times (3D: 6) as wide as tall, or the other way; about as many of them."""
    kind = parts.pick(s.rng, None, None, "flat", "tall") if s.element in ("hex", "prism", "tet") else None
    if not kind:
        return
    aspect = math.sqrt(s.rng.uniform(4, 10 if s.dim == 2 else 6))
    change = 1 / aspect if kind == "flat" else aspect
    x, y, z = np.array(s.cells) * (1 if s.dim == 2 else change**(-1 / 3))
    s.cells = [max(6, round(x * change)), max(6, round(y / change)), 1 if s.dim == 2 else max(4, round(z * change))]
    s.ratio = [1, 1, 1]
    s.what.append(kind)


def _halve(s):
    """One or two boxes or balls of cells halved once or twice, anywhere; in 3D some along two directions alone."""
    if s.rng.rand() < 0.2:
        return
    levels = parts.pick(s.rng, 1, 1, 2)
    for _ in range(s.rng.randint(1, 3)):
        centre = np.array([s.rng.uniform(0.1, 0.9), s.rng.uniform(0, 0.7) * s.size[1], s.rng.uniform(0, 1) * s.size[2]])
        half = s.rng.uniform(0.1, 0.25, size=3) * [1, s.size[1], 2 * s.size[2]]
        if s.dim == 2:
            centre[2], half[2] = 0, 10
        s.halved.append((centre, half, parts.pick(s.rng, "box", "box", "ball"), "tan1 tan2 normal" if s.dim == 3 and s.rng.rand() < 0.7 else "tan1 tan2"))
    s.halved *= levels          # the same places again, somewhat smaller: caseVariants
    s.finer = 0.5**levels
    s.what.append(f"halved {len(s.halved)} times")


def _snap(s):
    """snappyHexMesh around a round pier that leans, cells at it halved once."""
    s.ratio = [1, 1, 1]
    r, lean = s.rng.uniform(0.06, 0.12), s.rng.uniform(-0.15, 0.15)
    foot = np.array([s.rng.uniform(0.5, 0.7), -0.05, s.size[2] * s.rng.uniform(0.4, 0.6)])
    top = foot + np.array([lean, s.size[1] * parts.pick(s.rng, 0.6, 1.3), 0])
    s.snapped, s.finer = (foot, top, r), 0.5
    margin = np.array([r, 0, r])
    s.blocks = [(np.minimum(foot, top) - margin, np.maximum(foot, top) + margin)]
    _wallOfBlocks(s)


def _blocks(s):
    """One to three boxes of cells that are no mesh: on the bed, below the lid, in the middle, in a corner."""
    s.slant = 0
    for _ in range(s.rng.randint(1, 4)):
        w, high = s.rng.uniform(0.06, 0.2), s.rng.uniform(0.1, 0.5) * s.size[1]
        x = s.rng.uniform(0.4, 0.8)
        y = {"bed": 0, "lid": s.size[1] - high, "middle": s.rng.uniform(0.2, 0.4) * s.size[1]}[parts.pick(s.rng, "bed", "bed", "lid", "middle")]
        deep = s.rng.uniform(0.2, 0.5) * s.size[2] if s.dim == 3 else 10
        z = (parts.pick(s.rng, 0, s.size[2] - deep, s.rng.uniform(0, s.size[2] - deep)) if s.dim == 3 else -5)
        s.blocks.append((np.array([x, y, z]), np.array([x + w, y + high, z + deep])))
    _wallOfBlocks(s)
    s.what.append(f"{len(s.blocks)} blocks")


def _wallOfBlocks(s):
    s.blockWall = parts.pick(s.rng, "slip", "noSlip")
    s.blockType = parts.pick(s.rng, "wall", "wall", "patch")


# --- flows ----------------------------------------------------------------------------------------------------------------

def _damBreak(s):
    s.liquid.append((parts.box(-1, s.rng.uniform(0.2, 0.35), -1, s.rng.uniform(0.5, 0.9) * s.size[1]), np.zeros(3)))
    if s.rng.rand() < 0.5:
        s.liquid.append((parts.below(s.rng.uniform(0.05, 0.25) * s.size[1]), np.zeros(3)))
    _bodies(s, lambda: [s.rng.uniform(0, 0.6), s.rng.uniform(0, s.size[1]), s.rng.uniform(0, s.size[2])], 0.3)


def _pool(s):
    level = parts.pool(s, level=(0.25, 0.6))
    _bodies(s, lambda: [s.rng.uniform(0, 1), s.rng.uniform(0.5 * level, s.size[1]), s.rng.uniform(0, s.size[2])], 1)


def _stream(s):
    parts.stream(s, depth=(0.3, 0.55), froude=(0.3, 1.2))
    for body in _bodies(s, lambda: [s.rng.uniform(0, 0.5), s.inflowDepth * s.rng.uniform(0.5, 1.3), s.rng.uniform(0, s.size[2])], 0):
        body.velocity = np.array([s.inflow, 0, 0])


def _bodies(s, where, thrown):
    """Two to six, density 0.1 to 4, clear of the blocks."""
    made = []
    for _ in range(s.rng.randint(2, 9)):
        body = parts.body(s, elements=(2.5, 6), where=lambda r: clear(s, where, r))
        if body:
            body.density = s.rho[0] * parts.log(s.rng, 0.1, 4)
            parts.throw(s, body, s.rng.uniform(0, thrown), s.rng.uniform(0, 0.3 * thrown) / body.radius)
            made.append(body)
    return made


def clear(s, where, r):
    """A place farther than a cell and r from all blocks; outside where there is none."""
    for _ in range(20):
        x = np.array(where())
        gaps = [np.linalg.norm((np.maximum(np.maximum(low - x, x - high), 0))[:s.dim]) for low, high in s.blocks]
        if all(gap > r + parts.cell(s) for gap in gaps):
            return x
    return np.full(3, -1.0)
