# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating of a long bar with a square section: Archimedes, and the sign of the metacentric height.

Flat side up it is stable when s (1 - s) < 1/6 (s: relative density), that is s < 0.211 or s > 0.789; corner up when
0.281 < s < 0.719 (E. N. Gilbert, Am. Math. Monthly 98 (1991) 201). Driftwood of s = 0.59 floats corner up.
"""
import numpy as np

SIDE, RELATIVE_DENSITY = 0.02, 0.59

# the dry part is a right triangle below the upper corner: area t^2 = (1 - s) a^2, t its height
DRY_HEIGHT = np.sqrt(1 - RELATIVE_DENSITY) * SIDE
DRAFT = np.sqrt(2) * SIDE - DRY_HEIGHT              # of the lower corner [m]
CENTRE_DEPTH = DRAFT - SIDE / np.sqrt(2)            # of the centre below the water level [m]
ANGLE = 45.0                                        # [degrees]
