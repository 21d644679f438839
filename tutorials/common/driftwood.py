# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tutorials with driftwood evaluate and check of a run: water levels, discharge, overlaps of bodies, forces on structures; means of series.

A channel has x along its bed and y across, 0 in the middle. SI units.
"""
import flotsam
import numpy as np
from tutorial import parameters

MASS = 1e-6         # error that checkRuns() allows, over the liquid at the start; 1e-12 is reached


# --- water ------------------------------------------------------------------------------------------------------------

def meanDepth(case, time, stations, width, nLines):
    """Water depth normal to the bed at stations along the channel, mean over nLines lines across it [m]."""
    lines = width * ((np.arange(nLines) + 0.5) / nLines - 0.5)
    points = [(x, y) for x in stations for y in lines]
    return flotsam.waterLevel(case, time, points, nSamples=400).reshape(len(stations), nLines).mean(1)


def reachDepth(case, time, begin, end, height):
    """Mean water depth between two stations of a channel whose mesh is a box `height` high [m], from the volume of the water: waves shorter
    than the reach do not count."""
    f = flotsam.fields(case, time, [flotsam.ALPHA])
    chosen = (f["centre"][:, 0] > begin) & (f["centre"][:, 0] < end)
    return height * (f[flotsam.ALPHA] * f["volume"])[chosen].sum() / f["volume"][chosen].sum()


def discharge(h, span=0.25):
    """Times, discharge into and out of the channel [m^3/s], means over `span` seconds."""
    edges = np.arange(0, h.time[-1] + 1e-9, span)
    rate = [np.diff(np.interp(edges, h.time, h.run[name])) / np.diff(edges) for name in ("inflow", "outflow")]
    return 0.5 * (edges[1:] + edges[:-1]), rate[0], rate[1]


def massError(h):
    """Change of the liquid volume that inflow and outflow do not explain, over the largest volume (a channel may begin dry); largest over time."""
    volume, inflow, outflow = (h.run[name] for name in ("liquidVolume", "inflow", "outflow"))
    displaced = np.nan_to_num(h.run.get("displaced", np.zeros(len(volume))))    # what gave way to bodies put into a run that went on
    unexplained = (volume - volume[0]) - (inflow - inflow[0]) + (outflow - outflow[0]) + (displaced - displaced[0])
    return np.abs(unexplained).max() / volume.max()


def checkRuns(report, cases, runs):
    """Adds to the report whether each run has come to its end and lost no water. cases: {name: folder}; runs: {name: {"time", "history"}}."""
    for name, run in runs.items():
        end = parameters(cases[name], "system/controlDict")["endTime"]
        report.within(f"time reached, {name}", run["time"][-1], end - 1e-6, end + 1e-6, "s", "endTime")
        report.within(f"water neither made nor lost, {name}", massError(run["history"]), 0, MASS, source="conservation")


# --- bodies -----------------------------------------------------------------------------------------------------------

def turned(q, x):
    """Vectors of a body's frame in space; q: w x y z."""
    v = q[..., 1:]
    return x + 2 * np.cross(v, np.cross(v, x) + q[..., :1] * x)


def positions(h):
    """Centres of mass, bodies x records x 3."""
    return np.array([h["bodies/" + name].position for name in h.bodies])


def meanSpeed(h, span):
    """Distance that the bodies have come within the last `span` seconds over that time, bodies x records [m/s]; inf until then."""
    x = positions(h)
    before = np.array([[np.interp(h.time - span, h.time, body[:, d]) for d in range(3)] for body in x]).transpose(0, 2, 1)
    return np.where(h.time < span, np.inf, np.linalg.norm(x - before, axis=2) / span)


def inSpace(body, local):
    """Points of a body's frame (n x 3) in space, records x n x 3."""
    return body.position[:, None] + turned(body.orientation[:, None, :], local)


def accounted(x, setup):
    """Number of bodies per record that are to come, inside the channel of these parameters, or left it through the outlet. x: as positions()."""
    inside = (x[..., 0] > -setup["upstream"]) & (np.abs(x[..., 1]) < 0.5 * setup["width"]) & (x[..., 2] > 0) & (x[..., 2] < setup["height"])
    return (inside | (x[..., 0] > setup["downstream"])).sum(0)


def cameIn(h, names):
    """Number of these bodies over time that have come in."""
    return sum(h["bodies/" + name].awaited < 0.5 for name in names)


def row(diameter, length, axis):
    """(centres in its frame, radii) of a row of spheres along a log, finer than those by which logs touch."""
    radius, half = 0.5 * diameter, 0.5 * length
    along = np.linspace(-half + radius, half - radius, int(np.ceil((2 * half - 2 * radius) / (0.16 * radius))) + 1)
    return np.outer(along, np.eye(3)[axis]), np.full(len(along), radius)


def deepestOverlap(h, spheres):
    """Deepest overlap of two bodies in all records [m]. `spheres`: {body: (centres in its frame n x 3, radii n)} that make up its surface."""
    names = list(spheres)
    centres = [inSpace(h["bodies/" + name], spheres[name][0]) for name in names]
    reaches = [(np.linalg.norm(c, axis=1) + r).max() for c, r in spheres.values()]
    middle = [h["bodies/" + name].position for name in names]
    isThere = [h.isThere("bodies/" + name) for name in names]
    deepest = -np.inf
    for i, name in enumerate(names):
        for j in range(i):
            near = (np.linalg.norm(middle[i] - middle[j], axis=1) < reaches[i] + reaches[j]) & isThere[i] & isThere[j]
            radii = spheres[name][1][:, None] + spheres[names[j]][1]
            for k in np.flatnonzero(near):
                a, b = centres[i][k], centres[j][k]
                squares = (a**2).sum(1)[:, None] + (b**2).sum(1) - 2 * a @ b.T
                deepest = max(deepest, (radii - np.sqrt(np.maximum(squares, 0))).max())
    return deepest


# --- forces and means -------------------------------------------------------------------------------------------------

def forcesOn(h, names):
    """Force on each of the structures along x over time, structures x times [N]: of the water, of the bodies."""
    return tuple(np.array([getattr(h["structures/" + name], quantity)[:, 0] for name in names]) for quantity in ("fluidForce", "contactForce"))


def finalMean(time, series, seconds=1.0):
    """Mean of the last seconds of a series over its times."""
    return series[..., time > time[-1] - seconds].mean(-1)


def largestMean(time, series, seconds=1.0):
    """The largest mean of a series over so many seconds, whenever they are: of jams that may break up before the end."""
    if time[-1] - time[0] <= seconds:
        return series.mean()
    starts = np.flatnonzero(time <= time[-1] - seconds + 1e-9)
    return max(series[k:][time[k:] <= time[k] + seconds + 1e-9].mean() for k in starts)


def smooth(time, values, span=0.1):
    """Means over intervals: contact forces are made of short impacts."""
    edges = np.arange(0, time[-1] + span, span)
    number = np.digitize(time, edges)
    used = np.unique(number)
    return np.array([time[number == k].mean() for k in used]), np.array([values[..., number == k].mean(-1) for k in used]).T


def drawFlow(depths, discharges, forces, runs):
    """Into three axes, over time: depths upstream and downstream [cm], discharge [l/s], force of the water on the structure [N] of both runs, the one with
    driftwood first and solid. runs: {name: {"history", "time", "depth" (n x 2), "water"}}."""
    for (name, run), style in zip(runs.items(), ("-", "--")):
        depths.plot(run["time"], 100 * run["depth"][:, 0], "C0" + style, label=f"upstream, {name}")
        depths.plot(run["time"], 100 * run["depth"][:, 1], "C1" + style, label=f"downstream, {name}")
        time, inflow, outflow = discharge(run["history"])
        discharges.plot(time, 1000 * outflow, "C1" + style, label=f"out, {name}")
        forces.plot(*smooth(run["history"].time, np.atleast_2d(run["water"]).sum(0)), "C0" + style, label=f"water, {name}")
    discharges.plot(time, 1000 * inflow, "k:", label="in")
    depths.set(ylabel="water depth [cm]")
    discharges.set(ylabel="discharge [l/s]", title="discharge", ylim=(0, None))


def saveSeries(figure, axes, file):
    """Grid and legends for all axes; the picture."""
    for axis in axes.ravel():
        axis.grid(alpha=0.3)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(file, dpi=110)
    figure.clear()
