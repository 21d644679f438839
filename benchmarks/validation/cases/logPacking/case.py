# SPDX-License-Identifier: GPL-3.0-or-later
"""Resistance of a packing of logs, as a dense jam is one, beside Ergun's law of packed beds. N: elements a diameter."""
import os

import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import blockMesh, bodies, control, even, field, fixed, merged, oneFluid

DIAMETER, LENGTH, WIDTH = 0.03, 0.12, 0.24      # of a log, of the box that they are poured into [m]
DUCT = 0.12                                     # side of the duct's section, the middle of the box [m]
SPEED, DENSITY = 0.2, 1000                      # superficial velocity [m/s]
HEIGHT, SLICES = 0.39, 13                       # of the packing, cut into slices of a diameter for its porosity [m]
UPSTREAM, DOWNSTREAM = 4, 5                     # of the duct before and behind the packing [diameters]
POROSITY = 0.52                                 # of the whole packing with its loose ends: of the Reynolds numbers
END, COURANT, LARGEST_STEP = 0.8, {1: 4, 100: 2, 10000: 3}, 0.02    # [s], largest Courant number by Reynolds number, [s]; the flow comes to rest on these meshes

VOLUME, AREA = np.pi / 4 * DIAMETER**2 * LENGTH, np.pi * DIAMETER * (LENGTH + DIAMETER / 2)
SIZE = 6 * VOLUME / AREA                        # diameter of the sphere with a log's volume over its area, as Ergun has it

title = f"""110 logs of {DIAMETER:g} x {LENGTH:g} m poured into a box of {WIDTH:g} x {WIDTH:g} m by our own contact (`cases/logPacking/pour` makes `packing.csv` anew), then fixed, no-slip. A duct of {DUCT:g} x {DUCT:g} m with slip walls goes
through its middle along what was the vertical, mean porosity 0.47 without the ends (0.40 to 0.55 over a diameter); one fluid, superficial velocity {SPEED:g} m/s. Pressure lost: force of the fluid on all logs over the duct's section. Published: gradient
150 mu (1 - e)^2 U/(e^3 d^2) + 1.75 rho (1 - e) U^2/(e^3 d), d = 6 V/A of a log (Ergun 1952, Chem. Eng. Prog. 48, 89, from memory), integrated over slices with their own porosity; a fit to beds of spheres, cylinders and crushed solids
that measured ones follow within some 25 %, long particles rather above. Re = rho U d/(mu (1 - e))."""

runs = [Run("flotsamFoam", n, f"Re {reynolds}", {"Re": reynolds}, quick=n == 3 and reynolds == 100, timeLimit=7200)
        for n in (3, 4, 6) for reynolds in (1, 100, 10000)]


def _ends():
    """Both ends of every log's axis, logs x 2 x 3 [m]: x along the duct, from the floor upward."""
    return np.loadtxt(os.path.join(folder, "packing.csv"), delimiter=",").reshape(-1, 2, 3)      # noqa: F821 (set by the runner)


def _isInside(ends, points):
    inside = np.zeros(len(points), dtype=bool)
    for begin, end in ends:
        axis = (end - begin) / np.linalg.norm(end - begin)
        along = (points - begin) @ axis
        across = points - begin - along[:, None] * axis
        inside |= (np.abs(along - LENGTH / 2) < LENGTH / 2) & ((across**2).sum(1) < DIAMETER**2 / 4)
    return inside


def porosities(ends, count=8000):
    """Of the slices within the duct, by points drawn at random."""
    drawn, edges = np.random.default_rng(0), np.linspace(0, HEIGHT, SLICES + 1)
    points = [np.column_stack([drawn.uniform(low, high, count), *drawn.uniform(-DUCT / 2, DUCT / 2, (2, count))]) for low, high in zip(edges, edges[1:])]
    return 1 - np.array([_isInside(ends, p).mean() for p in points])


def _nu(run):
    return SPEED * SIZE / ((1 - POROSITY) * run.options["Re"])


def pressureLoss(run, ends):
    """By Ergun's law [Pa]."""
    void = porosities(ends)
    viscous, inertial = 150 * DENSITY * _nu(run) * (1 - void)**2 * SPEED / (void**3 * SIZE**2), 1.75 * DENSITY * (1 - void) * SPEED**2 / (void**3 * SIZE)
    return (viscous + inertial).mean() * HEIGHT


def resolution(run):
    return f"{run.variant}, {run.n} a diameter"


def _log(number, ends):
    first, last = (" ".join(f"{x:.9g}" for x in end) for end in ends)
    return f"log{number} {{ shape {{ type cylinder; end1 ({first}); end2 ({last}); radius {DIAMETER / 2}; }} wall noSlip; }}"


def _reachesDuct(ends):
    points = ends[0] + np.linspace(0, 1, 100)[:, None] * (ends[1] - ends[0])
    return (np.abs(points[:, 1:]).max(1) < DUCT / 2 + 0.75 * DIAMETER).any()


def files(run, _folder):
    ends, step = _ends(), DIAMETER / run.n
    before, behind = UPSTREAM * run.n, int(np.ceil((HEIGHT + DOWNSTREAM * DIAMETER) / step))
    across = even(-DUCT / 2, DUCT / 2, round(DUCT / step))
    inlet = f"type uniformFixedValue; uniformValue table ((0 (0 0 0)) ({END / 4} ({SPEED} 0 0)) (1000 ({SPEED} 0 0)));"
    return merged(
        blockMesh(even(-before * step, behind * step, before + behind), across, across, {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "sides": ("patch", "y- y+ z- z+")}),
        field("U", {"inlet": inlet, "outlet": "type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);", "sides": "slip"}),
        field("p", {"inlet": "zeroGradient", "outlet": fixed(0), "sides": "zeroGradient"}), oneFluid(_nu(run), DENSITY),
        bodies("structures\n{\n" + "\n".join(_log(i, e) for i, e in enumerate(ends) if _reachesDuct(e)) + "\n}"),
        control(END, 1e-3, maxDeltaT=LARGEST_STEP, maxCo=COURANT[run.options["Re"]]))


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    isLate = history.time > 0.6 * END
    force = sum(history[name].fluidForce[isLate, 0] for name in history.structures)
    steps = history.run["dt"][isLate]
    loss = (force * steps).sum() / steps.sum() / DUCT**2
    return {"comparisons": [relative("pressure lost", loss, pressureLoss(run, _ends()), target=0.25, unit="Pa", source="Ergun 1952"),
                            small("standard deviation of the force over its mean", force.std() / force.mean())]}
