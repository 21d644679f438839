# SPDX-License-Identifier: GPL-3.0-or-later
"""contacts.py CASE..: at every write time the contacts of each body add up to its contactForce, less what restraints do to it, those of each structure to its; contacts.xdmf shows them all.

Exits with the number of checks that fail."""
import re
import sys
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

import checks

import flotsam

ROUND_OFF = 1e-10   # of the largest force of a contact


def restraintForces(case, h, time):
    """{member: force} of restraints over the step that ends at `time`; ends by constant/bodies."""
    text = open(f"{case}/constant/bodies", encoding="utf-8").read()
    forces = {}
    for name in h.restraints.get("names", []):
        table = flotsam.stepTable(case, "restraints", name + ".dat")
        force = table[np.argmin(np.abs(table[:, 0] - time)), 1:4]
        entry = re.search(rf"\b{name}\s*{{([^}}]*)}}", text).group(1)
        for key, sign in (("body", 1), ("otherBody", -1), ("otherStructure", -1)):
            found = re.search(rf"\b{key}\s+(\S+?);", entry)
            if found:
                forces[found.group(1)] = forces.get(found.group(1), 0) + sign * force
    return forces


def checkSums(case):
    h = flotsam.history(case)
    c = h.contacts
    checks.check(f"{case}: times beside those of the surfaces [s]", np.abs(c["time"] - h.surface["time"]).max(), 0, 0)
    checks.check(f"{case}: rows of all times", c["begin"][-1], len(c["force"]), 0)
    worst = {"bodies/": 0.0, "structures/": 0.0}
    partners = set()
    for k, time in enumerate(c["time"]):
        rows = slice(c["begin"][k], c["begin"][k + 1])
        first, second, force = c["first"][rows], c["second"][rows], c["force"][rows]
        scale = np.linalg.norm(force, axis=1).max(initial=1e-300)
        record = np.argmin(np.abs(h.time - time))
        restraints = restraintForces(case, h, time) if record else {}
        for kind, names in (("bodies/", h.bodies), ("structures/", h.structures)):
            for name in names:
                member = h[kind + name]
                if kind == "bodies/" and member.left[record] > 0.5:
                    continue    # its contactForce is 0, what it did to others in its last step is there
                found = force[first == member.number].sum(0) - force[second == member.number].sum(0) + restraints.get(name, 0)
                worst[kind] = max(worst[kind], np.abs(found - member.contactForce[record]).max() / max(scale, np.abs(member.contactForce[record]).max()))
        partners |= set(zip(first, second))
    members = len(h.bodies) + len(h.structures)
    kinds = {"patch" if b >= members else "structure" if b < len(h.structures) else "body" for a, b in partners}
    checks.check(f"{case}: contacts of bodies less their contactForce, over the largest", worst["bodies/"], 0, ROUND_OFF)
    checks.check(f"{case}: the same of structures", worst["structures/"], 0, ROUND_OFF)
    print(f"{case}: {len(c['force'])} rows at {len(c['time'])} times, with {', '.join(sorted(kinds))}; walls {c['walls']}")
    return h, kinds


def numbers(case, item):
    """Of a DataItem of XDMF: given there, a data set, or some rows of one."""
    if item.get("Format") == "XML":
        return np.array(item.text.split(), dtype=float)
    if item.get("ItemType") == "HyperSlab":
        slab, source = item
        (first, _), _, (count, columns) = np.array(slab.text.split(), dtype=int).reshape(3, 2)
        rows = numbers(case, source)
        if list(rows.shape) != [int(n) for n in source.get("Dimensions").split()][: rows.ndim]:
            checks.check(f"{case}: size of {source.text}", rows.shape[0], int(source.get("Dimensions").split()[0]), 0)
        return rows.reshape(-1, columns)[first : first + count]
    file, path = item.text.split(":")
    with h5py.File(f"{case}/postProcessing/flotsam/{file}") as content:
        return content[path][...]


def checkXdmf(case, h):
    c = h.contacts
    grids = ElementTree.parse(f"{case}/postProcessing/flotsam/contacts.xdmf").getroot().findall("./Domain/Grid/Grid")
    checks.check(f"{case}: times of contacts.xdmf", len(grids), len(c["time"]), 0)
    for k, grid in enumerate(grids):
        rows = slice(c["begin"][k], c["begin"][k + 1])
        topology, geometry = numbers(case, grid.find("Topology")[0]), numbers(case, grid.find("Geometry")[0]).reshape(-1, 3)
        shown = {a.get("Name"): numbers(case, a[0]) for a in grid.findall("Attribute")}
        if rows.start == rows.stop:
            checks.check(f"{case}: a point where there are none", int(grid.find("Topology").get("NumberOfElements")), 1, 0)
            continue
        lines = geometry[topology.astype(int)]
        checks.check(f"{case}: line and force of the contacts, time {k}", np.abs(shown["force"] - c["force"][rows]).max() + np.abs(lines.reshape(-1, 3) - c["line"][3 * rows.start : 3 * rows.stop]).max(), 0, 0)
        record = np.argmin(np.abs(h.time - c["time"][k]))
        begin = {h[name].number: h[name].position[record] for name in h.bodies}
        checks.check(f"{case}: lines begin at their bodies [m]", max(np.abs(line[0] - begin[a]).max() for line, a in zip(lines, c["first"][rows])), 0, 1e-12)
        ends = np.array([begin.get(b, p) for b, p in zip(c["second"][rows], c["point"][rows])])
        checks.check(f"{case}: and end at the others or at the point [m]", np.abs(lines[:, 2] - ends).max(), 0, 1e-12)


wanted = set(sys.argv[1].split(","))
met = set()
for folder in sys.argv[2:]:
    history, kinds = checkSums(folder)
    checkXdmf(folder, history)
    met |= kinds
checks.check(f"partners met of {', '.join(sorted(wanted))}", len(wanted - met), 0, 0)
sys.exit(checks.count())
