# SPDX-License-Identifier: GPL-3.0-or-later
"""How a long bar with a rectangular section floats: attitude of least potential energy, draft by Archimedes."""
import numpy as np


def _corners(width, height, angle):
    x, y = np.array([-1, 1, 1, -1]) * width / 2, np.array([-1, -1, 1, 1]) * height / 2
    return np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y], axis=1)


def lowest(width, height, angle):
    """Of the section below its centre [m]."""
    return -_corners(width, height, angle)[:, 1].min()


def _below(points, level):
    """Area and first moment in y of the part of a convex polygon below y = level."""
    kept = []
    for a, b in zip(points, np.roll(points, -1, axis=0)):
        if a[1] <= level:
            kept.append(a)
        if (a[1] - level) * (b[1] - level) < 0:
            kept.append(a + (level - a[1]) / (b[1] - a[1]) * (b - a))
    if len(kept) < 3:
        return 0.0, 0.0
    p, q = np.array(kept), np.roll(kept, -1, axis=0)
    cross = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
    return cross.sum() / 2, (cross * (p[:, 1] + q[:, 1])).sum() / 6


def _floats(width, height, density, angle):
    """(waterline above the centre, height of the centre above that of the displaced area), at this angle."""
    points, area = _corners(width, height, angle), density * width * height
    low, high = points[:, 1].min(), points[:, 1].max()
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _below(points, middle)[0] < area else (low, middle)
    return low, -_below(points, low)[1] / area


def equilibrium(width, height, density, start):
    """(angle [rad], depth of the centre below the water [m]) of the energy's minimum downhill from the angle `start`.
    The potential energy is the weight times the height of the centre above the centre of the displaced liquid."""
    step, angle = np.radians(1), start

    def energy(a):
        return _floats(width, height, density, a)[1]
    while step > 1e-6:
        here = energy(angle)
        for turned in (angle - step, angle + step):
            if energy(turned) < here - 1e-15:
                angle = turned
                break
        else:
            step /= 2
    angle = round(angle, 6)     # as exact as the steps
    return angle, _floats(width, height, density, angle)[0]
