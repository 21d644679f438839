#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that is stopped and goes on ends like one that was never stopped: to round-off, whatever the tolerance of the linear solver.
# A floating bar, and one that lands on an edge under water and still touches it when the run is stopped; a floating log with steps that
# grow; three bars that jam at the slit dam, with steps that meet write times and an inlet velocity given face by face, on one process and
# on two.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

# stopAndGoOn CASE STOP END [RANKS]: CASE in one go against CASE.parts, stopped at STOP
stopAndGoOn() {
    local ranks=${4:-1}
    setEntry "$1/system/controlDict" endTime "$3"
    if [ "$ranks" != 1 ]; then (cd "$1" && quietly decomposePar) || exit; fi
    rm -rf "$1.parts" && cp -r "$1" "$1.parts"
    (cd "$1" && solve "$ranks") || exit
    setEntry "$1.parts/system/controlDict" endTime "$2"
    (cd "$1.parts" && solve "$ranks") || exit
    setEntry "$1.parts/system/controlDict" endTime "$3"
    (cd "$1.parts" && solve "$ranks") || exit
    if [ "$ranks" != 1 ]; then
        for case in "$1" "$1.parts"; do (cd "$case" && quietly reconstructPar -latestTime) || exit; done
    fi
    python "$here/compare.py" "$1" "$1.parts" 1e-13 || exit
    diff <(summary "$1"/log.[fm]*) <(summary "$1.parts"/log.[fm]*) || fail "$1: the summaries of the runs differ"
}

# summary LOG: what it says of the whole run, the stop included: number of steps, liquid, forces on structures
summary() { awk '/^ +[0-9]+ +0\.[0-9]/ { steps = $1 } /^  at the start/ { print } /^  forces/ { isTable = 1 } isTable && NF { print } END { print steps " steps" }' "$1"; }

# mustTouch CASE TIME NAME...: bodies and structures that touch something then
mustTouch() {
    python - "$@" << 'EOF' || exit
import sys

import flotsam

case, time, names = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
history = flotsam.history(f"{case}/postProcessing/flotsam")
at = abs(history.time - time).argmin()
free = [name for name in names if history[name].contacts[at] == 0]
if free:
    sys.exit(f"FAILED: {case}: {', '.join(free)} touch nothing when the run is stopped, at {history.time[at]} s")
EOF
}

makeFloatingBar whole
fixedSteps whole 0.001 0.04 20
echo 'flotsam { surfaceTimeOrder 2; }' >> whole/system/fvSolution # its mass fluxes are part of the state
stopAndGoOn whole 0.02 0.04

makeFloatingBar touching
sed -i 's/density .*590;/& velocity (0 -0.4 0);/' touching/constant/bodies     # else it floats without touching
cat >> touching/constant/bodies << 'EOF'
structures
{
    edge { shape { type box; size (0.01 0.01 0.05); } position (-0.002 -0.018 0.025); }
}
EOF
fixedSteps touching 0.001 0.08 20
stopAndGoOn touching 0.05 0.08
mustTouch touching 0.05 bar edge

# pushed by a structure that moves, on one process and on two
for ranks in 1 2; do
    makeFloatingBar pushed$ranks
    sed -i 's/orientation .*/orientation { axis (0 0 1); angleDeg 45; } velocity (-1 0 0);/' pushed$ranks/constant/bodies
    cat >> pushed$ranks/constant/bodies << 'EOF'
structures
{
    plate { shape { type box; size (0.01 0.05 0.05); } position (-0.021 0 0.025); motion { type linear; velocity (0.4 0 0); } }
}
EOF
    fixedSteps pushed$ranks 0.0005 0.02 16
    stopAndGoOn pushed$ranks 0.008 0.016 $ranks
    mustTouch pushed$ranks 0.008 bar plate
done

# otherBodies NAME 'COMMAND': what the command changes in constant/bodies of a run that is to go on is refused with the name
otherBodies() {
    rm -rf other && cp -r touching.parts other
    (cd other && eval "$2" && setEntry system/controlDict endTime 0.1) || fail "could not change $1"
    if (cd other && flotsamFoam > log.other 2>&1); then fail "the run goes on with another $1"; fi
    grep -q "constant/bodies is not that of the stored state.* of '$1' differ" other/log.other || fail "another $1: no such message: $(tail -n 12 other/log.other)"
}
otherBodies edge 'sed -i "s/position (-0.002 -0.018/position (-0.003 -0.018/" constant/bodies'
otherBodies edge 'sed -i "s/size (0.01 0.01 0.05)/size (0.012 0.01 0.05)/" constant/bodies'
otherBodies bar 'sed -i "s/density .*590;/density 800;/" constant/bodies'

# The paper's transport, as long as it is stable here (0.02 s), and a round body, whose cut is corrected. Steps grow; write times count from the start, 0.005 s.
makeFloatingBar growing
setNumerics growing 'dualCellTransport off;'
sed -i 's/type box; size (0.02 0.02 0.05);/type cylinder; end1 (0 0 -0.025); end2 (0 0 0.025); radius 0.012;/' growing/constant/bodies
for entry in 'deltaT 1e-4' 'startTime 0.005' 'startFrom latestTime' 'writeInterval 0.0075'; do
    setEntry growing/system/controlDict "${entry% *}" "${entry#* }"
done
mv growing/0 growing/0.005
stopAndGoOn growing 0.0125 0.02

for ranks in 1 2; do
    makeJam jam$ranks
    stopAndGoOn jam$ranks 0.03 0.06 $ranks
    mustTouch jam$ranks 0.03 bar.0 bar.1 bar.2 pipes.1 pipes.3 pipes.5
done

# momentum and loads of the bodies in bodies.h5, over the stop too
python "$here/momentum.py" touching.parts "0 -9.81 0" bar || exit
python "$here/momentum.py" growing "0 -9.81 0" bar || exit
tilted=$(python -c 'from math import *; a = atan(0.05); print(9.81*sin(a), 0, -9.81*cos(a))') # the bed's slope of slitDam; its bar.2 is held at first
for ranks in 1 2; do python "$here/momentum.py" jam$ranks.parts "$tilted" bar.0 bar.1 || exit; done
