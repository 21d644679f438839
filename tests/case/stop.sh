#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A signal to end (Ctrl-C, a batch system's time limit) ends a run at the end of a step with its state written, and the run can go on;
# in parallel when mpirun gets it, which kills its processes a few seconds later.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

isStep='^ +[0-9]+ +0\.'

# signalled SIGNAL COMMAND...: sends the signal after five steps, waits for the end
signalled() {
    local signal=$1 run
    shift
    setsid "$@" > log.stopped 2>&1 &    # shells let background jobs ignore SIGINT: the program's handlers count
    run=$!
    for _ in $(seq 600); do
        [ "$(grep -cE "$isStep" log.stopped)" -ge 5 ] && break
        kill -0 $run 2> /dev/null || fail "the run ended by itself: $(tail -n 20 log.stopped)"
        sleep 0.1
    done
    kill -"$signal" $run
    wait $run
}

# goesOn TIME COMMAND...: from the state of that time to five steps later
goesOn() {
    local last=$1
    shift
    setEntry system/controlDict endTime "$(awk -v t="$last" 'BEGIN { print t + 0.005 }')"
    "$@" > log.continued 2>&1 || fail "the second run: $(tail -n 20 log.continued)"
    grep -q '^continuing the stored state' log.continued || fail "the second run did not continue: $(head -n 60 log.continued)"
    grep -q '^End' log.continued || fail "the second run did not end"
}

makeFloatingBar bar
fixedSteps bar 0.001 100 100000
rm -rf parallel && cp -r bar parallel

for signal in TERM INT; do
    rm -rf serial && cp -r bar serial
    cd serial || exit
    signalled $signal flotsamFoam || fail "exit code $? after SIG$signal: $(tail -n 20 log.stopped)"
    last=$(grep -E "$isStep" log.stopped | tail -n 1 | awk '{print $2}')
    [ -f "$last/flotsamState.h5" ] && [ -f "$last/U" ] || fail "nothing was written at the last step, time $last: $(ls)"
    grep -q '^Stopped by a signal' log.stopped && ! grep -q '^End' log.stopped || fail "the log does not say that the run was stopped: $(tail -n 20 log.stopped)"
    goesOn "$last" flotsamFoam
    cd ..
done

# stopAt, left in system/controlDict from the last stop
rm -rf stopAt && cp -r bar stopAt
cd stopAt || exit
setEntry system/controlDict stopAt writeNow
quietly flotsamFoam
grep -q '^Stopped by stopAt writeNow of system/controlDict at 0.001 s, before endTime, 100 s. The state is written' log.flotsamFoam && ! grep -q '^End' log.flotsamFoam \
    || fail "the log does not say that stopAt has ended the run: $(tail -n 20 log.flotsamFoam)"
setEntry system/controlDict stopAt endTime
goesOn 0.001 flotsamFoam
cd ..

cd parallel || exit
quietly decomposePar
signalled TERM mpirun -np 2 flotsamFoam -parallel && fail "mpirun: exit code 0 after SIGTERM"
seen=$(grep -E "$isStep" log.stopped | tail -n 1 | awk '{print $2}')
last=$(foamListTimes -processor -latestTime 2> /dev/null | tail -n 1)
awk -v t="$last" -v seen="$seen" 'BEGIN { exit !(t > 0 && t >= seen) }' || fail "nothing was written after SIGTERM to mpirun at time $seen: $(ls processor0)"
for rank in 0 1; do [ -f "processor$rank/$last/U" ] || fail "processor$rank has no U at the last step, time $last"; done
goesOn "$last" mpirun -np 2 flotsamFoam -parallel
