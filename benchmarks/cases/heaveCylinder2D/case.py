# SPDX-License-Identifier: GPL-3.0-or-later
"""Half-submerged cylinder released above its equilibrium: heave decay. N: cells over two diameters near the cylinder."""
import os
import re

import numpy as np

from runner import foam
from runner.cases import Target, series

RADIUS, GRAVITY, RISE, THICKNESS = 0.0762, 9.81, 0.2 * 0.0762, 0.01
OURS, OVERSET = "flotsamFoam", "overInterDyMFoam"
END = "1.5"         # s, as in system/controlDict

title = """Cylinder of radius a = 0.0762 m, density 500, released 0.2 a above its equilibrium; tank 9.6 m x 2.4 m of water. N cells over two diameters in the square
around the cylinder, stretched beyond. Ours: the cylinder is a free body in a plain mesh; peers: O-grid, morphing mesh (sixDoFRigidBodyMotion), `outer 1`
one and `outer 3` three outer correctors, rebuilt solvers; overInterDyMFoam: the ring a .. 2a of the O-grid moves over a plain mesh with N cells over
two diameters in |x|, |y| < 3a, variants by method of interpolation, one outer corrector. Error: rms of z/z0 over t sqrt(g/a) in 0 .. 15 against the linear theory (infinite depth and width), which
is what limits the comparison below about 0.015."""
figures = {"heaveError": ("heave z/z0, rms error", ""), "trough": ("first trough (theory -0.641)", ""), "crest": ("first crest (theory 0.305)", ""),
           "periodError": ("trough to trough, relative error", ""), "volumeError": ("volume drift", "")}
mainError = "heaveError"
targets = [Target("heaveError", 0.015, "rms [z0]", 32), Target("cpu", 43, "CPU time [s]", 32)]

runs = [
    *series(OURS, [16, 32, 48], quick=1),
    *series("interFoam", [16, 32, 48], quick=1, variant="outer 1", options={"outer": 1}, rebuilt=True),
    *series("interFoam", [16, 32], quick=0, variant="outer 3", options={"outer": 3}, rebuilt=True),
    *series("interIsoFoam", [16, 32], quick=0, variant="outer 1", options={"outer": 1}, rebuilt=True),
    *series(OVERSET, [16, 32], quick=0, variant="inverseDistance", options={"interpolation": "inverseDistance"}, rebuilt=True),
    *series(OVERSET, [16, 32], quick=0, variant="cellVolumeWeight", options={"interpolation": "cellVolumeWeight"}, rebuilt=True),
]


def parameters(run):
    outer = run.options.get("outer", 1)
    return {"nOuter": outer, "nPressure": 2 if outer > 1 else 3, "interpolation": run.options.get("interpolation", "none")}


def prepare(run, do):
    kind = {OURS: "plain", OVERSET: "overset"}.get(run.solver, "fitted")
    do(os.path.join(folder, "makeMesh"), kind, str(run.n))      # noqa: F821 (folder is set by the runner)
    do("blockMesh")
    do("setAlphaField")
    if run.solver == OVERSET:
        do("setFields")
        do("postProcess", "-time", "0", "-funcs", "(writeCellCentres writeCellVolumes)")        # for _oversetVolume


def _motion(run, case):
    """Time [s] and height [m] of the axis over its equilibrium."""
    if run.solver == OURS:
        history = foam.history(root, case)      # noqa: F821
        return np.r_[0, history.time], np.r_[RISE, history["cylinder"].position[:, 1]]
    if run.solver == OVERSET:       # sixDoFRigidBodyState does not know its mesh
        with open(os.path.join(case, "log.solver"), encoding="utf-8") as log:
            steps = re.findall(r"^Time = (\S+).*?Centre of mass: \(\S+ (\S+) ", log.read(), re.MULTILINE | re.DOTALL)
        return np.r_[0, [float(t) for t, _ in steps]], np.r_[RISE, [float(y) for _, y in steps]]
    body = foam.table(case, "body/*/*.dat")
    return body[:, 0], body[:, 2] + (0 if abs(body[0, 2]) > 0.5 * RISE else RISE)


def _oversetVolume(run, case, time, height):
    """Water in the ring, and in the other mesh outside of it: 16 x 16 points in each of its cells there, which are uniform."""
    centre, size, alpha = (foam.field(os.path.join(case, *path)) for path in (("0", "C"), ("0", "V"), (time, "alpha.water")))
    isRing = foam.field(os.path.join(case, "0", "zoneID")) > 0.5
    share, width, points = np.ones(len(size)), 4 * RADIUS / run.n, (np.arange(16) - 7.5) / 16
    for i in np.flatnonzero(~isRing & (np.hypot(centre[:, 0], centre[:, 1] - height) < 2.7 * RADIUS)):
        x, y = centre[i, 0] + width * points[:, None], centre[i, 1] - height + size[i] / (width * THICKNESS) * points
        share[i] = np.mean(np.hypot(x, y) > 2 * RADIUS)
    return np.sum(share * size * alpha)


def _extremum(t, z, around, sign):
    near = np.abs(t - around) < 0.7
    fit = np.polyfit(t[near] - around, z[near], 4)
    fine = np.linspace(-0.7, 0.7, 1401)
    values = sign * np.polyval(fit, fine)
    return around + fine[values.argmax()], sign * values.max()


def errors(run, case):
    t, z = _motion(run, case)
    t, z = t * np.sqrt(GRAVITY / RADIUS), z / RISE
    theory = foam.reference(root, "heaveCylinderLinear")        # noqa: F821
    theory = theory[theory[:, 0] <= 15]
    expected, found = ([_extremum(*s, around, sign) for around, sign in ((3.7, -1), (7.2, 1), (10.6, -1))] for s in (theory.T, (t, z)))
    if run.solver == OVERSET:
        volume = [_oversetVolume(run, case, "0", RISE), _oversetVolume(run, case, END, z[-1] * RISE)]
    else:
        volume = foam.table(case, "volume/*/*.dat")[:, 1]
    return {"heaveError": float(np.sqrt(np.mean((np.interp(theory[:, 0], t, z) - theory[:, 1])**2))), "trough": float(found[0][1]), "crest": float(found[1][1]),
            "periodError": float((found[2][0] - found[0][0]) / (expected[2][0] - expected[0][0]) - 1), "volumeError": float(volume[-1] / volume[0] - 1)}
