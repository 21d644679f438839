# SPDX-License-Identifier: GPL-3.0-or-later
"""Test of tutorials/common/clogging.py and ensemble.py: bodies of known ways, forces of known series, runs put together."""

import os
import sys
import types
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tutorials", "common"))
import clogging  # noqa: E402
import contactNetwork  # noqa: E402
import ensemble  # noqa: E402
import flotsam  # noqa: E402

DOWNSTREAM = -np.eye(3)[1]
SPEED = 0.5     # of the stream [m/s]


class History:
    """As bodyHistory.History: bodies whose way along the stream is a function of time; one structure from s = 1.9 to 2 m."""

    def __init__(self, time, ways, come=None, gone=None):
        self.time = time
        self.run = {"dt": np.diff(time, prepend=time[0])}
        self.bodies, self.structures = list(ways), ["rack.0", "rack.1"]
        self._members = {}
        for name, way in ways.items():
            start, end = (come or {}).get(name, -1), (gone or {}).get(name, np.inf)
            s = np.array([way(min(max(t, start), end)) for t in time])
            self._members["bodies/" + name] = types.SimpleNamespace(longest=len(name), position=s[:, None] * DOWNSTREAM, awaited=(time < start) * 1.0, left=(time >= end) * 1.0)
        for k in range(2):
            self._members[f"structures/rack.{k}"] = types.SimpleNamespace(number=k, fluidForce=np.outer(time, [0, -1, k]), contactForce=np.outer(time > 1, [0, -3, 0]),
                                                                          peakContactForce=np.outer(np.where(np.abs(time - 2) < 1e-9, 10 + k, 1), [0, -1, 0]))
        corners = np.array([(0, -1.9, 0), (0, -2.0, 0), (1, -2.0, 0)], dtype=float)
        self.surface = {"time": np.array([0.0, 4.0]), "points": np.concatenate([corners, corners + 7]), "triangles": np.array([[0, 1, 2]]), "member": np.array([0])}

    def __getitem__(self, name):
        return self._members[name]


class Clogging(unittest.TestCase):
    def test_fates(self):
        time = np.linspace(0, 8, 321)
        ways = {"held": lambda t: min(SPEED * t, 1.6), "passes": lambda t: SPEED * t, "late": lambda t: SPEED * min(t - 6, 1.0), "never": lambda t: 0.0,
                "goes": lambda t: SPEED * t, "strays": lambda t: SPEED * min(t, 2.0)}
        h = History(time, ways, come={"late": 6.0, "never": 99.0}, gone={"goes": 6.0, "strays": 1.0})
        direction = clogging.streamDirection(h)
        np.testing.assert_array_equal(direction, DOWNSTREAM)
        falling = History(time, {"falls": lambda t: SPEED * t})     # longest 5: gets no farther than it is long
        np.testing.assert_array_equal(clogging.streamDirection(falling, 1), DOWNSTREAM)
        for axis, far, expected in ((0, 6.0, np.eye(3)[0]), (0, 4.0, DOWNSTREAM), (2, -6.0, -np.eye(3)[2])):
            falling["bodies/falls"].position[:, [0, 2]] = 0
            falling["bodies/falls"].position[:, 1] = -10 * time / time[-1]
            falling["bodies/falls"].position[:, axis] = far * time / time[-1]
            np.testing.assert_array_equal(clogging.streamDirection(falling, 1), expected)
            np.testing.assert_array_equal(clogging.streamDirection(falling), DOWNSTREAM)
        zone = clogging.zoneOf(h, h.structures, direction)
        np.testing.assert_allclose(zone, (1.9, 2.0))
        fate = clogging.fates(h, zone, direction)
        np.testing.assert_array_equal(sum(state.astype(int) for state in fate), 1)
        at = lambda name, t: next(f for f, state in fate._asdict().items() if state[list(ways).index(name), np.searchsorted(time, t - 1e-9)])  # noqa: E731
        self.assertEqual([at("held", t) for t in (0, 1, 3, 3.3, 4, 8)], ["coming"] * 4 + ["held"] * 2)   # stops at 3.2 s; mean speed below a quarter 3/8 s later
        self.assertEqual([at("passes", t) for t in (1, 3.9, 4.1, 8)], ["coming", "coming", "passed", "passed"])
        self.assertEqual([at("late", t) for t in (0, 5.9, 6.0, 6.4, 7.3, 7.5, 8)], ["awaited"] * 2 + ["coming"] * 3 + ["held"] * 2)     # stops at 7 s
        self.assertEqual([at("never", t) for t in (0, 8)], ["awaited"] * 2)
        self.assertEqual([at("goes", t) for t in (3, 5, 8)], ["coming", "passed", "passed"])    # it left downstream
        self.assertEqual([at("strays", t) for t in (0.9, 1.1, 8)], ["coming", "left", "left"])
        self.assertEqual(clogging.meanLongest(h, fate.passed[:, -1]), np.mean([len("passes"), len("goes")]))
        self.assertIsNone(clogging.meanLongest(h, fate.passed[:, 0]))
        share = clogging.retention(fate)
        self.assertTrue(np.isnan(share[0]))
        self.assertAlmostEqual(share[-1], 2 / 4)

    def test_without_bodies_and_structures(self):
        h = History(np.linspace(0, 1, 5), {})
        self.assertEqual(clogging.fates(h, clogging.Zone(0, 1), DOWNSTREAM).held.shape, (0, 5))
        self.assertIsNone(clogging.zoneOf(h, [], DOWNSTREAM))
        self.assertEqual(clogging.chosen(h, ["rack"]).structures, h.structures)
        self.assertEqual(clogging.chosen(h, ["rack.1"]).structures, ["rack.1"])
        with self.assertRaisesRegex(flotsam.CaseError, "nothing of the name dam holds bodies; there are: structures rack$"):
            clogging.chosen(h, ["dam"])
        self.assertEqual(clogging.groupsOf(["rack.0", "rack.1", "v1.5", "pier"]), {"rack": ["rack.0", "rack.1"], "v1": ["v1.5"], "pier": ["pier"]})

    def test_contacts_tell_what_is_held_by_the_structures(self):
        time = np.linspace(0, 4, 161)
        still = lambda t: min(SPEED * t, 1.6)  # noqa: E731
        names = ["atRack", "behind", "onBank", "inRow", "passes"]
        h = History(time, {name: (lambda t: SPEED * t) if name == "passes" else still for name in names})
        number = {name: 2 + k for k, name in enumerate(names)} | {"rack": 0, "other": 1, "bed": 7}
        for name in names:
            h["bodies/" + name].number = number[name]
        # rack.1 is not meant; bodies on the bed touch each other through nothing
        times = [[("atRack", "rack"), ("behind", "rack")], [("atRack", "rack"), ("atRack", "behind"), ("onBank", "bed"), ("behind", "bed"), ("inRow", "other"), ("inRow", "behind")]]
        pairs = [(number[a], number[b]) for contacts in times for a, b in contacts]
        n = len(pairs)
        h.contacts = {"time": np.array([1.0, 3.9]), "begin": np.array([0, 2, n]), "first": np.array([a for a, _ in pairs]), "second": np.array([b for _, b in pairs]),
                      "force": np.outer(np.arange(1, n + 1), [0, 0, 1.0]), "point": np.zeros((n, 3)), "line": np.zeros((3 * n, 3)), "walls": ["bed"]}
        held = lambda wanted: clogging.fates(h, clogging.Zone(1.9, 2.0), DOWNSTREAM, clogging.chosen(h, wanted)).held[:, -1]  # noqa: E731
        fate = clogging.fates(h, clogging.Zone(1.9, 2.0), DOWNSTREAM, clogging.chosen(h, ["rack.0"]))
        np.testing.assert_array_equal(sum(state.astype(int) for state in fate), 1)
        np.testing.assert_array_equal(fate.held[:, -1], [True, True, False, True, False])
        np.testing.assert_array_equal(fate.elsewhere[:, -1], [False, False, True, False, False])
        self.assertEqual(clogging.retention(fate)[-1], 1)
        keys = contactNetwork.keys(h, clogging.chosen(h, ["rack.0"]), fate.held[:, -1])
        self.assertEqual([tuple(key) for key in keys], [("atRack", 2, 3.0), ("behind", 1, 0.0)])
        np.testing.assert_array_equal(held(["rack.0", "rack.1"]), fate.held[:, -1])
        np.testing.assert_array_equal(held(None), fate.held[:, -1])
        np.testing.assert_array_equal(held(["bed"]), [True, True, True, True, False])    # behind is on it, too
        h.contacts["second"][n - 1] = number["bed"]     # in a row no more
        np.testing.assert_array_equal(held(["rack.0"]), [True, True, False, False, False])
        np.testing.assert_array_equal(held(["bed"]), [True, True, True, True, False])

    def test_restraints_hold(self):
        """Two floats one behind the other on a line, a log that touches the second one, one that lies on the bed; the link between the floats breaks at 3 s."""
        time = np.linspace(0, 6, 241)
        still = lambda t: min(SPEED * t, 0.8)  # noqa: E731
        names = ["first", "second", "log", "onBed", "drifts"]
        h = History(time, {name: (lambda t: SPEED * t) if name == "drifts" else still for name in names})
        for k, name in enumerate(names):
            h["bodies/" + name].number = 2 + k
        pairs = np.array([(4, 3), (5, 7)] * 2)
        h.contacts = {"time": np.array([2.0, 5.0]), "begin": np.array([0, 2, 4]), "first": pairs[:, 0], "second": pairs[:, 1], "force": np.zeros((4, 3)), "point": np.zeros((4, 3)),
                      "line": np.zeros((12, 3)), "walls": ["bed"]}
        ends = np.array([[(0, 0, 0), (3, 4, 0)], [(0, 0, 1), (0, 0, 2)], [(0, 0, 0), (3, 4, 0)], [(0, 0, 1), (0, 0, 1)]], dtype=float)
        h.restraints = {"names": ["line", "link"], "time": np.array([0.0, 2.0, 5.0]), "members": np.array([(2, -1), (3, 2)] * 3), "tension": np.array([0, 0, 10, 1, 20, 0], dtype=float),
                        "points": np.concatenate([ends[:2], ends]).reshape(-1, 3)}
        fate = lambda wanted: clogging.fates(h, clogging.Zone(1.9, 2.0), DOWNSTREAM, clogging.chosen(h, wanted))  # noqa: E731
        held, early = fate(["line"]).held, np.searchsorted(time, 2.5)
        np.testing.assert_array_equal(held[:, early], [True, True, True, False, False])
        np.testing.assert_array_equal(held[:, -1], [True, False, False, False, False])
        np.testing.assert_array_equal(fate(None).held, held)        # the racks touch nothing
        np.testing.assert_array_equal(fate(["rack", "link"]).held.any(axis=1), [False] * 5)     # both ends of the link are bodies
        np.testing.assert_array_equal(fate(["bed"]).held[:, -1], [False, False, False, True, False])
        key, = contactNetwork.keys(h, clogging.chosen(h, ["line"]), held[:, -1])
        self.assertEqual((key.name, key.holds), ("first", 0))
        self.assertAlmostEqual(key.force, 20)
        with self.assertRaisesRegex(flotsam.CaseError, "there are: structures rack; patches that bodies touch bed; restraints line, link"):
            clogging.chosen(h, ["boom"])
        del h.restraints["members"]     # of an older version: nobody knows what hangs on it
        np.testing.assert_array_equal(fate(["line"]).held[:, -1], [True] * 4 + [False])

    def test_confidence(self):
        self.assertEqual((str(clogging.confidence(0, 2)[0]), str(clogging.confidence(2, 2)[1])), ("0.0", "1.0"))
        np.testing.assert_allclose(clogging.confidence(8, 10), (0.49016, 0.94332), atol=2e-5)    # Wilson 1927
        for held in (0, 7):
            low, high = clogging.confidence(held, 7)
            self.assertGreaterEqual(low, -1e-12)
            self.assertLessEqual(high, 1 + 1e-12)

    def test_forces_of_uneven_steps(self):
        time = np.concatenate([np.linspace(0, 2, 21), np.linspace(2, 4, 201)[1:]])
        series = clogging.structureSeries(History(time, {}), ["rack.0", "rack.1"])
        force = clogging.forceOf(series, DOWNSTREAM, 2.0)
        # of steps from 2 s on: the first has 0.1 s, 200 have 0.01 s
        np.testing.assert_allclose(force.water, np.array([0, -2, 1]) * (0.1 * 2 + 0.01 * time[21:].sum()) / 2.1)
        np.testing.assert_allclose(force.contact, (0, -6, 0))
        self.assertAlmostEqual(force.largest, 6 + 2 * 3.955, places=9)   # ten steps, the last at 4 s
        self.assertEqual((force.impact, force.impactTime), (11, 2))

    def test_runs_with_one_value_are_put_together(self):
        def member(value, seed, held, passed, force):
            figures = {"direction": [0, -1, 0], "forces": {"rack": {"water": [5, -force, 0], "bodies": [0, -1, 0]}}, "bodies": {"held": held, "passed": passed, "retention": held / (held + passed)}}
            return ensemble.Member("", (value, seed), figures)
        groups = ensemble.together([member("0.1", "1", 3, 1, 4), member("0.2", "1", 0, 4, 2), member("0.1", "2", 4, 0, 6)], 0)
        self.assertEqual([(g.value, g.runs, g.held, g.came) for g in groups], [("0.1", 2, 7, 8), ("0.2", 1, 0, 4)])
        np.testing.assert_allclose(groups[0].forces["rack"], (6, np.sqrt(2)))
        self.assertAlmostEqual(groups[0].scatter, np.std([0.75, 1], ddof=1))
        self.assertAlmostEqual(groups[0].low, clogging.confidence(7, 8)[0])
        self.assertIn("| 0.1 | 2 | 7 | 8 | 0.875 |", ensemble.table(groups, "pitch"))

    def test_entries_are_set_in_the_text(self):
        text = "pitch 0.1; // pitch 0.3;\na { pitch2 1; seed  7;\n  speed $pitch; }\n// seed 3;\n"
        self.assertEqual(ensemble.withValue(text, "seed", "8"), (text.replace("seed  7;", "seed  8;"), 1))
        self.assertEqual(ensemble.withValue(text, "pitch", "2")[0].split(";")[0], "pitch 2")
        self.assertEqual(ensemble.withValue(text, "pitch2", "(1 2)"), (text.replace("pitch2 1", "pitch2 (1 2)"), 1))
        self.assertEqual(ensemble.withValue(text, "nothing", "2"), (text, 0))


if __name__ == "__main__":
    unittest.main()
