# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs in still water stay where they are: one afloat, a raft, a pile on the bed. N: elements over their diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import blockMesh, bodies, control, even, gravity, level, merged, openTank, twoFluids

DIAMETER, LENGTH, END, SETTLED = 0.06, 0.24, 10.0, 5.0
PLACE = 0.0073      # [m] beside the tank's middle, where the diagonals are symmetric

RAFT, PILE_DENSITY = 5, 1400

title = """Round logs of 0.06 m in a still tank of 0.6 m x 0.4 m (3D: 0.4 m wide, the logs 0.24 m long), slip walls, for 10 s: one, half as heavy as water, released half immersed; five of these side by side that touch
(raft); three of 1400 kg/m3 in a pile on the bed, under water, two below and one on both."""

runs = ([Run("flotsamFoam", n, "2D", quick=(n == 3)) for n in (2, 3, 4, 6)] + [Run("flotsamFoam", n, "3D", timeLimit=1200) for n in (2, 3)]
        + [Run("flotsamFoam", n, "raft", quick=(n == 3)) for n in (2, 3, 4, 6)] + [Run("flotsamFoam", 3, "raft3D", timeLimit=1200)]
        + [Run("flotsamFoam", n, "pile", quick=(n == 3)) for n in (2, 3, 4, 6)] + [Run("flotsamFoam", 3, "pile3D", timeLimit=1200)])


def resolution(run):
    return f"{run.n} a diameter"


def isPile(run):
    return run.variant.startswith("pile")


def places(run):
    """x, z of the logs [m]; z = 0: the surface."""
    if isPile(run):
        return [(PLACE - 0.5 * DIAMETER, -0.2 + 0.5 * DIAMETER), (PLACE + 0.5 * DIAMETER, -0.2 + 0.5 * DIAMETER), (PLACE, -0.2 + (0.5 + np.sqrt(0.75)) * DIAMETER)]
    if run.variant.startswith("raft"):
        return [(PLACE + (k - 0.5 * (RAFT - 1)) * DIAMETER, 0) for k in range(RAFT)]
    return [(-0.1 + PLACE, 0)]


def files(run, _folder):
    h = DIAMETER / run.n
    is3D = run.variant.endswith("3D")
    width = 0.4 if is3D else h
    length = LENGTH if is3D else width
    poses = " ".join(f"{{ position ({x:.9g} {width / 2:.9g} {z:.9g}); }}" for x, z in places(run))
    return merged(
        blockMesh(even(-0.3, 0.3, round(0.6 / h)), even(0, width, max(1, round(width / h))), even(-0.2, 0.2, round(0.4 / h)),
                  {"walls": ("wall", "x- x+ z-"), "atmosphere": ("patch", "z+"), "sides": ("wall" if is3D else "empty", "y- y+")}),
        openTank("slip", ["walls", "sides"] if is3D else ["walls"], empty=[] if is3D else ["sides"]),
        level("(0 0 1)"),
        twoFluids(), gravity(z=-9.81),
        bodies(f"""bodies
{{
    log
    {{
        shape    {{ type cylinder; end1 (0 {-length / 2:.9g} 0); end2 (0 {length / 2:.9g} 0); radius {DIAMETER / 2}; }}
        density  {PILE_DENSITY if isPile(run) else 500};
        poses    ({poses});
    }}
}}"""),
        control(END, 0.002, maxCo=1, maxDeltaT=0.0125))


def prepare(_run, do):
    do("blockMesh")
    do("setAlphaField")


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    logs, late = [history["bodies/" + name] for name in history.bodies], history.time >= SETTLED
    volume = 0.25 * np.pi * DIAMETER**2 * (LENGTH if run.variant.endswith("3D") else DIAMETER / run.n)
    net = 9.81 * volume * ((PILE_DENSITY - 1000) * len(logs) if isPile(run) else 0)
    onBed = sum(log.contactForce[late, 2].mean() for log in logs)   # what they do to each other has no sum
    way = max(np.linalg.norm(log.position[:, :2] - log.position[0, :2], axis=1).max() for log in logs)
    speed = max(np.linalg.norm(log.velocity[late, :2], axis=1).max() for log in logs)
    turning = max(np.linalg.norm(log.angularVelocity[late], axis=1).max() for log in logs)
    found = [small("way along the water", way / DIAMETER, 0.01, "diameters", "at rest"),
             small("its speed after 5 s", speed, 1e-4, "m/s", "at rest"),
             small("its rotation after 5 s", turning, 0.01, "rad/s", "at rest")]
    return {"comparisons": found + ([relative("force on the bed", onBed, net, 1e-3, "N", "weight less buoyancy")] if isPile(run) else [])}
