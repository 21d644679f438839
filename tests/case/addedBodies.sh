#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bodies put into a run that goes on: on one process and on two, from a state of a flow with structures alone, of one without constant/bodies, of bodies in a jam, and from reconstructed
# fields. Nothing of what is there is disturbed by a body that is not there yet, to round-off; the liquid that gives way is told and no mass error; histories and pictures have the
# new bodies. What must not be is refused with a message.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*
begin=0.02 end=0.03

# goOn CASE RANKS WORD: to `end`; the log must have the word
goOn() {
    setEntry "$1/system/controlDict" endTime $end
    (cd "$1" && solve "$2") || exit
    grep -q -- "$3" "$1"/log.[fm]* || fail "$1: no '$3' in the log"
}

# split CASE: into two
split() {
    echo 'nProcs 2;' > "$1/system/nProcs"
    (cd "$1" && quietly decomposePar -force "${@:2}") || exit
}

makeJam jam
setEntry jam/system/controlDict endTime $begin
cp -r jam flow1
sed -i '/^bodies$/,$d' flow1/constant/bodies
cp -r flow1 flow2
split flow2
for ranks in 1 2; do (cd flow$ranks && solve $ranks) || exit; done
(cd flow2 && quietly reconstructPar -latestTime) || exit
cp -r flow2 joined && rm -r joined/processor*

# bars into the stream before the pipes: anew, and on other processes
mkdir dry && cp -r flow1/* dry && cp jam/constant/bodies dry/constant
(cd dry && quietly flotsamFoam -dry-run) || exit
grep -q 'New in constant/bodies, not in the stored state: 3 bodies (bar.0; bar.1; bar.2)' dry/log.flotsamFoam || fail "the dry run does not say what is new"
for case in flow1 flow2 joined; do cp jam/constant/bodies $case/constant; done
goOn flow1 1 'continuing the stored state'
goOn flow2 2 'continuing the stored state'
goOn joined 1 'on other processes than those that wrote it'
for case in flow1 flow2 joined; do
    grep -q 'not in the stored state: 3 bodies' $case/log.[fm]* || fail "$case: the log does not say what is new"
    grep -q '^[0-9.e-]* m^3 of liquid gave way to what is new' $case/log.[fm]* || fail "$case: the log does not say what gave way"
done

# pipes and bars into a flow without constant/bodies
mkdir bare && cp -r dry/0 dry/system bare && cp -r dry/constant bare && rm bare/constant/bodies
setEntry bare/system/controlDict endTime 0.01
(cd bare && quietly flotsamFoam && cp ../jam/constant/bodies constant) || exit
goOn bare 1 'not in the stored state: 7 structures (pipes.0; pipes.1; pipes.2 and 4 more), 3 bodies (bar.0; bar.1; bar.2)'

# of bodies in a jam: one that is to come in much later, before them in the list
cp -r jam jam2
split jam2
for ranks in 1 2; do
    [ $ranks = 1 ] && mv jam jam1
    (cd jam$ranks && solve $ranks) || exit
    cp -r jam$ranks more$ranks
    [ $ranks = 1 ] && cp -r jam1 thin
    late='late { shape { type box; size (0.02 0.2 0.02); } density 590; material wood; position (-0.25 0 0.24); beforeRelease absent; releaseTime 5; }'
    sed -i "/^bodies\$/{n;s/{/{ $late/}" more$ranks/constant/bodies
    goOn jam$ranks $ranks 'continuing the stored state'
    goOn more$ranks $ranks 'not in the stored state: 1 body (late)'
    for case in jam$ranks more$ranks; do [ $ranks = 1 ] || (cd $case && quietly reconstructPar -latestTime) || exit; done
    python "$here/compare.py" jam$ranks more$ranks 1e-11 || exit # the order of sums over contacts follows from the numbers of the spheres
done

# one that is far thinner than those of the state, whose contact spheres stay as they are, then and in the next state
sed -i "/^bodies\$/{n;s/{/{ stick { shape { type box; size (0.004 0.2 0.004); } density 590; material wood; position (-0.25 0 0.24); beforeRelease absent; releaseTime 5; }/}" thin/constant/bodies
goOn thin 1 'not in the stored state: 1 body (stick)'
grep -q 'bar keeps the contact spheres of the stored state' thin/log.[fm]* || fail "thin: no word of the spheres"
end=0.032 goOn thin 1 'continuing the stored state'

# a flow without constant/bodies; a bar in front of which another one, moored, is put afterwards; then a second stop
makeFloatingBar bar
cp bar/constant/bodies bodies.one
sed '/^bodies$/{n;s/{/{ boat { shape { type box; size (0.02 0.02 0.05); } density 590; position (0.08 0 0.025); }/}' bodies.one > bodies.two
echo 'restraints { mooring { type tether; body boat; refAttachmentPt (0.08 0 0.025); anchor (0.12 0 0.025); length 0.03; stiffness 100; damping 0.1; } }' >> bodies.two
rm bar/constant/bodies
fixedSteps bar 0.001 0.004 4
(cd bar && quietly flotsamFoam && cp ../bodies.one constant/bodies && setEntry system/controlDict endTime 0.008 && quietly flotsamFoam) || exit
(cd bar && cp ../bodies.two constant/bodies && setEntry system/controlDict endTime 0.012 && quietly flotsamFoam && setEntry system/controlDict endTime 0.016 && quietly flotsamFoam) || exit
cp -r bar whole && rm -r whole/0.016 && (cd whole && quietly flotsamFoam) || exit
python "$here/compare.py" bar whole 0 || exit

python - << 'PY' || exit
import sys

import h5py
import numpy as np

import driftwood
import flotsam


def check(holds, what):
    if not holds:
        sys.exit(f"FAILED: {what}")


runs = {case: flotsam.history(case) for case in ("flow1", "flow2", "joined")}
for case, h in runs.items():
    new = np.flatnonzero(h.time > 0.02 + 1e-9)
    for name in h.bodies:
        check((h[name].awaited[new] == 0).all(), f"{case}: {name} does not come in")
    gone = np.nanmax(h.run["displaced"])
    check(len(h.bodies) == 3 and 1e-6 < gone < 3 * 8e-5, f"{case}: {gone} m^3 gave way to three bars of 8e-5 m^3")
    check(np.abs(h.run["massError"]).max() < 1e-9 and driftwood.massError(h) < 1e-9, f"{case}: mass error {np.abs(h.run['massError']).max():.1e}, {driftwood.massError(h):.1e}")
    if case != "joined":    # its records before are those of the run that was put together
        check(all((h[name].awaited[h.time <= 0.02 + 1e-9] == 1).all() for name in h.bodies), f"{case}: bars are there before they come")
bare = flotsam.history("bare")
pipes = 7 * np.pi / 4 * 0.0217**2 * 0.15  # [m^3] in water of 0.15 m
check(0.9 * pipes < np.nanmax(bare.run["displaced"]) < 1.2 * pipes + 3 * 8e-5 and driftwood.massError(bare) < 1e-9, f"bare: {np.nanmax(bare.run['displaced'])} m^3 gave way to seven pipes, about {pipes}")
a = runs["flow1"]
for case, allowed in (("flow2", 1e-3), ("joined", 2e-2)):
    b = runs[case]
    apart = max(np.linalg.norm(a[name].position[-1] - b[name].position[-1]) for name in a.bodies)
    way = max(np.linalg.norm(a[name].position[-1] - a[name].position[0]) for name in a.bodies)
    print(f"{case}: bars {1e6 * apart:.2f} um from those of one process after {1e3 * way:.2f} mm")
    check(apart < allowed * way, f"{case}: bars are {apart} m from those of one process")

bar = flotsam.history("bar")
check(list(bar["bodies/boat"].awaited[[0, 4, 8, 9, 16]]) == [1, 1, 1, 0, 0] and list(bar["bodies/bar"].awaited[[0, 4, 5, 16]]) == [1, 1, 0, 0], "bar and boat come in at other times")
check(driftwood.massError(bar) < 1e-9, f"bar: mass error {driftwood.massError(bar):.1e}")
with h5py.File("bar/postProcessing/flotsam/bodies.h5") as f:
    steps, points = len(f["surface/time"]), f["surface/points"]
    check(np.allclose(f["surface/time"], [0.004, 0.008, 0.012, 0.016]) and len(points) % steps == 0, "bar: surfaces")
    first = points[: len(points) // steps]
    check(np.ptp(first[f["surface/triangles"][f["surface/member"][:] == f["bodies/boat"].attrs["member"]].ravel()], 0).max() == 0, "bar: the boat is to be seen before it comes in")
PY

# refused NAME 'COMMAND' WORDS: constant/bodies of the jam, changed so, is refused by run and dry run
refused() {
    rm -rf "$1" && cp -r more1 "$1"
    setEntry "$1/system/controlDict" endTime 0.04
    (cd "$1" && cp ../jam1/constant/bodies constant && rm -r $end && eval "$2") || fail "could not make $1"
    for option in -dry-run -noFunctionObjects; do
        (cd "$1" && flotsamFoam $option) > "$1.log" 2>&1 && fail "$1 ($option): accepted"
        grep -q "$3" "$1.log" || fail "$1 ($option): no word of '$3': $(tail -n 12 "$1.log")"
    done
}
refused lost 'sed -i "/{ position (-0.046/d" constant/bodies' "bodies bar.2 are missing, which the state has"
refused renamed 'sed -i "s/^    bar\$/    log/" constant/bodies' "bodies bar.0; bar.1; bar.2 are missing, which the state has"
refused structure 'sed -i "/^structures\$/{n;s/{/{ post { shape { type box; size (0.02 0.02 0.1); } material wood; position (-0.25 0 0.05); }/}" constant/bodies' 'structures can be added to the state of a run without bodies alone'

# where a body of the state is now, not where it began
makeFloatingBar thrown
sed -i 's/position .*/position (-0.06 0.035 0.025); velocity (3 0 0);/' thrown/constant/bodies
fixedSteps thrown 0.001 0.03 30
(cd thrown && quietly flotsamFoam) || exit
x=$(python -c 'import flotsam; print(*flotsam.history("thrown")["bodies/bar"].position[-1])')
sed -i "/^bodies\$/{n;s/{/{ late { shape { type box; size (0.02 0.02 0.05); } density 590; position ($x); }/}" thrown/constant/bodies
setEntry thrown/system/controlDict endTime 0.04
(cd thrown && flotsamFoam) > thrown.log 2>&1 && fail "a body in the place of another one is accepted"
grep -q 'body late, which is new, reaches [0-9.]* mm into body bar at 0.03 s.* Move it' thrown.log || fail "a body in the place of another one: $(tail -n 12 thrown.log)"
sed -i "s/late {/late { beforeRelease absent; releaseTime 0.001;/" thrown/constant/bodies
(cd thrown && quietly flotsamFoam && grep -q "body late is to come in, but there is body 'bar' at its place" log.flotsamFoam) || fail "one that comes in at the place of another does not wait"
exit 0
