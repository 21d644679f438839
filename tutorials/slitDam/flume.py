# SPDX-License-Identifier: GPL-3.0-or-later
"""What is evaluated from the two runs of the flume: water levels, captured bars, forces on the pipes, hydraulic estimates."""
import numpy as np

import flotsam
from tutorial import history, parameters

CASES = {"with bars": "run/withBars", "without bars": "run/withoutBars"}
UPSTREAM, DOWNSTREAM = -0.6, 0.15   # stations where the level is taken [m]
REACH = 0.35                        # a bar is held when its centre is this near upstream of the pipes [m]
RHO, GRAVITY = 1000.0, 9.81

setup = parameters(CASES["with bars"], "system/parameters")


def depths(case):
    """Times, water depth normal to the bed at the two stations, mean over the width [m]."""
    lines = np.linspace(-0.4, 0.4, 5) * setup["width"] + 1e-4
    written = flotsam.times(case)
    stations = [(x, y) for x in (UPSTREAM, DOWNSTREAM) for y in lines]
    values = np.array([flotsam.waterLevel(case, t, stations) for t in written]).reshape(len(written), 2, len(lines))
    return np.array(written), values.mean(2)


def captureRatio(h):
    """Share of the bars held in front of the pipes."""
    return flotsam.captured(h, lambda x: (x[:, 0] > -REACH) & (x[:, 0] < 0.5 * setup["pipeDiameter"]))


def lost(h):
    """Number of bars that are not in the flume at the end."""
    x = np.array([h[name].position[-1] for name in h.bodies])
    inside = (x[:, 0] > -setup["upstream"]) & (x[:, 0] < setup["downstream"]) & (np.abs(x[:, 1]) < 0.5 * setup["width"]) & (x[:, 2] > 0)
    return int(np.sum(~inside))


def pipeForces(h):
    """Force on each pipe along x over time, pipes x times [N]: of the water, of the bars."""
    pipes = [name for name in h.structures if name.startswith("pipes")]
    return tuple(np.array([getattr(h[name], quantity)[:, 0] for name in pipes]) for quantity in ("fluidForce", "contactForce"))


def chokedDepth(contraction=1.0):
    """Depth upstream [m] when the flow is critical between the pipes: their energy 3/2 (q^2/g)^(1/3) stands upstream too."""
    gaps = setup["width"] - setup["nPipes"] * setup["pipeDiameter"]
    energy = 1.5 * ((setup["discharge"] / (contraction * gaps))**2 / GRAVITY)**(1 / 3)
    depth = energy
    for _ in range(20):
        depth = energy - (setup["discharge"] / setup["width"] / depth)**2 / (2 * GRAVITY)
    return depth


def momentumForce(up, down):
    """Force of the water on what stands between two sections of depth `up` and `down` [N]: hydrostatic pressure, momentum
    flux, and the weight of the water between them along the bed."""
    angle = np.arctan(setup["slope"])
    q = setup["discharge"] / setup["width"]
    pressure = 0.5 * RHO * GRAVITY * np.cos(angle) * (up**2 - down**2)
    flux = RHO * q**2 * (1 / up - 1 / down)
    # water stands at the upstream depth (rising with the slope) until the pipes and at the downstream depth behind them
    pool = up - 0.5 * setup["slope"] * UPSTREAM
    weight = RHO * GRAVITY * np.sin(angle) * (-UPSTREAM * pool + DOWNSTREAM * down)
    return setup["width"] * (pressure + flux + weight)


def results():
    """Everything above for both runs."""
    out = {}
    for name, case in CASES.items():
        h = history(case)
        time, depth = depths(case)
        water, contact = pipeForces(h)
        out[name] = dict(history=h, time=time, depth=depth, water=water, contact=contact)
    return out


def finalMean(run, series, seconds=1.0):
    """Mean of the last second of a series over the history's or the written times."""
    time = run["time"] if series.shape[-1] == len(run["time"]) else run["history"].time
    return series[..., time > time[-1] - seconds].mean(-1)
