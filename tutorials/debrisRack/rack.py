# SPDX-License-Identifier: GPL-3.0-or-later
"""What is evaluated from the run: levels, discharge, logs that came in, are held and passed, overlaps, forces on the rack."""
import driftwood
import flotsam
import momentum
import numpy as np
from tutorial import history, parameters

CASE = "run/rack"
LAST = 2.0                      # means of the jam are over the last seconds,
UPSTREAM = -1.85, -1.45         # reaches whose mean depth is taken [m]: upstream of what the rack holds, and behind the jets
DOWNSTREAM = 0.3, 0.6
SECTIONS = -1.45, 0.5           # of the momentum theorem [m]
NEAR = 1.45                     # a log is held when its centre is this near upstream of the rack [m], and its speed,
SLOW = 0.25                     # mean over half a second, is less than this share of the flow's
KIRSCHMER = 1.79                # round bars

setup = parameters(CASE, "system/parameters")


# --- logs -------------------------------------------------------------------------------------------------------------

def logVolume():
    return 0.25 * np.pi * setup["logDiameter"]**2 * setup["logLength"]


def cameIn(h):
    """Number of logs over time that have come in."""
    return driftwood.cameIn(h, h.bodies)


def isHeld(h):
    """Whether a log is held by the rack, logs x records."""
    x = driftwood.positions(h)[..., 0]
    isThere = np.array([h.isThere("bodies/" + name) for name in h.bodies])
    return isThere & (x > -NEAR) & (x < 0.5 * setup["barDiameter"]) & (driftwood.meanSpeed(h, 0.5) < SLOW * setup["speed"])


def passed(h):
    """Number of logs whose centre is downstream of the rack, over time."""
    return (driftwood.positions(h)[..., 0] > 0.5 * setup["barDiameter"]).sum(0)


def accounted(h):
    """Number of logs per record that are to come, inside the channel, or left it through the outlet."""
    return driftwood.accounted(driftwood.positions(h), setup)


def surfaces(h):
    """{log: (centres in its frame, radii)}: a row of spheres, finer than those by which the logs touch."""
    row = driftwood.row(setup["logDiameter"], setup["logLength"], 0)
    return {name: row for name in h.bodies}


def rackOverlap(h):
    """Deepest overlap of a log and a bar of the rack in all records [m], from the poses."""
    axes = [(0.0, (k - 0.5 * (setup["nBars"] - 1)) * setup["pitch"]) for k in range(int(setup["nBars"]))]
    deepest = -np.inf
    for name, (local, radii) in surfaces(h).items():
        centres = driftwood.inSpace(h["bodies/" + name], local)
        deepest = max(deepest, max((radii + 0.5 * setup["barDiameter"] - np.hypot(centres[..., 0] - x, centres[..., 1] - y)).max() for x, y in axes))
    return deepest


# --- water and forces -------------------------------------------------------------------------------------------------

def froude(depth):
    return setup["discharge"] / (setup["width"] * depth) / np.sqrt(momentum.GRAVITY * depth)


def kirschmer(depth):
    """Loss of the clean rack [m]: 1.79 (s/b)^(4/3) U^2/2g, bars of s, openings of b; depth of the approaching flow."""
    speed = setup["discharge"] / (setup["width"] * depth)
    return KIRSCHMER * (setup["barDiameter"] / setup["clearance"])**(4 / 3) * speed**2 / (2 * momentum.GRAVITY)


def lossOf(force, depth):
    """Loss of head [m] that a force on what stands in the channel makes, momentum theorem in 1D: to first order the same as from the levels, which
    have waves of 2 mm."""
    return force / (1000 * momentum.GRAVITY * setup["width"] * depth)


def depths():
    """Times, mean depths of the reaches upstream and downstream [m]."""
    written = flotsam.times(CASE)
    return np.array(written), np.array([[driftwood.reachDepth(CASE, t, *reach, setup["height"]) for reach in (UPSTREAM, DOWNSTREAM)] for t in written])


def _between(time, values, begin, end):
    return values[..., (time > begin) & (time <= end + 1e-9)].mean(-1)


def results():
    """Everything above; "clean": means over the second before the first log comes in, "jammed": over the last seconds."""
    h = history(CASE)
    time, depth = depths()
    water, contact = driftwood.forcesOn(h, h.structures)
    out = dict(history=h, time=time, depth=depth, water=water.sum(0), contact=contact.sum(0), held=isHeld(h))
    flowTime, _, outflow = driftwood.discharge(h)
    reach = momentum.Reach(*SECTIONS, setup["width"], setup["height"])
    for name, begin, end in (("clean", setup["firstRelease"] - 1, setup["firstRelease"]), ("jammed", time[-1] - LAST, time[-1])):
        part = dict(zip(("up", "down"), _between(time, depth.T, begin, end)))
        part["outflow"] = _between(flowTime, outflow, begin, end)
        part["water"], part["contact"] = (_between(h.time, out[k], begin, end) for k in ("water", "contact"))
        part["loss"] = lossOf(part["water"] + part["contact"], part["up"])
        chosen = time[(time >= begin - 1e-9) & (time <= end + 1e-9)]
        force, part["entering"] = momentum.forceOnStructures(CASE, h, reach, chosen)
        part["momentum"] = force - momentum.gainOfBodies(h, reach, chosen[0], chosen[-1]) / (chosen[-1] - chosen[0])
        out[name] = part
    return out
