#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A log of two elements that lies in still water, half immersed, stays where it is: what is left of side forces on its ends is seen by the speed that they add up to. On one and two processes.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*
header="FoamFile { version 2.0; format ascii; class dictionary; object x; }"

makeCase floatingBar one
sed -i "s/nu  *1e-03;/nu 1e-06;/" one/constant/transportProperties
cat > one/system/blockMeshDict << END
$header
scale 1;
vertices ((-0.3 0 -0.2) (0.3 0 -0.2) (0.3 0.4 -0.2) (-0.3 0.4 -0.2) (-0.3 0 0.2) (0.3 0 0.2) (0.3 0.4 0.2) (-0.3 0.4 0.2));
blocks (hex (0 1 2 3 4 5 6 7) (20 13 13) simpleGrading (1 1 1));
boundary (walls { type wall; faces ((0 1 5 4) (0 4 7 3) (1 2 6 5) (0 3 2 1) (4 5 6 7)); } atmosphere { type patch; faces ((3 7 6 2)); });
END
echo "$header bodies { log { shape { type cylinder; end1 (0 0 -0.12); end2 (0 0 0.12); radius 0.03; } density 500; position (-0.0927 0.2 0); } }" > one/constant/bodies
echo "$header field alpha.water; type plane; direction (0 1 0); origin (0 0.2 0);" > one/system/setAlphaFieldDict
fixedSteps one 0.0125 0.625 50
(cd one && quietly blockMesh && quietly setAlphaField) || exit
cp -r one two
(cd one && solve 1) || exit
(cd two && quietly decomposePar && solve 2) || exit

python - << 'PY'
import sys

import h5py
import numpy as np

failed = []
for case in ("one", "two"):
    with h5py.File(case + "/postProcessing/flotsam/bodies.h5", "r") as file:
        velocity = file["bodies/log/velocity"][-1]
    print(f"{case}: {np.hypot(velocity[0], velocity[2]):.1e} m/s along the water after 0.6 s, {velocity[1]:.1e} m/s upward")
    # three points of quadrature for the pieces of a whole face instead of for each: 2e-4 m/s
    if np.hypot(velocity[0], velocity[2]) > 2e-5 or abs(velocity[1]) > 1e-3:
        failed.append(case)
if failed:
    sys.exit(f"FAILED: a log in still water moves off ({', '.join(failed)})")
PY
