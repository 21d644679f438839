# SPDX-License-Identifier: GPL-3.0-or-later
"""Bars that a steady current presses against two pipes: case of one bar and of two, one pinned on the other.

Seen from above, 2D, one layer 0.1 m thick; bars 0.02 m x 0.06 m broadside to 0.1 m/s, nu = 2e-4 m2/s (Re = 30 by the length), pipes of 0.02 m at y = +-0.02 m.
Run `held`: free bars, almost touching at the start, carried against the pipes; run `fixed`: the bars held where they came to rest. A bar at rest hands all its drag on.
"""
import os

import numpy as np

from runner import foam
from runner.cases import Run

from .compare import relative, small
from .files import around, blockMesh, bodies, control, even, field, fixed, merged, oneFluid

THICK, END, LAST = 0.02, 6.0, 1.0
PIPES = {"left": 0.02, "right": -0.02}
# Between the centres of neighbours at the start [m]. A gap of 0.1 mm: from 1 mm on the water between two bars leaves so slowly that the second one slides
# off along it before it touches, or not, by where it starts to a tenth of a millimetre
START = 0.0201


def runs(sizes):
    return [Run("flotsamFoam", n, kind, quick=n == sizes[0], timeLimit=2400) for n in sizes for kind in ("held", "fixed")]


def _pipes(facets):
    return "\n".join(f"    {name} {{ shape {{ type cylinder; end1 (0 {y} -0.01); end2 (0 {y} 0.11); radius 0.01; }} {facets} wall noSlip; }}" for name, y in PIPES.items())


def _text(places):
    """constant/bodies; places: entries of each bar's place."""
    bars = "\n".join(f"""    {name}
    {{
        shape       {{ type box; size (0.02 0.06 0.1); }}
        spheres     {{ radius 0.005; spacing 0.005; }}
        density     800;
        {place}
    }}""" for name, place in places.items())
    return f"""contact {{ default {{ stiffness 1e6; restitution 0.2; frictionAngle 30; }} }}
wallPatches none;
structures
{{
{_pipes('facetSize 0.002;')}
}}
bodies
{{
{bars}
}}"""


def _freePlaces(names):
    return {name: f"position ({-START * (i + 1):.6g} 0 0.05);" for i, name in enumerate(names)}


def _heldPlaces(root, names, heldFolder):
    """Where the free ones came to rest, held there: with the same pressure between bars and pipes, which structures that touch do not have."""
    if not os.path.isdir(heldFolder):
        raise RuntimeError("needs the run `held` of the same N, kept (--keep) or in the same call")
    history = foam.history(root, heldFolder)
    places = {}
    for name in names:
        x, y, z = history.mean(name, "position", END - LAST)
        q = history.mean(name, "orientation", END - LAST)
        angle = np.degrees(2 * np.arctan2(q[3], q[0]))
        places[name] = f"position ({x:.9g} {y:.9g} {z:.9g}); orientation {{ axis (0 0 1); angleDeg {angle:.9g}; }} releaseTime {10 * END:g};"
    return places


def heldFolder(folder):
    return folder.replace("flotsamFoam-fixed_", "flotsamFoam-held_")


def files(root, names, run, folder):
    h, growth = THICK / run.n, 1 + 1 / run.n
    upstream = -0.03 * (len(names) + 1)
    aside = 0.37 * h    # no face of a bar on nodes: where the last digit of its place decides which bar has them
    x = around(-0.15, upstream + aside, 0.06 + aside, 0.35, h, growth)
    y = around(-0.1, -0.05 + aside, 0.05 + aside, 0.1, h, growth)
    places = _freePlaces(names) if run.variant == "held" else _heldPlaces(root, names, heldFolder(folder))
    return merged(
        blockMesh(x, y, even(0, 0.1, 1), {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("wall", "y- y+"), "frontAndBack": ("empty", "z- z+")}),
        field("U", {"inlet": fixed("(0.1 0 0)"), "outlet": "zeroGradient", "sides": "slip", "frontAndBack": "empty"}, "(0.1 0 0)"),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient", "frontAndBack": "empty"}), oneFluid(2e-4, 1000),
        bodies(_text(places)), control(END, 0.002, maxCo=1, maxDeltaT=0.02))


def _x(history, name, quantity):
    return history.mean(name, quantity, history.time[-1] - LAST)[0]


def errors(root, names, run, folder):
    """What a bar hands on: the sum of the drags of those upstream of it and its own."""
    held = foam.history(root, heldFolder(folder))
    drag = [_x(held, n, "fluidForce") for n in names]
    onPipes = sum(_x(held, p, "contactForce") for p in PIPES)
    pressing = [sum(_x(held, n, "contactForce") for n in names[i:]) for i in range(len(names))]      # on bar i from downstream
    late = held.time >= held.time[-1] - LAST
    if run.variant == "held":
        found = [relative(f"force handed on by bar {i + 1}", -pressing[i], sum(drag[i:]), 0.01, "N", "drags of the bars at rest") for i in range(len(names))]
        found.append(relative("contact force on the pipes", onPipes, -pressing[0], 0.001, "N", "reaction"))
        found.append(small("largest speed in the last second", max(np.abs(held[n].velocity[late]).max() for n in names), 1e-3, "m/s", "at rest"))
        spread = np.std(-sum(held[n].contactForce[late, 0] for n in names)) / onPipes
        found.append(small("unsteadiness of the contact force, rms over mean", spread, 0.01))
        return {"comparisons": found}
    still = foam.history(root, folder)
    fixedDrag = [_x(still, n, "fluidForce") for n in names]
    found = [relative("contact force on the pipes against the drag of fixed bars", onPipes, sum(fixedDrag), 0.01, "N", "same bars fixed")]
    if len(names) > 1:
        found.append(relative("contact force between the bars against the drag of the fixed bar", -pressing[1], fixedDrag[1], 0.01, "N", "same bars fixed"))
    return {"comparisons": found}
