# SPDX-License-Identifier: GPL-3.0-or-later
"""flotsamReport: a page of results of any case of flotsamFoam, with plots and pictures: bodies held and passed over time, forces on structures, conservation."""
import argparse
import json
import os
import sys

import clogging
import contactNetwork
import contactScene
import driftwood
import flotsam
import flotsamScene
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

AXES = {sign + name: (-1 if sign == "-" else 1) * np.eye(3)[k] for k, name in enumerate("xyz") for sign in ("", "-")}


def arguments():
    parser = argparse.ArgumentParser(prog="flotsamReport", description="Writes report.md, report.json, plots and pictures of a case into CASE/postProcessing/flotsam/report.")
    parser.add_argument("case", nargs="?", default=".", help="folder of the case (default: this one)")
    parser.add_argument("--direction", choices=[*AXES], help="of the stream (default: that in which bodies come farthest): --direction=-x")
    parser.add_argument("--structures", nargs="+", metavar="NAME", help="that bodies are to be held by: structures, members or groups; patches of the mesh; restraints, by their anchors (default: all structures and restraints)")
    parser.add_argument("--at", type=float, metavar="S", help="where bodies count as passed, along the stream [m], instead of the structures' end: for structures in the mesh")
    parser.add_argument("--start", type=float, metavar="T", help="means of forces are from this time on [s] (default: the last quarter)")
    parser.add_argument("--times", type=float, nargs="+", metavar="T", help="of the pictures [s] (default: a third, two thirds, the end)")
    parser.add_argument("--no-pictures", action="store_true", help="plots and tables only")
    return parser.parse_args()


# --- evaluation -------------------------------------------------------------------------------------------------------

def evaluate(h, series, options):
    """All figures of the report, as in report.json, and what became of the bodies. series: of forces, by name."""
    direction = AXES[options.direction] if options.direction else clogging.streamDirection(h, flotsam.verticalAxis(options.case))
    holders = clogging.chosen(h, options.structures)
    zone = clogging.Zone(options.at, options.at) if options.at is not None else clogging.zoneOf(h, holders.structures, direction)
    if options.structures and h.bodies and not zone:
        raise flotsam.CaseError(f"--structures {' '.join(options.structures)}: no structure of constant/bodies, of which the end would be known; say with --at where bodies have passed")
    if options.at is not None and not options.structures:
        holders = contactNetwork.Holders([], [], [])    # what is in the mesh was not named: whatever is at rest is held
    start = h.time[0] + 0.75 * (h.time[-1] - h.time[0]) if options.start is None else options.start
    if not h.time[0] <= start < h.time[-1]:
        raise flotsam.CaseError(f"--start {start:g}: the run has records from {h.time[0]:g} to {h.time[-1]:g} s")
    figures = {"run": _ofRun(h), "direction": direction.tolist(), "meansFrom": start,
               "forces": {name: _ofForce(clogging.forceOf(one, direction, start)) for name, one in series.items()}}
    fate = None
    if h.bodies:
        figures["bodies"] = {"number": len(h.bodies), "volume": sum(h["bodies/" + name].volume for name in h.bodies)}
    if h.bodies and zone:
        fate = clogging.fates(h, zone, direction, holders)
        figures["bodies"].update(_ofFate(h, fate, zone))
        figures["bodies"]["areContactsKnown"] = contactNetwork.isKnown(h, holders)
        if figures["bodies"]["areContactsKnown"]:
            figures["bodies"]["heldBy"] = ", ".join(name for names in holders for name in clogging.groupsOf(names))
            figures["bodies"]["keys"] = [one._asdict() for one in contactNetwork.keys(h, holders, fate.held[:, -1])]
        figures["bodies"]["longest"] = {name: clogging.meanLongest(h, getattr(fate, name)[:, -1]) for name in ("held", "passed")}
    return figures, fate


def forceSeries(case, h):
    """Of groups of structures, and of walls of the mesh."""
    series = {group: clogging.structureSeries(h, names) for group, names in clogging.groupsOf(h.structures).items()}
    return series | {f"patches {name}": one for name, one in clogging.patchSeries(case).items()}


def _ofRun(h):
    return {"time": h.time[-1], "steps": len(h.time) - 1, "massError": driftwood.massError(h) if h.run["liquidVolume"].max() > 0 else 0.0,
            "largestOverlap": h.run["largestOverlap"].max()}


def _ofForce(force):
    return {"water": force.water.tolist(), "bodies": force.contact.tolist(), "largest": force.largest, "impact": force.impact, "impactTime": force.impactTime}


def _ofFate(h, fate, zone):
    last = {name: int(state[:, -1].sum()) for name, state in fate._asdict().items()}
    isHeld = fate.held.any(0)
    came = last["held"] + last["passed"]
    result = {"begin": zone.begin, "end": zone.end, **last, "firstHeld": h.time[np.argmax(isHeld)] if isHeld.any() else None, "mostHeld": int(fate.held.sum(0).max())}
    if came:
        result.update(retention=float(clogging.retention(fate)[-1]), confidence=list(clogging.confidence(last["held"], came)))
    return result


# --- page -------------------------------------------------------------------------------------------------------------

def page(case, figures, pictures):
    run, bodies = figures["run"], figures.get("bodies")
    stream = next(name for name, axis in AXES.items() if np.array_equal(axis, figures["direction"]))
    rows = [("time reached", run["time"], "s"), ("steps", run["steps"], ""), ("liquid made or lost, over all there was", run["massError"], "")]
    if bodies:
        rows += [("bodies", bodies["number"], ""), ("their volume", bodies["volume"], "m3"), ("deepest overlap of contact surfaces", 1000 * run["largestOverlap"], "mm")]
    if bodies and "held" in bodies:
        rows += [("still to come in; on their way", f"{bodies['awaited']}; {bodies['coming']}", ""), ("held at the end; most at a time", f"{bodies['held']}; {bodies['mostHeld']}", ""),
                 ("passed; left the mesh elsewhere", f"{bodies['passed']}; {bodies['left']}", ""),
                 *([("at rest elsewhere", bodies["elsewhere"], "")] if bodies["areContactsKnown"] else []),
                 ("first held", bodies["firstHeld"] if bodies["firstHeld"] is not None else "never", "s")]
    if bodies and "longest" in bodies and all(bodies["longest"].values()):
        rows.append(("mean longest extent of those held; passed", "{held:.4g}; {passed:.4g}".format(**bodies["longest"]), "m"))
    if bodies and "retention" in bodies:
        low, high = bodies["confidence"]
        rows.append(("held of those that came", f"{100 * bodies['retention']:.0f} ({100 * low:.0f} to {100 * high:.0f})", "%"))
    if bodies or figures["forces"]:
        rows.append(("the stream is along", stream, ""))
    lines = [f"# {os.path.basename(os.path.abspath(case))}", "", "| | | |", "|---|---|---|"] + [f"| {what} | {_shown(value)} | {unit} |" for what, value, unit in rows]
    if figures["forces"]:
        lines += _forceTable(figures)
    if bodies and bodies.get("keys"):
        lines += _keyTable(bodies["keys"])
    if bodies and "held" in bodies:
        touch = f" and connected by contacts or restraints with {bodies['heldBy']}, directly or through others (else: at rest elsewhere)" if bodies["areContactsKnown"] else ""
        lines += ["", f"Held: at rest (less than {clogging.SLOW:g} of the speed with which bodies come, over {clogging.SPAN:g} s) with the centre before {bodies['end']:.4g} m along the stream{touch}; "
                  "passed: beyond. In brackets: what chance leaves open in 95 of 100 cases, were bodies independent."]
    lines += [line for name in pictures for line in ("", f"![{name}]({name})")]
    return "\n".join(lines) + "\n"


def _keyTable(keys, most=8):
    """Of the bodies on which others hang."""
    rest = f" (the first {most} of {len(keys)})" if len(keys) > most else ""
    lines = ["", f"Key bodies at the last write time{rest}: how many others would be connected with what holds them no longer were it not there, and its own force on that.", "",
             "| body | holds | force on what holds it [N] |", "|---|---|---|"]
    return lines + [f"| {one['name']} | {one['holds']} | {one['force']:.4g} |" for one in keys[:most]]


def _forceTable(figures):
    lines = ["", f"Forces [N]: means from {figures['meansFrom']:.4g} s on, of the members of a group together; largest: mean over 0.1 s of both, along the stream; impact: of one moment.", "",
             "| on | water x | y | z | bodies x | y | z | largest | impact, at [s] |", "|---|---|---|---|---|---|---|---|---|"]
    for name, f in figures["forces"].items():
        impact = f"{f['impact']:.4g}, {f['impactTime']:.4g}" if f["impact"] > 0 else "none"
        lines.append("| " + " | ".join([name, *(f"{value:.4g}" for value in f["water"] + f["bodies"] + [f["largest"]]), impact]) + " |")
    return lines


def _shown(value):
    return f"{value:.4g}" if isinstance(value, (float, np.floating)) else str(value)


# --- plots and pictures -----------------------------------------------------------------------------------------------

def plot(h, fate, series, direction, file):
    panels = []
    if fate is not None:
        panels.append(lambda axis: _plotBodies(axis, h, fate))
    if series:
        panels.append(lambda axis: _plotForces(axis, series, direction))
    if h.run["liquidVolume"].max() > 0:
        panels.append(lambda axis: _plotLiquid(axis, h))
    if not panels:
        return []
    figure, axes = plt.subplots(len(panels), 1, figsize=(9, 3 * len(panels)), sharex=True, squeeze=False)
    for drawPanel, axis in zip(panels, axes[:, 0]):
        drawPanel(axis)
    axes[-1, 0].set(xlabel="time [s]")
    driftwood.saveSeries(figure, axes, file)
    return [os.path.basename(file)]


def _plotBodies(axis, h, fate):
    axis.plot(h.time, (~fate.awaited).sum(0), "k", label="came in")
    axis.plot(h.time, fate.held.sum(0), label="held")
    axis.plot(h.time, fate.passed.sum(0), "--", label="passed")
    axis.set(ylabel="bodies", ylim=(0, None))


def _plotForces(axis, series, direction):
    for k, (name, one) in enumerate(list(series.items())[:8]):
        for force, style, what in ((one.water @ direction, "-", "water"), (one.contact @ direction, "--", "bodies")):
            if np.any(force):
                axis.plot(*driftwood.smooth(one.time, force), f"C{k}{style}", label=f"{name}, {what}")
    axis.set(ylabel="force along the stream [N]", title="means over 0.1 s")


def _plotLiquid(axis, h):
    axis.plot(h.time, h.run["liquidVolume"], label="in the mesh")
    for name in ("inflow", "outflow"):
        if np.any(h.run[name]):
            axis.plot(h.time, h.run[name], label={"inflow": "entered", "outflow": "left"}[name])
    axis.set(ylabel="liquid [m3]")


def draw(case, h, wanted, folder):
    written = flotsam.times(case)
    if not written:
        return []
    across = flotsam.emptyAxis(case)
    names = []
    for time in dict.fromkeys(flotsam.nearestTime(case, t) for t in wanted or [h.time[-1] / 3, 2 * h.time[-1] / 3, h.time[-1]]):
        names.append(f"scene_{time:g}s.png")
        file = os.path.join(folder, names[-1])
        if across is None:
            flotsamScene.renderScene(case, time, file, history=h)
        else:
            flotsamScene.renderField2d(case, time, file, normal=across, history=h)
    name = f"contacts_{h.contacts['time'][-1]:g}s.png" if len(h.contacts.get("time", [])) else None
    if name and _drawContacts(h, across, os.path.join(folder, name)):
        names.append(name)
    return names


def _drawContacts(h, across, file):
    last = h.contacts["time"][-1]
    return contactScene.renderContacts(last, file, h) if across is None else contactScene.renderContacts2d(last, file, h, across)


def main():
    options = arguments()
    try:
        h = flotsam.history(options.case)
        folder = os.path.join(options.case, "postProcessing", "flotsam", "report")
        os.makedirs(folder, exist_ok=True)
        series = forceSeries(options.case, h)
        figures, fate = evaluate(h, series, options)
        pictures = plot(h, fate, series, np.array(figures["direction"]), os.path.join(folder, "series.png"))
        if not options.no_pictures:
            pictures += draw(options.case, h, options.times, folder)
        text = page(options.case, figures, pictures)
    except flotsam.CaseError as error:
        sys.exit(f"flotsamReport: {error}")
    with open(os.path.join(folder, "report.md"), "w", encoding="utf-8") as out:
        out.write(text)
    with open(os.path.join(folder, "report.json"), "w", encoding="utf-8") as out:
        json.dump(figures, out, indent=1)
    print(text + "\nWritten: " + os.path.abspath(folder))


if __name__ == "__main__":
    main()
