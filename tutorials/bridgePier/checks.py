# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold in the two runs of the channel."""
import channel
import driftwood
import numpy as np

OVERLAP = 1e-3      # of logs and pier [m]: a twenty-fourth of a log


def check(report, runs):
    """Adds every check to the report."""
    driftwood.checkRuns(report, channel.CASES, runs)
    _checkFlow(report, runs)
    _checkPier(report, runs["without logs"])
    _checkLogs(report, runs["with logs"])
    _checkLoad(report, runs["with logs"], runs["without logs"])


def _checkFlow(report, runs):
    for name, run in runs.items():
        report.compare(f"inflow, {name}", 1000 * run["inflow"], 1000 * channel.setup["discharge"], 0.001, "l/s", "discharge")
    report.compare("outflow, without logs", 1000 * runs["without logs"]["outflow"], 1000 * channel.setup["discharge"], 0.03, "l/s", "discharge")
    report.show("outflow, with logs", 1000 * runs["with logs"]["outflow"], "l/s", "less: the water upstream still rises")
    for name, run in runs.items():
        report.compare(f"depth downstream, {name}", 100 * run["down"], 100 * channel.setup["depth"], 0.02, "cm", "level kept by the outlet")


def _checkPier(report, run):
    depth, force = run["down"], run["force"]["water"]
    report.within("drag coefficient of the pier", channel.dragCoefficient(force, depth), 0.7, 1.33, "", "AASHTO 0.7, HEC-RAS 1.33")
    rise = run["up"] - run["down"]
    alone = force / (9810 * channel.setup["width"] * depth * (1 - channel.froude2(depth)))
    # Yarnell's formula is an upper end: measured backwater lies below it (Charbeneau and Holley); the lower one is that of drag 0.7, less the waves left
    report.within("backwater of the pier", 1000 * rise, 1.0, 1000 * channel.yarnell(depth), "mm", "1.6 from AASHTO's drag, less 0.5 of waves .. Yarnell")
    report.show("the same from the force, momentum theorem in 1D", 1000 * alone, "mm", "wake mixed to a uniform flow")


def _checkLogs(report, run):
    h, n = run["history"], int(channel.setup["nLogs"] + channel.setup["nRooted"])
    report.within("logs in the history", len(h.bodies), n, n, source="constant/bodies")
    report.within("fewest logs accounted for at any time", float(channel.accountedLogs(h).min()), n, n, source="none is lost")
    pier = channel.pierOverlap(h)
    report.within("deepest overlap of two logs", driftwood.deepestOverlap(h, channel.surfaces(h)), -1, OVERLAP, "m", "from the poses")
    report.within("deepest overlap of a log and the pier", pier.max(), -1, OVERLAP, "m", "from the poses")
    report.within("deepest overlap of all contacts", np.max(h.run["largestOverlap"]), 0, OVERLAP, "m", "as the solver found it")
    report.show("logs that touched the pier", (pier.max(1) > -OVERLAP).sum(), "", f"of {n}")
    report.show("logs downstream of the pier at the end", channel.passedLogs(h)[-1], "", f"of {n}")
    held = channel.isHeld(h).mean(0)
    report.within("largest share of the logs held at a time", held.max(), 0.4, 1, "", "lodged at the nose or behind others")
    report.show("share of the logs held at the end", held[-1], "", "whether the heap breaks up before is chance")


def _checkLoad(report, logged, free):
    for name, run in (("with logs", logged), ("without logs", free)):
        force = sum(run["force"].values())
        report.show(f"force of the water on the pier, {name}", run["force"]["water"], "N")
        if name == "with logs":
            report.show("force of the logs on the pier", run["force"]["logs"], "N", "0 where the heap has broken up")
            report.within("the same, largest mean over one second", run["heldForce"], 0.1, 50, "N", "held logs push downstream")
        report.compare(f"force on the pier, {name}", force, run["momentum"], 0.1 if name == "with logs" else 0.2, "N", "momentum theorem, from the fields")
        report.within(f"difference of the two over what enters upstream, {name}", abs(force - run["momentum"]) / run["entering"], 0, 0.005, "",
                      f"{run['entering']:.3g} N of pressure and momentum")
    report.show("backwater of pier and logs", 1000 * (logged["up"] - logged["down"]), "mm")
    report.within("the same, largest mean over one second, over that of the pier alone", logged["heldRise"] / free["heldRise"], 1.2, 50, "", "the logs hold water back")
