# SPDX-License-Identifier: GPL-3.0-or-later
"""Front of the collapsing column and the experiment it is compared with."""
import numpy as np

import flotsam

COLUMN = 0.146          # width of the water column [m]
OBSTACLE = 2 * COLUMN   # where the obstacle stands [m]
GRAVITY = 9.81


def scaledTime(t):
    """Time in the experiment's unit."""
    return t * np.sqrt(2 * GRAVITY / COLUMN)


def experiment():
    """Scaled time, front over column width."""
    return np.loadtxt("reference/front.csv", delimiter=",", unpack=True)


def isBesideObstacle(front):
    """Whether a front, over the column's width, is at the obstacle or past it."""
    return front >= 0.95 * OBSTACLE / COLUMN


def computed(case="."):
    """Times and front [m]: how far water reaches along the bottom, from its volume in the lowest layer of cells."""
    written, front = [], []
    for time in flotsam.times(case):
        cells = flotsam.fields(case, time, [flotsam.ALPHA])
        low = cells["centre"][:, 1] < cells["centre"][:, 1].min() + 1e-6
        x, alpha = cells["centre"][low, 0], cells[flotsam.ALPHA][low]
        order = np.argsort(x)
        x, alpha = x[order], alpha[order]
        dry = np.flatnonzero((alpha[:-1] >= 0.5) & (alpha[1:] < 0.5))
        if not len(dry):
            break
        k = dry[-1]
        written.append(time)
        front.append(x[k] + (alpha[k] - 0.5) / (alpha[k] - alpha[k + 1]) * (x[k + 1] - x[k]))
    return np.array(written), np.array(front)
