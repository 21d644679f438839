# SPDX-License-Identifier: GPL-3.0-or-later
"""Period and peaks of a wave's amplitude a over the time t (arrays of equal length)."""
import numpy as np


def period(t, a):
    """Slope through the first ten zero crossings."""
    before = np.flatnonzero(a[:-1] * a[1:] < 0)
    crossing = (t[before] - a[before] * (t[before + 1] - t[before]) / (a[before + 1] - a[before]))[:10]
    return 2 * np.polyfit(np.arange(len(crossing)), crossing, 1)[0]


def peak(t, a, around, length):
    """Largest value near the time `around` of a wave with the period `length`: polynomial through the samples there."""
    near = np.abs(t - around) < 0.06 * length
    fit = np.polyfit(t[near] - around, a[near], 4)
    return np.polyval(fit, np.linspace(-0.05, 0.05, 201) * length).max()
