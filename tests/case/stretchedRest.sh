#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Water at rest under an open top stays at rest where elements are up to 18 times as long as high and grow from one to the next, so that the profile, whose
# width is that of the element's size, goes over many rings of elements and reaches the top: 2D, and 3D on one and two processes.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

# makeTank CASE CELLS-ACROSS: 8 m long (3D: and wide), 0.9 m deep, cells 37 mm high at the surface
makeTank() {
    makeCase floatingBar "$1"
    rm "$1/constant/bodies"
    local corners="(-4 -0.9 0) (4 -0.9 0) (4 0.4 0) (-4 0.4 0) (-4 -0.9 8) (4 -0.9 8) (4 0.4 8) (-4 0.4 8)" along="((3.8 12 0.1) (0.4 8 1) (3.8 12 10))"
    local sides="frontAndBack { type empty; faces ((0 3 2 1) (4 5 6 7)); }" across=1 walls=
    if [ "$2" -gt 1 ]; then sides= across=$along walls="(0 3 2 1) (4 5 6 7)"; fi
    cat > "$1/system/blockMeshDict" << EOF
FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }
scale 1;
vertices ($corners);
blocks (hex (0 1 2 3 4 5 6 7) (32 21 $2) simpleGrading ($along ((0.68 7 0.2) (0.44 10 1) (0.18 4 1.8)) $across));
boundary
(
    walls { type wall; faces ((0 1 5 4) (0 4 7 3) (1 2 6 5) $walls); }
    atmosphere { type patch; faces ((3 7 6 2)); }
    $sides
);
EOF
    (cd "$1" && quietly blockMesh && quietly setExprFields) || exit
    fixedSteps "$1" 0.01 0.5 50
    setNumerics "$1" "tolerance 1e-7;" # what is left of the solves moves the gas with 1e-3 m/s
}

makeTank 2D 1
makeTank 3D 32
cp -r 3D 3D.two
(cd 2D && solve 1) || exit
(cd 3D && solve 1) || exit
(cd 3D.two && quietly decomposePar && solve 2 && quietly reconstructPar -latestTime) || exit

python - << 'PY'
import sys

import numpy as np

import flotsam

for case in ("2D", "3D", "3D.two"):
    field = flotsam.fields(case, "last", ["U", flotsam.ALPHA])
    speed, isWater = np.linalg.norm(field["U"], axis=1), field[flotsam.ALPHA] > 0.5
    print(f"{case}: largest speed in the water {speed[isWater].max():.1e} m/s, in the gas {speed[~isWater].max():.1e} m/s")
    if speed[isWater].max() > 1e-6 or speed[~isWater].max() > 5e-4:
        sys.exit(f"FAILED: {case}: water at rest moves")
PY
