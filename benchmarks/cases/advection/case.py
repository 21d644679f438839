# SPDX-License-Identifier: GPL-3.0-or-later
"""Transport of the free surface alone: reversed vortex (T = 8) and Zalesak's disc. N: cells over the side of the unit square."""
import os
import re

import numpy as np

from runner import foam
from runner.cases import Run, Target, series

OURS, WIDTH = "transportTable", "0.20"     # the default interfaceWidth

title = """Prescribed velocity: Rider & Kothe's vortex, reversed by cos(pi t/8), disc of radius 0.15; one turn of Zalesak's slotted disc. N cells over the unit
square, Courant number 0.5. Error: integral of |alpha - alpha at the start| over the disc's area. Ours: `transportTable`, the transport of flotsamFoam
in a program of its own, default parameters, triangles with nodes moved by 0.15 cells; its CPU time is that of the time loop. Peers: interFoam and interIsoFoam with `frozenFlow`
on squares (the function object setFlow, which prescribes the velocity, is part of their time); `explicit`: MULES without corrector at Courant number 0.25."""
figures = {"vortexError": ("vortex T = 8, shape error", ""), "zalesakError": ("Zalesak, shape error", ""), "volumeError": ("volume drift", ""),
           "lowest": ("smallest alpha", ""), "above": ("largest alpha - 1", "")}
mainError, moreErrors = "vortexError", ["zalesakError"]
targets = [Target("vortexError", 0.25, "vortex T = 8", 64), Target("vortexError", 0.07, "vortex T = 8", 128), Target("vortexError", 0.12, "vortex T = 8, stricter", 64),
           Target("vortexError", 0.03, "vortex T = 8, stricter", 128), Target("zalesakError", 0.06, "Zalesak", 64)]
EXPLICIT = {"courant": 0.25, "mulesCorr": "no"}


def test(name, solver, sizes, variant="", quick=0, **options):
    return series(solver, sizes, quick=quick, variant=(name + " " + variant).strip(), options={"test": name, **options})


def ours(name, sizes):
    return [Run(OURS, n, name, {"test": name, "arguments": [str(n), "no", "0.5", WIDTH]}, quick=n <= 64) for n in sizes]


runs = [
    *ours("vortex", [32, 64, 128]),
    *test("vortex", "interIsoFoam", [32, 64, 128], quick=2),
    *test("vortex", "interFoam", [32, 64, 128], quick=2),
    *test("vortex", "interFoam", [128], "explicit", **EXPLICIT),
    *ours("zalesak", [32, 64, 128]),
    *test("zalesak", "interIsoFoam", [40, 80, 160], quick=2),
    *test("zalesak", "interFoam", [40, 80, 160], quick=2),
    *test("zalesak", "interFoam", [80], "explicit", **EXPLICIT),
]


def _length(run):
    """(end time, steps)."""
    courant = run.options.get("courant", 0.5)
    return (8, round(8 * run.n / courant)) if run.options["test"] == "vortex" else (1, round(2.5 * run.n / courant))


def parameters(run):
    end, steps = _length(run)
    # setFlow acts at the end of a step, so that the velocity lags by one: the sine's phase is that of the middle of the step
    return {"n": run.n, "endTime": end, "steps": steps, "maxStep": end / steps, "sineStart": -4 - end / steps / 2,
            "mulesCorr": run.options.get("mulesCorr", "yes")}


def prepare(run, do):
    if run.solver == OURS:
        return
    do("cp", "system/setVelocity." + run.options["test"], "system/setVelocity")
    do("blockMesh")
    do(run.solver, "-postProcess", "-time", "0")        # 0/U and 0/phi: else the first step would have no velocity
    do("setAlphaField")
    if run.options["test"] == "zalesak":
        do("setFields")
    do("cp", "0/alpha.water", "alpha.start")


def _ours(run, case):
    with open(os.path.join(case, "log.solver"), encoding="utf-8") as log:
        name = "zalesak" if run.options["test"] == "zalesak" else "vortex T=8"
        line = [x for x in log if x.startswith(name) and re.search(rf"n +{run.n} delta {WIDTH}", x)][-1]
    values = re.search(r"error ([\d.]+) mass (\S+) .*alpha \[(\S+), 1(\S+)\].*\| ([\d.]+) us/node/step, (\d+) steps", line).groups()
    error, mass, lowest, above, pace, steps = (float(v) for v in values)
    nodes = (run.n + 1)**2
    return {run.options["test"] + "Error": error, "volumeError": mass, "lowest": lowest, "above": above, "steps": int(steps), "nodes": nodes,
            "cpu": pace * 1e-6 * nodes * steps}


def errors(run, case):
    if run.solver == OURS:
        return _ours(run, case)
    start, end = foam.field(os.path.join(case, "alpha.start")), foam.field(os.path.join(case, f"{_length(run)[0]}", "alpha.water"))
    return {run.options["test"] + "Error": float(np.abs(end - start).sum() / start.sum()), "volumeError": float(end.sum() / start.sum() - 1),
            "lowest": float(end.min()), "above": float(end.max() - 1)}
