#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Stored states that do not fit: computed with other fluids (goes on, with a warning that names both values), cut off (refused with what can be done
# without it, which then works; nothing is changed before); of other walls (refused) and other starts of bodies (warned of); of an earlier run, ahead of the start (goes on, with a warning before and, where it was continued, after).
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

makeFloatingBar bar
fixedSteps bar 0.001 0.002 2
(cd bar && quietly flotsamFoam) || exit
setEntry bar/system/controlDict endTime 0.004

cp -r bar denser
sed -i 's/ 1000;/ 1200;/' denser/constant/transportProperties
sed -i 's/-9.81/-9.7/' denser/constant/g
words='state of time 0.002 was computed with other properties: density of the liquid 1000, now 1200 kg/m^3; gravity (0 -9.81 0), now (0 -9.7 0) m/s^2\.'
for option in -dry-run -noFunctionObjects; do
    (cd denser && quietly flotsamFoam $option)
    grep -q "$words" denser/log.flotsamFoam || fail "a state computed with other fluids ($option): no word"
done
setEntry denser/system/controlDict endTime 0.006
(cd denser && quietly flotsamFoam) || exit
grep -q 'other properties' denser/log.flotsamFoam && fail "a state computed with the same fluids: a warning"

# refused CASE FILE ADVICE COMMAND...: the state is named with what to do, on every process that has it or on one; the histories stay as they are
refused() {
    local case=$1 file=$2 advice=$3
    shift 3
    cksum "$case"/postProcessing/flotsam/* > before
    (cd "$case" && "$@") > log 2>&1 && fail "$case: $file is accepted by $*"
    grep -q "$case/$file: cannot open the file .*: cut off, damaged, or not a file of flotsamFoam. Remove the time's folder .* $advice" log || fail "$case: $file: $(tail -n 15 log)"
    cksum "$case"/postProcessing/flotsam/* | diff before - || fail "$case: the histories are changed"
}

cp -r bar cut
truncate -s 3000 cut/0.002/flotsamState.h5
refused cut 0.002/flotsamState.h5 'from the written fields' flotsamFoam -dry-run
refused cut 0.002/flotsamState.h5 'from the written fields' flotsamFoam
rm cut/0.002/flotsamState.h5
(cd cut && quietly flotsamFoam && grep -q 'bodies, contact and sums exactly' log.flotsamFoam) || fail "without the state that was cut off: the run does not go on"
rm cut/0.004/flotsamState.h5
echo 'no HDF5' > cut/0.004/uniform/flotsamState.h5
setEntry cut/system/controlDict endTime 0.006
refused cut 0.004/uniform/flotsamState.h5 'anew from the written fields' flotsamFoam
rm -r cut/0.004
(cd cut && cp ../bar/0.002/flotsamState.h5 0.002 && quietly flotsamFoam && grep -q 'continuing the stored state of time 0.002' log.flotsamFoam) || fail "from the time before: the run does not go on"

cp -r bar two
rm -r two/0.002 two/postProcessing
setEntry two/system/controlDict endTime 0.002
(cd two && quietly decomposePar && solve 2) || exit
setEntry two/system/controlDict endTime 0.004
truncate -s 3000 two/processor1/0.002/flotsamState.h5
refused two processor1/0.002/flotsamState.h5 'from the written fields' mpirun -np 2 flotsamFoam -parallel
rm two/processor1/0.002/flotsamState.h5
(cd two && solve 2 && grep -q 'bodies, contact and sums exactly' log.mpirun) || fail "without one process's state: the run does not go on"

# a gate whose motion is changed: goes on where it passes through the place of the state (stopped, faster, by its fields alone), is refused where it would jump; a
# body that moves and is to be held again is told
makeFloatingBar gate
sed -i 's/density .*590;/& velocity (0 -0.1 0);/' gate/constant/bodies
echo 'structures { gate { shape { type box; size (0.02 0.05 0.05); } position (0.06 -0.05 0.025); motion { type linear; velocity (0 0.5 0); } } }' >> gate/constant/bodies
fixedSteps gate 0.001 0.002 2
(cd gate && quietly flotsamFoam) || exit
setEntry gate/system/controlDict endTime 0.004

# another NAME 'COMMAND' WORDS: what the command changes is answered with the words, '' : with nothing
another() {
    rm -rf "$1" && cp -r gate "$1"
    (cd "$1" && eval "$2") || fail "could not make $1"
    for option in -dry-run -noFunctionObjects; do
        (cd "$1" && flotsamFoam $option) > "$1.log" 2>&1
        if [ -n "$3" ]; then grep -q "$3" "$1.log" || fail "$1 ($option): no word of '$3': $(tail -n 12 "$1.log")"
        else grep -q '^End$' "$1.log" && ! grep -q 'arning: ' "$1.log" || fail "$1 ($option): does not go on without a word: $(tail -n 12 "$1.log")"; fi
    done
}
another jumping 'sed -i "s/velocity (0 0.5 0)/velocity (0 0.4 0)/" constant/bodies' "'gate' would jump: it is at (0.06 -0.049 0.025), and its .motion. has it at (0.06 -0.0492 0.025) at 0.002 s"
another shifted 'sed -i "s/position (0.06 -0.05 0.025)/position (0.06 -0.04 0.025)/" constant/bodies' "'gate' would jump"
another motionless 'sed -i "s/motion { .* } } }/} }/" constant/bodies' "'gate' had a .motion. and has none now"
another stopped 'sed -i "s/velocity (0 0.5 0)/velocity (0 0 0)/; s/position (0.06 -0.05 /position (0.06 -0.049 /" constant/bodies' ''
another shared 'rm 0.002/flotsamState.h5; sed -i "s/velocity (0 0.5 0)/velocity (0 1 0)/; s/position (0.06 -0.05 /position (0.06 -0.051 /" constant/bodies' ''
another jumpingShared 'rm 0.002/flotsamState.h5; sed -i "s/velocity (0 0.5 0)/velocity (0 1 0)/" constant/bodies' "'gate' would jump"
another heldAgain 'sed -i "s/density /releaseTime 0.003; density /" constant/bodies' 'body bar, which moves in it, is stopped and held until its releaseTime, 0.003 s'
another otherWalls 'echo "wallPatches (atmosphere);" >> constant/bodies' 'bodies touched patch walls and do so no more, and they now touch patch atmosphere. Continue with what it was'
another noWalls 'echo "wallPatches none;" >> constant/bodies' 'bodies touched patch walls and do so no more. Continue'
another untouched 'sed -i "s/motion { type linear/contact off; &/" constant/bodies' 'bodies touched structure gate and do so no more'
another finer 'sed -i "s/density /spheres { radius 0.001; } density /" constant/bodies' 'body bar had [0-9]* contact spheres .* and now has [0-9]*. Continue'
another startedElsewhere 'sed -i "s/position    (0 0.001/position    (0 0.002/" constant/bodies' 'position, orientation or velocity of bar. The change does not count'

# Once more from the beginning, over the results of a run that went further, and stopped before it has come so far: latestTime is then of the earlier run. Both are told; a run
# that goes on as it should is told nothing.
cp -r bar again
setEntry again/system/controlDict startFrom startTime
setEntry again/system/controlDict endTime 0.001
for option in -dry-run -noFunctionObjects; do
    (cd again && quietly flotsamFoam $option)
    grep -q "before the start:  foamListTimes -rm -time '0.002:'" again/log.flotsamFoam || fail "results ahead of the start ($option): no word"
done
setEntry again/system/controlDict startFrom latestTime
setEntry again/system/controlDict endTime 0.004
(cd again && quietly flotsamFoam) || exit
grep -q 'bodies.h5 end at 0.001 s, and the run goes on from 0.002 s' again/log.flotsamFoam || fail "a state of another run than the records: no word"
(cd bar && quietly flotsamFoam) || exit
grep 'Warning: ' bar/log.flotsamFoam && fail "a run that goes on as it should: a warning"
setEntry two/system/controlDict startFrom startTime
(cd two && quietly mpirun -np 2 flotsamFoam -parallel -dry-run) || exit
grep -q "before the start:  foamListTimes -processor -rm -time '0.002:'" two/log.mpirun || fail "results ahead of the start on two processes: no word"

# On a mesh of as many cells that lie elsewhere: goes on as OpenFOAM's solvers do, with a warning; on another decomposition of its own without one.
cp -r bar elsewhere
setEntry elsewhere/system/controlDict endTime 0.006
sed -i 's/(80 20 1)/(80 20 1.3)/' elsewhere/system/blockMeshDict
(cd elsewhere && quietly blockMesh && quietly flotsamFoam) || exit
grep -q 'the mesh is not that of the stored state of time 0.004' elsewhere/log.flotsamFoam || fail "a state of another mesh: no word"
cp -r bar renumbered
setEntry renumbered/system/controlDict endTime 0.006
cp renumbered/system/controlDict controlDict.later
setEntry renumbered/system/controlDict startFrom startTime
setEntry renumbered/system/controlDict writeFormat ascii      # of the mesh: rounds its points
(cd renumbered && quietly renumberMesh -overwrite && cp ../controlDict.later system/controlDict && quietly flotsamFoam) || exit    # the fields of time 0
grep -q 'the fields of time 0.004 hold [0-9.]* m^3 of liquid, the stored state 0.002[0-9]* m^3' renumbered/log.flotsamFoam || fail "fields of another order of the cells: no word"
grep -q 'time 0.004 on a mesh that was written anew since' renumbered/log.flotsamFoam || fail "a mesh that was written anew: taken for other processes"
cp -r bar shared
setEntry shared/system/controlDict endTime 0.006
(cd shared && rm 0.004/flotsamState.h5 && quietly flotsamFoam) || exit
grep -q 'the mesh is not that' shared/log.flotsamFoam && fail "a state of the same mesh without the process's own: a warning"
(cd shared && quietly decomposePar -latestTime && setEntry system/controlDict endTime 0.008 && solve 2) || exit
grep -q 'bodies, contact and sums exactly' shared/log.mpirun || fail "on two processes: the run does not go on"
grep -q 'the mesh is not that' shared/log.mpirun && fail "a state of the same mesh on two processes: a warning"
exit 0
