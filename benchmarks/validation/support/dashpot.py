# SPDX-License-Identifier: GPL-3.0-or-later
"""Spring and dashpot that never attract (Schwager & Poeschel, Granular Matter 9 (2007) 465; docs/contact.md)."""
import numpy as np


def _restitution(beta):
    w = np.sqrt(abs(1 - beta**2))
    if beta < 1:
        return np.exp(-beta / w * (np.pi - np.arctan2(2 * beta * w, w**2 - beta**2)))
    return np.exp(-2 * beta / w * np.log(beta + w))


def dampingRatio(restitution):
    """c/(2 sqrt(k m)) that gives the restitution."""
    low, high = 0.0, 20.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _restitution(middle) > restitution else (low, middle)
    return low


def impactFactor(beta):
    """Largest force of an impact on spring and dashpot over v sqrt(k m), beta = c/(2 sqrt(k m)): at its start from 1/2 on, else where it is steady."""
    if beta >= 0.5:
        return 2 * beta
    w = np.sqrt(1 - beta**2)
    t = np.arctan2(w * (1 - 4 * beta**2), beta * (3 - 4 * beta**2)) / w
    return np.exp(-beta * t) * (2 * beta * np.cos(w * t) + (1 - 2 * beta**2) / w * np.sin(w * t))
