# SPDX-License-Identifier: GPL-3.0-or-later
"""Water at rest on meshes with slanted inner edges: every velocity is an error. N: cells over the length of the tank."""
import glob
import os

import numpy as np

from runner import foam
from runner.cases import Target, series

title = """Water at rest, 0.1 m deep, in a closed tank 0.2 m x 0.15 m, slip walls, to t = 2 s; N cells over the length. The inner edges of the four
blocks are slanted: `slant 0` orthogonal (the surface lies on cell faces), `slant 0.2` 10 degrees, `slant 1` 41 degrees non-orthogonal at most. Every velocity is an error:
shown is the largest in the water (alpha > 0.99) at 2 s, and the largest anywhere during the run. Start field by setAlphaField (exact cell fractions).
On slanted meshes interFoam and interIsoFoam are the rebuilt ones."""
figures = {"waterSpeed": ("largest speed in the water at 2 s", "m/s"), "largestSpeed": ("largest speed anywhere, ever", "m/s"), "volumeError": ("volume drift", "")}
mainError, moreErrors = "waterSpeed", ["largestSpeed"]
targets = [Target("waterSpeed", 1e-5, "speed in the water at rest [m/s]")]


def problem(variant):
    return variant


def slanted(solver, slant, sizes, quick=0):
    return series(solver, sizes, quick=quick, variant=f"slant {slant:g}", options={"slant": slant}, rebuilt=slant > 0)


runs = [
    *slanted("flotsamFoam", 0, [40, 80, 160]),
    *slanted("flotsamFoam", 0.2, [40, 80], quick=1),
    *slanted("flotsamFoam", 1, [40, 80], quick=1),
    *slanted("interFoam", 0, [40, 80, 160]),
    *slanted("interFoam", 0.2, [40], quick=1),
    *slanted("interFoam", 1, [40]),
    *slanted("interIsoFoam", 0, [40, 80]),
    *slanted("interIsoFoam", 0.2, [40], quick=1),
    *slanted("interIsoFoam", 1, [40]),
]


def parameters(run):
    s = run.options["slant"]
    return {"nx": run.n // 2, "ny": 3 * run.n // 8, "maxStep": 0.16 / run.n, "xb": 0.1 - 0.02 * s, "xc": 0.1 + 0.03 * s, "xt": 0.1,
            "yl": 0.075 - 0.015 * s, "yc": 0.075 + 0.015 * s, "yr": 0.075 - 0.005 * s}


def prepare(_run, do):
    do("blockMesh")
    do("setAlphaField")


def _largestEver(case):
    """Of the table of fieldMinMax: magnitudes, with their places in brackets between them."""
    speeds = []
    with open(glob.glob(os.path.join(case, "postProcessing/umax/*/fieldMinMax.dat"))[0], encoding="utf-8") as file:
        for line in file:
            if not line.startswith("#"):
                speeds += [float(x) for x in line.split("\t")[1:] if x.strip() and "(" not in x and x.strip() != "U"]
    return max(speeds)


def errors(_run, case):
    speed = np.linalg.norm(foam.field(os.path.join(case, "2", "U")), axis=1)
    wet = foam.field(os.path.join(case, "2", "alpha.water")) > 0.99
    volume = foam.table(case, "volume/*/*.dat")[:, 1]
    return {"waterSpeed": float(speed[wet].max()), "largestSpeed": _largestEver(case), "volumeError": float(volume[-1] / volume[0] - 1)}
