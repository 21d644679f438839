# SPDX-License-Identifier: GPL-3.0-or-later
"""Bar held by two pipes in a steady current: the contact force is the drag of the same bar fixed. N: elements over the bar's thickness."""
from support import heldBars

NAMES = ["bar"]

title = """Bar 0.06 m x 0.02 m (density 800) carried against two pipes by 0.1 m/s, 2D, Re = 30; N elements over its thickness; means over the last of 6 s. The contact
force must be the drag of the same bar fixed at the same place."""

runs = heldBars.runs([8, 12])


def resolution(run):
    return f"{run.n} over the thickness"


def files(run, folder):
    return heldBars.files(root, NAMES, run, folder)     # noqa: F821 (root is set by the runner)


def errors(run, folder):
    return heldBars.errors(root, NAMES, run, folder)    # noqa: F821
