# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of the run."""
import driftwood  # first: its message when packages are missing
import matplotlib
import rack

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def series(run, file):
    """Logs, levels, discharge and forces over time."""
    figure, axes = plt.subplots(2, 2, figsize=(12, 7.5), sharex=True)
    h = run["history"]
    axes[0, 0].plot(h.time, rack.cameIn(h), "k", label="came in")
    axes[0, 0].plot(h.time, run["held"].sum(0), label="held at the rack")
    axes[0, 0].plot(h.time, rack.passed(h), "--", label="passed it")
    axes[0, 0].set(ylabel="logs", title=f"logs, of {len(h.bodies)}", ylim=(0, None))
    for k, (name, style) in enumerate((("upstream", "C0"), ("downstream", "C1"))):
        axes[0, 1].plot(run["time"], 100 * run["depth"][:, k], style, label=name)
    axes[0, 1].axhline(100 * run["clean"]["up"], color="C0", ls=":", label="upstream, clean rack")
    axes[0, 1].set(ylabel="depth [cm]", title="mean over {:g} to {:g} m, and over {:g} to {:g} m".format(*rack.UPSTREAM, *rack.DOWNSTREAM))
    flowTime, inflow, outflow = driftwood.discharge(h)
    axes[1, 0].plot(flowTime, 1000 * inflow, "k", lw=0.8, label="in")
    axes[1, 0].plot(flowTime, 1000 * outflow, label="out")
    axes[1, 0].set(ylabel="discharge [l/s]", xlabel="time [s]", ylim=(0, None))
    for name, values in (("water", run["water"]), ("logs", run["contact"]), ("both", run["water"] + run["contact"])):
        axes[1, 1].plot(*driftwood.smooth(h.time, values), label=name)
    axes[1, 1].set(ylabel="force along the channel [N]", xlabel="time [s]", title="rack, means over 0.1 s")
    driftwood.saveSeries(figure, axes, file)
