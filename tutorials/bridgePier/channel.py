# SPDX-License-Identifier: GPL-3.0-or-later
"""What is evaluated from the two runs of the channel: levels, discharge, logs held by the pier, overlaps, forces on the pier."""
import driftwood
import flotsam
import momentum
import numpy as np
from tutorial import history, parameters

CASES = {"with logs": "run/withLogs", "without logs": "run/withoutLogs"}
LAST = 2.0                      # means are over the last seconds: more than one period of the wake (about 1 s)
UPSTREAM = -1.0, -0.65          # reaches whose mean depth is taken [m]: upstream of what the pier holds, and where the wake has mixed
DOWNSTREAM = 0.75, 1.1
SECTIONS = -0.65, 0.7           # of the momentum theorem [m]
NEAR = 0.5                      # a log is held when its centre is this near upstream of the nose [m], or beside the nose, and
SLOW = 0.25                     # its speed, mean over half a second, is less than this share of the flow's
ROOT_POINTS = 32                # round the edge of a root wad

setup = parameters(CASES["with logs"], "system/parameters")


# --- logs -------------------------------------------------------------------------------------------------------------

def flowSpeed(depth):
    return setup["discharge"] / (setup["width"] * depth)


def isHeld(h):
    """Whether a log is held by the pier, logs x records."""
    x = driftwood.positions(h)[..., 0]
    return (x > -NEAR) & (x < 0.5 * setup["pierWidth"]) & (driftwood.meanSpeed(h, 0.5) < SLOW * flowSpeed(setup["depth"]))


def accountedLogs(h):
    """Number of logs per record that are inside the channel or left it through the outlet."""
    return driftwood.accounted(driftwood.positions(h), setup)


def passedLogs(h):
    """Number of logs whose centre is downstream of the pier, over time."""
    return (driftwood.positions(h)[..., 0] > setup["pierLength"]).sum(0)


def _row(begin, end, radius):
    """Centres on the axis of a trunk from begin to end: its surface with rounded ends, but for 0.04 mm between two spheres."""
    along = np.linspace(begin + radius, end - radius, int(np.ceil((end - begin - 2 * radius) / (0.16 * radius))) + 1)
    return np.stack([along, 0 * along, 0 * along], axis=1)


def surfaces(h):
    """{log: (centres in its frame, radii)}: trunk and edge of the root wad, made of spheres. Finer than those by which the logs touch."""
    radius, wad, thickness, length = 0.5 * setup["logDiameter"], 0.5 * setup["wadDiameter"], setup["wadThickness"], setup["rootedLength"]
    plain = _row(-0.5 * setup["logLength"], 0.5 * setup["logLength"], radius)
    volumes = wad**2 * thickness, radius**2 * (length - thickness)
    centre = (volumes[0] * 0.5 * thickness + volumes[1] * 0.5 * (length + thickness)) / sum(volumes)   # of mass, from the wad's face
    trunk = _row(0, length, radius) - (centre, 0, 0)
    angle = 2 * np.pi * np.arange(ROOT_POINTS) / ROOT_POINTS
    ring = (wad - 0.5 * thickness) * np.stack([0 * angle, np.cos(angle), np.sin(angle)], axis=1) + (0.5 * thickness - centre, 0, 0)
    rooted = np.concatenate([trunk, ring])
    radii = np.concatenate([np.full(len(trunk), radius), np.full(len(ring), 0.5 * thickness)])
    return {name: (rooted, radii) if name.startswith("rooted") else (plain, np.full(len(plain), radius)) for name in h.bodies}


def pierDistance(x):
    """Distance of points from the pier's surface, negative inside [m]."""
    radius = 0.5 * setup["pierWidth"]
    return np.hypot(x[..., 0] - np.clip(x[..., 0], radius, setup["pierLength"] - radius), x[..., 1]) - radius


def pierOverlap(h):
    """Per log, overlap with the pier over time [m], negative: the gap between them; from the poses."""
    return np.array([(radii - pierDistance(driftwood.inSpace(h["bodies/" + name], local))).max(1) for name, (local, radii) in surfaces(h).items()])


# --- water and forces -------------------------------------------------------------------------------------------------

def froude2(depth):
    """Square of the Froude number of the undisturbed channel."""
    return flowSpeed(depth)**2 / (momentum.GRAVITY * depth)


def yarnell(depth):
    """Backwater of the pier [m] by Yarnell's formula for semicircular nose and tail, K = 0.9; depth downstream."""
    blockage, shape, f = setup["pierWidth"] / setup["width"], 0.9, froude2(depth)
    return depth * shape * (shape + 5 * f - 0.6) * (blockage + 15 * blockage**4) * f


def dragCoefficient(force, depth):
    """Force over the dynamic pressure of the approaching flow on the pier's wetted front."""
    return force / (500 * flowSpeed(depth)**2 * setup["pierWidth"] * depth)


def depths(case):
    """Times, mean depths of the reaches upstream and downstream [m]."""
    written = flotsam.times(case)
    return np.array(written), np.array([[driftwood.reachDepth(case, t, *reach, setup["height"]) for reach in (UPSTREAM, DOWNSTREAM)] for t in written])


def _momentum(case, h, time):
    """Force on the pier by the momentum theorem over the last seconds, and what enters upstream [N]."""
    reach = momentum.Reach(*SECTIONS, setup["width"], setup["height"])
    last = time[time >= time[-1] - LAST - 1e-9]
    force, entering = momentum.forceOnStructures(case, h, reach, last)
    return force - momentum.gainOfBodies(h, reach, last[0], last[-1]) / (last[-1] - last[0]), entering


def results():
    """Everything above for both runs, with means over the last seconds."""
    out = {}
    for name, case in CASES.items():
        h = history(case)
        time, depth = depths(case)
        (water,), (contact,) = driftwood.forcesOn(h, ["pier"])
        run = dict(history=h, time=time, depth=depth, water=water, contact=contact)
        run["up"], run["down"] = driftwood.finalMean(time, depth.T, LAST)
        run["force"] = dict(water=h.mean("pier", "fluidForce", h.time[-1] - LAST)[0], logs=h.mean("pier", "contactForce", h.time[-1] - LAST)[0])
        # chance breaks heaps up before the end: what logs and the water behind them do while most are held
        run["heldForce"] = driftwood.largestMean(h.time, contact)
        run["heldRise"] = driftwood.largestMean(time, depth[:, 0] - depth[:, 1])
        flowTime, inflow, outflow = driftwood.discharge(h)
        run["inflow"], run["outflow"] = (driftwood.finalMean(flowTime, q, LAST) for q in (inflow, outflow))
        run["momentum"], run["entering"] = _momentum(case, h, time)
        out[name] = run
    return out
