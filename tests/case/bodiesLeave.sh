#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bodies that leave the mesh are taken out where they left, for good, and two that are absent before their release come in at one place: on one process and
# on two, stopped and continued, and on another number of processes.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*
stop=0.22 end=0.32     # the bars leave at 0.19, 0.23 and 0.28 s

makeJam one
sed -i '/^structures$/,/^}$/d' one/constant/bodies
sed -i '$d' one/constant/bodies
cat >> one/constant/bodies << 'EOF'
    late        // where the bars were, the second when the first has made room
    {
        shape           { type box; size (0.02 0.1 0.02); }
        density         590;
        material        wood;
        velocity        (0.5 0 0);
        beforeRelease   absent;
        poses           ( { position (-0.0225 0 0.23); releaseTime 0.25; } { position (-0.0225 0 0.23); releaseTime 0.25; } );
    }
}
EOF
setEntry one/system/controlDict writeInterval $stop
setEntry one/system/controlDict writeControl timeStep
fixedSteps one 0.004 $end 55
cp -r one two
(cd two && quietly decomposePar) || exit
for ranks in 1 2; do
    case=one
    [ $ranks = 2 ] && case=two
    cp -r $case $case.parts
    (cd $case && solve $ranks) || exit
    setEntry $case.parts/system/controlDict endTime $stop
    (cd $case.parts && solve $ranks) || exit
    cat $case.parts/log.{flotsamFoam,mpirun} > parts.log 2> /dev/null
    grep -q '5 free (2 come in at their release)' parts.log || fail "no word about the bodies to come"
    grep -q '2 of 5 bodies have not come in' parts.log || fail "no word about the bodies that did not come"
    cp -r $case.parts $case.other
    setEntry $case.parts/system/controlDict endTime $end
    (cd $case.parts && solve $ranks) || exit
done
(cd two && quietly reconstructPar -latestTime) || exit
(cd two.parts && quietly reconstructPar -latestTime) || exit
for case in one two; do python "$here/compare.py" $case $case.parts 1e-13 || exit; done
setEntry one.other/system/controlDict endTime $end
setEntry two.other/system/controlDict endTime $end
(cd one.other && quietly decomposePar -latestTime && solve 2) || exit
(cd two.other && quietly reconstructPar -latestTime && rm -r processor* && solve 1) || exit
grep -q '3 of 5 bodies have left the mesh' two.other/log.flotsamFoam || fail "no word about bodies that left"
grep -q '^body late.0 has come in' two.other/log.flotsamFoam || fail "no word about the body that came in"
grep -q "^body late.1 is to come in, but there is body 'late.0' at its place: it waits" two.other/log.flotsamFoam || fail "no word about the body that waits"

python - << 'PY' || exit
import sys

import numpy as np

import flotsam

for case in ("one", "two", "one.parts", "two.parts", "one.other", "two.other"):
    history = flotsam.history(f"{case}/postProcessing/flotsam")
    late, second = history["late.0"], history["late.1"]
    there = np.flatnonzero(late.awaited == 0)
    if not len(there) or late.awaited[there[0]:].any() or not 0.25 < history.time[there[0]] < 0.26:
        sys.exit(f"FAILED: {case}: the late bar has not come in at its release")
    waits = np.flatnonzero(second.awaited == 0)
    if not len(waits) or late.position[waits[0], 0] - late.position[0, 0] < 0.021 or late.position[waits[0] - 2, 0] - late.position[0, 0] > 0.021:
        sys.exit(f"FAILED: {case}: the second late bar has not come in when its place was free")
    before = slice(0, there[0])
    if np.ptp(late.position[before], axis=0).any() or late.velocity[before].any() or late.fluidForce[before].any() or late.contacts[before].any():
        sys.exit(f"FAILED: {case}: the late bar was there before")
    if not late.velocity[there[0], 0] > 0.45 or not late.velocity[there[0], 2] < -0.01:
        sys.exit(f"FAILED: {case}: the late bar does not fly")
    for name in (name for name in history.bodies if not name.startswith("late")):
        body = history[name]
        left = np.flatnonzero(body.left > 0)
        if not len(left) or len(left) != len(body.left) - left[0]:
            sys.exit(f"FAILED: {case}: {name} has not left, or came back")
        first = left[0]
        print(f"{case}: {name} left at {history.time[first]:.3f} s, x = {body.position[first, 0]:.4f} m, with {body.velocity[first - 1, 0]:.2f} m/s")
        rests = np.ptp(body.position[first:], axis=0).max() == 0 and not body.velocity[first:].any()
        free = not (body.contacts[first:].any() or body.contactForce[first:].any() or body.fluidForce[first + 1:].any() or body.wetFraction[first:].any())
        if not (rests and free):
            sys.exit(f"FAILED: {case}: {name} goes on after it has left")
        if not (0.1 < body.position[first, 0] - 0.005 < 0.16):
            sys.exit(f"FAILED: {case}: {name} was taken out in the mesh or far from it, which ends at 0.1 m")
PY
