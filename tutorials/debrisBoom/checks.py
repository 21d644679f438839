# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold in the two runs. README.md, "Why these bounds": they were stated before the runs."""
import boom
import driftwood
import numpy as np

OVERLAP = 1e-3                                  # of logs and floats [m]: a thirtieth of a log
UNEVEN = {"clean": 0.10, "with logs": 0.25}     # of the load over the span, against the parabola
THEOREM = {"clean": 0.2, "with logs": 0.1}      # as bridgePier's without and with logs
DRAG = 0.6                                      # of the clean boom at least: half of a round bar's in an unbounded stream


def check(report, runs):
    """Adds every check to the report."""
    driftwood.checkRuns(report, boom.CASES, runs)
    for name, run in runs.items():
        steps = len(run["history"].time) - 1
        report.within(f"steps repeated, {name}", boom.repeatedSteps(boom.CASES[name]), 0, 0.01 * steps, "", f"a hundredth of {steps} at most")
        _checkLines(report, name, run)
        for state in ("clean", "with logs"):
            _checkLoad(report, f"{name}, {state}", state, run[state])
        _checkLogs(report, name, run)
    _checkDrag(report, runs)
    _checkHolding(report, runs)


def _checkLines(report, name, run):
    largest = max(run["lines"], key=lambda line: run["lines"][line][:, 5].max())
    report.within(f"largest tension, {name}", run["lines"][largest][:, 5].max(), 0.01, boom.setup["breakingForce"], "N", f"of {largest}; not broken")
    report.within(f"lines broken, {name}", sum(rows[-1, 7] for rows in run["lines"].values()), 0, 0)


def _checkLoad(report, label, state, part):
    load = part["lines"]
    report.show(f"load of the boom along the channel, {label}", load, "N", f"of water {part['water']:.3g}, of logs {part['logs']:.3g} N")
    report.compare(f"held by the end lines, {label}", load, part["water"] + part["logs"], 0.01, "N", "water and logs on the floats")
    if state == "clean":
        report.compare(f"the same, water alone, {label}", load, part["water"], 0.01, "N", "nothing touches the floats")
    report.compare(f"the same, {label}", load, part["theorem"], THEOREM[state], "N", "momentum theorem, from the fields")
    report.within(f"difference of the two over what enters upstream, {label}", abs(load - part["theorem"]) / part["entering"], 0, 0.005, "", f"{part['entering']:.3g} N of pressure and momentum")
    report.show(f"sag, {label}", 100 * part["sag"], "cm", f"{100 * boom.setup['sag']:g} cm at the start")
    report.compare(f"tension across the channel, {label}", part["across"], part["parabola"], UNEVEN[state], "N", "w L^2/(8 f), parabola")


def _checkLogs(report, name, run):
    h, n = run["history"], int(boom.setup["nLogs"])
    report.within(f"logs that came in, {name}", boom.cameIn(h)[-1], n, n, source="all, one after the other")
    report.within(f"fewest logs accounted for at any time, {name}", float(boom.accounted(h).min()), n, n, source="none is lost")
    report.within(f"deepest overlap of two bodies, {name}", driftwood.deepestOverlap(h, boom.surfaces(h)), -1, OVERLAP, "m", "logs and floats, from the poses")
    report.within(f"deepest overlap of all contacts, {name}", np.max(h.run["largestOverlap"]), 0, OVERLAP, "m", "as the solver found it")


def _checkDrag(report, runs):
    for name, run in runs.items():
        clean = run["clean"]
        report.show(f"front of the clean boom under water over that at rest, {name}", clean["front"] / boom.frontAtRest(name), "", "the stream draws the floats down")
        drag = boom.dragCoefficient(clean["lines"], clean["front"])
        if boom.isSkirted(name):    # a third of the depth: no longer a body in a wide stream
            report.show(f"its drag coefficient, {name}", drag, "", "of a third of the depth, without correction for that")
        else:
            report.within(f"its drag coefficient, {name}", drag, DRAG, boom.RIGID, "", "half of a round bar's 1.2 .. rule for a rigid barrier")
        report.show(f"the same with the front at rest, {name}", boom.dragCoefficient(clean["lines"], boom.frontAtRest(name)))


def _checkHolding(report, runs):
    for name, run in runs.items():
        report.show(f"share of the logs held at the end, {name}", run["held"][:, -1].mean())
        report.show(f"logs that passed the boom, {name}", boom.passed(run["history"])[-1], "", f"of {int(boom.setup['nLogs'])}")
        report.show(f"load, largest mean over one second, {name}", run["largest"], "N")
    plain, skirted = (runs[name]["held"].mean(0).max() for name in ("plain", "skirts"))
    report.show("largest share of the logs held at a time, plain", plain)
    report.within("the same, skirts", skirted, max(0.5, plain), 1, "", "at least half, and more than without")
    skirts = runs["skirts"]
    report.show("load over the last seconds over that of the clean boom, skirts", skirts["final"] / skirts["clean"]["lines"], "", "no law says how much: logs shelter the floats")
    report.within("force of the logs on the floats, skirts", skirts["with logs"]["logs"], 0.1, 100, "N", "held logs push downstream")
