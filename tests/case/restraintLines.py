# SPDX-License-Identifier: GPL-3.0-or-later
"""restraintLines.py CASE..: the lines that ParaView shows of the restraints are those of their histories, those of a run that went on and of broken ones included."""
import sys

import numpy as np

import checks

import flotsam

for case in sys.argv[1:]:
    h = flotsam.history(f"{case}/postProcessing/flotsam")
    lines = h.restraints
    checks.check(f"{case}: times beside those of the surfaces [s]", np.abs(lines["time"] - h.surface["time"]).max(), 0, 0)
    shown = {}
    for i, name in enumerate(lines["names"]):
        table = flotsam.stepTable(case, "restraints", name + ".dat")
        checks.check(f"{case}: steps of {name}", len(table), len(h.time) - 1, 0)
        ends = lines["points"].reshape(len(lines["time"]), -1, 2, 3)[:, i]
        shown[name] = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        rows = np.searchsorted(table[:, 0], lines["time"][1:] - 1e-9)
        length = np.where(table[rows, 7] > 0, 0, table[rows, 6])
        checks.check(f"{case}: length of {name} [m]", np.abs(shown[name][1:] - length).max(), 0, 1e-9)
        checks.check(f"{case}: tension of {name} [N]", np.abs(lines["tension"].reshape(len(lines["time"]), -1)[1:, i] - table[rows, 4]).max(), 0, 1e-9)
    checks.check(f"{case}: length of the broken one at the start and the end [m]", np.abs(shown["weak"][[0, -1]] - [0.03, 0]).max(), 0, 1e-9)
    checks.check(f"{case}: ends of the link, on its bodies at the start [m]", np.abs(lines["points"].reshape(-1, 2, 3)[1] - [(0.025, -0.06, 0), (0.01, -0.06, 0)])[:, :2].max(), 0, 1e-9)
sys.exit(checks.count())
