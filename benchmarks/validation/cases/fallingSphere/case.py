# SPDX-License-Identifier: GPL-3.0-or-later
"""Sphere falling in a box of silicone oil, experiments E1 to E4 of ten Cate et al. 2002. N: elements a diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import around, blockMesh, bodies, control, field, gravity, merged, oneFluid

SOURCE = "ten Cate et al. 2002, experiment"
COMPUTED = "ten Cate et al. 2002, lattice Boltzmann"
DIAMETER = 0.015
#      density, viscosity [Pa s], largest speed [m/s], end [s], time when the largest speed is past [s]
OILS = {"E1": (970, 0.373, 0.035986, 3.6, 1.2), "E2": (965, 0.212, 0.05718, 2.4, 1.1), "E3": (962, 0.113, 0.087269, 1.7, 1.0), "E4": (960, 0.058, 0.12224, 1.3, 0.95)}
# the authors' own computations of the same falls in the same box (table II, as quoted in a public data sheet): largest speed over that in unbounded oil, and the latter [m/s]
LATTICE_BOLTZMANN = {"E1": (0.894, 0.038), "E2": (0.950, 0.06), "E3": (0.955, 0.091), "E4": (0.947, 0.128)}

title = """Nylon sphere of 15 mm (1120 kg/m3) released from rest in oil, box 0.1 x 0.1 x 0.16 m, its lowest point 0.12 m above the bottom (ten Cate et al. 2002;
Re = 1.5, 4.1, 11.6, 31.9). N elements a diameter along its way, wider towards the side walls. Speed and gap over time (E1, E4: digitised) as long as the
gap exceeds a diameter, the film below it being thinner than an element later; other runs stop when the largest speed is past."""

runs = [Run("flotsamFoam", n, name, {"isWhole": n < 12 and name in ("E1", "E4")}, quick=(n == 6 and name == "E4"), timeLimit=3600) for n in (6, 8, 12) for name in OILS]


def resolution(run):
    return f"{run.n} a diameter"


def files(run, _folder):
    rho, mu, _, whole, part = OILS[run.variant]
    h = DIAMETER / run.n
    side = around(-0.05, -0.0105, 0.0105, 0.05, h, 1.2)
    height = around(0, 0 if run.options["isWhole"] else 0.03, 0.145, 0.16, h, 1.2)
    return merged(
        blockMesh(side, side, height, {"walls": ("wall", "x- x+ y- y+ z-"), "top": ("patch", "z+")}),
        field("U", {"walls": "noSlip", "top": "type pressureInletOutletVelocity; value uniform (0 0 0);"}),
        field("p_rgh", {"walls": "type fixedFluxPressure; value uniform 0;", "top": "type totalPressure; p0 uniform 0; value uniform 0;"}),
        oneFluid(mu / rho, rho), gravity(z=-9.81),
        bodies("bodies { sphere { shape { type sphere; radius 0.0075; } density 1120; position (0 0 0.1275); } }"),
        control(whole if run.options["isWhole"] else part, 1e-3, maxDeltaT=0.02))


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    sphere, largest = history["sphere"], OILS[run.variant][2]
    speed, gap = sphere.velocity[:, 2], sphere.position[:, 2] / DIAMETER - 0.5
    found = [relative("largest speed", -speed.min(), largest, 0.02, "m/s", SOURCE),
             relative("largest speed, computed", -speed.min(), np.prod(LATTICE_BOLTZMANN[run.variant]), 0.02, "m/s", COMPUTED)]
    if run.options["isWhole"] and run.variant in ("E1", "E4"):
        t, u = foam.reference(root, "tenCateVelocity" + run.variant).T      # noqa: F821
        t, u = t[(t < history.time[-1]) & (np.interp(t, history.time, gap) > 1)], u[(t < history.time[-1]) & (np.interp(t, history.time, gap) > 1)]
        found.append(small("speed over time, rms over the largest", _rms(np.interp(t, history.time, speed) - u) / largest, 0.05, source=SOURCE))
        t, z = foam.reference(root, "tenCateGap" + run.variant).T           # noqa: F821
        t, z = t[(z > 1) & (t < history.time[-1])], z[(z > 1) & (t < history.time[-1])]
        found.append(small("gap over time, rms over the diameter", _rms(np.interp(t, history.time, gap) - z), source=SOURCE))
    found.append(small("sideways drift over the diameter", np.abs(sphere.position[:, :2]).max() / DIAMETER, 0.05, source="symmetry"))
    return {"comparisons": found}
