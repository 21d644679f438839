# SPDX-License-Identifier: GPL-3.0-or-later
"""Block, sphere, log and capsule on an incline: held, sliding, rolling."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import gas
from support.compare import absolute, relative, small

GRAVITY, END = 9.81, 0.4
#         shape, slope [degrees], friction coefficient
RUNS = {"block 30, 0.3": ("block", 30, 0.3), "block 10, 0.3": ("block", 10, 0.3), "block 40, 0.5": ("block", 40, 0.5), "sphere 30, 0.3": ("sphere", 30, 0.3),
        "sphere 40, 0.1": ("sphere", 40, 0.1), "log 15, 0.5": ("log", 15, 0.5), "log 40, 0.1": ("log", 40, 0.1), "capsule 15, 0.5": ("capsule", 15, 0.5)}
#         moment of inertia about the axis of rolling, over mass and radius squared; capsule: 0.06 m between the centres of its ends
ROUND = {"sphere": 2 / 5, "log": 1 / 2, "capsule": (0.06 / 2 + 4 / 3 * 0.02 * 2 / 5) / (0.06 + 4 / 3 * 0.02)}

title = """Block of 0.04 x 0.04 x 0.02 m; sphere, log and capsule of 0.02 m radius, the latter 0.08 and 0.1 m long (590 kg/m3) on a wall, gravity inclined by the given angle, with the given coefficient of friction, released from rest
just above the wall, in a gas of 1e-4 kg/m3; acceleration between 0.15 and 0.4 s. Exact: g (sin - mu cos) sliding, g sin/(1 + k) rolling (where mu > k/(1 + k) tan), k: moment of inertia over mass and radius squared."""

runs = [Run("flotsamFoam", 1, name, quick=name in ("block 30, 0.3", "sphere 30, 0.3")) for name in RUNS]


def resolution(_run):
    return "40 x 6 x 4 cells"


def files(run, _folder):
    shape, slope, friction = RUNS[run.variant]
    text = {"block": "block { shape { type box; size (0.04 0.04 0.02); } density 590; position (0.06 0 0.01001); }",
            "sphere": "sphere { shape { type sphere; radius 0.02; } density 590; position (0.06 0 0.02001); }",
            "log": "log { shape { type cylinder; end1 (0 -0.04 0); end2 (0 0.04 0); radius 0.02; } density 590; position (0.06 0 0.02001); }",
            "capsule": "capsule { shape { type capsule; end1 (0 -0.03 0); end2 (0 0.03 0); radius 0.02; } density 590; position (0.06 0 0.02001); }"}[shape]
    angle = np.radians(slope)
    return gas.files(((0, 0.6), (-0.05, 0.05), (0, 0.06)), (40, 6, 4), (GRAVITY * np.sin(angle), 0, -GRAVITY * np.cos(angle)),
                     f"contact {{ default {{ stiffness 1e5; restitution 0.2; frictionAngle {np.degrees(np.arctan(friction)):.10g}; }} }}\nbodies {{ {text} }}", END, 2e-3)


def errors(run, case):
    shape, slope, mu = RUNS[run.variant]
    history = foam.history(root, case)      # noqa: F821 (root is set by the runner)
    body, angle = history[shape], np.radians(slope)
    late = history.time > 0.15
    t = history.time[late]
    acceleration = np.polyfit(t, body.velocity[late, 0], 1)[0]
    sliding = GRAVITY * (np.sin(angle) - mu * np.cos(angle))
    if shape == "block":
        exact = max(0.0, sliding)
        found = [relative("acceleration", acceleration, exact, 0.005, "m/s2", "exact") if exact else absolute("acceleration", acceleration, 0.0, 0.005, "m/s2", "held by friction"),
                 small("largest turning rate", np.abs(body.angularVelocity[late]).max(), 0.05, "rad/s", "flat on the wall")]
        if not exact:
            found.append(small("distance slid", abs(body.position[-1, 0] - body.position[0, 0]), 1e-4, "m", "held by friction"))
        return {"comparisons": found}
    k = ROUND[shape]
    isRolling = mu >= k / (1 + k) * np.tan(angle)
    exact = GRAVITY * np.sin(angle) / (1 + k) if isRolling else sliding
    turning = exact if isRolling else mu * GRAVITY * np.cos(angle) / k
    return {"comparisons": [
        relative("acceleration", acceleration, exact, 0.005, "m/s2", "exact"),
        relative("angular acceleration x radius", 0.02 * np.polyfit(t, body.angularVelocity[late, 1], 1)[0], turning, 0.005, "m/s2", "exact")]}
