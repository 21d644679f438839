# SPDX-License-Identifier: GPL-3.0-or-later
"""A log, and a raft of logs, carried by a uniform stream go with it. N: elements over the diameter."""
import numpy as np

from runner import foam
from runner.cases import Run
from support.compare import relative, small
from support.files import Axis, blockMesh, bodies, control, even, field, fixed, gravity, level, merged, twoFluids

SPEED, DEPTH, HEIGHT, LENGTH, START, END, LATE = 0.3, 0.2, 0.4, 3.0, 0.5, 6.0, 3.0
ELEMENT = 0.02      # [m]
RAFT, FIRST = 5, 0.3    # logs; place of the first one [m]

title = """A round log, half as heavy as water, half immersed in water and air that flow with 0.3 m/s through a channel of 3 m x 0.4 m, 0.2 m of water, 2D, elements of 0.02 m (variant fine: 0.01 m); released with the
stream's speed; variant raft: five of these side by side that touch. Nothing moves against anything else, but all of it through the mesh: what differs from the stream is of the discretisation. Between 3 and 6 s, 0.9 to 1.8 m from the start."""

runs = [Run("flotsamFoam", n, quick=(n == 4)) for n in (3, 4, 6, 8)] + [Run("flotsamFoam", 12, "fine")] + [Run("flotsamFoam", n, "raft", quick=(n == 3)) for n in (3, 4, 6)]


def resolution(run):
    return f"{run.n} a diameter"


def element(run):
    return ELEMENT / 2 if run.variant == "fine" else ELEMENT


def places(run):
    """x of the logs [m]."""
    diameter = run.n * element(run)
    return [FIRST + k * diameter for k in range(RAFT)] if run.variant == "raft" else [START]


def files(run, _folder):
    h = element(run)
    n = round(DEPTH / h)
    z = Axis([-DEPTH, 0, HEIGHT - DEPTH], [n, n], [1, 1])
    pressure = "type fixedFluxPressure; value uniform 0;"
    stream = fixed(f"({SPEED} 0 0)")
    return merged(
        blockMesh(even(0, LENGTH, round(LENGTH / h)), even(0, h, 1), z,
                  {"inlet": ("patch", "x-"), "outlet": ("patch", "x+"), "bed": ("wall", "z-"), "atmosphere": ("patch", "z+"), "frontAndBack": ("empty", "y- y+")}),
        field("U", {"inlet": stream, "outlet": stream, "bed": "slip", "atmosphere": "type pressureInletOutletVelocity; value uniform (0 0 0);", "frontAndBack": "empty"},
              f"({SPEED} 0 0)"),
        field("p_rgh", {"inlet": pressure, "outlet": pressure, "bed": pressure, "atmosphere": "type totalPressure; p0 uniform 0; value uniform 0;", "frontAndBack": "empty"}),
        field("alpha.water", {"inlet": "zeroGradient", "outlet": "zeroGradient", "bed": "zeroGradient",
                              "atmosphere": "type inletOutlet; inletValue uniform 0; value uniform 0;", "frontAndBack": "empty"}),
        level("(0 0 1)"),
        twoFluids(), gravity(z=-9.81),
        bodies(f"""bodies
{{
    log
    {{
        shape    {{ type cylinder; end1 (0 {-h / 2:.9g} 0); end2 (0 {h / 2:.9g} 0); radius {0.5 * run.n * h:.9g}; }}
        density  500;
        poses    ({" ".join(f"{{ position ({x:.9g} {h / 2:.9g} 0); }}" for x in places(run))});
        velocity ({SPEED} 0 0);
    }}
}}"""),
        control(END, 0.002, maxCo=1, maxBodyCo=1, maxDeltaT=0.0125))


def prepare(_run, do):
    do("blockMesh")
    do("setAlphaField")


def errors(run, case):
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    logs, late = [history["bodies/" + name] for name in history.bodies], history.time >= LATE
    radius, x = 0.5 * run.n * element(run), np.array([log.position[:, 0] for log in logs])
    found = [relative("mean speed", np.polyfit(history.time[late], x[:, late].mean(0), 1)[0], SPEED, 0.01, "m/s", "the stream's"),
             small("heave", max(np.ptp(log.position[late, 2]) for log in logs) / radius, 0.01, "radii", "none"),
             small("speed of its surface by rotation", max(np.abs(log.angularVelocity[late]).max() for log in logs) * radius / SPEED, 0.05, "of the stream's", "none")]
    if run.variant == "raft":
        found.append(small("widest gap between neighbours", (np.diff(x, axis=0) / (2 * radius) - 1).max(), 0.05, "diameters", "none"))
    return {"comparisons": found}
