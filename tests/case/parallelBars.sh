#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The slit dam on one process and on two, with the tutorial's own tolerances: the bars stay together to 1 mm until they first touch.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeCase slitDam serial
cd serial || exit
for tool in blockMesh setExprFields setExprBoundaryFields; do quietly $tool; done
setEntry system/controlDict endTime 0.3
setEntry system/controlDict writeInterval 0.3
cd ..
rm -rf parallel && cp -r serial parallel
(cd serial && quietly flotsamFoam) || exit
(cd parallel && quietly decomposePar && quietly mpirun -np 2 flotsamFoam -parallel) || exit

python - <<'EOF'
import sys

import numpy as np

import flotsam

a, b = (flotsam.history(f"{case}/postProcessing/flotsam") for case in ("serial", "parallel"))
end = min(a.time[-1], b.time[-1])
for h in (a, b):
    touched = [h.time[np.abs(h[bar].contactForce[:, :2]).max(axis=1) > 0] for bar in h.bodies if bar.startswith("first")]
    end = min([end] + [t[0] for t in touched if len(t)])
times = np.linspace(0, end, 20)[1:]
far = 0.0
for bar in a.bodies:
    at = [np.array([np.interp(times, h.time, h[bar].position[:, d]) for d in range(3)]) for h in (a, b)]
    far = max(far, np.linalg.norm(at[0] - at[1], axis=0).max())
print(f"{len(a.bodies)} bars until {end:.3f} s: apart by {1e3 * far:.4f} mm at most")
if not (end > 0.2 and far < 1e-3):
    sys.exit("allowed: 1 mm, over 0.2 s at least")
EOF
