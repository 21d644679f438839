# SPDX-License-Identifier: GPL-3.0-or-later
"""Transport of the free surface alone: reversed vortex (T = 8, 2, 4), Zalesak's disc, reversed deformation in 3D. N: cells over a side of
the unit square or cube."""
import os
import re

import numpy as np

from runner import foam
from runner.cases import Run, Target, series

OURS, WIDTH = "transportTable", "0.20"     # the default interfaceWidth
OUR_NAME = {"vortex": "vortex T=8", "deformation3D": "deformation 3D"}     # in transportTable, where it is another

title = """Prescribed velocity: Rider & Kothe's vortex, reversed by cos(pi t/T), T = 8 unless said, disc of radius 0.15; one turn of Zalesak's slotted disc;
LeVeque's deformation in 3D, reversed by cos(pi t/3), sphere of radius 0.15. N cells over a side of the unit square or cube, Courant number 0.5. Error: integral of
|alpha - alpha at the start| over the liquid's area or volume. Ours: `transportTable`, the transport of flotsamFoam
in a program of its own, default parameters, triangles and tetrahedra with nodes moved by 0.15 cells (`six meshes`: means over six, moved otherwise); its CPU time is that of the time loop. Peers: interFoam and interIsoFoam with `frozenFlow`
on squares and cubes (the function object setFlow, which prescribes the velocity, is part of their time); `explicit`: MULES without corrector at Courant number 0.25."""
figures = {"vortexError": ("vortex and 3D deformation, shape error", ""), "zalesakError": ("Zalesak, shape error", ""), "volumeError": ("volume drift", ""),
           "lowest": ("smallest alpha", ""), "above": ("largest alpha - 1", "")}
mainError, moreErrors = "vortexError", ["zalesakError"]
targets = [Target("vortexError", 0.25, "vortex T = 8", 64, "vortex"), Target("vortexError", 0.07, "vortex T = 8", 128, "vortex"),
           Target("vortexError", 0.12, "vortex T = 8, stricter", 64, "vortex"), Target("vortexError", 0.03, "vortex T = 8, stricter", 128, "vortex"),
           Target("vortexError", 0.12, "vortex T = 8, stricter, mean of six meshes", 64, "vortex six meshes"),
           Target("vortexError", 0.03, "vortex T = 8, stricter, mean of six meshes", 128, "vortex six meshes"),
           Target("zalesakError", 0.06, "Zalesak", 64)]
EXPLICIT = {"courant": 0.25, "mulesCorr": "no"}
PERIOD = {"vortex": 8, "vortex T=2": 2, "vortex T=4": 4, "deformation3D": 3}


def problem(variant):
    return variant.replace(" explicit", "").replace(" six meshes", "")


problemsApart = True


def test(name, solver, sizes, variant="", quick=0, **options):
    return series(solver, sizes, quick=quick, variant=(name + " " + variant).strip(), options={"test": name, **options})


def ours(name, sizes, meshes=1):
    return [Run(OURS, n, name + (" six meshes" if meshes == 6 else ""),
                {"test": name, "arguments": [str(n), "no", "0.5", WIDTH, OUR_NAME.get(name, name), str(meshes)]},
                quick=n <= 64 and name in ("vortex", "zalesak") and meshes == 1) for n in sizes]


runs = [
    *ours("vortex", [32, 64, 128]),
    *ours("vortex", [32, 64, 128], meshes=6),
    *test("vortex", "interIsoFoam", [32, 64, 128], quick=2),
    *test("vortex", "interFoam", [32, 64, 128], quick=2),
    *test("vortex", "interFoam", [128], "explicit", **EXPLICIT),
    *ours("zalesak", [32, 64, 128]),
    *test("zalesak", "interIsoFoam", [40, 80, 160], quick=2),
    *test("zalesak", "interFoam", [40, 80, 160], quick=2),
    *test("zalesak", "interFoam", [80], "explicit", **EXPLICIT),
    *[run for name in ("vortex T=2", "vortex T=4") for run in
      [*ours(name, [32, 64, 128]), *test(name, "interIsoFoam", [32, 64, 128]), *test(name, "interFoam", [32, 64, 128])]],
    *ours("deformation3D", [16, 32, 64]),
    *test("deformation3D", "interIsoFoam", [16, 32, 64]),
    *test("deformation3D", "interFoam", [16, 32, 64]),
]


def _length(run):
    """(end time, steps)."""
    courant, name = run.options.get("courant", 0.5), run.options["test"]
    if name == "zalesak":
        return 1, round(2.5 * run.n / courant)
    fastest = 2 if name == "deformation3D" else 1
    return PERIOD[name], round(fastest * PERIOD[name] * run.n / courant)


def _column(run):
    return "zalesakError" if run.options["test"] == "zalesak" else "vortexError"


def parameters(run):
    end, steps = _length(run)
    # setFlow acts at the end of a step, so that the velocity lags by one: the sine's phase is that of the middle of the step
    is3D = run.options["test"] == "deformation3D"
    return {"n": run.n, "nDeep": run.n if is3D else 1, "depth": 1 if is3D else 0.05, "sides": "patch" if is3D else "empty",
            "shape": "sphere" if is3D else "cylinder", "centre": "(0.35 0.35 0.35)" if is3D else "(0.5 0 0.75)",
            "endTime": end, "steps": steps, "maxStep": end / steps, "frequency": 0.5 / end, "sineStart": -end / 2 - end / steps / 2,
            "mulesCorr": run.options.get("mulesCorr", "yes")}


def prepare(run, do):
    if run.solver == OURS:
        return
    do("cp", "system/setVelocity." + run.options["test"].split()[0], "system/setVelocity")
    do("blockMesh")
    do(run.solver, "-postProcess", "-time", "0")        # 0/U and 0/phi: else the first step would have no velocity
    do("setAlphaField")
    if run.options["test"] == "zalesak":
        do("setFields")
    do("cp", "0/alpha.water", "alpha.start")


def _ours(run, case):
    with open(os.path.join(case, "log.solver"), encoding="utf-8") as log:
        name = OUR_NAME.get(run.options["test"], run.options["test"])
        line = [x for x in log if x.startswith(name) and re.search(rf"n +{run.n} delta {WIDTH}", x)][-1]
    values = re.search(r"error ([\d.]+) mass (\S+) .*alpha \[(\S+), 1(\S+)\].*\| ([\d.]+) us/node/step, (\d+) steps", line).groups()
    error, mass, lowest, above, pace, steps = (float(v) for v in values)
    nodes = (run.n + 1)**(3 if run.options["test"] == "deformation3D" else 2)
    return {_column(run): error, "volumeError": mass, "lowest": lowest, "above": above, "steps": int(steps), "nodes": nodes,
            "cpu": pace * 1e-6 * nodes * steps}


def errors(run, case):
    if run.solver == OURS:
        return _ours(run, case)
    start, end = foam.field(os.path.join(case, "alpha.start")), foam.field(os.path.join(case, f"{_length(run)[0]}", "alpha.water"))
    return {_column(run): float(np.abs(end - start).sum() / start.sum()), "volumeError": float(end.sum() / start.sum() - 1),
            "lowest": float(end.min()), "above": float(end.max() - 1)}
