# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced by the case tests: small cases made from the tutorials, in the build folder ($FLOTSAM_BUILD, set by case.cmake).
export LC_ALL=C    # awk writes decimal points
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/../../scripts/environment.sh"
tutorials=$flotsamRoot/tutorials
work=$flotsamBuild/tests/case/$(basename "$0" .sh)${1:+.$1}

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

# quietly COMMAND...: its output only when it fails
quietly() {
    local log
    log=log.$(basename "$1")
    "$@" > "$log" 2>&1 || {
        tail -n 40 "$log" >&2
        fail "$* in $PWD"
    }
}

# setEntry FILE ENTRY VALUE: one entry of a dictionary of plain numbers
setEntry() { foamDictionary -entry "$2" -set "$3" "$1" > /dev/null || fail "$1 has no entry $2"; }

# makeCase TUTORIAL FOLDER: a copy without results
makeCase() {
    rm -rf "$2"
    mkdir -p "$2"
    cp -r "$tutorials/$1/0.orig" "$tutorials/$1/constant" "$tutorials/$1/system" "$2"
    rm -rf "$2/constant/polyMesh" "$2/constant/generated" "$2/system/nProcs"
    cp -r "$2/0.orig" "$2/0"
}

# a bar in the water of a small 2D tank, one fifth of the tutorial's cells: seconds
makeFloatingBar() {
    makeCase floatingBar "$1"
    sed -i -e 's/(108 45 1)/(50 22 1)/' -e 's/(160 34 /(160 15 /g' -e 's/(80 40 1)/(80 20 1)/' \
        -e 's/(70 10 0.2) (60 30 1) (30 5 3)/(70 5 0.2) (60 15 1) (30 2 3)/' "$1/system/blockMeshDict"
    (cd "$1" && quietly blockMesh && quietly setExprFields) || exit
}

# a sphere in a viscous fluid, 3D, 3 cells a diameter
makeFallingSphere() {
    makeCase fallingSphere "$1"
    sed -i -e 's/(22 22 64)/(12 12 32)/' -e 's/(35 5 0.28) (30 12 1) (35 5 3.6)/(35 3 0.28) (30 6 1) (35 3 3.6)/' "$1/system/blockMeshDict"
    (cd "$1" && quietly blockMesh) || exit
}

# makeJam CASE: three bars that the water presses against the pipes of a short flume; the third is let go above the others
makeJam() {
    makeCase slitDam "$1"
    sed -i -e 's/^upstream .*/upstream 0.32;/' -e 's/^downstream .*/downstream 0.1;/' \
        -e 's/^quick .*/quick { drift 5; approach 4; slit 7; outlet 3; nx 19; ny 14; bed 3; surface 8; air 2; nz 13; refinedLength 0; refinedHeight 0; }/' "$1/system/parameters"
    sed -i '/^#ifeq/,$d' "$1/constant/bodies"
    cat >> "$1/constant/bodies" << 'EOF'
bodies
{
    bar
    {
        shape       { type box; size (0.02 0.2 0.02); }
        density     590;
        material    wood;
        velocity    (0.5 0 0);
        poses
        (
            { position (-0.0225 0 0.167); }
            { position (-0.046 0.01 0.166); orientation { axis (0 0 1); angleDeg 1; } }
            { position (-0.05 -0.01 0.189); orientation { axis (0 0 1); angleDeg 10; } velocity (0.3 0 -0.3); releaseTime 0.01; }
        );
    }
}
EOF
    for tool in blockMesh setExprFields setExprBoundaryFields; do (cd "$1" && quietly $tool) || exit; done
    sed -i -e 's/^writeInterval .*/writeInterval 0.01;/' -e 's/^maxDeltaT .*/maxDeltaT 0.004;/' "$1/system/controlDict" # 2.5 steps: round-off makes it two or three
}

# solve RANKS: the case in this folder
solve() {
    if [ "$1" = 1 ]; then quietly flotsamFoam; else quietly mpirun -np "$1" flotsamFoam -parallel; fi
}

# fixedSteps CASE DT END WRITE: the same steps whatever happens
fixedSteps() {
    setEntry "$1/system/controlDict" adjustTimeStep no
    setEntry "$1/system/controlDict" deltaT "$2"
    setEntry "$1/system/controlDict" endTime "$3"
    setEntry "$1/system/controlDict" writeControl timeStep
    setEntry "$1/system/controlDict" writeInterval "$4"
    setEntry "$1/system/controlDict" timePrecision 12
}

# setNumerics CASE ENTRIES: the sub-dictionary flotsam of fvSolution
setNumerics() {
    sed -i '/^flotsam$/,/^}/d' "$1/system/fvSolution"
    echo "flotsam { $2 }" >> "$1/system/fvSolution"
}

python() { PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$tutorials/common:$here" "$FLOTSAM_PYTHON" "$@"; }
