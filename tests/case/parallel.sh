#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# parallel.sh 2D|3D: the same results on one process and on two.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

case $1 in
    2D) makeFloatingBar serial && fixedSteps serial 0.001 0.02 20 ;;
    3D) makeFallingSphere serial && fixedSteps serial 0.005 0.05 10 ;;
    *) fail "2D or 3D" ;;
esac
# the linear solves stop at a tolerance: small enough not to be what is compared
setNumerics serial 'tolerance 1e-11; maxIterations 1000;'
rm -rf parallel && cp -r serial parallel
(cd serial && quietly flotsamFoam) || exit
(cd parallel && quietly decomposePar && quietly mpirun -np 2 flotsamFoam -parallel && quietly reconstructPar) || exit

python "$here/compare.py" serial parallel 1e-6
