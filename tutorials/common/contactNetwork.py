# SPDX-License-Identifier: GPL-3.0-or-later
"""/contacts of bodies.h5 as a network: who is held by the structures, through whom, and which bodies hold others."""
from collections import namedtuple

import numpy as np

Contacts = namedtuple("Contacts", "time first second point force line")     # of one write time
Key = namedtuple("Key", "name holds force")     # a body, how many others it holds, and its force on structures [N]


def at(h, k):
    """Contacts of write time k of /contacts."""
    c = h.contacts
    rows = slice(c["begin"][k], c["begin"][k + 1])
    return Contacts(c["time"][k], c["first"][rows], c["second"][rows], c["point"][rows], c["force"][rows], c["line"].reshape(-1, 3, 3)[rows])


def isKnown(h, structures):
    """Whether the file says what holds bodies. Not with restraints: what hangs on them is no contact."""
    return bool(structures) and len(getattr(h, "contacts", {}).get("time", [])) > 0 and not getattr(h, "restraints", {})


def links(h, times):
    """Pairs of members, n x 2, that touch at any of these write times."""
    parts = [np.stack((c.first, c.second), axis=1) for c in (at(h, k) for k in times)]
    return np.unique(np.concatenate(parts or [np.zeros((0, 2), dtype=int)]), axis=0)


def reached(pairs, holders, bodies, without=None):
    """Numbers of the bodies from which contacts lead to one of the holders, by way of bodies alone."""
    isOpen = np.isin(pairs, list(bodies) + list(holders)).all(axis=1) & ~(pairs == (-1 if without is None else without)).any(axis=1)
    pairs, found = pairs[isOpen], set(holders)
    while True:
        isFound = np.isin(pairs, list(found))
        new = set(pairs[isFound.any(axis=1)].ravel()) - found
        if not new:
            return found - set(holders)
        found |= new


def holdersOf(h, structures):
    return {h["structures/" + name].number for name in structures}


def numbersOfBodies(h):
    return [h["bodies/" + name].number for name in h.bodies]


def isConnected(h, structures, span):
    """Bodies x records: whether contacts lead to one of the structures. A jam rocks: those of the last `span` seconds count, besides those of the write times before and after."""
    written, numbers, holders = h.contacts["time"], numbersOfBodies(h), holdersOf(h, structures)
    result, known = np.zeros((len(numbers), len(h.time)), dtype=bool), {}
    for r, t in enumerate(h.time):
        first = min(np.searchsorted(written, t - span, "right"), np.searchsorted(written, t, "right") - 1)
        times = range(max(first, 0), min(np.searchsorted(written, t) + 1, len(written)))
        if times not in known:
            found = reached(links(h, times), holders, numbers)
            known[times] = np.isin(numbers, list(found))
        result[:, r] = known[times]
    return result


def keys(h, structures, isHeld):
    """Of the bodies that are held at the last write time those without which others would be held by nothing, the most important first: a log on which a jam hangs."""
    k = len(h.contacts["time"]) - 1
    last, numbers, holders = at(h, k), numbersOfBodies(h), holdersOf(h, structures)
    pairs = links(h, [k])
    held = {number for number, isOne in zip(numbers, isHeld) if isOne} & reached(pairs, holders, numbers)
    result = []
    for name, number in zip(h.bodies, numbers):
        if number not in held:
            continue
        lost = held - reached(pairs, holders, numbers, without=number) - {number}
        onStructures = (last.first == number) & np.isin(last.second, list(holders))
        result.append(Key(name, len(lost), float(np.linalg.norm(last.force[onStructures].sum(0)))))
    return sorted((one for one in result if one.holds or one.force), key=lambda one: (-one.holds, -one.force))
