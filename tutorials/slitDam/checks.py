# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold in the two runs of the flume."""
import driftwood
import flume
import numpy as np

OVERLAP = 1e-3      # of bars and pipes [m]: a twentieth of a bar


def check(report, runs):
    """Adds every check to the report."""
    driftwood.checkRuns(report, flume.CASES, runs)
    _checkBars(report, runs["with bars"])
    _checkWater(report, runs["with bars"], runs["without bars"])


def _checkBars(report, run):
    h, n = run["history"], int(flume.setup["nBars"])
    report.within("bars in the history", len(h.bodies), n, n, source="constant/bodies")
    report.within("fewest bars accounted for at any time", float(flume.accountedBars(h).min()), n, n, source="none is lost")
    gap = flume.setup["pitch"] - flume.setup["pipeDiameter"]
    if gap < flume.setup["barSide"]:
        report.within("bars that passed the pipes", flume.passedBars(h), 0, 0, source=f"gap {1000 * gap:.1f} mm")
    else:
        report.show("bars that passed the pipes", flume.passedBars(h), source=f"gap {1000 * gap:.1f} mm: they may")
    bar, pipe = flume.overlaps(h)
    report.within("deepest overlap of two bars", bar, -1, OVERLAP, "m", "from the poses")
    report.within("deepest overlap of a bar and a pipe", pipe, -1, OVERLAP, "m", "from the poses")
    report.within("deepest overlap of all contacts", np.max(h.run["largestOverlap"]), 0, OVERLAP, "m", "as the solver found it")
    report.within("share of bars held at the slit at the end", flume.captureRatio(h)[-1], 0.5, 1)
    report.within("force of the bars on the pipes", flume.finalMean(run, run["contact"]).sum(), 0.05, 50, "N", "held bars push downstream")


def _checkWater(report, barred, free):
    drop = flume.setup["slope"] * (flume.DOWNSTREAM - flume.UPSTREAM)   # of the bed between the stations
    for name, run in (("with bars", barred), ("without bars", free)):
        report.within(f"level upstream over level downstream, {name}", run["up"] - run["down"] + drop, 0.02, 0.3, "m", "the slit holds water back")
    report.within("rise of the level upstream by the bars", barred["up"] - free["up"], 0.005, 0.15, "m", "the bars hold water back")
    report.within("discharge coefficient of the slit, without bars", free["coefficient"], flume.LONG_GAP, 1, "", "long gap .. free jet")
    report.within("the same with bars, over that without", barred["coefficient"] / free["coefficient"], 0.1, 0.95, "", "the bars close a part")
    for name, run in (("with bars", barred), ("without bars", free)):
        force = flume.finalMean(run, run["water"]).sum() + flume.finalMean(run, run["contact"]).sum()
        report.show(f"force of water and bars on the pipes, {name}", force, "N", f"{run['momentum']:.4g} N by the momentum theorem, from the fields")
        report.within(f"difference of the two over what enters upstream, {name}", abs(force - run["momentum"]) / run["entering"], 0, 0.1, "",
                      f"momentum balance; {run['entering']:.3g} N of pressure and momentum enter")
