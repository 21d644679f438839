# SPDX-License-Identifier: GPL-3.0-or-later
"""How the work of a step is shared out to the ranks, by equal numbers of cells and by the cost of the cells (flotsamFoam -cell-cost)."""
import os
import shutil

from runner import environment
import scenes
import startState
import steps

STEPS = 3, 8            # few, many
BLOCK = """FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
structures { block { shape { type box; size (0.53 1.4 1.4); } position (0.935 0.5 0.5); } }
"""


def dam(root, runs, _state=None, n=32):
    """Dam break in 3D; a block fills the last third of the box."""
    folder = os.path.join(runs, "balance_block")
    startState.makeCase(folder, 3, n, "flotsamFoam")
    fields, fastest = startState.state(root, runs, 3, n)
    startState.writeFields(folder, fields)
    with open(os.path.join(folder, "constant", "bodies"), "w", encoding="utf-8") as out:
        out.write(BLOCK)
    return scenes.Scene(f"dam break 3D {n}^3, a third solid", folder, scenes.COURANT / n / fastest, *STEPS)


def flume(root, runs, state=None):
    """slitDam without bars, from its start or from (folder, time) of a run."""
    if not state:
        scene = scenes.slitDam(root, runs, bars="no", suffix="_balance")
    else:
        scene = scenes.continued(root, runs, state[0], float(state[1]))
        scene.name = scene.name.replace("quick", "quick without bars")
        stored = os.path.join(scene.folder, f"{scene.start:g}", "flotsamState.h5")
        if os.path.isfile(stored):
            os.remove(stored)       # of one process
    scene.few, scene.many = STEPS
    return scene


def slabs(ranks):
    """Of method simple: along the flume; from 8 ranks on, two across."""
    return f"{ranks // 2} 2 1" if ranks >= 8 else f"{ranks} 1 1"


def decompose(root, scene, ranks, byCost):
    file = os.path.join(scene.folder, "system", "decomposeParDict")
    with open(file, "w", encoding="utf-8") as out:
        out.write("FoamFile { version 2.0; format ascii; class dictionary; object decomposeParDict; }\n"
                  f"numberOfSubdomains {ranks}; method simple; coeffs {{ n ({slabs(ranks)}); }}\n" + ("weightField cellCost;\n" if byCost else ""))
    steps.write(scene.folder, scene.stepSize, scene.few, scene.start)
    if byCost:
        steps.do(scene.folder, environment.program(root, "flotsamFoam", False), "-cell-cost")
    steps.do(scene.folder, "decomposePar", "-force")


def works(scene, ranks, run):
    """Processor seconds a step of every rank outside MPI. run(folder, file of counts): one run under the counter."""
    file = os.path.join(scene.folder, "counts")
    if os.path.isfile(file):
        os.remove(file)
    for count in (scene.few, scene.many):
        steps.write(scene.folder, scene.stepSize, count, scene.start)
        run(scene.folder, file)
    with open(file, encoding="utf-8") as lines:
        first, last = [list(map(int, line.split()))[-ranks:] for line in lines]
    return [1e-6 * (b - a) / (scene.many - scene.few) for a, b in zip(first, last)]


def measure(root, scene, ranks, run, repeats):
    """Rows of both decompositions; the repeats alternate, each starts from the same fields."""
    copies = {}
    for byCost in (False, True):
        copies[byCost] = scenes.Scene(scene.name, scene.folder + ("_cost" if byCost else "_cells"), scene.stepSize, scene.few, scene.many, scene.start)
        shutil.rmtree(copies[byCost].folder, ignore_errors=True)
        shutil.copytree(scene.folder, copies[byCost].folder)
        decompose(root, copies[byCost], ranks, byCost)
    collected = {byCost: [] for byCost in copies}
    for _ in range(repeats):
        for byCost, copy in copies.items():
            collected[byCost].append(works(copy, ranks, run))
    for folder in (scene.folder, *(c.folder for c in copies.values())):
        shutil.rmtree(folder)
    return {byCost: steps.medians([{"least": min(w), "most": max(w), "ratio": max(w) * len(w) / sum(w)} for w in list_]) for byCost, list_ in collected.items()}
