# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of results."""
import flotsam
import rack


def writeSummary(run, file):
    h, setup = run["history"], rack.setup
    rows = [
        ("logs that came in", int(rack.cameIn(h)[-1]), f"of {len(h.bodies)}", ""),
        ("logs held at the end", int(run["held"][:, -1].sum()), "", ""),
        ("logs that passed the rack", int(rack.passed(h)[-1]), "", ""),
        ("volume of the logs over width and depth squared", float(len(h.bodies) * rack.logVolume() / (setup["width"] * setup["depth"]**2)), "", ""),
        ("Froude number", float(rack.froude(setup["depth"])), "", ""),
    ]
    for name in ("clean", "jammed"):
        part = run[name]
        rows += [
            (f"depth upstream, {name}", float(100 * part["up"]), "cm", ""),
            (f"depth downstream, {name}", float(100 * part["down"]), "cm", f"{100 * setup['depth']:g} cm kept by the outlet"),
            (f"loss of head from the force on the rack, {name}", float(1000 * part["loss"]), "mm", f"{1000 * rack.kirschmer(part['up']):.1f} mm: Kirschmer" if name == "clean" else ""),
            (f"outflow, {name}", float(1000 * part["outflow"]), "l/s", f"{1000 * setup['discharge']:g} l/s enter"),
            (f"force of the water on the rack, {name}", float(part["water"]), "N", ""),
            (f"force of the logs on the rack, {name}", float(part["contact"]), "N", ""),
            (f"both, {name}", float(part["water"] + part["contact"]), "N", f"{part['momentum']:.2f} N: momentum theorem"),
        ]
    text = f"""Clean: means from {setup['firstRelease'] - 1:g} to {setup['firstRelease']:g} s, before the first log. Jammed: over the last {rack.LAST:g} s ({h.time[-1]:.1f} s).
Resolution `{setup['resolution']}`, {1000 * setup['discharge']:g} l/s in a channel {setup['width']:g} m wide.

![logs](debrisRack.png)

![series](series.png)
"""
    flotsam.writeSummary(file, "A stream of logs at a rack", rows, text)
