# SPDX-License-Identifier: GPL-3.0-or-later
"""Which logs a rack holds, over their length: beside the rules by which racks and slit dams are spaced. N: elements over the clear opening."""
import numpy as np

from runner import foam
from runner.cases import Run
from support import rackCase
from support.compare import small

RULES = "Japanese guideline (opening at most half a log), Lange & Bezzola 2006 (two thirds), both recalled"
PITCH, DIAMETER, DENSITY, NLOGS, SPEED = 0.10, 0.02, 600, 32, 0.45
OPENING = PITCH - rackCase.BAR
FIRST, INTERVAL, LAST = 2.0, 0.1, 2.0       # the first log comes in, the next ones after it; means over the last seconds [s]
HELD, PASSED, OVERLAP = 2, 0.75, 1e-3       # length over opening from which on, up to which logs are held, pass
MOST, FEW = 0.9, 0.1                        # of the logs

VARIANTS = {f"length {ratio:g} b": ratio for ratio in (0.75, 1, 1.5, 2, 3)}

title = f"""tutorials/debrisRack with other parameters: channel 0.4 m wide, 0.16 m deep at the outlet, {SPEED:g} m/s (Froude number 0.36), rack of four no-slip bars 0.02 m thick with clear openings b of
{OPENING:g} m, {NLOGS} logs {DIAMETER:g} m thick of {DENSITY} kg/m3, which come in at random places and yaws {1000 * INTERVAL:g} ms apart, 1.45 to 1.8 m upstream. Held: at the end (4 s after the last may have come to
the rack) upstream of it and slower than a quarter of the stream. Rules of design hold the logs that are {HELD:g} (1.5) openings long; shorter than an opening, a log passes at any yaw and is held by others alone.
Targets, stated before the runs: from {HELD:g} openings on at least {100 * MOST:g} % held, up to {PASSED:g} at most {100 * FEW:g} %. Force: of water and logs on the rack, mean over the last {LAST:g} s, over that of the clean rack."""
runs = [Run("flotsamFoam", 5, name, quick=name == "length 2 b", timeLimit=7200) for name in VARIANTS]


def resolution(run):
    return f"{run.n} an opening"


def files(run, _folder):
    """But system/parameters."""
    return rackCase.files(root, 1, FIRST + NLOGS * INTERVAL + 1.8 / SPEED + 4)    # noqa: F821 (root is set by the runner)


def parameters(run):
    return rackCase.parameters(root, {"discharge": f"{SPEED * rackCase.CHANNEL['width'] * rackCase.CHANNEL['depth']:.6g}", "nBars": 4, "pitch": PITCH,    # noqa: F821
                                      "nLogs": NLOGS, "logDiameter": DIAMETER, "logLength": f"{VARIANTS[run.variant] * OPENING:.6g}", "logDensity": DENSITY,
                                      "firstRelease": FIRST, "releaseInterval": INTERVAL}, run.n / 5)


prepare = rackCase.prepare


def errors(run, case):
    reader = foam.resultReader(root)    # noqa: F821
    import driftwood    # beside the reader, whose folder is in the path now
    h = reader.history(case)
    held, passed = rackCase.held(h, driftwood, SPEED)
    force = sum(part.sum(0) for part in driftwood.forcesOn(h, h.structures))
    clean, jammed = (force[(h.time > end - span) & (h.time <= end)].mean() for end, span in ((FIRST, 1), (h.time[-1], LAST)))
    return {"comparisons": [*_retention(VARIANTS[run.variant], held.sum() / NLOGS), small("logs that passed, of all", passed.sum() / NLOGS),
                            small("force on the clean rack", clean, unit="N"), small("force with logs over it", jammed / clean),
                            small("deepest overlap of a contact", h.run["largestOverlap"].max(), OVERLAP, "m"),
                            small("water made or lost, over the largest volume", driftwood.massError(h), driftwood.MASS)]}


def _retention(ratio, share):
    if ratio <= PASSED:
        return [small("logs held, of all", share, FEW, source=RULES)]
    shown = [small("logs held, of all", share, source=RULES)]
    return shown if ratio < HELD else [*shown, small("logs not held, of all", 1 - share, round(1 - MOST, 10), source=RULES)]
