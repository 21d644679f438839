#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# flotsamEnsemble: a bar afloat with three densities, one of which cannot be, and two lengths of the step; runs that are complete are not run again; mistakes of the command line.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*
ensemble() { "$flotsamRoot/scripts/flotsamEnsemble" "$@"; }

makeFloatingBar bar
fixedSteps bar 0.01 0.02 2
cp -r bar before
vary=(--vary constant/bodies:density=500,-3,700 --vary system/controlDict:deltaT=0.01,0.02 --report='--direction=-y --at 1')
ensemble bar "${vary[@]}" -j 2 > log.first 2>&1 && fail "a run with a negative density has not failed"
[ "$(grep -c "^flotsamEnsemble: flotsamFoam ended with exit code" log.first)" = 2 ] || fail "two runs of a negative density: $(cat log.first)"
grep -q "^4 runs, 2 failed" log.first || fail "no 4 runs: $(cat log.first)"
diff -r bar before || fail "the case itself has changed"
touch stamp
ensemble bar --vary constant/bodies:density=500,700 "${vary[@]:2}" > log.second 2>&1 || fail "the second call: $(cat log.second)"
find ensemble -name log.flotsamFoam -newer stamp | grep -q . && fail "complete runs were run again"
tail -n +2 ensemble/ensemble.csv | cut -d, -f1,2 | sort | diff - <(printf '500,0.01\n500,0.02\n700,0.01\n700,0.02\n') || fail "ensemble.csv"
[ -s ensemble/ensemble.png ] || fail "no picture"
grep -q '^| 500 | 2 |' ensemble/ensemble.md || fail "ensemble.md: $(cat ensemble/ensemble.md)"
grep -q 'density *700;' ensemble/density-700_deltaT-0.02/constant/bodies || fail "the density was not set"
for mistake in "bar --vary density=3" "bar --vary constant/bodies:speed=3" "bar --vary constant/none:density=3" "bar --vary constant/bodies:density=500 --over speed"; do
    # shellcheck disable=SC2086
    ensemble $mistake > log.mistake 2>&1 && fail "no error of: flotsamEnsemble $mistake"
    grep -q "^flotsamEnsemble: " log.mistake && ! grep -q Traceback log.mistake || fail "message of: flotsamEnsemble $mistake: $(cat log.mistake)"
done

# from the state of a flow without bodies: each run goes on from it, the case's fields are not made; a mesh of other points, a state that is missing, an end that is over and fields
# that would not count are told
cp -r bar flow
rm flow/constant/bodies
(cd flow && quietly flotsamFoam) || exit
vary=(--vary constant/bodies:density=500,700 --report='--direction=-y --at 1')
ensemble bar --start flow --output started "${vary[@]}" > log.mistake 2>&1 && fail "runs begin at their end"
grep -q 'endTime 0.02 is not after 0.02' log.mistake || fail "an end that is over: $(cat log.mistake)"
setEntry bar/system/controlDict endTime 0.04
ensemble bar --start flow --output started "${vary[@]}" > log.started 2>&1 || fail "--start: $(cat log.started)"
for density in 500 700; do
    folder=started/density-$density
    grep -q 'continuing the stored state of time 0.02' $folder/log.flotsamFoam && grep -q 'not in the stored state: 1 body (bar)' $folder/log.flotsamFoam || fail "--start: $folder has not gone on from the state"
    [ ! -e $folder/log.setExprFields ] || fail "--start: fields were made"
done
python -c 'import flotsam; a, b = (flotsam.history(f"started/density-{d}") for d in (500, 700)); assert a.time[0] == 0.02 and len(a.time) == 3 and (a["bodies/bar"].awaited == 0).all() and a["bodies/bar"].mass < b["bodies/bar"].mass' || fail "--start: histories"
cp -r bar other
sed -i 's/(80 20 1)/(80 20 1.3)/' other/system/blockMeshDict
ensemble other --start flow --output others "${vary[@]}" > log.mistake 2>&1 && fail "another mesh goes on from the state"
grep -q 'its mesh is not that of --start' log.mistake || fail "another mesh: $(cat log.mistake)"
for mistake in "--start before --vary constant/bodies:density=500" "--start flow --vary 0/U:internalField=1" "--start nowhere --vary constant/bodies:density=500"; do
    # shellcheck disable=SC2086
    ensemble bar --output mistakes $mistake > log.mistake 2>&1 && fail "no error of: flotsamEnsemble bar $mistake"
    grep -q "^flotsamEnsemble: --" log.mistake && ! grep -q Traceback log.mistake || fail "message of: flotsamEnsemble bar $mistake: $(cat log.mistake)"
done
exit 0
