#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One scene in other units, at another size, on other axes, and at coordinates of a map: the same flow, but for round-off. What depends on a length, mass or time hidden in the program,
# or on the names of axes, shows here.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

# scene NAME [L M T [AXES [PLACE]]]
scene() {
    python "$here/scaledScene.py" write "$@"
    (cd "$1" && quietly blockMesh && quietly setFields && solve 1) || exit
}

# same NAME TOLERANCE [L M T [AXES [PLACE]]]
same() {
    local name=$1 tolerance=$2
    shift 2
    scene "$name" "$@"
    python "$here/scaledScene.py" compare first "$name" "$tolerance" "$@" || exit
}

scene first
# powers of two: not a bit changes but by what is no multiple of the units
same seconds16 1e-12 1 1 16
same density1 1e-12 1 0.0009765625 1
same millimetres 1e-6 1024 1 1
same model 1e-6 0.015625 3.814697265625e-06 0.125
same river 1e-6 64 262144 8
same planeYZ 1e-6 1 1 1 y,z,x
same planeXZ 1e-6 1 1 1 x,-z,y
same gravityX 1e-6 1 1 1 z,-x,-y
same mirrored 1e-6 1 1 1 x,y,-z
# the last digit of such coordinates is a nanometre: 1e-3 N of a contact of 1e6 N/m
same map 2e-3 1 1 1 x,y,z 4194304,512,524288
