# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of scenes: one in which a rule acts, one in which it cannot."""
import os
from dataclasses import dataclass
from typing import Callable

import numpy as np

import scenes
import startState
from scenes import Scene

SIDE = 24               # cells a direction of the 3D scenes
ONE_FLUID = """FoamFile { version 2.0; format ascii; class dictionary; object transportProperties; }
transportModel Newtonian;
nu 1e-06;
rho 1000;
"""


@dataclass
class Pair:
    row: str
    rule: str
    first: str              # the scene with the rule
    second: str
    how: str                # switch or equivalent scene
    withRule: Callable
    withoutRule: Callable
    reference: Callable = None  # what the first scene's answer is compared with, unless it is the second scene's
    part: Callable = lambda fields: fields      # of the first scene's cells that the other has too


@dataclass
class KernelPair:
    """Two kernels of speedKernels; their counters are the answers."""
    row: str
    rule: str
    first: str
    second: str
    withRule: str           # names of benchmarks
    withoutRule: str
    answers: tuple
    how: str = "kernel"


def _dam(root, runs, name, dim, n, change=None):
    """Dam break scene in a folder of its own; change(folder, fields) before the fields are written."""
    folder = os.path.join(runs, "skipping_" + name)
    startState.makeCase(folder, dim, n, "flotsamFoam")
    fields, fastest = startState.state(root, runs, dim, n)
    if change:
        change(folder, fields)
    startState.writeFields(folder, fields)
    return Scene(name, folder, scenes.COURANT / n / fastest, 5, 25)


def _write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as out:
        out.write(text)


def _replace(folder, name, old, new):
    path = os.path.join(folder, name)
    with open(path, encoding="utf-8") as file:
        text = file.read()
    if old not in text:
        raise RuntimeError(f"{path}: '{old}' not found")
    with open(path, "w", encoding="utf-8") as out:
        out.write(text.replace(old, new))


def _full(folder, fields):
    fields["alpha.water"] = np.ones_like(fields["alpha.water"])
    fields["p_rgh"] = np.zeros_like(fields["p_rgh"])


def _fullOneFluid(folder, fields):
    _full(folder, fields)
    _write(folder, "constant/transportProperties", ONE_FLUID)


def _twice(folder, fields):
    """The 2D scene as one layer of cells in 3D."""
    _replace(folder, "system/parameters", "front empty;", "front wall;")
    for name, kind in (("U", "slip"), ("alpha.water", "zeroGradient"), ("p_rgh", "fixedFluxPressure; value uniform 0")):
        _replace(folder, "0.orig/" + name, '    ".*"', f"    frontAndBack {{ type {kind}; }}\n    \".*\"")
    startState.steps.do(folder, "blockMesh")


def _box(root, runs, name, change):
    """One fluid in a box, or in its first two thirds (change "short"), or with a block that fills the last third (change "block")."""
    folder = os.path.join(runs, "skipping_" + name)
    startState.makeCase(folder, 3, SIDE, "flotsamFoam")
    fields, fastest = startState.state(root, runs, 3, SIDE)
    _fullOneFluid(folder, fields)
    if change == "block":
        _write(folder, "constant/bodies", BLOCK)
    if change == "short":
        fields = {field: firstTwoThirds(values) for field, values in fields.items()}
        _replace(folder, "system/blockMeshDict", "(1 0 0) (1 1 0)", "(#eval{2.0/3} 0 0) (#eval{2.0/3} 1 0)")
        _replace(folder, "system/blockMeshDict", "(1 0 $depth) (1 1 $depth)", "(#eval{2.0/3} 0 $depth) (#eval{2.0/3} 1 $depth)")
        _replace(folder, "system/blockMeshDict", "($n $n $nz)", f"({2 * SIDE // 3} $n $nz)")
        startState.steps.do(folder, "blockMesh")
    startState.writeFields(folder, fields)
    return Scene(name, folder, scenes.COURANT / SIDE / fastest, 5, 25)


def firstTwoThirds(values):
    """Of cell values in the order of blockMesh's cells, x fastest."""
    cells = values.reshape((SIDE, SIDE, SIDE) + values.shape[values.ndim - (values.shape[-1] == 3):])
    return cells[:, :, :2 * SIDE // 3]


def _newHierarchies(root, runs):
    scene = _dam(root, runs, "newHierarchies", 3, SIDE)
    scene.extra = {"PETSC_OPTIONS": "-pressure_max_age 0"}
    return scene


def _supg(folder, _fields):
    _replace(folder, "system/fvSolution", "PIMPLE", "flotsam { dualCellTransport off; }\nPIMPLE")


BLOCK = f"""FoamFile {{ version 2.0; format ascii; class dictionary; object bodies; }}
structures {{ block {{ shape {{ type box; size (0.6 1.4 1.4); }} position ({2 / 3 + 0.3:.10f} 0.5 0.5); }} }}
"""
POST = """FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
structures { post { shape { type cylinder; end1 (0 -0.1 0); end2 (0 1.1 0); radius 0.1; } position (0.7013 0 0.4007); %s } }
"""
HELD = "bodies { held { shape { type sphere; radius 0.08; } density 590; position (0.2 0.85 0.8); releaseTime 1000; } }\n"


def _post(motion="", bodies=""):
    """A post in the way of the water."""
    return lambda folder, _fields: _write(folder, "constant/bodies", POST % motion + bodies)


PAIRS = [
    Pair("oneFluid", "one fluid: no phase field", "3D box, one fluid", "the same box filled by the liquid of two", "equivalent scene",
         lambda root, runs: _dam(root, runs, "oneFluid", 3, SIDE, _fullOneFluid), lambda root, runs: _dam(root, runs, "twoFluids", 3, SIDE, _full)),
    Pair("noBodies", "no bodies: no DEM engine", "dam break 3D with a post", "and with a sphere, held in the air", "equivalent scene",
         lambda root, runs: _dam(root, runs, "post", 3, SIDE, _post()), lambda root, runs: _dam(root, runs, "postAndSphere", 3, SIDE, _post("", HELD))),
    Pair("fixedOnly", "fixed structures: cut once", "dam break 3D, post fixed", "post moving at 0 m/s", "equivalent scene",
         lambda root, runs: _dam(root, runs, "fixedPost", 3, SIDE, _post()),
         lambda root, runs: _dam(root, runs, "movingPost", 3, SIDE, _post("contact off; motion { type linear; velocity (0 0 0); }"))),
    Pair("planar", "2D: triangles, three unknowns a node", "dam break 2D", "the same as one layer of cells in 3D", "equivalent scene",
         lambda root, runs: _dam(root, runs, "planar", 2, 100), lambda root, runs: _dam(root, runs, "layer", 2, 100, _twice)),
    Pair("insideSolids", "inside solids: not assembled, no unknowns", "box, one fluid, with a block that fills a third of it", "without the block",
         "equivalent scene",
         lambda root, runs: _box(root, runs, "block", "block"), lambda root, runs: _box(root, runs, "whole", ""),
         lambda root, runs: _box(root, runs, "short", "short"), firstTwoThirds),
    KernelPair("nearOnly", "moving bodies: only elements near them cut again", "20 bars move", "the whole cover anew", "cutTwentyBars/length:24/anew:0",
               "cutTwentyBars/length:24/anew:1", ("volume", "area")),
    Pair("farFromSurface", "phase field only near the surface", "dam break 3D, dual-cell transport", "SUPG form, solved everywhere", "switch `dualCellTransport`",
         lambda root, runs: _dam(root, runs, "near", 3, SIDE), lambda root, runs: _dam(root, runs, "everywhere", 3, SIDE, _supg)),
    KernelPair("freeFlight", "nothing near contact: largest DEM steps", "20 bars in free flight", "in contact's sub-steps", "demFreeFlight/contactSteps:0",
               "demFreeFlight/contactSteps:1", ("z", "turn")),
    Pair("keptHierarchy", "steady operators: preconditioner kept", "dam break 3D", "a multigrid hierarchy a step", "developer's switch `-pressure_max_age 0`",
         lambda root, runs: _dam(root, runs, "keptHierarchy", 3, SIDE), _newHierarchies),
]

NOTES = """Answers: velocity (mostly of the air, which is faster) and phase field in the cells after 25 steps. Equivalent scenes
differ by more than the rule: the held sphere displaces air; beside a structure that may move the density is the element's
mean; a layer of cells is cut into tetrahedra; inside solids: the answer is compared with a mesh that ends at the block,
where a wall of the mesh takes the place of a cut one and the start does not fit the block; phase field: another form of
its equation. Kernels: seconds of a call, no nodes; their counters are compared. Matrix blocks are assembled anew in every
step: wherever fluid moves, all of them change.
"""
