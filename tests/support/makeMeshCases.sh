#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# makeMeshCases.sh FOLDER: meshes for the tests of the mesh adapter, each whole (NAME.np1) and decomposed (NAME.np2, NAME.np4).
#   obstacle   2D, empty z: a dam-break tank with an obstacle, five graded blocks
#   upright    2D, empty y: one block in the x-z plane, locally refined (cells with hanging points)
#   boxed      2D, boxed3D 3D: a block of even cells, those in a box in its middle halved in all directions (refineMesh)
#   skewed     3D: two graded, skewed blocks
#   snapped    3D: polyhedra of snappyHexMesh around a rotated box, its edges blunt (folds, concave faces)
#   hanging    3D: prisms with hanging points (hangingPrisms.py)
#   bare       skewed without the files that tell the numbers of the undecomposed mesh
#   cyclic, wedge, layers: meshes the adapter refuses
set -euo pipefail
folder=$1
support=$(cd "$(dirname "$0")" && pwd)
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

header() { echo "FoamFile { version 2.0; format ascii; class ${1:-dictionary}; object x; }"; }

newCase() {     # name; blockMeshDict on standard input
    mkdir -p "$1.np1/system" "$1.np1/constant"
    { header; cat; } > "$1.np1/system/blockMeshDict"
    { header; echo "application none; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1; writePrecision 12; writeFormat ascii;"; } > "$1.np1/system/controlDict"
    { header; echo "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} snGradSchemes {}"; } > "$1.np1/system/fvSchemes"
    header > "$1.np1/system/fvSolution"
    run "$1.np1" blockMesh
}

run() {         # case, command ...
    local case=$1
    shift
    if ! "$@" -case "$case" > "$case/log.$1" 2>&1; then
        tail -n 40 "$case/log.$1"
        exit 1
    fi
}

decompose() {   # name, cuts for 2 ranks, cuts for 4 ranks
    local ranks
    for ranks in 2 4; do
        cp -r "$1.np1" "$1.np$ranks"
        local cuts=$2
        [ "$ranks" -eq 2 ] || cuts=$3
        { header; echo "numberOfSubdomains $ranks; method simple; simpleCoeffs { n ($cuts); delta 0.001; }"; } > "$1.np$ranks/system/decomposeParDict"
        run "$1.np$ranks" decomposePar
    done
}

newCase obstacle << 'EOF'
convertToMeters 0.146;
vertices
(
    (0 0 0) (2 0 0) (2.16438 0 0) (4 0 0) (0 0.32876 0) (2 0.32876 0) (2.16438 0.32876 0) (4 0.32876 0) (0 4 0) (2 4 0) (2.16438 4 0) (4 4 0)
    (0 0 0.1) (2 0 0.1) (2.16438 0 0.1) (4 0 0.1) (0 0.32876 0.1) (2 0.32876 0.1) (2.16438 0.32876 0.1) (4 0.32876 0.1) (0 4 0.1) (2 4 0.1) (2.16438 4 0.1) (4 4 0.1)
);
blocks
(
    hex (0 1 5 4 12 13 17 16) (12 4 1) simpleGrading (0.5 1 1)
    hex (2 3 7 6 14 15 19 18) (10 4 1) simpleGrading (2 1 1)
    hex (4 5 9 8 16 17 21 20) (12 14 1) simpleGrading (0.5 3 1)
    hex (5 6 10 9 17 18 22 21) (3 14 1) simpleGrading (1 3 1)
    hex (6 7 11 10 18 19 23 22) (10 14 1) simpleGrading (2 3 1)
);
boundary
(
    leftWall { type wall; faces ((0 12 16 4) (4 16 20 8)); }
    rightWall { type wall; faces ((7 19 15 3) (11 23 19 7)); }
    lowerWall { type wall; faces ((0 1 13 12) (1 5 17 13) (5 6 18 17) (2 14 18 6) (2 3 15 14)); }
    atmosphere { type patch; faces ((8 20 21 9) (9 21 22 10) (10 22 23 11)); }
    frontAndBack { type empty; faces ((0 4 5 1) (2 6 7 3) (4 8 9 5) (5 9 10 6) (6 10 11 7) (12 13 17 16) (14 15 19 18) (16 17 21 20) (17 18 22 21) (18 19 23 22)); }
);
EOF
decompose obstacle "2 1 1" "2 2 1"

newCase upright << 'EOF'
vertices ((0 -0.05 0) (2 -0.05 0.2) (2.2 -0.05 1.1) (0.1 -0.05 1) (0 0.05 0) (2 0.05 0.2) (2.2 0.05 1.1) (0.1 0.05 1));
blocks (hex (0 1 5 4 3 2 6 7) (16 1 10) simpleGrading (2 1 1));
boundary
(
    inlet { type patch; faces ((0 4 7 3)); }
    outlet { type patch; faces ((1 2 6 5)); }
    bottom { type wall; faces ((0 1 5 4)); }
    top { type symmetryPlane; faces ((3 7 6 2)); }
    front { type empty; faces ((0 3 2 1)); }
    back { type empty; faces ((4 5 6 7)); }
);
EOF
{ header; echo "actions ({ name c0; type cellSet; action new; source boxToCell; sourceInfo { box (0.6 -1 0.3) (1.4 1 0.8); } });"; } > upright.np1/system/topoSetDict
{ header; echo "set c0; coordinateSystem global; globalCoeffs { tan1 (1 0 0); tan2 (0 0 1); } directions (tan1 tan2); useHexTopology no; geometricCut yes; writeMesh no;"; } > upright.np1/system/refineMeshDict
run upright.np1 topoSet
run upright.np1 refineMesh -overwrite
decompose upright "2 1 1" "2 1 2"

halve() {       # case, box, directions
    { header; echo "actions ({ name c0; type cellSet; action new; source boxToCell; sourceInfo { box $2; } });"; } > "$1/system/topoSetDict"
    { header; echo "set c0; coordinateSystem global; globalCoeffs { tan1 (1 0 0); tan2 (0 1 0); } directions ($3); useHexTopology no; geometricCut no; writeMesh no;"; } > "$1/system/refineMeshDict"
    run "$1" topoSet
    run "$1" refineMesh -overwrite
}

evenBlock() {   # cells, type of the ends in z
    cat << EOF
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) ($1) simpleGrading (1 1 1));
boundary
(
    sides { type patch; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }
    ends { type $2; faces ((0 3 2 1) (4 5 6 7)); }
);
EOF
}
newCase boxed < <(evenBlock "16 16 1" empty)
halve boxed.np1 "(0.25 0.25 -1) (0.75 0.75 2)" "tan1 tan2"
decompose boxed "2 1 1" "2 2 1"
newCase boxed3D < <(evenBlock "8 8 8" patch)
halve boxed3D.np1 "(0.25 0.25 0.25) (0.75 0.75 0.75)" "tan1 tan2 normal"
decompose boxed3D "2 1 1" "2 2 1"

newCase skewed << 'EOF'
vertices ((0 0 0) (1 0.1 0) (0.9 0.8 0) (0 0.7 0.1) (0 0 0.5) (1.1 0 0.6) (1 0.8 0.7) (0.1 0.7 0.5) (2 0 0.1) (2 0.9 0) (2.1 0.1 0.5) (2 0.8 0.6));
blocks
(
    hex (0 1 2 3 4 5 6 7) (9 7 6) simpleGrading (2 1 0.5)
    hex (1 8 9 2 5 10 11 6) (8 7 6) simpleGrading (0.5 1 0.5)
);
boundary
(
    inlet { type patch; faces ((0 4 7 3)); }
    outlet { type patch; faces ((8 9 11 10)); }
    walls { type wall; faces ((0 3 2 1) (0 1 5 4) (3 7 6 2) (1 2 9 8) (1 8 10 5) (2 6 11 9)); }
    top { type patch; faces ((4 5 6 7) (5 10 11 6)); }
);
EOF
decompose skewed "2 1 1" "2 2 1"
for ranks in 1 2 4; do
    cp -r skewed.np$ranks bare.np$ranks
    rm -f bare.np$ranks/processor*/constant/polyMesh/*ProcAddressing
done

newCase snapped << 'EOF'
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) (12 12 12) simpleGrading (1 1 1));
boundary (sides { type patch; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); });
EOF
{ header; cat << 'EOF'
castellatedMesh true; snap true; addLayers false; mergeTolerance 1e-6;
geometry { block { type searchableRotatedBox; origin (0.4 0.3 0.3); span (0.3 0.25 0.4); e1 (1 0.4 0.2); e3 (-0.2 0.1 1); } }
castellatedMeshControls
{
    maxLocalCells 100000; maxGlobalCells 200000; minRefinementCells 0; nCellsBetweenLevels 1; features ();
    refinementSurfaces { block { level (1 2); } } resolveFeatureAngle 30; refinementRegions {} locationInMesh (0.03 0.04 0.05); allowFreeStandingZoneFaces true;
}
snapControls { nSmoothPatch 3; tolerance 2; nSolveIter 30; nRelaxIter 5; }
addLayersControls { relativeSizes true; layers {} expansionRatio 1; finalLayerThickness 0.3; minThickness 0.1; nGrow 0; featureAngle 60; nRelaxIter 3; nSmoothSurfaceNormals 1; nSmoothNormals 3; nSmoothThickness 10; maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3; minMedianAxisAngle 90; nBufferCellsNoExtrude 0; nLayerIter 50; }
meshQualityControls
{
    maxNonOrtho 65; maxBoundarySkewness 20; maxInternalSkewness 4; maxConcave 80; minVol 1e-13; minTetQuality 1e-15; minArea -1; minTwist 0.02;
    minDeterminant 0.001; minFaceWeight 0.05; minVolRatio 0.01; minTriangleTwist -1; nSmoothScale 4; errorReduction 0.75;
}
EOF
} > snapped.np1/system/snappyHexMeshDict
run snapped.np1 snappyHexMesh -overwrite
decompose snapped "2 1 1" "2 2 1"

newCase hanging < <(evenBlock "1 1 1" patch)
"$support/hangingPrisms.py" hanging.np1
decompose hanging "2 1 1" "2 2 1"

unitCube() {    # entries of patch x0, cells across, entries of the ends
    cat << EOF
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) (3 3 $2) simpleGrading (1 1 1));
boundary
(
    x0 { $1 faces ((0 4 7 3)); }
    x1 { ${1//x1/x0} faces ((1 2 6 5)); }
    rest { type wall; faces ((0 1 5 4) (3 7 6 2)); }
    ends { $3 faces ((0 3 2 1) (4 5 6 7)); }
);
EOF
}
newCase cyclic < <(unitCube "type cyclic; neighbourPatch x1;" 3 "type wall;")
newCase layers < <(unitCube "type patch;" 2 "type empty;")
newCase wedge << 'EOF'
vertices ((0 0 0) (1 0 0) (1 0.5 -0.02) (0 0.5 -0.02) (1 0.5 0.02) (0 0.5 0.02));
blocks (hex (0 1 2 3 0 1 4 5) (3 3 1) simpleGrading (1 1 1));
boundary
(
    front { type wedge; faces ((0 3 2 1)); }
    back { type wedge; faces ((0 1 4 5)); }
    rest { type wall; faces ((3 5 4 2)); }
    ends { type patch; faces ((0 5 3 0) (1 2 4 1)); }
);
EOF
