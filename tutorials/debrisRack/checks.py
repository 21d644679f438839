# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold in the run."""
import driftwood
import numpy as np
import rack

OVERLAP = 1e-3      # of logs and rack [m]: a thirtieth of a log


def check(report, run):
    """Adds every check to the report."""
    driftwood.checkRuns(report, {"logs": rack.CASE}, {"logs": run})
    _checkRack(report, run["clean"])
    _checkLogs(report, run)
    _checkJam(report, run)


def _checkRack(report, clean):
    report.compare("outflow before the logs", 1000 * clean["outflow"], 1000 * rack.setup["discharge"], 0.02, "l/s", "discharge")
    report.compare("depth downstream before the logs", 100 * clean["down"], 100 * rack.setup["depth"], 0.02, "cm", "level kept by the outlet")
    # a formula for bars between walls of water; ours slip, with a numerical drag on two elements in place of the real one
    report.compare("loss of head at the clean rack, from its force", 1000 * clean["loss"], 1000 * rack.kirschmer(clean["up"]), 0.3, "mm", "Kirschmer")


def _checkLogs(report, run):
    h, n = run["history"], int(rack.setup["nLogs"])
    report.within("logs that came in", rack.cameIn(h)[-1], n, n, source="all, one after the other")
    report.within("fewest logs accounted for at any time", float(rack.accounted(h).min()), n, n, source="none is lost")
    report.within("share of the logs held at the end", run["held"][:, -1].mean(), 0.5, 1, "", "bars 6.8 cm apart, logs 16 cm long")
    report.show("logs that passed the rack", rack.passed(h)[-1], "", f"of {n}")
    report.within("deepest overlap of two logs", driftwood.deepestOverlap(h, rack.surfaces(h)), -1, OVERLAP, "m", "from the poses")
    report.within("deepest overlap of a log and the rack", rack.rackOverlap(h), -1, OVERLAP, "m", "from the poses")
    report.within("deepest overlap of all contacts", np.max(h.run["largestOverlap"]), 0, OVERLAP, "m", "as the solver found it")


def _checkJam(report, run):
    for name in ("clean", "jammed"):
        part = run[name]
        force = part["water"] + part["contact"]
        report.show(f"force of water and logs on the rack, {name}", force, "N", f"{part['momentum']:.2f} N by the momentum theorem, from the fields")
        report.within(f"difference of the two over what enters upstream, {name}", abs(force - part["momentum"]) / part["entering"], 0, 0.03, "",
                      f"momentum balance; {part['entering']:.3g} N of pressure and momentum enter")
    report.within("force of the logs on the rack", run["jammed"]["contact"], 0.1, 100, "N", "held logs push downstream")
    rise = (run["jammed"]["up"] - run["jammed"]["down"]) - (run["clean"]["up"] - run["clean"]["down"])
    report.within("backwater of the logs", 1000 * rise, 5, 200, "mm", "the jam holds water back")
