# SPDX-License-Identifier: GPL-3.0-or-later
"""A stream that meets a wall is thrown back as a bore. N: elements over the stream's depth."""
import numpy as np

from runner.cases import Run
from support import channel
from support.compare import relative
from support.files import control, merged

DEPTH, LENGTH, HEIGHT, SPEED = 0.1, 4.0, 0.4, 0.7


def jump():
    """(depth behind, speed) of the bore that stops the stream: mass and momentum (Belanger); the depth by bisection."""
    low, high = DEPTH, 10 * DEPTH
    for _ in range(60):
        depth = 0.5 * (low + high)
        stopped = (depth - DEPTH) * np.sqrt(channel.G * (DEPTH + depth) / (2 * DEPTH * depth))
        low, high = (depth, high) if stopped < SPEED else (low, depth)
    return depth, SPEED * DEPTH / (depth - DEPTH)


BEHIND, BORE = jump()
END = 0.7 * LENGTH / BORE
WRITES = 24

title = f"""A stream of {SPEED} m/s, {DEPTH} m deep (Froude number 0.71), in a horizontal slip channel of {LENGTH:g} m meets a wall, 2D. The bore that runs back has the depth of mass and momentum across it ({BEHIND:.4f} m at {BORE:.3f} m/s;
it is undular and breaks a little). Mean over the half of its length next to the wall and over the later half of the run."""

runs = [Run("flotsamFoam", n, quick=(n == 5)) for n in (5, 10)]


def resolution(run):
    return f"{run.n} over the depth"


def files(run, _folder):
    h = DEPTH / run.n
    end = ("wall", "slip", "type fixedFluxPressure; value uniform 0;", "zeroGradient")
    return merged(channel.files(LENGTH, HEIGHT, h, DEPTH, SPEED, end), control(END, 0.002, maxDeltaT=0.01, writeInterval=END / WRITES))


def prepare(_run, do):
    do("blockMesh")
    do("setFields")


def errors(run, case):
    h = DEPTH / run.n
    time, depth = channel.depths(case, round(LENGTH / h), h)
    x = (np.arange(depth.shape[1]) + 0.5) * h
    late = time > 0.5 * END
    behind = np.mean([d[x > LENGTH - 0.5 * BORE * t].mean() for t, d in zip(time[late], depth[late])])
    return {"comparisons": [relative("depth behind the bore", behind, BEHIND, 0.02, "m", "Belanger")]}
