# SPDX-License-Identifier: GPL-3.0-or-later
"""Test of benchmarks/validation/support/jam.py: jams whose shape is known."""
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", "validation"))
from support import jam  # noqa: E402

LOGS = jam.Logs(diameter=0.02, length=0.2, density=600)
WIDTH = 0.4


def raft(rows, layers, height=0.1):
    """Centres of logs side by side across the channel, two in a row, from the rack's axes upstream, layer over layer."""
    return np.array([(-(i + 0.5) * LOGS.diameter, side * LOGS.length / 2, height + k * LOGS.diameter) for i in range(rows) for side in (-1, 1) for k in range(layers)])


def turned(centres, angle):
    """All logs in the direction `angle` from the channel's axis, in the plane of the bed."""
    return np.tile([np.cos(angle), np.sin(angle), 0.0], (len(centres), 1))


class JamShape(unittest.TestCase):
    def test_fullRaftsHaveTheBulkFactorOfTheirSection(self):
        for layers in (1, 3):
            centres = raft(20, layers)
            shape = jam.shape(LOGS, centres, turned(centres, np.pi / 2), WIDTH)
            # the ends leave out two rows of fortieths and less of the bow
            self.assertLess(abs(shape.length - 0.4), LOGS.diameter)
            self.assertLess(abs(shape.atRack(LOGS.length) / (layers * LOGS.diameter) - 1), 0.02)
            for envelope in (shape.thickness, shape.outline):
                self.assertLess(abs(shape.bulk(envelope) / (4 / np.pi) - 1), 0.06)

    def test_aHangingLogThickensTheOutlineMoreThanTheColumns(self):
        centres = raft(20, 1)
        before = jam.shape(LOGS, centres, turned(centres, np.pi / 2), WIDTH)
        hanging = np.vstack([centres, (-0.2, 0.1, 0.02)])
        after = jam.shape(LOGS, hanging, turned(hanging, np.pi / 2), WIDTH)
        self.assertLess(abs(after.outline.max() - 0.1), 1e-3)
        gain = after.bulk(after.thickness) - before.bulk(before.thickness), after.bulk(after.outline) - before.bulk(before.outline)
        self.assertGreater(gain[0], 0)
        self.assertGreater(gain[1], 1.5 * gain[0])

    def test_logsApartAreALooserJam(self):
        centres = raft(20, 1) * (2, 1, 1)
        shape = jam.shape(LOGS, centres, turned(centres, np.pi / 2), WIDTH)
        self.assertLess(abs(shape.length - 0.8), LOGS.diameter * 2)

    def test_surfacesLieARadiusFromTheAxis(self):
        rng = np.random.default_rng(1)
        directions = rng.normal(size=(50, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        axes, surfaces = jam.points(LOGS, rng.normal(size=(50, 3)), directions)
        off = surfaces - axes[:, :, None]
        self.assertLess(abs(np.linalg.norm(off, axis=3) - LOGS.diameter / 2).max(), 1e-12)
        self.assertLess(abs((off * directions[:, None, None]).sum(3)).max(), 1e-12)

    def test_thinLightAndSlowLogsFloat(self):
        self.assertLess(abs(jam.buoyancyToDrag(LOGS, 1.0) / (0.4 * 9.81 * np.pi / 4 * 0.02 / 0.6) - 1), 1e-12)
        self.assertGreater(jam.buoyancyToDrag(LOGS, 0.2), 1)
        self.assertLess(jam.buoyancyToDrag(LOGS, 0.6), 1)


if __name__ == "__main__":
    unittest.main()
