# SPDX-License-Identifier: GPL-3.0-or-later
"""tutorials/debrisRack with other parameters, and what its history says of the logs."""
import os
import re

TUTORIAL_SPEED = 0.45           # of the stream [m/s]
SLOW = 0.25                     # a log is held when its speed, mean over half a second, is less than this share of the stream's
# the tutorial's, which the evaluations need as numbers
CHANNEL = {"width": 0.40, "upstream": 1.90, "downstream": 0.70, "height": 0.32, "depth": 0.16}
BAR = 0.02                      # diameter of the rack's bars, little thicker than an element: the clean rack of the tutorial would choke the fastest stream [m]


def tutorialFile(root, *path):
    with open(os.path.join(os.path.dirname(root), "tutorials", "debrisRack", *path), encoding="utf-8") as file:
        return file.read()


def files(root, seed, endTime):
    """But system/parameters. seed: of the places of the logs."""
    found = {f"{folder}/{name}": tutorialFile(root, source, name) for source, folder, names in
             (("0.orig", "0", ("U", "alpha.water", "p_rgh")), ("constant", "constant", ("g", "hRef", "transportProperties", "turbulenceProperties")),
              ("system", "system", ("blockMeshDict", "fvSchemes", "fvSolution", "setExprFieldsDict"))) for name in names}
    found["constant/bodies"] = _replaced(tutorialFile(root, "constant", "bodies"), r"(random\s*\{)", rf"\1 seed {seed};")
    found["system/controlDict"] = _replaced(tutorialFile(root, "system", "controlDict"), r"endTime +\d+;", f"endTime {endTime:.4g};")
    return found


def _replaced(text, pattern, new):
    text, n = re.subn(pattern, new, text)
    assert n == 1, pattern
    return text


def parameters(root, own, fineness):
    """Those of the tutorial with `own` in their places: what it computes from them follows. fineness: cells a direction over those of elements of 0.016 m."""
    own = {**CHANNEL, "barDiameter": BAR, "barWall": "noSlip", "supplyLow": 0.255, "supplyHigh": 0.305, "surfaceEnd": 0.24, **own, **_cells(fineness)}
    found = dict(re.findall(r"^(\w+)\s+([^{};]+|#eval\{[^}]*\}|\$\{.*\});", tutorialFile(root, "system", "parameters"), re.MULTILINE))
    assert own.keys() <= found.keys(), own.keys() - found.keys()
    return {**found, **own}


def _cells(fineness):
    cells = {name: round(fineness * number) for name, number in
             {"nDrift": 57, "nRack": 38, "nOutlet": 18, "ny": 24, "nBed": 3, "nBelow": 6, "nAbove": 5, "nAir": 4}.items()}
    return {**cells, "nx": sum(cells[i] for i in ("nDrift", "nRack", "nOutlet")), "nLower": cells["nBed"] + cells["nBelow"], "nUpper": cells["nAbove"] + cells["nAir"]}


def prepare(_run, do):
    do("blockMesh")
    do("setExprFields")


def held(history, driftwood, speed):
    """Which logs the rack holds at the end, and which have passed it."""
    isThere = [history.isThere("bodies/" + name)[-1] for name in history.bodies]
    x = driftwood.positions(history)[:, -1, 0]
    return isThere & (x < BAR / 2) & (driftwood.meanSpeed(history, 0.5)[:, -1] < SLOW * speed), x > BAR / 2
