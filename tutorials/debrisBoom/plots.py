# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of the two runs."""
import boom
import driftwood  # first: its message when packages are missing
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLES = {"plain": "--", "skirts": "-"}
STATES = {"clean": "C0", "with logs": "C1"}


def series(runs, file):
    """Logs, tension of the end lines, load of the booms over time; their shape beside the parabola."""
    figure, axes = plt.subplots(2, 2, figsize=(12, 7.5))
    for name, run in runs.items():
        _logs(axes[0, 0], name, run)
        _tension(axes[0, 1], name, run)
        _loads(axes[1, 0], name, run)
    _shape(axes[1, 1], runs["skirts"])
    axes[0, 0].set(ylabel="logs", title=f"logs, of {int(boom.setup['nLogs'])}", xlabel="time [s]", ylim=(0, None))
    axes[0, 1].set(ylabel="tension [N]", xlabel="time [s]", title="lines to the banks, means over 0.1 s", ylim=(0, None))
    axes[1, 0].set(ylabel="force along the channel [N]", xlabel="time [s]", title="load of the boom, means over 0.1 s")
    driftwood.saveSeries(figure, axes, file)


def _logs(axis, name, run):
    h = run["history"]
    if name == "skirts":
        axis.plot(h.time, boom.cameIn(h), "k", label="came in")
    axis.plot(h.time, run["held"].sum(0), "C0" + STYLES[name], label=f"held, {name}")
    axis.plot(h.time, boom.passed(h), "C3" + STYLES[name], label=f"passed, {name}")


def _tension(axis, name, run):
    lines = [line for line in run["lines"] if line in boom.ends(run["lines"])]
    colours = {"right": "C0", "left": "C1", "rightLow": "C2", "leftLow": "C4"}
    for line in lines:
        rows = run["lines"][line]
        axis.plot(*driftwood.smooth(rows[:, 0], rows[:, 4]), colours[line] + STYLES[name], label=f"{line}, {name}")


def _loads(axis, name, run):
    time = run["history"].time[1:]
    for what, colour, label in (("lines", "k", "held by the end lines"), ("water", "C0", "by water"), ("logs", "C3", "by logs")):
        axis.plot(*driftwood.smooth(time, run["loads"][what]), colour + STYLES[name], label=f"{label}, {name}")


def _shape(axis, run):
    half = 0.5 * boom.setup["width"]
    y = np.linspace(-half, half, 81)
    for state, colour in STATES.items():
        shape = run[state]["shape"]
        axis.plot(100 * shape[:, 1], 100 * shape[:, 0], colour + "o-", ms=3, label=state)
        axis.plot(100 * y, 100 * run[state]["sag"] * (1 - (y / half)**2), colour + ":", label=f"parabola of its sag, {state}")
    axis.set(xlabel="across the channel [cm]", ylabel="downstream [cm]", title="boom with skirts from above: floats and lines, means")
    axis.invert_yaxis()
