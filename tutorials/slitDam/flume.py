# SPDX-License-Identifier: GPL-3.0-or-later
"""What is evaluated from the two runs of the flume: water levels, discharge, captured bars, forces on the pipes."""
import flotsam
import momentum
import numpy as np
from tutorial import history, parameters

CASES = {"with bars": "run/withBars", "without bars": "run/withoutBars"}
UPSTREAM, DOWNSTREAM = -0.2, 0.15   # stations where the level is taken [m]: in the pool of both runs, in the sheet behind the pipes
REACH = 0.35                        # a bar is held when its centre is this near upstream of the pipes [m]
GRAVITY = 9.81
LONG_GAP = 1/np.sqrt(3)             # discharge coefficient of critical flow in a long gap; 1 is a free jet without contraction

setup = parameters(CASES["with bars"], "system/parameters")


def depths(case):
    """Times, water depth normal to the bed at the two stations, mean over the width [m]."""
    written = flotsam.times(case)
    values = np.array([meanDepth(case, t, (UPSTREAM, DOWNSTREAM)) for t in written])
    return np.array(written), values


def meanDepth(case, time, stations):
    """Water depth normal to the bed at stations along the flume, mean over the width [m]."""
    n = 4 * int(setup["nPipes"])    # several lines to a pitch: behind the pipes the water is jets and wakes
    lines = setup["width"] * ((np.arange(n) + 0.5) / n - 0.5)
    points = [(x, y) for x in stations for y in lines]
    return flotsam.waterLevel(case, time, points, nSamples=400).reshape(len(stations), n).mean(1)


def discharge(h):
    """Times, discharge into and out of the flume [m^3/s], means over 0.25 s."""
    edges = np.arange(0, h.time[-1] + 1e-9, 0.25)
    rate = [np.diff(np.interp(edges, h.time, h.run[name])) / np.diff(edges) for name in ("inflow", "outflow")]
    return 0.5 * (edges[1:] + edges[:-1]), rate[0], rate[1]


def massError(h):
    """Change of the liquid volume that inflow and outflow do not explain, over the volume at the start; largest over time."""
    volume, inflow, outflow = (h.run[name] for name in ("liquidVolume", "inflow", "outflow"))
    unexplained = (volume - volume[0]) - (inflow - inflow[0]) + (outflow - outflow[0])
    return np.abs(unexplained).max() / volume[0]


# --- bars -------------------------------------------------------------------------------------------------------------

def captureRatio(h):
    """Share of the bars held in front of the pipes."""
    return flotsam.captured(h, lambda x: (x[:, 0] > -REACH) & (x[:, 0] < 0.5 * setup["pipeDiameter"]))


def accountedBars(h):
    """Number of bars per record that are inside the flume or left it over the free overfall (passedBars counts these)."""
    x = _positions(h)
    inside = ((x[..., 0] > -setup["upstream"]) & (np.abs(x[..., 1]) < 0.5 * setup["width"]) & (x[..., 2] > 0) & (x[..., 2] < setup["height"]))
    return (inside | (x[..., 0] > setup["downstream"])).sum(0)


def passedBars(h):
    """Number of bars that were behind the pipes at any time."""
    return int((_positions(h)[..., 0] > 0.5 * setup["pipeDiameter"]).any(1).sum())


def turned(q, x):
    """Vectors of a body's frame in space; q: w x y z."""
    v = q[..., 1:]
    return x + 2 * np.cross(v, np.cross(v, x) + q[..., :1] * x)


def _positions(h):
    return np.array([h["bodies/" + name].position for name in h.bodies])


def _sphereCentres(h):
    """Centres of the spheres by which bars touch: bars x records x spheres x 3; and their radius. As by default: rows on the bar's
    edges, radius a quarter of its thickness."""
    radius = 0.25 * setup["barSide"]
    half = 0.5 * setup["barLength"] - radius
    n = int(np.ceil(half / radius - 1e-9)) + 1
    local = np.array([(a, b, c) for a in (-radius, radius) for b in np.linspace(-half, half, n) for c in (-radius, radius)])
    q = np.array([h["bodies/" + name].orientation for name in h.bodies])
    return _positions(h)[:, :, None] + turned(q[..., None, :], local), radius


def overlaps(h):
    """Deepest overlap of two bars and of a bar and a pipe in all records [m], from the bars' poses alone."""
    centres, radius = _sphereCentres(h)
    axes = [(0.0, (k - 0.5 * (setup["nPipes"] - 1)) * setup["pitch"]) for k in range(int(setup["nPipes"]))]
    pipe = max((radius + 0.5 * setup["pipeDiameter"] - np.hypot(centres[..., 0] - x, centres[..., 1] - y)).max() for x, y in axes)
    middle = _positions(h)
    reach = np.hypot(setup["barLength"], 2 * setup["barSide"])
    bar = -np.inf
    for i in range(len(middle)):
        for j in range(i):
            for k in np.flatnonzero(np.linalg.norm(middle[i] - middle[j], axis=1) < reach):
                a, b = centres[i, k], centres[j, k]
                squares = (a**2).sum(1)[:, None] + (b**2).sum(1) - 2 * a @ b.T
                bar = max(bar, 2 * radius - np.sqrt(max(squares.min(), 0)))
    return bar, pipe


# --- forces and hydraulics --------------------------------------------------------------------------------------------

def pipeForces(h):
    """Force on each pipe along x over time, pipes x times [N]: of the water, of the bars."""
    pipes = [name for name in h.structures if name.startswith("pipes")]
    return tuple(np.array([getattr(h[name], quantity)[:, 0] for name in pipes]) for quantity in ("fluidForce", "contactForce"))


def dischargeCoefficient(depth, flow):
    """mu of flow = mu 2/3 sqrt(2 g) b E^1.5 through the open width b, E [m]: the pool's energy at the pipes, from the depth at
    UPSTREAM, its surface being horizontal. LONG_GAP: critical flow with parallel streamlines; 1: free jet."""
    open_ = setup["width"] - setup["nPipes"] * setup["pipeDiameter"]
    speed = flow / (setup["width"] * depth)
    energy = depth - setup["slope"] * UPSTREAM + speed**2 / (2 * GRAVITY)
    return flow / (2 / 3 * np.sqrt(2 * GRAVITY) * open_ * energy**1.5)


def results():
    """Everything above for both runs, with means over the last second."""
    out = {}
    for name, case in CASES.items():
        h = history(case)
        time, depth = depths(case)
        water, contact = pipeForces(h)
        run = dict(history=h, time=time, depth=depth, water=water, contact=contact)
        run["up"], run["down"] = (finalMean(run, depth[:, k]) for k in (0, 1))
        last = discharge(h)[0] > h.time[-1] - 1
        run["outflow"] = discharge(h)[2][last].mean()
        run["coefficient"] = dischargeCoefficient(run["up"], run["outflow"])
        run["momentum"], run["entering"] = momentum.forceOnPipes(case, h, setup, time[time >= time[-1] - 1 - 1e-9])
        out[name] = run
    return out


def finalMean(run, series, seconds=1.0):
    """Mean of the last second of a series over the history's or the written times."""
    time = run["time"] if series.shape[-1] == len(run["time"]) else run["history"].time
    return series[..., time > time[-1] - seconds].mean(-1)
