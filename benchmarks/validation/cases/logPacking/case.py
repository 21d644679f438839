# SPDX-License-Identifier: GPL-3.0-or-later
"""Resistance of a packing of logs, as a dense jam is one, beside Ergun's law of packed beds. N: elements a diameter."""
import os

import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import blockMesh, bodies, control, even, field, fixed, merged, oneFluid

DIAMETER, LENGTH, WIDTH = 0.03, 0.12, 0.24      # of a log, of the square duct [m]; `pour` has the same
SPEED, DENSITY = 0.2, 1000                      # superficial velocity [m/s]
RAMP = 0.5                                      # [s] until the stream is let in
BEGIN, END = 0.06, 0.27                         # of the part of the packing that is evaluated [m]: without its loose ends
UPSTREAM, DOWNSTREAM = 4, 6                     # of the duct before and behind the packing [diameters]
LASTS = {1: 0.8, 100: 0.8, 10000: 2.0}          # [s], by Reynolds number; means over the last 40 %

VOLUME, AREA = np.pi / 4 * DIAMETER**2 * LENGTH, np.pi * DIAMETER * (LENGTH + DIAMETER / 2)
SIZE = 6 * VOLUME / AREA                        # diameter of the sphere with a log's volume over its area, as Ergun has it

title = f"""110 logs of {DIAMETER:g} x {LENGTH:g} m, poured into a box of {WIDTH:g} x {WIDTH:g} m by our own contact (`cases/logPacking/pour` makes `packing.csv` anew), then fixed, no-slip, in a duct of that section with slip walls,
one fluid, superficial velocity {SPEED:g} m/s along what was the vertical. Of the layer from {BEGIN:g} to {END:g} m above the floor, porosity 0.524: force of the fluid on the logs (each by the share of its axis within) over the layer's
volume, that is the pressure gradient G; friction factor f = G d e^3/(rho U^2 (1 - e)), d = 6 V/A of a log. Published: f = 150/Re + 1.75, Re = rho U d/(mu (1 - e)) (Ergun 1952, Chem. Eng. Prog. 48, 89), a fit to beds of spheres, cylinders
and crushed solids, from memory; measured beds lie within some 25 % of it, those of cylinders rather above, walls let some 10 % more through here (6 d across)."""

runs = [Run("flotsamFoam", n, f"Re {reynolds}", {"Re": reynolds}, quick=n == 3 and reynolds == 100, timeLimit=7200)
        for n in (3, 4, 6) for reynolds in (1, 100, 10000)]


def _ends():
    """Both ends of every log's axis, logs x 2 x 3 [m]: x along the duct, from the floor upward."""
    return np.loadtxt(os.path.join(folder, "packing.csv"), delimiter=",", comments="#").reshape(-1, 2, 3)      # noqa: F821 (set by the runner)


def _isInside(ends, points):
    inside = np.zeros(len(points), dtype=bool)
    for begin, end in ends:
        axis = (end - begin) / np.linalg.norm(end - begin)
        along = (points - begin) @ axis
        across = points - begin - along[:, None] * axis
        inside |= (np.abs(along - LENGTH / 2) < LENGTH / 2) & ((across**2).sum(1) < DIAMETER**2 / 4)
    return inside


def porosity(ends, count=400_000):
    """Of the layer, by points drawn at random (error 0.001)."""
    drawn = np.random.default_rng(0)
    points = np.column_stack([drawn.uniform(BEGIN, END, count), *drawn.uniform(-WIDTH / 2, WIDTH / 2, (2, count))])
    return 1 - _isInside(ends, points).mean()


def resolution(run):
    return f"{run.variant}, {run.n} a diameter"


def _log(number, ends):
    first, last = (" ".join(f"{x:.9g}" for x in end) for end in ends)
    return f"log{number} {{ shape {{ type cylinder; end1 ({first}); end2 ({last}); radius {DIAMETER / 2}; }} wall noSlip; }}"


def files(run, _folder):
    ends, step, reynolds = _ends(), DIAMETER / run.n, run.options["Re"]
    nu = SPEED * SIZE / ((1 - porosity(ends)) * reynolds)
    before, behind = UPSTREAM * run.n, int(np.ceil((ends[:, :, 0].max() + DOWNSTREAM * DIAMETER) / step))
    across = even(-WIDTH / 2, WIDTH / 2, round(WIDTH / step))
    inlet = f"type uniformFixedValue; uniformValue table ((0 (0 0 0)) ({RAMP} ({SPEED} 0 0)) (1000 ({SPEED} 0 0)));"
    return merged(
        blockMesh(even(-before * step, behind * step, before + behind), across, across, {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("patch", "y- y+ z- z+")}),
        field("U", {"inlet": inlet, "outlet": "type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);", "sides": "slip"}),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient"}), oneFluid(nu, DENSITY),
        bodies("structures\n{\n" + "\n".join(_log(i, e) for i, e in enumerate(ends)) + "\n}"),
        control(LASTS[reynolds], 1e-3, maxDeltaT=0.02, maxCo=1))


def parameters(_run):
    return {}


def prepare(_run, do):
    do("blockMesh")


def _share(ends, count=200):
    """Of a log's axis, between BEGIN and END."""
    x = ends[0, 0] + (ends[1, 0] - ends[0, 0]) * (np.arange(count) + 0.5) / count
    return ((x > BEGIN) & (x < END)).mean()


def errors(run, case):
    history, ends = foam.history(root, case), _ends()      # noqa: F821 (root is set by the runner)
    isLate = history.time > 0.6 * LASTS[run.options["Re"]]
    force = sum(_share(e) * history[f"log{i}"].fluidForce[isLate, 0] for i, e in enumerate(ends))
    steps = history.run["dt"][isLate]
    mean, void = (force * steps).sum() / steps.sum(), porosity(ends)
    factor = mean / (WIDTH**2 * (END - BEGIN)) * SIZE * void**3 / (DENSITY * SPEED**2 * (1 - void))
    return {"comparisons": [relative("friction factor", factor, 150 / run.options["Re"] + 1.75, target=0.25, source="Ergun 1952"),
                            small("standard deviation of the force over its mean", force.std() / mean)]}
