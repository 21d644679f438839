# SPDX-License-Identifier: GPL-3.0-or-later
"""Free overfall at the end of a horizontal frictionless channel. N: elements over the critical depth."""
import numpy as np

from runner.cases import Run
from support import channel
from support.compare import relative
from support.files import control, merged

CRITICAL, LENGTH, HEIGHT, END = 0.08, 1.2, 0.2, 4.0
SPEED = float(np.sqrt(channel.G * CRITICAL))
ROUSE = 0.715       # of the critical depth, measured at a brink with the jet's pressure in its section: Rouse 1936

title = f"""Water at the critical depth of {CRITICAL} m and speed in a horizontal slip channel of 15 critical depths, 2D, leaves through its end, where the pressure is prescribed as 0 (prghTotalPressure). The momentum theorem between the
critical section and one without pressure gives 2/3 of the critical depth for the depth there. A real brink, with the pressure of the bent jet in its section, has {ROUSE} (Rouse 1936): put the end of the mesh below the brink if that matters.
After {END:g} s; depth extrapolated from the last two columns of cells."""

runs = [Run("flotsamFoam", n, quick=(n == 4)) for n in (4, 8, 16)]


def resolution(run):
    return f"{run.n} over the critical depth"


def files(run, _folder):
    end = ("patch", "type pressureInletOutletVelocity; value uniform (0 0 0);", "type prghTotalPressure; p0 uniform 0; value uniform 0;",
           "type inletOutlet; inletValue uniform 0; value uniform 0;")
    h = CRITICAL / run.n
    return merged(channel.files(LENGTH, HEIGHT, h, CRITICAL, SPEED, end), control(END, 0.002, maxDeltaT=0.01))


def prepare(_run, do):
    do("blockMesh")
    do("setFields")


def errors(run, case):
    h = CRITICAL / run.n
    _, depth = channel.depths(case, round(LENGTH / h), h)
    last = depth[-1] / CRITICAL
    return {"comparisons": [relative("depth at the end over the critical one", 1.5 * last[-1] - 0.5 * last[-2], 2 / 3, 0.02, "", "momentum theorem")]}
