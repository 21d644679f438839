#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that is stopped and goes on ends like one that was never stopped: to round-off, at the default tolerance of the linear solver.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeFloatingBar whole
fixedSteps whole 0.001 0.04 20
rm -rf parts && cp -r whole parts
(cd whole && quietly flotsamFoam) || exit

setEntry parts/system/controlDict endTime 0.02
(cd parts && quietly flotsamFoam) || exit
setEntry parts/system/controlDict endTime 0.04
(cd parts && quietly flotsamFoam) || exit

python "$here/compare.py" whole parts 1e-13
