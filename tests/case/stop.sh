#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# SIGTERM (a batch system's time limit) ends a run at the end of a step with its state written, and the run can go on.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeFloatingBar bar
fixedSteps bar 0.001 100 100000
cd bar || exit
flotsamFoam > log.stopped 2>&1 &
run=$!
for _ in $(seq 600); do     # until some steps are made
    [ "$(grep -cE '^ +[0-9]+ +0\.' log.stopped)" -ge 5 ] && break
    kill -0 $run 2> /dev/null || fail "the run ended by itself: $(tail -n 20 log.stopped)"
    sleep 0.1
done
kill -TERM $run
wait $run || fail "exit code $? after SIGTERM: $(tail -n 20 log.stopped)"

last=$(grep -E '^ +[0-9]+ +0\.' log.stopped | tail -n 1 | awk '{print $2}')
[ -f "$last/flotsamState.h5" ] && [ -f "$last/U" ] || fail "nothing was written at the last step, time $last: $(ls)"

setEntry system/controlDict endTime "$(awk -v t="$last" 'BEGIN { print t + 0.005 }')"
quietly flotsamFoam
grep -q '^continuing the stored state' log.flotsamFoam || fail "the second run did not continue: $(head -n 60 log.flotsamFoam)"
grep -q '^End' log.flotsamFoam || fail "the second run did not end"
