# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes that are timed: case folders ready to run."""
import os
import re
import shutil
from dataclasses import dataclass

import startState
import steps

COURANT = 0.5               # of the largest speed of the dam break's start
SIDES = {2: {1e4: 100, 64e3: 253, 3e5: 548, 1e6: 1000}, 3: {1e4: 22, 64e3: 40, 3e5: 67, 1e6: 100}}      # cells a direction


@dataclass
class Scene:
    name: str
    folder: str
    stepSize: float         # [s]
    few: int                # steps before the timed ones
    many: int               # steps of the longer run
    start: float = 0        # [s]
    extra: dict = None      # of the program's environment


def damBreak(root, runs, dim, n, solver):
    folder = os.path.join(runs, f"damBreak{dim}D_{n}_{solver}")
    startState.makeCase(folder, dim, n, solver)
    fields, fastest = startState.state(root, runs, dim, n)
    startState.writeFields(folder, fields)
    return Scene(f"dam break {dim}D", folder, COURANT / n / fastest, 5, 25 if n**dim > 2e4 else 65)


def wideDamBreak(root, runs, n):
    """The dam break in 3D in a tank twice as wide, which is symmetric: each half of it is the work of the narrow one."""
    folder = os.path.join(runs, f"damBreak3D_{n}_wide")
    startState.makeCase(folder, 3, n, "flotsamFoam", width=2)
    fields, fastest = startState.state(root, runs, 3, n)
    startState.writeFields(folder, startState.mirrored(fields))
    return Scene("dam break 3D, two wide", folder, COURANT / n / fastest, 5, 25)


LOGS = [0, 20, 100, 400, 700]


def logCarpet(root, runs, count):
    """Logs of 0.4 m that fall at random places on a tank of 8 x 2 m, which gravity tilts a little, until most of them touch: the case of the dam break with other files."""
    folder = os.path.join(runs, f"logCarpet_{count}")
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("damBreak", "logCarpet"):
        shutil.copytree(os.path.join(root, "speed", part), folder, dirs_exist_ok=True)
    shutil.copytree(os.path.join(folder, "0.orig"), os.path.join(folder, "0"))
    if count == 0:
        os.remove(os.path.join(folder, "constant", "bodies"))
    with open(os.path.join(folder, "system", "parameters"), "w", encoding="utf-8") as out:
        out.write(f"solver flotsamFoam;\nnLogs {count};\n")
    steps.write(folder, 1, 1)
    for tool in ("blockMesh", "setExprFields"):
        steps.do(folder, tool)
    return Scene("log carpet", folder, 0.0125, 30, 40)


def _copyTutorial(root, runs, tutorial, suffix=""):
    source, folder = os.path.join(root, "..", "tutorials", tutorial), os.path.join(runs, tutorial + suffix)
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("0.orig", "constant", "system"):
        shutil.copytree(os.path.join(source, part), os.path.join(folder, part))
    shutil.copytree(os.path.join(folder, "0.orig"), os.path.join(folder, "0"))
    with open(os.path.join(folder, "system", "controlDict"), "a", encoding="utf-8") as out:
        out.write('\n#include "steps"\n')
    steps.write(folder, 1, 1)
    return folder


def setEntry(file, entry, value):
    """Replaces the value of an entry that stands on a line of its own."""
    with open(file, encoding="utf-8") as source:
        text, count = re.subn(rf"^(\s*{entry}\s+)[^;]*;", rf"\g<1>{value};", source.read(), flags=re.MULTILINE)
    if count != 1:
        raise RuntimeError(f"{file}: entry {entry} found {count} times")
    with open(file, "w", encoding="utf-8") as out:
        out.write(text)


def slitDam(root, runs, resolution="quick", bars="yes", suffix=""):
    folder = _copyTutorial(root, runs, "slitDam", f"_{resolution}{suffix}")
    parameters = os.path.join(folder, "system", "parameters")
    setEntry(parameters, "resolution", resolution)
    setEntry(parameters, "bars", bars)
    refine = [("topoSet",), ("refineMesh", "-overwrite")] if resolution == "standard" else []
    for tool in (("blockMesh",), *refine, ("setExprFields",), ("setExprBoundaryFields",)):
        steps.do(folder, *tool)
    return Scene(f"slitDam {resolution}" + ("" if bars == "yes" else " without bars"), folder, 0.005 if resolution == "quick" else 0.002, 5, 25)


def continued(root, runs, run, time):
    """slitDam from a written state of a run of the tutorial, where bars touch each other and the pipes."""
    folder = _copyTutorial(root, runs, "slitDam", f"_{time:g}s")
    for part in ("constant", "system/parameters", f"{time:g}"):
        source, target = os.path.join(run, part), os.path.join(folder, part)
        shutil.rmtree(target, ignore_errors=True)
        (shutil.copytree if os.path.isdir(source) else shutil.copyfile)(source, target)
    return Scene(f"slitDam quick from {time:g} s", folder, 0.005, 5, 25, time)


def fallingSphere(root, runs):
    folder = _copyTutorial(root, runs, "fallingSphere")
    steps.do(folder, "blockMesh")
    return Scene("falling sphere", folder, 0.004, 5, 25)
