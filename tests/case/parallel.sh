#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# parallel.sh 2D|3D|few|edge|alone|steep: the same results on one process and on two; few: on four, three of which have one cell each and own no node of the mesh;
# edge: a box that turns, pairs of cells on either process in turn; alone: a block whose corners are at the surface, every third cell on a process that owns no node; steep: a stream that rises at pipes, on three, cells on any of them.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

# divide CASE RANKS EXPRESSION: process of cell i of n, for awk
divide() {
    local n
    n=$(head -n 20 "$1/constant/polyMesh/owner" | sed -n 's/.*nCells: *\([0-9]*\).*/\1/p')
    awk -v n="$n" "BEGIN { print \"FoamFile { version 2.0; format ascii; class labelList; object cellDecomposition; }\n\" n \"\n(\"
        for (i = 0; i < n; ++i) print ($3)
        print \")\" }" > "$1/constant/cellDecomposition"
    echo "FoamFile { version 2.0; format ascii; class dictionary; object decomposeParDict; } numberOfSubdomains $2; method manual; manualCoeffs { dataFile cellDecomposition; }" \
        > "$1/system/decomposeParDict"
}

tolerance=1e-11 allowed=1e-6 ranks=2
case $1 in
    2D) makeFloatingBar serial && fixedSteps serial 0.001 0.02 20 ;;
    3D) makeFallingSphere serial && fixedSteps serial 0.005 0.05 10 ;;
    few)
        makeFloatingBar serial && fixedSteps serial 0.001 0.005 5
        ranks=4
        divide serial 4 'i == int(n/4) ? 1 : i == int(n/2) ? 2 : i == int(3*n/4) ? 3 : 0'
        ;;
    edge)
        makeFloatingBar serial && fixedSteps serial 0.001 0.005 5
        sed -i '/^bodies$/,$d' serial/constant/bodies
        echo 'structures { paddle { shape { type box; size (0.02 0.05 0.1); } position (0.001 -0.05 0.025); contact off; motion { type rotating; axis (0 0 1); omega 10; } } }' \
            >> serial/constant/bodies
        divide serial 2 'int(i/2) % 2'
        tolerance=1e-12 allowed=5e-8
        ;;
    alone)
        makeFloatingBar serial && fixedSteps serial 0.001 0.005 5
        sed -i '/^bodies$/,$d' serial/constant/bodies
        echo 'structures { block { shape { type box; size (0.05 0.05 0.1); } position (0.001 -0.025 0.025); orientation { axis (0 0 1); angleDeg 10; } } }' >> serial/constant/bodies
        divide serial 2 'i % 3 == 1'
        tolerance=1e-12 allowed=5e-8
        ;;
    steep)
        makeJam serial && fixedSteps serial 0.004 0.032 8
        sed -i '/^bodies$/,$d' serial/constant/bodies
        ranks=3
        divide serial 3 '(i*i + int(i/7)) % 3'
        tolerance=1e-13 allowed=5e-8    # with 1e-12 the solves leave 7e-8 of a pressure
        ;;
    *) fail "2D, 3D, few, edge, alone or steep" ;;
esac
# the linear solves stop at a tolerance: small enough not to be what is compared
setNumerics serial "tolerance $tolerance; maxIterations 1000;"
rm -rf parallel && cp -r serial parallel
(cd serial && quietly flotsamFoam) || exit
(cd parallel && quietly decomposePar && quietly timeout 300 mpirun -np $ranks flotsamFoam -parallel && quietly reconstructPar) || exit

python "$here/compare.py" serial parallel $allowed
