# SPDX-License-Identifier: GPL-3.0-or-later
"""What any case with bodies and structures in a stream is asked: which bodies are held, which passed, how many over time, and the forces on the structures.

A place along the stream is s = direction . x [m]. SI units.
"""
import glob
import os
from collections import namedtuple

import bodyHistory
import contactNetwork
import driftwood
import numpy as np
from bodyHistory import CaseError

SPAN = 0.5      # mean speeds are over so many seconds;
SLOW = 0.25     # a body is at rest where that is less than this share of the speed with which bodies come

Zone = namedtuple("Zone", "begin end")                      # of the structures along the stream [m]
Fate = namedtuple("Fate", "awaited coming held passed left elsewhere")  # bodies x records: exactly one is true. left: taken out, but not downstream


def groupsOf(names):
    """{group: members}: rack.0, rack.1, .. are members of rack."""
    groups = {}
    for name in names:
        stem, _, number = name.rpartition(".")
        groups.setdefault(stem if stem and number.isdigit() else name, []).append(name)
    return groups


def chosen(h, wanted):
    """What is to hold bodies, contactNetwork.Holders: structures, patches that bodies touch and restraints of these names, members or groups. Where none is named: all structures, and all restraints
    that are fastened to points of space."""
    restraints, walls = getattr(h, "restraints", {}).get("names", []), getattr(h, "contacts", {}).get("walls", [])
    if not wanted:
        return contactNetwork.Holders(h.structures, [], restraints)
    kinds = h.structures, walls, restraints
    found = [[name for w in wanted for name in (groupsOf(names).get(w) or ([w] if w in names else []))] for names in kinds]
    missing = [w for w in wanted if not any(w in names or w in groupsOf(names) for names in kinds)]
    if missing:
        there = "; ".join(f"{kind} {', '.join(groupsOf(names))}" for kind, names in zip(("structures", "patches that bodies touch", "restraints"), kinds) if names)
        raise CaseError(f"nothing of the name {missing[0]} holds bodies; there are: {there or 'none'}")
    return contactNetwork.Holders(*found)


def streamDirection(h, vertical=None):
    """The axis, and the sense along it, in which bodies come farthest, all together. Along the vertical (an axis) they fall into the stream, or are lifted by it: that counts only
    where they get no farther than they are long otherwise."""
    way, length = np.zeros(3), 0.0
    for name in h.bodies:
        came = np.flatnonzero(h["bodies/" + name].awaited < 0.5)
        if len(came):
            way += h["bodies/" + name].position[-1] - h["bodies/" + name].position[came[0]]
            length += h["bodies/" + name].longest
    if vertical is not None and np.abs(np.delete(way, vertical)).max() > length:
        way[vertical] = 0
    axis = np.argmax(np.abs(way))
    return np.sign(way[axis] or 1) * np.eye(3)[axis]


def zoneOf(h, structures, direction):
    """Where the structures begin and end along the stream, as they stand at the first written time; None without structures."""
    numbers = [h["structures/" + name].number for name in structures]
    if not numbers or not len(h.surface.get("time", [])):
        return None
    points = h.surface["points"][: len(h.surface["points"]) // len(h.surface["time"])]
    s = points[h.surface["triangles"][np.isin(h.surface["member"], numbers)]].reshape(-1, 3) @ direction
    return Zone(s.min(), s.max())


def fates(h, zone, direction, holders=contactNetwork.Holders([], [], [])):
    """What has become of each body in each record. Held: at rest, and not beyond the structures' end; passed: the centre is beyond it. Where the file has contacts, what is at rest
    and not connected with one of the holders, by way of other bodies or none, rests elsewhere: on a bank, on the bed, or it waits to be let go."""
    if not h.bodies:
        return Fate(*np.zeros((6, 0, len(h.time)), dtype=bool))
    s = driftwood.positions(h) @ direction
    awaited = np.array([h["bodies/" + name].awaited > 0.5 for name in h.bodies])
    left = np.array([h["bodies/" + name].left > 0.5 for name in h.bodies])
    span = min(SPAN, 0.5 * h.time[-1])
    speed = np.where(_isNew(h, awaited, span), np.inf, driftwood.meanSpeed(h, span))
    approach = approachSpeed(speed, awaited | left)
    isBeyond = ~awaited & (s > zone.end)
    isRest = ~awaited & ~left & ~isBeyond & (speed < SLOW * approach)
    isHeld = isRest & contactNetwork.isConnected(h, holders, SPAN) if contactNetwork.isKnown(h, holders) else isRest
    return Fate(awaited, ~awaited & ~left & ~isBeyond & ~isRest, isHeld, isBeyond, left & ~isBeyond, isRest & ~isHeld)


def _isNew(h, awaited, span):
    """Until `span` seconds after it has come in a body's mean speed is not its own, bodies x records."""
    arrival = h.time[np.minimum(awaited.sum(1), len(h.time) - 1)]
    return awaited[:, :1] & (h.time < arrival[:, None] + span)


def approachSpeed(speed, isNotThere):
    """Median over the bodies of the largest mean speed of each [m/s]."""
    largest = np.where(np.isfinite(speed) & ~isNotThere, speed, 0).max(axis=1)
    return np.median(largest[largest > 0]) if (largest > 0).any() else 0.0


def retention(fate):
    """Share of the bodies that have come to the structures which they hold, per record; nan until one has come."""
    came = (fate.held | fate.passed).sum(0)
    return np.where(came > 0, fate.held.sum(0) / np.maximum(came, 1), np.nan)


def meanLongest(h, isMeant):
    """Mean of the longest extents of some bodies [m]: which logs a rack lets through. None where there are none, or the file does not say."""
    extents = [h["bodies/" + name].longest for name, isOne in zip(h.bodies, isMeant) if isOne]
    return float(np.mean(extents)) if extents and np.isfinite(extents).all() else None


def confidence(held, came):
    """Of a share that was found with so many: the interval that holds the true one in 95 of 100 cases, were bodies independent (Wilson 1927, doi 10.2307/2276774)."""
    z = 1.959964
    share, spread = held / came, z * z / came
    middle = (share + 0.5 * spread) / (1 + spread)
    half = z / (1 + spread) * np.sqrt(share * (1 - share) / came + 0.25 * spread / came)
    return max(0.0, middle - half), min(1.0, middle + half)     # round-off shows as -0 %


# --- forces -----------------------------------------------------------------------------------------------------------

Series = namedtuple("Series", "time dt water contact peak")     # of each step: vectors [N], n x 3; peak: largest force of bodies at an instant of it [N]
Force = namedtuple("Force", "water contact largest impact impactTime")


def structureSeries(h, names):
    """Of some structures together; peak: of the one that is struck hardest."""
    water, contact = (sum(getattr(h["structures/" + name], quantity) for name in names) for quantity in ("fluidForce", "contactForce"))
    peaks = [np.linalg.norm(h["structures/" + name].peakContactForce, axis=1) for name in names]
    return Series(h.time, h.run["dt"], water, contact, np.max(peaks, axis=0))


def patchSeries(case):
    """{name: Series} of the walls of the mesh whose forces wallForces asked for."""
    root, found = os.path.join(case, "postProcessing"), {}
    for name in sorted(os.listdir(root)) if os.path.isdir(root) else []:
        if glob.glob(os.path.join(root, name, "*", "force.dat")) and glob.glob(os.path.join(root, name, "*", "moment.dat")):
            table = bodyHistory.stepTable(case, name, "force.dat")
            if len(table) < 2 or table.shape[1] != 16:
                continue    # of OpenFOAM's own function object
            found[name] = Series(table[:, 0], np.diff(table[:, 0], prepend=2 * table[0, 0] - table[1, 0]), table[:, 4:7] + table[:, 7:10], table[:, 10:13], np.linalg.norm(table[:, 13:16], axis=1))
    return found


def forceOf(series, direction, start):
    """Means of water and bodies from `start` on (vectors), the largest mean over 0.1 s of both along the stream, the largest force of one impact, and its time [N, s]."""
    isLate = series.time >= start
    dt = series.dt[isLate]
    both = slidingMean(series.time, series.dt, (series.water + series.contact) @ direction)
    at = np.argmax(series.peak)
    return Force(dt @ series.water[isLate] / dt.sum(), dt @ series.contact[isLate] / dt.sum(), both[np.argmax(np.abs(both))], series.peak[at], series.time[at])


def slidingMean(time, dt, values, span=0.1):
    """Means over `span` seconds that end with each step, of values that hold over their step; over all there is where that is shorter."""
    impulse = np.cumsum(values * dt)
    begin = np.maximum(time - span, time[0] - dt[0])
    before = np.interp(begin, np.concatenate(([time[0] - dt[0] - 1e-9], time)), np.concatenate(([0.0], impulse)))
    isWhole = time - begin >= min(span, time[-1] - time[0]) * (1 - 1e-9)
    return ((impulse - before) / np.maximum(time - begin, 1e-300))[isWhole]
