# SPDX-License-Identifier: GPL-3.0-or-later
"""The rules, each with a scene in which it acts, and the same without it."""
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
    rule: str               # as in the list of what a scene does not need
    scene: str
    without: str            # what is done all the same
    make: Callable          # (root, runs, name) -> Scene
    phases: tuple           # in which the rule saves
    switch: str = ""        # for the second run of the same scene: PETSC_OPTIONS (fluidSolver/algebra/needlessWork.hpp)
    makeWithout: Callable = None    # without a switch: a scene in which the rule does not act
    fields: tuple = ("U", "alpha.water", "p_rgh")
    check: int = 0          # steps of a further pair of runs for the answers alone
    tolerance: float = 0    # of its linear solves; 0: as it is
    countsChanges: bool = False     # how many cells change their velocity in a step
    reason: str = ""        # why answers of the timed runs differ by more than SAME


@dataclass
class KernelPair:
    """Two kernels of speedKernels; their counters are the answers."""
    row: str
    rule: str
    scene: str
    without: str
    withRule: str           # names of benchmarks
    withoutRule: str
    answers: tuple
    reason: str = ""


SAME = 1e-10                # largest relative difference of answers that are the same


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


def _block(root, runs, name):
    """One fluid in a box, a third of it filled by a block."""
    folder = os.path.join(runs, "skipping_" + name)
    startState.makeCase(folder, 3, SIDE, "flotsamFoam")
    fields, fastest = startState.state(root, runs, 3, SIDE)
    _fullOneFluid(folder, fields)
    _write(folder, "constant/bodies", BLOCK)
    startState.writeFields(folder, fields)
    return Scene(name, folder, scenes.COURANT / SIDE / fastest, 5, 25)


def _rest(runs, name, n, bodies, level):
    """A box at rest: of one fluid, or filled to level(x, z)."""
    folder = os.path.join(runs, "skipping_" + name)
    startState.makeCase(folder, 3, n, "flotsamFoam")
    z, y, x = (np.indices((n, n, n)) + 0.5) / n
    fields = {"alpha.water": np.ones_like(y), "p_rgh": np.zeros_like(y), "U": np.zeros(y.shape + (3,))}
    if level:
        fields["alpha.water"] = np.clip((level(x, z) - y) * n + 0.5, 0, 1)
    else:
        _write(folder, "constant/transportProperties", ONE_FLUID)
    _write(folder, "constant/bodies", bodies)
    startState.writeFields(folder, fields)
    return Scene(name, folder, 0.01, 5, 25)


def _wave(bodies):
    return lambda root, runs, name: _rest(runs, name, SIDE, bodies, lambda x, z: 0.45 + 0.05 * np.cos(np.pi * x) + 0.02 * np.cos(np.pi * z))


def _sinking(_root, runs, name, contact=None):
    """Twenty bars that sink without touching anything."""
    poses = "".join(f"{{ position ({0.14 + 0.18 * (k % 5):g} {0.72 + 0.16 * (k // 10):g} {0.27 + 0.46 * (k // 5 % 2):g}); "
                    f"orientation {{ axis (1 {0.5 * (k % 5 % 3):g} 0.3); angleDeg {4 * k - 40}; }} }}\n" for k in range(20))
    return _rest(runs, name, 32, HEAD + (contact or CONTACT) + f"bodies {{ bars {{ shape {{ type box; size (0.06 0.06 0.24); }} density 1500; velocity (0.1 -0.1 0.05);\n"
                 f"poses\n(\n{poses}); }} }}\n", None)


def _dam3D(change=None):
    return lambda root, runs, name: _dam(root, runs, name, 3, SIDE, change)


HEAD = "FoamFile { version 2.0; format ascii; class dictionary; object bodies; }\n"
CONTACT = "contact { default { stiffness 1e5; restitution 0.2; frictionAngle 30; } }\nwallPatches all;\n"
BLOCK = HEAD + f"structures {{ block {{ shape {{ type box; size (0.6 1.4 1.4); }} position ({2 / 3 + 0.3:.10f} 0.5 0.5); }} }}\n"
POST = HEAD + "structures { post { shape { type cylinder; end1 (0 -0.1 0); end2 (0 1.1 0); radius 0.1; } position (0.7013 0 0.4007); %s } }\n"
MOVING = POST % "contact off; motion { type linear; velocity (0 0 0); }"
ABSENT = "bodies { absent { shape { type sphere; radius 0.08; } density 590; position (0.2 0.85 0.8); beforeRelease absent; releaseTime 1000; } }\n"
PILE = """bodies { bars { shape { type box; size (0.1 0.1 0.5); } density 1500; poses
(
    { position (0.2 0.05 0.5); }
    { position (0.31 0.05 0.5); }
    { position (0.255 0.15 0.5); orientation { axis (0 1 0); angleDeg 90; } }
    { position (0.255 0.25 0.5); }
); } }
"""


def _post(folder, _fields):
    """A post in the way of the water."""
    _write(folder, "constant/bodies", POST % "")


SOLVES = "solves end at `tolerance` by other ways"
PAIRS = [
    Pair("oneFluid", "one fluid only: no phase field, no density jump treatment", "3D box full of water, developed flow", "as the liquid of two fluids",
         _dam3D(_fullOneFluid), ("phase field", "flow assembly"), makeWithout=_dam3D(_full), fields=("U",)),
    Pair("noBodies", "no bodies: LIGGGHTS never opened", "wave in a 3D box around a post (moving, at 0 m/s)", "a body that is never let in: LIGGGHTS cannot be without any",
         _wave(MOVING), ("DEM",), makeWithout=_wave(MOVING + CONTACT + ABSENT)),
    Pair("fixedOnly", "fixed structures only: cut once", "dam break 3D with a post", "cut in every step", _dam3D(_post), ("cut",), "-needless_cut"),
    Pair("nearOnly", "moving bodies: only elements near them re-cut", "20 bars sink in a 3D box, one fluid", "distances at all nodes, all elements looked at",
         _sinking, ("cut",), "-needless_cut", fields=("U", "p_rgh"), countsChanges=True),
    Pair("sameBlocks", "moving bodies: only changed matrix blocks re-assembled", "wave over a pile of four bars, about one more contact load a step",
         "the matrix again for every contact load", _wave(HEAD + CONTACT + PILE), ("flow assembly",), "-needless_assembly", countsChanges=True),
    Pair("planar", "2D: triangles, three unknowns a node", "dam break 2D", "one layer of 3D cells", lambda root, runs, name: _dam(root, runs, name, 2, 100),
         ("flow assembly", "flow solve", "phase field"), makeWithout=lambda root, runs, name: _dam(root, runs, name, 2, 100, _twice),
         reason="no switch: triangles and tetrahedra agree to discretisation only"),
    Pair("insideSolids", "elements inside solids: not assembled, their nodes not unknowns", "3D box, one fluid, a block fills a third", "assembled and solved for",
         _block, ("flow assembly", "flow solve"), "-needless_insides", fields=("U",), check=25, tolerance=1e-11, reason=SOLVES),
    Pair("farFromSurface", "far from the surface: phase field neither assembled nor solved", "dam break 3D", "in all elements", _dam3D(), ("phase field",),
         "-needless_transport"),
    Pair("freeFlight", "nothing near contact: DEM takes the largest stable steps", "20 stiff bars sink in a 3D box, one fluid", "contact's sub-steps",
         lambda root, runs, name: _sinking(root, runs, name, CONTACT.replace("1e5", "1e7")),
         ("DEM",), "-needless_demSteps", fields=("U", "p_rgh"), check=2, reason="LIGGGHTS' rotation is of second order in its step"),
    KernelPair("freeFlightKernel", "the same, DEM alone", "20 bars in free flight", "contact's sub-steps", "demFreeFlight/contactSteps:0",
               "demFreeFlight/contactSteps:1", ("z", "turn"), "the same"),
    Pair("keptHierarchy", "steady operators: preconditioner kept", "3D box, one fluid, a block fills a third", "a multigrid hierarchy a step", _block,
         ("flow solve",), "-pressure_max_age 0", fields=("U", "p_rgh"), check=25, tolerance=1e-11, reason=SOLVES),
    Pair("keptHierarchyDam", "the same, operators that change", "dam break 3D", "a multigrid hierarchy a step", _dam3D(), ("flow solve",),
         "-pressure_max_age 0", check=2, tolerance=1e-11, reason=SOLVES + "; the dam break amplifies it"),
]

NOTES = """* One fluid: the other scene is filled by the liquid of two fluids, so that the rule that leaves out the phase field far from the surface acts in both.
* No bodies: LIGGGHTS cannot run without a body; the body is outside until its release, which does not come. The post counts as moving in
  both scenes: beside bodies solids are treated so.
* 2D: one layer of cells in 3D is cut into tetrahedra with nodes on both sides.
* Inside solids: rows of nodes inside have entries of nodes outside, but not the other way round. Pressures inside differ, and are not compared.
* Phase field far from the surface: elements there are exchanged, reconstructed and limited without fluxes. What the fluxes of a constant phase field sum up
  to is added apart, as with the rule: an error of 1e-12, the rule's own tolerance, would decide which elements the flow takes for varying.
* Matrix blocks: within a step they are kept. From step to step all change, wherever the fluid moves.
"""
