# SPDX-License-Identifier: GPL-3.0-or-later
"""Two bars in a steady current, one pinned on the other by it, the first held by two pipes. N: elements over a bar's thickness."""
from support import heldBars

NAMES = ["first", "second"]

title = """As barHeld, with a second bar upstream that the current presses on the first: the force between the bars must be the drag of the second one, that on the
pipes the sum of both drags, as of the same two bars fixed at the same places."""

runs = heldBars.runs([8, 12])


def resolution(run):
    return f"{run.n} over the thickness"


def files(run, folder):
    return heldBars.files(root, NAMES, run, folder)     # noqa: F821 (root is set by the runner)


def errors(run, folder):
    return heldBars.errors(root, NAMES, run, folder)    # noqa: F821
