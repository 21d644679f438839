# SPDX-License-Identifier: GPL-3.0-or-later
"""compare.py CASE CASE TOLERANCE: whether two runs of a case ended alike: bodies, forces, fields. Differences are relative to the
largest value of each quantity, those of volumes to the liquid's."""
import os
import sys

import numpy as np

import flotsam

first, second, tolerance = sys.argv[1], sys.argv[2], float(sys.argv[3])
worst = []


def check(what, a, b, scale=0.0):
    scale = max(np.abs(a).max(), scale, 1e-12)
    worst.append((np.abs(a - b).max() / scale, what))


histories = [flotsam.history(os.path.join(case, "postProcessing", "flotsam")) for case in (first, second)]
if abs(histories[0].time[-1] - histories[1].time[-1]) > 1e-9:
    sys.exit(f"the runs end at {histories[0].time[-1]} s and {histories[1].time[-1]} s")
if len(histories[0].time) != len(histories[1].time):
    sys.exit(f"the runs have {len(histories[0].time)} and {len(histories[1].time)} steps")
for name in histories[0].bodies + histories[0].structures:
    a, b = (h[name] for h in histories)
    weight = 9.81 * a.mass
    for quantity in ("position", "orientation", "velocity", "angularVelocity"):
        check(f"{name} {quantity}", getattr(a, quantity), getattr(b, quantity))
    for quantity in ("fluidForce", "contactForce", "peakContactForce"):
        check(f"{name} {quantity}", getattr(a, quantity)[1:], getattr(b, quantity)[1:], weight)
a, b = (h.run for h in histories)
for quantity in ("liquidVolume", "inflow", "outflow", "redistributed", "massError"):
    scale = 1.0 if quantity == "massError" else np.abs(a["liquidVolume"]).max()
    check(quantity, a[quantity], b[quantity], scale)
check("largestOverlap", a["largestOverlap"], b["largestOverlap"])

end = flotsam.times(first)[-1]
for name in ("U", "p_rgh", "alpha.water"):
    try:
        a, b = (flotsam.fields(case, end, [name]) for case in (first, second))
    except flotsam.CaseError:
        continue    # a single fluid has no alpha
    order = [np.lexsort(np.round(f["centre"], 9).T) for f in (a, b)]
    check(name, a[name][order[0]], b[name][order[1]])

for difference, what in sorted(worst, reverse=True)[:6]:
    print(f"{difference:10.2e}  {what}")
if not max(worst)[0] <= tolerance:
    sys.exit(f"{max(worst)[1]} differs by {max(worst)[0]:.2e}, allowed are {tolerance:g}")
