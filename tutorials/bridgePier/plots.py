# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of the two runs of the channel."""
import driftwood  # first: its message when packages are missing
import channel
import flotsam
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

WOOD = (0.52, 0.33, 0.16)


def _pierOutline():
    radius, angle = 0.5 * channel.setup["pierWidth"], np.linspace(-0.5 * np.pi, 0.5 * np.pi, 40)
    nose = np.stack([radius - radius * np.cos(angle[::-1]), radius * np.sin(angle[::-1])], axis=1)
    tail = np.stack([channel.setup["pierLength"] - radius + radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    return np.concatenate([nose, tail])


def velocity(runs, time, file):
    """Speed along the channel 4 cm below the undisturbed level, pier and logs from above: dead water in front, wake behind."""
    x = np.linspace(-0.8, channel.setup["downstream"] - 0.01, 200)
    y = 0.5 * channel.setup["width"] * np.linspace(-0.999, 0.999, 61)
    points = np.stack([a.ravel() for a in np.meshgrid(x, y, [channel.setup["depth"] - 0.04], indexing="ij")], axis=1)
    figure, axes = plt.subplots(2, 1, figsize=(11, 5.6), sharex=True)
    for a, (name, run) in zip(axes, runs.items()):
        speed = flotsam.sample(channel.CASES[name], time, points, ["U"])["U"][:, 0].reshape(len(x), len(y))
        shown = a.pcolormesh(x, y, speed.T, cmap="RdYlBu_r", vmin=-0.3, vmax=0.9, shading="gouraud")
        a.fill(*_pierOutline().T, color="0.45")
        h = run["history"]
        for body in h.bodies:
            centres = driftwood.turned(h.at(body, "orientation", time), channel.surfaces(h)[body][0]) + h.at(body, "position", time)
            if centres[:, 0].min() > x[-1]:
                continue
            ends = centres[[0, len(centres) - 1 - (channel.ROOT_POINTS if body.startswith("rooted") else 0)]]
            a.plot(ends[:, 0], ends[:, 1], color=WOOD, lw=3, solid_capstyle="round")
        a.set(ylabel="y [m]", title=f"{name}, t = {time:g} s", aspect="equal", xlim=(x[0], x[-1]))
        figure.colorbar(shown, ax=a, label="along x [m/s]")
    axes[-1].set_xlabel("distance from the pier's nose [m]")
    figure.tight_layout()
    figure.savefig(file, dpi=110)
    plt.close(figure)


def series(runs, file):
    """Levels, discharge, held logs and forces over time."""
    figure, axes = plt.subplots(2, 2, figsize=(12, 7.5), sharex=True)
    logged = runs["with logs"]
    h = logged["history"]
    driftwood.drawFlow(axes[0, 0], axes[0, 1], axes[1, 1], runs)
    axes[0, 0].set_title("mean over {:g} to {:g} m, and over {:g} to {:g} m".format(*channel.UPSTREAM, *channel.DOWNSTREAM))
    axes[1, 0].plot(h.time, channel.isHeld(h).sum(0), label="held")
    axes[1, 0].plot(h.time, channel.passedLogs(h), "--", label="downstream of the pier")
    axes[1, 0].set(ylabel="logs", xlabel="time [s]", ylim=(0, len(h.bodies)), title=f"logs, of {len(h.bodies)}")
    axes[1, 1].plot(*driftwood.smooth(h.time, logged["contact"]), "C3", label="logs")
    axes[1, 1].plot(*driftwood.smooth(h.time, logged["contact"] + logged["water"]), "k", lw=0.8, label="both, with logs")
    axes[1, 1].set(ylabel="force along the channel [N]", xlabel="time [s]", title="pier, means over 0.1 s", ylim=(-3, None))
    driftwood.saveSeries(figure, axes, file)
