# SPDX-License-Identifier: GPL-3.0-or-later
"""What is evaluated from the two runs of the flume: water levels, discharge, captured bars, forces on the pipes."""
import driftwood
import flotsam
import momentum
import numpy as np
from tutorial import history, parameters

CASES = {"with bars": "run/withBars", "without bars": "run/withoutBars"}
UPSTREAM, DOWNSTREAM = -0.2, 0.15   # stations where the level is taken [m]: in the pool of both runs, in the sheet behind the pipes
REACH = 0.35                        # a bar is held when its centre is this near upstream of the pipes [m]
SECTIONS = -0.45, 0.15              # of the momentum theorem [m]: upstream of the held bars, downstream of the pipes
LONG_GAP = 1/np.sqrt(3)             # discharge coefficient of critical flow in a long gap; 1 is a free jet without contraction

setup = parameters(CASES["with bars"], "system/parameters")


def depths(case):
    """Times, water depth normal to the bed at the two stations, mean over the width [m]."""
    written = flotsam.times(case)
    values = np.array([meanDepth(case, t, (UPSTREAM, DOWNSTREAM)) for t in written])
    return np.array(written), values


def meanDepth(case, time, stations):
    """Water depth normal to the bed at stations along the flume, mean over the width [m]."""
    return driftwood.meanDepth(case, time, stations, setup["width"], 4 * int(setup["nPipes"]))  # behind the pipes the water is jets and wakes


# --- bars -------------------------------------------------------------------------------------------------------------

def captureRatio(h):
    """Share of the bars held in front of the pipes."""
    return flotsam.captured(h, lambda x: (x[:, 0] > -REACH) & (x[:, 0] < 0.5 * setup["pipeDiameter"]))


def accountedBars(h):
    """Number of bars per record that are inside the flume or left it over the free overfall (passedBars counts these)."""
    return driftwood.accounted(driftwood.positions(h), setup)


def passedBars(h):
    """Number of bars that were behind the pipes at any time."""
    return int((driftwood.positions(h)[..., 0] > 0.5 * setup["pipeDiameter"]).any(1).sum())


def _spheres():
    """Centres and radii of the spheres by which a bar touches, in its frame. As by default: rows on the bar's edges, radius a quarter of its
    thickness."""
    radius = 0.25 * setup["barSide"]
    half = 0.5 * setup["barLength"] - radius
    n = int(np.ceil(half / radius - 1e-9)) + 1
    local = np.array([(a, b, c) for a in (-radius, radius) for b in np.linspace(-half, half, n) for c in (-radius, radius)])
    return local, np.full(len(local), radius)


def overlaps(h):
    """Deepest overlap of two bars and of a bar and a pipe in all records [m], from the bars' poses alone."""
    local, radii = _spheres()
    axes = [(0.0, (k - 0.5 * (setup["nPipes"] - 1)) * setup["pitch"]) for k in range(int(setup["nPipes"]))]
    pipe = -np.inf
    for name in h.bodies:
        centres = driftwood.inSpace(h["bodies/" + name], local)
        pipe = max(pipe, max((radii + 0.5 * setup["pipeDiameter"] - np.hypot(centres[..., 0] - x, centres[..., 1] - y)).max() for x, y in axes))
    return driftwood.deepestOverlap(h, {name: (local, radii) for name in h.bodies}), pipe


# --- forces and hydraulics --------------------------------------------------------------------------------------------

def pipeForces(h):
    """Force on each pipe along x over time, pipes x times [N]: of the water, of the bars."""
    return driftwood.forcesOn(h, [name for name in h.structures if name.startswith("pipes")])


def dischargeCoefficient(depth, flow):
    """mu of flow = mu 2/3 sqrt(2 g) b E^1.5 through the open width b, E [m]: the pool's energy at the pipes, from the depth at
    UPSTREAM, its surface being horizontal. LONG_GAP: critical flow with parallel streamlines; 1: free jet."""
    open_ = setup["width"] - setup["nPipes"] * setup["pipeDiameter"]
    speed = flow / (setup["width"] * depth)
    energy = depth - setup["slope"] * UPSTREAM + speed**2 / (2 * momentum.GRAVITY)
    return flow / (2 / 3 * np.sqrt(2 * momentum.GRAVITY) * open_ * energy**1.5)


def results():
    """Everything above for both runs, with means over the last second."""
    out = {}
    reach = momentum.Reach(*SECTIONS, setup["width"], setup["height"], setup["slope"], 4 * int(setup["nPipes"]))
    for name, case in CASES.items():
        h = history(case)
        time, depth = depths(case)
        water, contact = pipeForces(h)
        run = dict(history=h, time=time, depth=depth, water=water, contact=contact)
        run["up"], run["down"] = (finalMean(run, depth[:, k]) for k in (0, 1))
        flowTime, _, outflow = driftwood.discharge(h)
        run["outflow"] = outflow[flowTime > h.time[-1] - 1].mean()
        run["coefficient"] = dischargeCoefficient(run["up"], run["outflow"])
        run["momentum"], run["entering"] = momentum.forceOnStructures(case, h, reach, time[time >= time[-1] - 1 - 1e-9])
        out[name] = run
    return out


def finalMean(run, series):
    """Mean of the last second of a series over the history's or the written times."""
    return driftwood.finalMean(run["time"] if series.shape[-1] == len(run["time"]) else run["history"].time, series)
