# SPDX-License-Identifier: GPL-3.0-or-later
"""What is evaluated from the two runs: tension of the boom's lines and what loads it, its sag, logs that came in, are held and passed, overlaps, levels."""
import glob

import driftwood
import flotsam
import momentum
import numpy as np
from tutorial import history, parameters

CASES = {"plain": "run/plain", "skirts": "run/skirts"}
SPAN = 2.0                      # means with logs are over the seconds in which it holds most of them,
CLEAN = 1.0                     # those of the clean boom over this time before the first log
UPSTREAM = -1.25, -0.85         # reaches whose mean depth is taken [m]: upstream of what the boom holds, and downstream of its wake
DOWNSTREAM = 0.3, 0.6
SECTIONS = -0.85, 0.5           # of the momentum theorem [m]
NEAR = 0.85                     # a log is held when its centre is this near upstream of the anchors [m], and its speed,
SLOW = 0.25                     # mean over half a second, is less than this share of the flow's
RIGID = 1.93                    # drag coefficient of a boom as a rigid barrier, [2] of README.md: F = 26 A V^2 [kg, m^2, knots]

setup = parameters(CASES["plain"], "system/parameters")


def isSkirted(name):
    return name == "skirts"


def lineNames(name):
    """Of a run's lines, from the right bank to the left one; with skirts those of the second row after the first."""
    rows = ("", "Low") if isSkirted(name) else ("",)
    return [line + row for row in rows for line in ("right", "linkRight", "linkMiddle", "linkLeft", "left")]


def ends(rows):
    """Of the lines those to the banks."""
    return [line for line in rows if line.startswith(("right", "left"))]


# --- bodies -----------------------------------------------------------------------------------------------------------

def floats(h):
    return [name for name in h.bodies if name.startswith("float")]


def axisAbove(h):
    """Height of the floats' axes above their centres of mass [m]: they begin with it in the level."""
    return setup["depth"] - h["bodies/" + floats(h)[0]].position[0, 2]


def _ofLogs(h, values):
    """Rows of the logs, of values that have one for each body."""
    return values[[name.startswith("log") for name in h.bodies]]


def cameIn(h):
    """Number of logs over time that have come in."""
    return driftwood.cameIn(h, [name for name in h.bodies if name.startswith("log")])


def isHeld(h):
    """Whether a log is held by the boom, logs x records."""
    x = driftwood.positions(h)[..., 0]
    isThere = np.array([h.isThere("bodies/" + name) for name in h.bodies])
    return _ofLogs(h, isThere & (x > -NEAR) & (x < behind(h)) & (driftwood.meanSpeed(h, 0.5) < SLOW * setup["speed"]))


def behind(h):
    """From where on downstream a log is behind the boom, over time [m]: it touches no float any more."""
    return np.max([h["bodies/" + name].position[:, 0] for name in floats(h)], axis=0) + 0.5 * (setup["floatDiameter"] + setup["logDiameter"])


def passed(h):
    """Number of logs whose centre is behind the boom, which they went under, a few over, over time."""
    return (_ofLogs(h, driftwood.positions(h)[..., 0]) > behind(h)).sum(0)


def accounted(h):
    """Number of logs per record that are to come, inside the channel, or left it through the outlet."""
    return driftwood.accounted(_ofLogs(h, driftwood.positions(h)), setup)


def surfaces(h):
    """{body: (centres in its frame, radii)}: a row of spheres, finer than those by which they touch; logs have their axes along x, floats along y. Skirts are left out."""
    log = driftwood.row(setup["logDiameter"], setup["logLength"], 0)
    centres, radii = driftwood.row(setup["floatDiameter"], setup["floatLength"], 1)
    member = centres + np.array([0, 0, axisAbove(h)]), radii
    return {name: member if name.startswith("float") else log for name in h.bodies}


def repeatedSteps(case):
    """Steps that were repeated with a smaller length, of all logs of a run that may have gone on."""
    count = 0
    for file in glob.glob(case + "/log.flotsamFoam*"):
        with open(file, encoding="utf-8", errors="replace") as log:
            count += sum(line.startswith("step of ") and " rejected: " in line for line in log)
    return count


# --- boom -------------------------------------------------------------------------------------------------------------

def endsOfFloats(h):
    """Ends of the floats' axes in space, right to left, floats x records x 2 x 3."""
    half, above = 0.5 * setup["floatLength"], axisAbove(h)
    return np.array([driftwood.inSpace(h["bodies/" + name], np.array([[0, -half, above], [0, half, above]])) for name in floats(h)])


def sag(h):
    """Distance of the middle of the boom from the line between its anchors along the channel, over time [m]."""
    points = endsOfFloats(h)
    return 0.5 * (points[1, :, 1, 0] + points[2, :, 0, 0])


def chainShape(h, begin, end):
    """Points of the chain from bank to bank, means over time: its anchors and the ends of its floats [m]."""
    chosen = (h.time > begin) & (h.time <= end)
    banks = [np.array([[0, side * 0.5 * setup["width"], setup["depth"]]]) for side in (-1, 1)]
    return np.concatenate([banks[0], endsOfFloats(h)[:, chosen].mean(1).reshape(-1, 3), banks[1]])


def draft(name):
    """Of the floats at rest, with their skirts [m]."""
    return setup["draft"] + (setup["skirtDepth"] if isSkirted(name) else 0.0)


def frontAtRest(name):
    return setup["front"] * draft(name) / setup["draft"]


def front(name, h, level, begin, end):
    """Area of the floats across the stream below a level [m^2], mean over time: they turn, and the stream draws them down."""
    chosen = (h.time > begin) & (h.time <= end + 1e-9)
    area = 0.0
    for body in (h["bodies/" + member] for member in floats(h)):
        across = driftwood.turned(body.orientation, np.array([0.0, setup["floatLength"], 0.0]))[:, 1]
        sunk = level - setup["depth"] + body.position[0, 2] - body.position[:, 2]
        area += (across * np.clip(draft(name) + sunk, 0, draft(name) + setup["draft"]))[chosen].mean()
    return area


def dragCoefficient(force, area):
    return force / (500 * setup["speed"]**2 * area)


def parabola(load, sagNow):
    """Tension across the stream of a line from bank to bank under a load that is even over its span [N]: w L^2/(8 f), [1] of README.md."""
    return load * setup["width"] / (8 * sagNow)


def loads(case, h, rows):
    """Series along the channel [N], all positive downstream: what the end lines hold, what water, and logs and banks do to the floats, what the banks hold of all
    bodies; and the tension across the stream, mean of both ends."""
    bodies = [h["bodies/" + name] for name in floats(h)]
    onFloats = -sum(rows[name][:, 1] for name in ends(rows))
    water = sum(body.fluidForce[1:, 0] for body in bodies)
    contact = sum(body.contactForce[1:, 0] for body in bodies) + onFloats  # contactForce has the lines' in it, of links the sum is nothing
    banks = flotsam.stepTable(case, "banks", "force.dat")[:, 10]
    across = 0.5 * sum(np.abs(rows[name][:, 2]) for name in ends(rows))
    return dict(lines=onFloats, water=water, logs=contact, banks=banks, across=across)


# --- water and means --------------------------------------------------------------------------------------------------

def froude(depth):
    return setup["discharge"] / (setup["width"] * depth) / np.sqrt(momentum.GRAVITY * depth)


def depths(case):
    """Times, mean depths of the reaches upstream and downstream [m]."""
    written = flotsam.times(case)
    return np.array(written), np.array([[driftwood.reachDepth(case, t, *reach, setup["height"]) for reach in (UPSTREAM, DOWNSTREAM)] for t in written])


def _mean(h, values, begin, end):
    """Of series with a value for each step, its steps weighted by their lengths."""
    chosen = (h.time[1:] > begin) & (h.time[1:] <= end + 1e-9)
    return np.average(values[chosen], weights=h.run["dt"][1:][chosen])


def _theorem(case, run, load, begin, end):
    """What the lines hold by the momentum theorem, and what enters upstream [N]. The theorem's "force on structures" is what is left of the balance here: there are
    no structures, and what holds the bodies (contactForce, lines included) is in it."""
    reach = momentum.Reach(*SECTIONS, setup["width"], setup["height"])
    time = run["time"]
    chosen = time[(time >= begin - 1e-9) & (time <= end + 1e-9)]
    left, entering = momentum.forceOnStructures(case, run["history"], reach, chosen)
    return load + left - momentum.gainOfBodies(run["history"], reach, chosen[0], chosen[-1]) / (chosen[-1] - chosen[0]), entering


def _part(name, run, begin, end):
    """Means over a time."""
    h = run["history"]
    part = {what: _mean(h, values, begin, end) for what, values in run["loads"].items()}
    part["sag"] = _mean(h, run["sag"][1:], begin, end)
    part["parabola"] = parabola(part["lines"], part["sag"])
    part["tension"] = {line: _mean(h, rows[:, 4], begin, end) for line, rows in run["lines"].items()}
    chosen = (run["time"] > begin) & (run["time"] <= end + 1e-9)
    part["up"], part["down"] = run["depth"][chosen].mean(0)
    part["front"] = front(name, h, part["up"], begin, end)
    part["theorem"], part["entering"] = _theorem(CASES[name], run, part["lines"], begin, end)
    part["shape"] = chainShape(h, begin, end)
    return part


def fullest(run):
    """Written time at which the seconds end in which the boom holds most logs; the last of those."""
    h, time = run["history"], run["time"]
    held = run["held"].sum(0)[1:]
    return max((_mean(h, held, end - SPAN, end), end) for end in time[time >= setup["firstRelease"] + SPAN])[1]


def results():
    """Everything above for both runs; "clean": means over the time before the first log comes in, "with logs": over the seconds in which most are held."""
    out = {}
    for name, case in CASES.items():
        h = history(case)
        time, depth = depths(case)
        rows = {line: flotsam.stepTable(case, "restraints", line + ".dat") for line in lineNames(name)}
        run = dict(history=h, time=time, depth=depth, lines=rows, sag=sag(h), held=isHeld(h), loads=loads(case, h, rows))
        run["clean"] = _part(name, run, setup["firstRelease"] - CLEAN, setup["firstRelease"])
        run["fullest"] = fullest(run)
        run["with logs"] = _part(name, run, run["fullest"] - SPAN, run["fullest"])
        run["final"] = _mean(h, run["loads"]["lines"], time[-1] - SPAN, time[-1])
        run["largest"] = driftwood.largestMean(h.time[1:], run["loads"]["lines"])
        out[name] = run
    return out
