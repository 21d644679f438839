# SPDX-License-Identifier: GPL-3.0-or-later
"""momentum.py CASE 'GRAVITY' BODY...: what bodies.h5 says of a body's loads changes its momentum as it says, in every step, to round-off."""
import sys

import numpy as np

import flotsam

case, gravity, names = sys.argv[1], [float(g) for g in sys.argv[2].split()], sys.argv[3:]
h = flotsam.history(f"{case}/postProcessing/flotsam")
for name in names:
    body = h["bodies/" + name]
    impulse = (flotsam.momentumLoad(h, name, gravity) + body.contactForce) * h.run["dt"][:, None]
    gained = body.mass * np.diff(body.velocity, axis=0)
    isThere = h.isThere("bodies/" + name)[1:, None]
    worst = abs((gained - impulse[1:]) * isThere).max()
    scale = abs(body.fluidForce * h.run["dt"][:, None]).max()
    if not worst < 1e-10 * scale or len(h.time) < 10 or not abs(gained).max() > 1e-3 * scale:
        sys.exit(f"FAILED: {case}: of {name} a step's change of momentum differs from the impulse by {worst} N s; the largest of the fluid is {scale} N s")
