# SPDX-License-Identifier: GPL-3.0-or-later
"""/contacts and /restraints of bodies.h5 as a network: who is held by structures, patches and anchors, through whom, and which bodies hold others."""
from collections import namedtuple

import numpy as np

Contacts = namedtuple("Contacts", "time first second point force line")     # of one write time
Key = namedtuple("Key", "name holds force")     # a body, how many others it holds, and its force on the holders [N]
Holders = namedtuple("Holders", "structures patches restraints")    # names; of restraints: the points of space that they are fastened to


def at(h, k):
    """Contacts of write time k of /contacts."""
    c = h.contacts
    rows = slice(c["begin"][k], c["begin"][k + 1])
    return Contacts(c["time"][k], c["first"][rows], c["second"][rows], c["point"][rows], c["force"][rows], c["line"].reshape(-1, 3, 3)[rows])


def isKnown(h, holders):
    """Whether the file says what holds bodies: of older versions it does not, or not what restraints are fastened to."""
    restraints = getattr(h, "restraints", {})
    return any(holders) and len(getattr(h, "contacts", {}).get("time", [])) > 0 and (not restraints or "members" in restraints)


Lines = namedtuple("Lines", "pairs force ends") # of restraints that are there at one time: members or anchors, n x 2; force on the first of each, n x 3 [N]; ends, n x 2 x 3 [m]


def anchor(k):
    """Number of the point of space that restraint k is fastened to, in pairs; members and patches have none below 0."""
    return -2 - k


def linesAt(h, time):
    """Restraints at a write time; neither broken ones nor those with an end that is not there, of which both ends are at one place."""
    r = getattr(h, "restraints", {})
    n = len(r.get("names", []))
    row = np.flatnonzero(np.abs(r["time"] - time) <= 1e-9 * max(time, 1)) if n else []
    if not len(row):
        return Lines(np.zeros((0, 2), dtype=int), np.zeros((0, 3)), np.zeros((0, 2, 3)))
    rows = slice(n * row[0], n * (row[0] + 1))
    ends = r["points"].reshape(-1, 2, 3)[rows]
    way = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(way, axis=1)
    isThere = length > 0
    pairs = np.where(r["members"][rows] < 0, anchor(np.arange(n))[:, None], r["members"][rows])
    return Lines(pairs[isThere], (r["tension"].ravel()[rows, None] * way)[isThere] / length[isThere, None], ends[isThere])


def links(h, times):
    """Pairs that touch, or that restraints connect, at any of these write times, n x 2."""
    parts = [part for k in times for c in [at(h, k)] for part in (np.stack((c.first, c.second), axis=1), linesAt(h, c.time).pairs)]
    return np.unique(np.concatenate(parts or [np.zeros((0, 2), dtype=int)]), axis=0)


def reached(pairs, holders, bodies, without=None):
    """Numbers of the bodies from which contacts and restraints lead to one of the holders, by way of bodies alone."""
    isOpen = np.isin(pairs, list(bodies) + list(holders)).all(axis=1) & ~(pairs == (-1 if without is None else without)).any(axis=1)
    pairs, found = pairs[isOpen], set(holders)
    while True:
        isFound = np.isin(pairs, list(found))
        new = set(pairs[isFound.any(axis=1)].ravel()) - found
        if not new:
            return found - set(holders)
        found |= new


def numbersOf(h, holders):
    """Of structures, patches and anchors in pairs: patches come after all members."""
    members = len(h.bodies) + len(h.structures)
    return ({h["structures/" + name].number for name in holders.structures} | {members + h.contacts["walls"].index(name) for name in holders.patches}
            | {anchor(h.restraints["names"].index(name)) for name in holders.restraints})


def numbersOfBodies(h):
    return [h["bodies/" + name].number for name in h.bodies]


def isConnected(h, holders, span):
    """Bodies x records: whether contacts and restraints lead to one of the holders. A jam rocks: those of the last `span` seconds count, besides those of the write times before and after."""
    written, numbers, ends = h.contacts["time"], numbersOfBodies(h), numbersOf(h, holders)
    result, known = np.zeros((len(numbers), len(h.time)), dtype=bool), {}
    for r, t in enumerate(h.time):
        first = min(np.searchsorted(written, t - span, "right"), np.searchsorted(written, t, "right") - 1)
        times = range(max(first, 0), min(np.searchsorted(written, t) + 1, len(written)))
        if times not in known:
            found = reached(links(h, times), ends, numbers)
            known[times] = np.isin(numbers, list(found))
        result[:, r] = known[times]
    return result


def keys(h, holders, isHeld):
    """Of the bodies that are held at the last write time those without which others would be held by nothing, the most important first: a log on which a jam hangs."""
    k = len(h.contacts["time"]) - 1
    last, numbers, ends = at(h, k), numbersOfBodies(h), numbersOf(h, holders)
    pairs, lines = links(h, [k]), linesAt(h, last.time)
    held = {number for number, isOne in zip(numbers, isHeld) if isOne} & reached(pairs, ends, numbers)
    result = []
    for name, number in zip(h.bodies, numbers):
        if number not in held:
            continue
        lost = held - reached(pairs, ends, numbers, without=number) - {number}
        touches = (last.first == number) & np.isin(last.second, list(ends))
        hangs = (lines.pairs[:, 0] == number) & np.isin(lines.pairs[:, 1], list(ends))
        result.append(Key(name, len(lost), float(np.linalg.norm(last.force[touches].sum(0) + lines.force[hangs].sum(0)))))
    return sorted((one for one in result if one.holds or one.force), key=lambda one: (-one.holds, -one.force))
