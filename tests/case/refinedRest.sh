#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Water at rest on locally refined meshes (topoSet and refineMesh, cells with hanging points) around a cut pier stays at rest, whether its surface lies on faces of the
# coarse cells, of the finer ones alone or within cells: 2D, and 3D, refined twice, on one and two processes. To bodies a refined bed is one plane.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

# halve CASE BOX DIRECTIONS: the cells with their centres in the box
halve() {
    local header="FoamFile { version 2.0; format ascii; class dictionary; object x; }"
    echo "$header actions ({ name fine; type cellSet; action new; source boxToCell; sourceInfo { box $2; } });" > "$1/system/topoSetDict"
    echo "$header set fine; coordinateSystem global; globalCoeffs { tan1 (1 0 0); tan2 (0 1 0); } directions ($3); useHexTopology no; geometricCut no; writeMesh no;" \
        > "$1/system/refineMeshDict"
    (cd "$1" && quietly topoSet && quietly refineMesh -overwrite) || exit
}

# makeTank CASE CELLS-ACROSS LEVEL: 0.4 m long (3D: 0.2 m wide), 0.25 m high, cells of 0.02 m, a pier that slips
makeTank() {
    makeCase floatingBar "$1"
    local sides="walls { type wall; faces ((0 1 5 4) (0 4 7 3) (1 2 6 5)); } frontAndBack { type empty; faces ((0 3 2 1) (4 5 6 7)); }"
    if [ "$2" -gt 1 ]; then sides="walls { type wall; faces ((0 1 5 4) (0 4 7 3) (1 2 6 5) (0 3 2 1) (4 5 6 7)); }"; fi
    cat > "$1/system/blockMeshDict" << END
FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }
scale 1;
vertices ((0 0 0) (0.4 0 0) (0.4 0.24 0) (0 0.24 0) (0 0 0.2) (0.4 0 0.2) (0.4 0.24 0.2) (0 0.24 0.2));
blocks (hex (0 1 2 3 4 5 6 7) (20 12 $2) simpleGrading (1 1 1));
boundary ($sides atmosphere { type patch; faces ((3 7 6 2)); });
END
    echo "FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
structures { pier { shape { type cylinder; end1 (0.203 -0.01 0.1); end2 (0.203 0.3 0.1); radius 0.033; } wall slip; } }" > "$1/constant/bodies"
    if [ "$2" -eq 1 ]; then sed -i "s/end1 .* radius/end1 (0.203 0.06 -0.1); end2 (0.203 0.06 0.3); radius/" "$1/constant/bodies"; fi
    echo "FoamFile { version 2.0; format ascii; class dictionary; object setAlphaFieldDict; } field alpha.water; type plane; direction (0 1 0); origin (0 $3 0);" \
        > "$1/system/setAlphaFieldDict"
    (cd "$1" && quietly blockMesh) || exit
    fixedSteps "$1" 0.01 0.5 50
    setNumerics "$1" "tolerance 1e-7;"
}

for level in 0.16 0.15 0.143; do
    makeTank "2D.$level" 1 $level
    halve "2D.$level" "(0.1 0.1 -1) (0.3 0.2 1)" "tan1 tan2"
    (cd "2D.$level" && quietly setAlphaField && solve 1) || exit
    makeTank "3D.$level" 10 $level
    halve "3D.$level" "(0.13 0.06 0.05) (0.28 0.2 0.15)" "tan1 tan2 normal"
    (cd "3D.$level" && quietly setAlphaField) || exit
done
makeTank 3D.one 10 0.16
halve 3D.one "(0.13 -1 0.03) (0.28 1 0.17)" "tan1 normal"
halve 3D.one "(0.16 0.1 0.05) (0.25 0.2 0.15)" "tan1 tan2 normal"
(cd 3D.one && quietly setAlphaField) || exit
cp -r 3D.one 3D.two
cp -r 3D.one bed
echo "bodies { ball { shape { type sphere; radius 0.03; } density 2000; position (0.1 0.05 0.1); } }" >> bed/constant/bodies
(cd bed && quietly flotsamFoam -dry-run) || exit
grep -q ', 6 DEM walls' bed/log.flotsamFoam || fail "not five planes and the pier: $(grep 'DEM walls' bed/log.flotsamFoam)"
for case in 3D.0.16 3D.0.15 3D.0.143 3D.one; do (cd $case && solve 1) || exit; done
(cd 3D.two && quietly decomposePar && solve 2 && quietly reconstructPar -latestTime) || exit

python - << 'PY'
import glob
import sys

import numpy as np

import flotsam

failed = []
for case in sorted(glob.glob("?D.*")):
    field = flotsam.fields(case, "last", ["U", flotsam.ALPHA])
    speed, isWater = np.linalg.norm(field["U"], axis=1), field[flotsam.ALPHA] > 0.5
    print(f"{case}: largest speed in the water {speed[isWater].max():.1e} m/s, in the gas {speed[~isWater].max():.1e} m/s")
    if speed[isWater].max() > 1e-6 or speed[~isWater].max() > 1e-4:
        failed.append(case)
if failed:
    sys.exit(f"FAILED: water at rest moves in {', '.join(failed)}")
PY
