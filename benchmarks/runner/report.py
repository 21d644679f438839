# SPDX-License-Identifier: GPL-3.0-or-later
"""Markdown table and plot of a case: error against CPU seconds, and our time to reach a peer's error."""
import os
import textwrap

import numpy as np

from . import table

OURS = ("flotsamFoam", "transportTable")
COLOURS = {"flotsamFoam": "tab:blue", "transportTable": "tab:blue", "interFoam": "tab:orange", "interIsoFoam": "tab:green", "simpleFoam": "tab:red",
           "icoFoam": "tab:purple", "overInterDyMFoam": "tab:brown"}
MARKERS = "osD^v"


def label(row):
    return row["solver"] + (" " + row["variant"] if row["variant"] else "")


def isOurs(row):
    return row["solver"] in OURS


def _curves(rows, column):
    """{label: (cpu, |error|, N)} of the runs that went well, by increasing time."""
    curves = {}
    for row in rows:
        cpu, error = table.number(row, "cpu"), table.number(row, column)
        if row["status"] == "ok" and cpu and error is not None:
            curves.setdefault(label(row), []).append((cpu, abs(error), int(row["N"])))
    return {name: sorted(points) for name, points in curves.items()}


def _timeToReach(points, error):
    """CPU seconds at which a curve reaches an error: linear between its points in logarithms, each point counting with the best
    error of those before it. Returns (seconds, sign): '<' when the cheapest run is already better, '>' when none is."""
    best, envelope = np.inf, []
    for cpu, e, _ in points:
        best = min(best, e)
        envelope.append((cpu, max(best, 1e-300)))
    if envelope[0][1] <= error:
        return envelope[0][0], "<"
    for (c0, e0), (c1, e1) in zip(envelope, envelope[1:]):
        if e1 <= error:
            weight = np.log(e0 / error) / np.log(e0 / e1)
            return float(np.exp((1 - weight) * np.log(c0) + weight * np.log(c1))), ""
    return envelope[-1][0], ">"


def _markdown(head, lines):
    cells = [head] + lines
    width = [max(len(line[i]) for line in cells) for i in range(len(head))]
    text = ["| " + " | ".join(c.ljust(w) for c, w in zip(line, width)) + " |" for line in cells]
    return "\n".join([text[0], "|" + "|".join("-" * (w + 2) for w in width) + "|"] + text[1:])


def _allRuns(case, rows):
    head = ["solver", "N", "cells", "nodes", "steps", "CPU s", "us/point/step"]
    head += [f"{name}{' [' + unit + ']' if unit else ''}" for name, unit in case.figures.values()] + ["load", "commit"]
    hasFailed = any(row["status"] != "ok" for row in rows)
    lines = []
    for row in rows:
        cpu, steps = table.number(row, "cpu"), table.number(row, "steps")
        points = table.number(row, "nodes") or table.number(row, "cells")
        pace = f"{1e6 * cpu / points / steps:.2f}" if cpu and points and steps else ""
        values = ["" if (v := table.number(row, c)) is None else f"{v:.4g}" for c in case.figures]
        load = table.number(row, "load")
        lines.append([label(row), row["N"], row.get("cells", ""), row.get("nodes", ""), row.get("steps", ""), f"{cpu:.4g}" if cpu else "", pace, *values,
                      "" if load is None else f"{load:.1f}", row["commit"]] + ["" if row["status"] == "ok" else "FAILED: " + row["status"]] * hasFailed)
    return _markdown(head + ["failed runs"] * hasFailed, lines)


def _comparison(case, rows, column):
    """A line per peer's run and curve of ours of the same problem."""
    curves = _curves(rows, column)
    problem = getattr(case, "problem", lambda variant: "")
    group = {label(r): problem(r["variant"]) for r in rows}
    ours = [name for name in dict.fromkeys(label(r) for r in rows if isOurs(r)) if name in curves]
    lines = []
    for name in [n for n in curves if n not in ours]:
        for cpu, error, n in curves[name]:
            for our in [o for o in ours if group[o] == group[name]]:
                seconds, sign = _timeToReach(curves[our], error)
                lines.append([f"{name}, N {n}", f"{error:.4g}", f"{cpu:.3g}", our, f"{sign} {seconds:.3g}".strip(), f"{sign} {seconds / cpu:.2g}".strip()])
    head = ["peer's run", "its error", "its CPU s", "ours", "CPU s to that error", "ours / its"]
    return _markdown(head, lines) if lines else ""


def _targets(case, rows):
    lines = []
    for target in getattr(case, "targets", []):
        for row in rows:
            value = table.number(row, target.column)
            if not isOurs(row) or value is None or not target.holdsFor(row):
                continue
            limit = f"{'at least' if target.isLeast else 'at most'} {target.limit:g}"
            lines.append([target.text, limit, f"{label(row)} {row['N']}", f"{value if target.isLeast else abs(value):.4g}", "reached" if target.isReached(value) else "not reached"])
    return _markdown(["target", "limit", "run, N", "value", "verdict"], lines) if lines else ""


def _wrapped(text):
    return textwrap.fill(" ".join(text.split()), 120, break_long_words=False, break_on_hyphens=False)


def write(case, rows, results):
    """<case>.md and <case>.png."""
    if not rows:
        return
    last = next((row for row in reversed(rows) if row["compiler"]), rows[-1])
    command = "benchmarks/run" + (" --quick" if os.path.basename(results) == "quick" else "")
    compiler = f"; flotsamFoam compiled by {last['compiler']}" if last["compiler"] else ""
    parts = [f"# {case.name}", _wrapped(case.title),
             f"Regenerate: `{command} {case.name}`;\nthis page alone, from the rows there are: `{command} --report {case.name}`.\n"
             f"Machine: {last['machine']}{compiler}.",
             f"![error against CPU seconds]({case.name}.png)"]
    targets = _targets(case, rows)
    if targets:
        parts += ["## Targets", targets]
    parts += ["## All runs", _wrapped("CPU s: user seconds of the solver. us/point/step: the same per node (peers: cell) and step. load: load of the machine "
                                      "when the run started; compare times of equal load, and leave differences below 20 % alone."), _allRuns(case, rows)]
    isFirst = True
    for column in [case.mainError, *getattr(case, "moreErrors", [])]:
        comparison = _comparison(case, rows, column)
        if comparison:
            parts += [f"## Our CPU time to reach the peer's error: {case.figures[column][0]}"]
            if isFirst:
                parts += [_wrapped("`<`: our cheapest run is better already, its time is shown; `>`: none of our runs is as good, the time of the dearest is "
                                   "shown; else interpolated between two of our runs.")]
            parts += [comparison]
            isFirst = False
    with open(os.path.join(results, case.name + ".md"), "w", encoding="utf-8") as out:
        out.write("\n\n".join(parts) + "\n")
    _plot(case, rows, results)


def _look(names, solverOf):
    """{name: plot options}: a solver has one colour in all pictures, its variants other markers and paler tones."""
    import matplotlib.colors
    seen, looks = {}, {}
    for name in names:
        solver = solverOf[name]
        k = seen[solver] = seen.get(solver, -1) + 1
        colour = np.array(matplotlib.colors.to_rgb(COLOURS.get(solver, "black")))
        pale = min(0.3 * k, 0.6)
        isOur = solver in OURS
        looks[name] = {"color": tuple((1 - pale) * colour + pale), "marker": MARKERS[k % len(MARKERS)], "linestyle": "-" if isOur else "--",
                       "linewidth": 2.2 if isOur else 1.2, "label": name.replace("transportTable", "flotsamFoam's transport").strip()}
    return looks


def _setScale(axis):
    """Logarithmic, with enough numbers to read a value: 1, 2, 5 of each decade unless there are many."""
    from matplotlib import ticker
    for one, (low, high) in ((axis.xaxis, axis.get_xlim()), (axis.yaxis, axis.get_ylim())):
        decades = np.log10(high / low)
        one.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if decades < 3.5 else (1,), numticks=20))
        one.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        one.set_minor_formatter(ticker.NullFormatter())


def _plot(case, rows, results):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    problems = list(dict.fromkeys(case.problem(r["variant"]) for r in rows)) if getattr(case, "problemsApart", False) else [None]
    panels = [(column, problem, [r for r in rows if problem is None or case.problem(r["variant"]) == problem])
              for column in [case.mainError, *getattr(case, "moreErrors", [])] for problem in problems]
    panels = [panel for panel in panels if _curves(panel[2], panel[0])]
    if not panels:
        return
    solverOf = {label(r): r["solver"] for r in rows}
    perRow = min(len(panels), 3)
    nRows = -(-len(panels) // perRow)
    figure, axes = plt.subplots(nRows, perRow, figsize=(5.6 * perRow, 5.2 * nRows), dpi=130, squeeze=False)
    for axis in axes.flat[len(panels):]:
        axis.axis("off")
    for axis, (column, problem, panelRows) in zip(axes.flat, panels):
        curves = _curves(panelRows, column)
        looks = _look(curves, solverOf)
        for name, points in curves.items():
            cpu, error, n = zip(*points)
            axis.loglog(cpu, np.maximum(error, 1e-16), **looks[name])
            for x, y, size in points:
                axis.annotate(str(size), (x, max(y, 1e-16)), textcoords="offset points", xytext=(4, 4), fontsize=7, color=looks[name]["color"])
        _setScale(axis)
        what, unit = case.figures[column]
        axis.set_xlabel("CPU seconds of the solver (numbers at the points: N)")
        axis.set_ylabel(what + (f" [{unit}]" if unit else ""))
        if problem:
            axis.set_title(problem, fontsize=9)
        axis.grid(True, which="both", alpha=0.25)
        axis.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=3, frameon=False)     # below: it hides no point
    figure.suptitle(f"{case.name}: error against run time, lower left is better", fontsize=11)
    figure.tight_layout()
    figure.savefig(os.path.join(results, case.name + ".png"))
    plt.close(figure)
