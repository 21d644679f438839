# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of the two runs of the flume."""
import driftwood  # first: its message when packages are missing
import flume
import matplotlib
import momentum
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLE = {"with bars": "-", "without bars": "--"}


def profiles(runs, times, file):
    """Bed and water surface along the flume, in the true direction of gravity, mean over the width; the bars from the side."""
    x = np.linspace(-flume.setup["upstream"] + 0.02, flume.setup["downstream"] - 0.02, 70)
    bed = -flume.setup["slope"] * x
    figure, axes = plt.subplots(len(times), 1, figsize=(11, 3.2 * len(times)), sharex=True, sharey=True)
    for a, time in zip(np.atleast_1d(axes), times):
        a.fill_between(x, bed - 0.02, bed, color="0.75")
        for name, run in runs.items():
            level = bed + flume.meanDepth(flume.CASES[name], time, x)
            a.plot(x, level, "C0" + STYLE[name], label=f"water, {name}")
        critical = ((flume.setup["discharge"] / flume.setup["width"])**2 / momentum.GRAVITY)**(1 / 3)
        a.plot(x, bed + critical, "k:", lw=0.8, label="critical depth of the inflow")
        h = runs["with bars"]["history"]
        half = 0.5 * flume.setup["barLength"]
        for name in h.bodies:
            centre = h.at(name, "position", time)
            axis = driftwood.turned(h.at(name, "orientation", time), np.array([0, half, 0]))
            ends = np.array([centre - axis, centre + axis])
            a.plot(ends[:, 0], ends[:, 2] - flume.setup["slope"] * ends[:, 0], color=(0.52, 0.33, 0.16), lw=2.5, solid_capstyle="round")
        radius = 0.5 * flume.setup["pipeDiameter"]
        a.fill_between([-radius, radius], 0, flume.setup["height"], color="0.6", alpha=0.5)
        a.set(ylabel="height [m]", title=f"t = {time:g} s", xlim=(x[0], x[-1]), ylim=(-0.03, 0.24))
        a.grid(alpha=0.3)
    np.atleast_1d(axes)[0].legend(fontsize=8, loc="lower left")
    np.atleast_1d(axes)[-1].set_xlabel("distance from the pipes, along the bed [m]")
    figure.tight_layout()
    figure.savefig(file, dpi=110)
    plt.close(figure)


def series(runs, file):
    """Levels, discharge, captured bars and forces over time."""
    figure, axes = plt.subplots(3, 2, figsize=(12, 10), sharex=True)
    barred = runs["with bars"]
    h = barred["history"]
    driftwood.drawFlow(axes[0, 0], axes[0, 1], axes[1, 1], runs)
    axes[0, 0].set_title(f"{-flume.UPSTREAM} m upstream and {flume.DOWNSTREAM} m downstream of the pipes")
    axes[1, 0].plot(h.time, 100 * flume.captureRatio(h))
    axes[1, 0].set(ylabel="share of the bars [%]", ylim=(0, 102), title=f"bars less than {flume.REACH} m upstream of the pipes")
    axes[1, 1].plot(*driftwood.smooth(h.time, barred["contact"].sum(0)), "C3", label="bars")
    axes[1, 1].set(ylabel="force along the flume [N]", title="all pipes, means over 0.1 s")
    for axis, values, title in ((axes[2, 0], barred["water"], "water"), (axes[2, 1], barred["contact"], "bars")):
        time, forces = driftwood.smooth(h.time, values)
        for k, force in enumerate(forces):
            axis.plot(time, force, f"C{k}", label=f"pipe {k + 1}")
        axis.set(xlabel="time [s]", ylabel="force along the flume [N]", title=f"each pipe, {title}, with bars")
    driftwood.saveSeries(figure, axes, file)
