# SPDX-License-Identifier: GPL-3.0-or-later
"""speed.md and speed.png from the rows."""
import os

from rows import markdown, number
from steps import PHASES

OURS, PEER = "flotsamFoam", "interFoam"


def _pairs(rows):
    """(ours, interFoam's or None) of every scene and size of ours that went well."""
    peers = {(r["scene"], r["size"]): r for r in rows if r["solver"] == PEER and number(r, "total")}
    return [(r, peers.get((r["scene"], r["size"]))) for r in rows if r["solver"] == OURS and number(r, "total")]


def _shown(row, column, pattern):
    value = number(row, column) if row else None
    return "" if value is None else format(value, pattern)


def _comparison(rows):
    lines = []
    for ours, peer in _pairs(rows):
        u, p = number(ours, "total"), number(peer, "total") if peer else None
        lines.append([ours["scene"], ours["cells"], ours["nodes"], f"{u:.2f}", f"{p:.2f}" if p else "", ours["ratio"] and f"{number(ours, 'ratio'):.2f}",
                      _shown(ours, "iterations", ".1f"), _shown(peer, "iterations", ".1f"),
                      _shown(ours, "peakMB", ".0f"), _shown(peer, "peakMB", ".0f"), _shown(ours, "startup", ".1f"), _shown(ours, "load", ".1f"), ours["commit"]])
    return markdown(["scene", "cells", "nodes", "flotsamFoam us/node/step", "interFoam us/cell/step", "ratio", "flotsamFoam iterations", "interFoam iterations",
                     "flotsamFoam peak MB", "interFoam peak MB", "start and 5 steps, CPU s", "load", "commit"], lines)


def _phases(rows, isShare):
    """us per node and step, or the same as a share of their sum [%]."""
    lines = []
    for ours, _ in _pairs(rows):
        total = sum(number(ours, p) or 0 for p in PHASES)
        scale, form = (100 / total, ".0f") if isShare else (1, ".2f")
        lines.append([ours["scene"], ours["nodes"], *[format((number(ours, p) or 0) * scale, form) for p in PHASES], format(total * scale, form)])
    return markdown(["scene", "nodes", *PHASES, "sum"], lines)


def _growth(rows):
    """Per dam break: growth of the time from the smallest to the largest mesh, memory per additional node (or cell)."""
    lines = []
    for scene in dict.fromkeys(r["scene"] for r in rows if r["scene"].startswith("dam break")):
        for solver in (OURS, PEER):
            series = sorted((number(r, "nodes") or number(r, "cells"), number(r, "total"), number(r, "peakMB")) for r in rows
                            if (r["scene"], r["solver"]) == (scene, solver) and number(r, "total"))
            if len(series) < 2:
                continue
            (n0, t0, m0), (n1, t1, m1) = series[0], series[-1]
            lines.append([scene, solver, f"{n0:.0f}", f"{n1:.0f}", f"{t1 / t0:.2f}", f"{1.048576e3 * (m1 - m0) / (n1 - n0):.2f}"])
    return markdown(["scene", "solver", "points from", "to", "growth of the time per point", "kB per additional point"], lines) if lines else ""


def _targets(rows):
    lines = []

    def add(text, limit, value):
        lines.append([text, f"{limit:g}", f"{value:.3g}", "reached" if value <= limit else f"missed by {100 * (value / limit - 1):.0f} %"])
    for ours, _ in _pairs(rows):
        if number(ours, "ratio") and 5e4 < number(ours, "cells") < 7e4:
            add(f"whole step per node over interFoam's per cell, {ours['scene']}, 64,000 cells", 1, number(ours, "ratio"))
    for dim in ("2D", "3D"):
        series = sorted((number(o, "nodes"), number(o, "total"), number(o, "peakMB")) for o, _ in _pairs(rows) if o["scene"] == "dam break " + dim)
        if len(series) > 1:
            add(f"growth per node, {dim}, {series[0][0]:.0f} to {series[-1][0]:.0f} nodes", 1.5, series[-1][1] / series[0][1])
            iterations = [number(o, "iterations") for o, _ in sorted(_pairs(rows), key=lambda pair: number(pair[0], "nodes")) if o["scene"] == "dam break " + dim]
            add(f"most iterations over those of the smallest mesh, {dim}, {series[0][0]:.0f} to {series[-1][0]:.0f} nodes", 1.2, max(iterations) / iterations[0])
            if dim == "3D":
                add("kB per additional node, 3D", 1.5, 1.048576e3 * (series[-1][2] - series[0][2]) / (series[-1][0] - series[0][0]))
    for ours, _ in _pairs(rows):
        if ours["scene"].startswith("slitDam"):
            total = sum(number(ours, p) or 0 for p in PHASES)
            add(f"cutting, share of the step, {ours['scene']}", 0.10, (number(ours, "cut") or 0) / total)
            add(f"DEM and exchange, share of the step, {ours['scene']}", 0.05, ((number(ours, "DEM") or 0) + (number(ours, "exchange") or 0)) / total)
    return markdown(["target", "at most", "value", "verdict"], lines) if lines else ""


def _logs(rows):
    """A step against the number of logs, and what each of them adds to that without."""
    carpets = sorted(((int(o["size"]), o) for o, _ in _pairs(rows) if o["scene"] == "log carpet"), key=lambda pair: pair[0])
    if not carpets or carpets[0][0] != 0:
        return ""
    step = {n: 1e-6 * number(o, "total") * number(o, "nodes") for n, o in carpets}
    lines = [[n, f"{step[n]:.2f}", f"{1e3 * (step[n] - step[0]) / n:.1f}" if n else "", *[f"{1e-6 * (number(o, p) or 0) * number(o, 'nodes'):.2f}" for p in PHASES], f"{number(o, 'iterations'):.1f}",
              o["commit"]] for n, o in carpets]
    return markdown(["logs", "step [s]", "a log [ms]", *PHASES, "iterations", "commit"], lines)


def _plot(rows, file):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, (left, right) = plt.subplots(1, 2, figsize=(12.5, 4.6), dpi=120)
    for k, scene in enumerate(dict.fromkeys(r["scene"] for r in rows if r["scene"].startswith("dam break"))):
        for solver, style in ((OURS, "o-"), (PEER, "s--")):
            series = sorted((number(r, "nodes") or number(r, "cells"), number(r, "total")) for r in rows
                            if (r["scene"], r["solver"]) == (scene, solver) and number(r, "total"))
            if series:
                left.semilogx(*zip(*series), style, color=f"C{k}", label=f"{solver}, {scene}")
    left.set(xlabel="nodes (interFoam: cells)", ylabel="processor us per node (cell) and step", ylim=(0, None))
    left.grid(True, which="both", alpha=0.25)
    left.legend(fontsize=8)
    ours = [o for o, _ in _pairs(rows)]
    names = [f"{o['scene']}\n{o['nodes']} nodes" for o in ours]
    bottom = [0.0] * len(ours)
    for p in PHASES:
        values = [max(number(o, p) or 0, 0) for o in ours]
        right.barh(names, values, left=bottom, label=p)
        bottom = [b + v for b, v in zip(bottom, values)]
    right.invert_yaxis()
    right.tick_params(axis="y", labelsize=7)
    right.set_xlabel("processor us per node and step")
    right.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(file)
    plt.close(figure)


def write(rows, results):
    if not rows:
        return
    last, logs = rows[-1], _logs(rows)
    rows = [r for r in rows if r["scene"] != "log carpet"]
    parts = ["# Speed", "Processor time of one process per step of fixed length, without start-up and first steps; medians over the repeats, the\n"
             "solvers in turn. Iterations: ours of the whole system, interFoam's of the pressure, three correctors together.",
             "Regenerate: `benchmarks/speed/run`; this page alone, from the rows there are: `benchmarks/speed/run --report`.\n"
             f"Machine: {last['machine']}; {last['compiler']}.", "![time per node and step](speed.png)", "## Targets", _targets(rows),
             "## A step beside interFoam's", _comparison(rows),
             "## Phases", "Processor us per node and step:", _phases(rows, False), "Share of the step [%]:", _phases(rows, True),
             "## Growth and memory", "Points: nodes (interFoam: cells).", _growth(rows),
             *(["## Number of logs", "The log carpet: processor seconds a step, in all and by phase, and what a log adds.", logs] if logs else [])]
    with open(os.path.join(results, "speed.md"), "w", encoding="utf-8") as out:
        out.write("\n\n".join(part for part in parts if part) + "\n")
    _plot(rows, os.path.join(results, "speed.png"))
