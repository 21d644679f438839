# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of results."""
import channel
import flotsam


def writeSummary(runs, file):
    logged, free = runs["with logs"], runs["without logs"]
    h, setup = logged["history"], channel.setup
    held = channel.isHeld(h)
    rows = [
        ("most logs held at a time", int(held.sum(0).max()), f"of {len(h.bodies)}", ""),
        ("logs held at the end", int(held[:, -1].sum()), f"of {len(h.bodies)}", ""),
        ("logs downstream of the pier at the end", int(channel.passedLogs(h)[-1]), f"of {len(h.bodies)}", ""),
        ("drag coefficient of the pier, without logs", float(channel.dragCoefficient(free["force"]["water"], free["down"])), "", "AASHTO 0.7, HEC-RAS 1.33"),
    ]
    hits = flotsam.impacts(h, "pier")
    if hits:
        hardest = max(hits, key=lambda hit: hit.peak)
        rows.append((f"largest force of an impact on the pier, {hardest.at:.2f} s", float(hardest.peak), "N", "with `contact` of constant/bodies: docs/contact.md"))
    for name, run in runs.items():
        rows += [
            (f"depth upstream, {name}", float(100 * run["up"]), "cm", ""),
            (f"depth downstream, {name}", float(100 * run["down"]), "cm", f"{100 * setup['depth']:g} cm kept by the outlet"),
            (f"outflow, {name}", float(1000 * run["outflow"]), "l/s", f"{1000 * setup['discharge']:g} l/s enter"),
            (f"force of the water on the pier, {name}", float(run["force"]["water"]), "N", ""),
            (f"force of the logs on the pier, {name}", float(run["force"]["logs"]), "N", ""),
            (f"the same, largest mean over one second, {name}", float(run["heldForce"]), "N", ""),
            (f"both, {name}", float(sum(run["force"].values())), "N", f"{run['momentum']:.2f} N: momentum theorem"),
        ]
    text = f"""Means over the last {channel.LAST:g} s ({h.time[-1]:.1f} s). Resolution `{setup['resolution']}`, {1000 * setup['discharge']:g} l/s in a channel
{setup['width']:g} m wide and {setup['depth']:g} m deep; pier {setup['pierWidth']:g} m thick, {setup['pierLength']:g} m long.

![from above and from the side](bridgePier.png)

![the pier's nose](near.png)

Speed along the channel 4 cm below the undisturbed level:

![velocity](velocity.png)

![series](series.png)
"""
    flotsam.writeSummary(file, "Logs at a bridge pier", rows, text)
