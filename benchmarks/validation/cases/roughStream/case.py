# SPDX-License-Identifier: GPL-3.0-or-later
"""A uniform turbulent stream on a rough or smooth bed: its depth, friction and profile. N: elements over the depth."""
import math
import os

import numpy as np

from runner import foam
from runner.cases import Run
from support import channel
from support.compare import relative, small
from support.files import blockMesh, control, dictionary, even, field, fixed, gravity, merged, referenceHeight, twoFluids

SPEED, DEPTH, HEIGHT, LENGTH, ASPECT, NU, KAPPA = 1.5, 1.0, 1.5, 120.0, 4.8, 1e-6, 0.41
NEAR, FAR = 80.0, 110.0         # where the profile has developed [m]
END, LATE = 150.0, 0.8          # [s]; means over the rest of the run

VARIANTS = {"": (0.02, True), "smooth": (0, True), "wall law alone": (0.02, False)}     # sand roughness [m], mixingDepth
TARGETS = {"friction": 0.05, "depth": 0.01, "profile": 0.03}


def frictionVelocity(roughness, depth=DEPTH, speed=SPEED):
    """Of the logarithmic profile with this mean [m/s], B = 5 over a smooth bed, 8.5 over grains; by iteration."""
    friction = 0.05 * speed
    for _ in range(60):
        own = math.log(depth / roughness) / KAPPA + 8.5 if roughness else math.log(depth * friction / NU) / KAPPA + 5
        friction = speed / (own - 1 / KAPPA)
    return friction


title = f"""A stream of {SPEED:g} m/s, {DEPTH:g} m deep (Froude number 0.48, Reynolds number 1.5e6), 2D, on a bed of {LENGTH:g} m with the slope that the logarithmic profile asks for (gravity is tilted): u/u* = ln(y/ks)/0.41 + 8.5 over
grains of ks = 0.02 m (Nikuradse), ln(y u*/nu)/0.41 + 5 over a smooth bed; the outlet keeps the depth, the inlet's velocity is even. `wallLaw on`, `mixingDepth` {DEPTH:g} (wall law alone: without); elements {ASPECT:g} times as long as high. Means over the
last {100 * (1 - LATE):g} % of {END:g} s, {NEAR:g} to {FAR:g} m downstream: traction of the bed (wallForces), depth at the inlet, velocity at the end of the run. Targets, stated after three runs by hand with the case of this page: friction {100 * TARGETS["friction"]:g} %,
depth {100 * TARGETS["depth"]:g} %, profile {100 * TARGETS["profile"]:g} % of the mean (rms over the depth)."""
runs = [*(Run("flotsamFoam", n, quick=n == 6) for n in (6, 12, 24)), *(Run("flotsamFoam", n, "smooth") for n in (6, 12)), Run("flotsamFoam", 12, "wall law alone")]


def resolution(run):
    return f"{run.n} over the depth"


def _cells(run):
    """(along, upwards) of the mesh."""
    return round(LENGTH * run.n / ASPECT), round(HEIGHT * run.n)


def _numerics(run):
    roughness, hasMixing = VARIANTS[run.variant]
    entries = f"wallLaw on; wallRoughness {roughness};" + (f" mixingDepth {DEPTH};" if hasMixing else "")
    return {"system/fvSolution": dictionary("fvSolution", f"flotsam\n{{\n    {entries}\n}}")}


def _controls():
    files = control(END, 0.01, maxDeltaT=1, writeInterval=END)
    files["system/controlDict"] += "\nwallForces { probe { patches (probe); } }\n"
    return files


def files(run, _folder):
    nx, nz = _cells(run)
    h = HEIGHT / nz
    angle = math.asin(frictionVelocity(VARIANTS[run.variant][0])**2 / (channel.G * DEPTH))
    profile = channel.entering([0.5 * (1 + math.tanh((DEPTH - z) / (0.2 * h))) for z in channel.heights(HEIGHT, h)])
    out = "type inletOutlet; inletValue uniform 0; value uniform 0;"
    leaves, flux = "type pressureInletOutletVelocity; value uniform (0 0 0);", "type fixedFluxPressure; value uniform 0;"

    def patches(inlet, outlet, bed, top):
        return {"inlet": inlet, "outlet": outlet, "bed": bed, "probe": bed, "atmosphere": top, "frontAndBack": "empty"}

    return merged(
        blockMesh(even(0, LENGTH, nx), even(0, 0.1, 1), even(0, HEIGHT, nz),
                  {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "bed": ("wall", "z-"), "atmosphere": ("patch", "z+"), "frontAndBack": ("empty", "y- y+")}),
        field("U", patches(fixed(f"({SPEED} 0 0)"), leaves, "noSlip", leaves), f"({SPEED} 0 0)"),
        field("p_rgh", patches(flux, fixed(0), flux, "type totalPressure; p0 uniform 0; value uniform 0;")),
        field("alpha.water", patches(profile, out, "zeroGradient", out)),
        {"system/setFieldsDict": dictionary("setFieldsDict", f"""defaultFieldValues (volScalarFieldValue alpha.water 0);
regions ( boxToCell {{ box (-1 -1 -1) (1e9 1 {DEPTH}); fieldValues (volScalarFieldValue alpha.water 1); }} );"""),
         "system/topoSetDict": dictionary("topoSetDict", f"""actions
(
    {{ name probed; type faceSet; action new; source patchToFace; patch bed; }}
    {{ name probed; type faceSet; action subset; source boxToFace; box ({NEAR} -1 -1) ({FAR} 1 1e-6); }}
);"""),
         "system/createPatchDict": dictionary("createPatchDict", "pointSync false;\npatches ( { name probe; patchInfo { type wall; } constructFrom set; set probed; } );")},
        twoFluids(), gravity(x=channel.G * math.sin(angle), z=-channel.G * math.cos(angle)),
        referenceHeight(DEPTH * math.cos(angle) - LENGTH * math.sin(angle)), _controls(), _numerics(run))


def prepare(_run, do):
    do("blockMesh")
    do("topoSet")
    do("createPatch", "-overwrite")
    do("setFields")


def _traction(case):
    """Of the bed, mean over the last part of the run [Pa]."""
    rows = np.loadtxt(os.path.join(case, "postProcessing", "probe", "0", "force.dat"))
    late = rows[rows[:, 0] > LATE * END]
    return late[:, 1].mean() / ((FAR - NEAR) * 0.1)


def errors(run, case):
    nx, nz = _cells(run)
    h, roughness = HEIGHT / nz, VARIANTS[run.variant][0]
    alpha, along = (foam.field(os.path.join(case, f"{END:g}", name)) for name in ("alpha.water", "U"))
    alpha, along = alpha.reshape(nz, nx), along.reshape(nz, nx, 3)[..., 0]
    there = slice(round(NEAR * nx / LENGTH), round(FAR * nx / LENGTH))
    depth = alpha.sum(0) * h
    speed = (alpha * along).sum(0)[there].mean() * h / depth[there].mean()
    friction = frictionVelocity(roughness, depth[there].mean(), speed)
    height = np.array(channel.heights(HEIGHT, h))
    below = height < DEPTH - 0.5 * h
    law = friction * (np.log(height[below] / roughness) / KAPPA + 8.5 if roughness else np.log(height[below] * friction / NU) / KAPPA + 5)
    profile = along[:, there].mean(1)[below]
    target = TARGETS if VARIANTS[run.variant][1] else dict.fromkeys(TARGETS)
    source = "logarithmic profile"
    return {"comparisons": [relative("friction of the bed, for the mean velocity and depth there", _traction(case), 1000 * friction**2, target["friction"], "Pa", source),
                            relative("depth at the inlet", depth[0], DEPTH, target["depth"], "m", source),
                            small("velocity over the depth, rms of the difference over the mean velocity", np.sqrt(((profile - law)**2).mean()) / speed, target["profile"], source=source)]}
