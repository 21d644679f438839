# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of results."""
import boom
import flotsam


def writeSummary(runs, file):
    setup = boom.setup
    rows = [("Froude number", float(boom.froude(setup["depth"])), "", "")]
    for name, run in runs.items():
        rows += _ofRun(name, run)
    text = f"""Clean: means from {setup['firstRelease'] - boom.CLEAN:g} to {setup['firstRelease']:g} s, before the first log. With logs: over the {boom.SPAN:g} s in which most
are held ({', '.join(f"{name} up to {run['fullest']:g} s" for name, run in runs.items())}).
Resolution `{setup['resolution']}`, {1000 * setup['discharge']:g} l/s in a channel {setup['width']:g} m wide.

![logs](debrisBoom.png)

![series](series.png)
"""
    flotsam.writeSummary(file, "Logs drift onto a boom", rows, text)


def _ofRun(name, run):
    h, clean = run["history"], run["clean"]
    rows = [
        (f"logs that came in, {name}", int(boom.cameIn(h)[-1]), f"of {int(boom.setup['nLogs'])}", ""),
        (f"most logs held at a time, {name}", int(run["held"].sum(0).max()), "", ""),
        (f"logs held at the end, {name}", int(run["held"][:, -1].sum()), "", ""),
        (f"logs that passed the boom, {name}", int(boom.passed(h)[-1]), "", ""),
        (f"drag coefficient of the clean boom, {name}", float(boom.dragCoefficient(clean["lines"], clean["front"])), "", f"{boom.RIGID}: rule for a rigid barrier"),
    ]
    for state in ("clean", "with logs"):
        part = run[state]
        rows += [
            (f"load of the boom along the channel, {name}, {state}", float(part["lines"]), "N", f"{part['theorem']:.3g} N: momentum theorem"),
            (f"of it by the water, {name}, {state}", float(part["water"]), "N", ""),
            (f"of it by logs, {name}, {state}", float(part["logs"]), "N", ""),
            (f"sag, {name}, {state}", float(100 * part["sag"]), "cm", ""),
            (f"tension across the channel, {name}, {state}", float(part["across"]), "N", f"{part['parabola']:.3g} N: parabola"),
            (f"largest mean tension of a line, {name}, {state}", float(max(part["tension"].values())), "N", ""),
            (f"depth upstream less depth downstream, {name}, {state}", float(1000 * (part["up"] - part["down"])), "mm", ""),
        ]
    largest = max(lines[:, 5].max() for lines in run["lines"].values())
    return rows + [(f"load, largest mean over one second, {name}", float(run["largest"]), "N", ""), (f"largest tension of all, {name}", float(largest), "N", f"lines break at {boom.setup['breakingForce']:g} N")]
