#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that is stopped and goes on ends like one that was never stopped: to round-off, at the default tolerance of the linear solver.
# A floating bar, and one that lands on an edge under water and still touches it when the run is stopped.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

# stopAndGoOn CASE STOP END: CASE in one go against CASE.parts, stopped at STOP
stopAndGoOn() {
    fixedSteps "$1" 0.001 "$3" 20
    rm -rf "$1.parts" && cp -r "$1" "$1.parts"
    (cd "$1" && quietly flotsamFoam) || exit
    setEntry "$1.parts/system/controlDict" endTime "$2"
    (cd "$1.parts" && quietly flotsamFoam) || exit
    setEntry "$1.parts/system/controlDict" endTime "$3"
    (cd "$1.parts" && quietly flotsamFoam) || exit
    python "$here/compare.py" "$1" "$1.parts" 1e-13 || exit
}

makeFloatingBar whole
stopAndGoOn whole 0.02 0.04

makeFloatingBar touching
cat >> touching/constant/bodies << 'EOF'
structures
{
    edge { shape { type box; size (0.01 0.01 0.05); } position (0.004 -0.0175 0.025); }
}
EOF
stopAndGoOn touching 0.06 0.08
python - << 'EOF' || fail "the bar does not touch the edge when the run is stopped"
import sys
import flotsam
history = flotsam.history("touching/postProcessing/flotsam")
sys.exit(int(history["bar"].contacts[59] == 0))
EOF
