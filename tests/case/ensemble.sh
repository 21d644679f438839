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
