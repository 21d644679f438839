# SPDX-License-Identifier: GPL-3.0-or-later
"""bodies.h5: series of bodies and structures, and what follows from them. Part of flotsam.py, which has its names, too."""
import os
from collections import namedtuple

import h5py
import numpy as np


OF_STEPS = {"contactForce", "contactMoment"}   # a record has the mean over the step that ends with it; the fluid's is that at its end (momentumLoad)


class CaseError(RuntimeError):
    """Something is missing in the case; the message says what and where."""


class Member:
    """Series of one body or structure member: m.position (n x 3), m.fluidForce, ...; m.mass, m.volume, extents m.longest, m.thinnest; m.time."""

    def __init__(self, group):
        self.mass = float(group.attrs.get("mass", 0))
        self.volume = float(group.attrs.get("volume", 0))
        self.longest, self.thinnest = (float(group.attrs.get(name, np.nan)) for name in ("longest", "thinnest"))    # not in files of older versions
        self.number = int(group.attrs.get("member", -1))
        for name in group:
            setattr(self, name, group[name][...])
        self.units = {name: group[name].attrs.get("unit", b"") for name in group}


class History:
    """bodies.h5 as numpy arrays; see history()."""

    def __init__(self, file):
        if not os.path.isfile(file):
            raise CaseError(f"{file}: no such file; has the solver been run?")
        with h5py.File(file, "r") as content:
            self.run = {name: content["run"][name][...] for name in content["run"]}
            self._members = {}
            self.bodies, self.structures = [], []
            for kind, names in (("bodies", self.bodies), ("structures", self.structures)):
                for name in sorted(content.get(kind, {}), key=lambda n: content[kind][n].attrs.get("member", 0)):
                    names.append(name)
                    self._members[kind + "/" + name] = Member(content[kind][name])
            self.surface = {name: content["surface"][name][...] for name in content.get("surface", {})}
            self.restraints = {name: content["restraints"][name][...] for name in content.get("restraints", {})}
            if self.restraints:
                self.restraints["names"] = content["restraints"].attrs["names"].decode().split()
            self.contacts = {name: content["contacts"][name][...] for name in content.get("contacts", {})}
            if self.contacts:
                self.contacts["walls"] = content["contacts"].attrs["walls"].decode().split()
        self.time = self.run["time"]

    def __getitem__(self, name):
        """A member by name; "bodies/x" or "structures/x" where both have an x."""
        found = [m for m in (name, "bodies/" + name, "structures/" + name) if m in self._members]
        if not found:
            raise CaseError(f"no body or structure {name}; there are: {', '.join(self.bodies + self.structures)}")
        return self._members[found[0]]

    def isThere(self, name):
        """Per record: whether the body is in the mesh, neither to come (beforeRelease absent) nor gone."""
        return (self[name].awaited < 0.5) & (self[name].left < 0.5)

    def at(self, name, quantity, time):
        """A series of a member, linear between the records."""
        values = getattr(self[name], quantity)
        if values.ndim == 1:
            return np.interp(time, self.time, values)
        return np.stack([np.interp(time, self.time, values[:, d]) for d in range(values.shape[1])], axis=-1)

    def mean(self, name, quantity, start, end=np.inf):
        """Mean of a series over time from start to end: contact is constant over each step, the rest linear between the records."""
        chosen = (self.time >= start) & (self.time <= end)
        if chosen.sum() < 2:
            raise CaseError(f"fewer than two records between {start:g} s and {end:g} s")
        t, values = self.time[chosen], getattr(self[name], quantity)[chosen]
        ofStep = values[1:] if quantity in OF_STEPS else 0.5 * (values[1:] + values[:-1])
        return np.diff(t) @ ofStep / (t[-1] - t[0])


def historyFile(case):
    """The bodies.h5 of a case (or of the folder that holds it); None where there is none."""
    for path in ("postProcessing/flotsam/bodies.h5", "bodies.h5"):
        if os.path.isfile(os.path.join(case, path)):
            return os.path.join(case, path)
    return None


def history(path):
    """History of a bodies.h5, given itself, its folder or the case."""
    return History((historyFile(path) or os.path.join(path, "bodies.h5")) if os.path.isdir(path) else path)


def stepTable(case, folder, name):
    """Rows of a table with a line for each step (postProcessing/<folder>/<start time>/<name>: of restraints, of wallForces) from all runs that went on, each until the next begins."""
    root = os.path.join(case, "postProcessing", folder)
    starts = sorted(os.listdir(root) if os.path.isdir(root) else [], key=float)
    parts = [_rows(_newest(os.path.join(root, start), name)) for start in starts]
    if not parts:
        raise CaseError(f"{root}: no {name}; has the solver been run?")
    for k, start in enumerate(starts[1:]):
        parts[k] = parts[k][parts[k][:, 0] < float(start) * (1 + 1e-9) + 1e-12]     # later ones were computed once more
    return np.concatenate([part for part in parts if len(part)] or parts[:1])


def _rows(file):
    """Of a table whose heading has `#`; one column of none where a run was at its end already."""
    with open(file, encoding="utf-8") as table:
        rows = [line.split() for line in table if line[0] != "#"]
    return np.array(rows, dtype=float) if rows else np.zeros((0, 1))


def _newest(folder, name):
    """Of name, name_1, name_2, ..: a run that begins at the same time as an earlier one leaves that one's file as it is."""
    stem, ending = os.path.splitext(name)
    number, found = 0, os.path.join(folder, name)
    while os.path.isfile(os.path.join(folder, f"{stem}_{number + 1}{ending}")):
        number += 1
        found = os.path.join(folder, f"{stem}_{number}{ending}")
    if not os.path.isfile(found):
        raise CaseError(f"{found}: no such file; there are: {', '.join(sorted(os.listdir(folder)))}")
    return found


def sumForce(h, names, quantity="fluidForce"):
    """Sum of a series over members, n x 3."""
    return sum((getattr(h[name], quantity) for name in names), np.zeros((len(h.time), 3)))


def momentumLoad(h, name, gravity, released=0.0):
    """Load of fluid and weight on a body as it changes its momentum in every step, n x 3 [N]: to round-off

        mass (velocity[k] - velocity[k-1]) = (momentumLoad[k] + contactForce[k]) dt[k]

    fluidForce is that at the step's end in the sense of BDF2: a step gets a part of it, and of the step's before the rest (docs/numerics, 6.1), so that plain sums of
    fluidForce dt agree over many steps only. gravity: vector [m/s2]; released: time until which the body is held [s]. For timeOrder 2, the default.
    """
    member = h["bodies/" + name]
    dt, new = h.run["dt"], member.fluidForce + member.mass * np.asarray(gravity, dtype=float)
    isFree = h.isThere("bodies/" + name)[1:] & (h.time[:-1] >= released - 1e-9)
    load = np.zeros_like(new)
    isFirst = True
    for k in np.flatnonzero(isFree) + 1:
        ratio = dt[k] / dt[k - 1] if not isFirst else 0.0
        share = (1 + ratio) / (1 + 2 * ratio)
        load[k] = share * new[k] + (1 - share) * load[k - 1]
        isFirst = False
    return load


Impact = namedtuple("Impact", "begin end peak at impulse")


def impacts(h, name, least=0.0):
    """When a body or structure is struck: a list of Impact(begin, end [s], peak: largest force [N], at: end of the step it falls in [s], impulse: vector [N s]), one for each
    run of steps in which its contact force exceeds `least` [N] at some instant. What the peak depends on: docs/contact.md, "Largest force of an impact".
    """
    member = h[name]
    size = np.linalg.norm(member.peakContactForce, axis=1)
    isStruck = np.concatenate(([False], size > least, [False]))
    turns = np.flatnonzero(isStruck[1:] != isStruck[:-1])
    found = []
    for first, end in zip(turns[::2], turns[1::2]):
        steps = slice(first, end)
        hardest = first + np.argmax(size[steps])
        impulse = (member.contactForce * h.run["dt"][:, None])[steps].sum(axis=0)
        found.append(Impact(h.time[first] - h.run["dt"][first], h.time[end - 1], size[hardest], h.time[hardest], impulse))
    return found


def captured(h, inside, names=None):
    """Share per time of the bodies that have come in whose position fulfils `inside` (function: positions n x 3 -> n booleans)."""
    names = ["bodies/" + name for name in (h.bodies if names is None else names)]
    nInside = sum((inside(h[name].position) & (h[name].awaited < 0.5) for name in names), np.zeros(len(h.time)))
    return nInside / np.maximum(sum((h[name].awaited < 0.5 for name in names), np.zeros(len(h.time))), 1)
