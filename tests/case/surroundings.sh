#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Folders whose names OpenFOAM does not read, a disk that is full (one message, no crash), an installed program.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeFloatingBar bar
setEntry bar/system/controlDict startFrom latestTime

# OpenFOAM says no more than "invalid fileName"
for name in "a bar" "bar's"; do
    rm -rf "$name" && cp -r bar "$name"
    (cd "$name" && flotsamFoam -dry-run) > log.name 2>&1 && fail "a folder '$name' is accepted"
    [ "$(wc -l < log.name)" -eq 1 ] && grep -q "the folder $work/$name has a blank or a quote in its path" log.name || fail "a folder '$name': $(head log.name)"
    flotsamFoam -dry-run -case "$work/$name" > log.name 2>&1 && fail "-case '$name' is accepted"
    [ "$(wc -l < log.name)" -eq 1 ] || fail "-case '$name': $(head log.name)"
done
ln -sfn "$work/a bar" link
(cd link && quietly flotsamFoam -dry-run) || exit

# no room for the states of a run: HDF5 cannot close a file that it cannot write, and crashes where it ends with the program
full() {
    local run
    (trap '' XFSZ && cd "$1" && exec flotsamFoam > ../log.full 2>&1) &
    run=$!
    for _ in $(seq 600); do
        grep -qE '^ +[0-9]+ +0\.' log.full 2> /dev/null && break
        sleep 0.05
    done
    prlimit --fsize=100000 --pid $run || fail "the run ended before it was to: $(tail -n 20 log.full)"
    wait $run
}
rm -f log.full
setEntry bar/system/controlDict endTime 100
setEntry bar/system/controlDict writeInterval 0.2
full bar
code=$?
[ $code -eq 1 ] && grep -q 'flotsamState.h5.*: cannot write the file to disk (File too large)$' log.full || fail "a full disk: exit code $code, $(tail -n 30 log.full)"
[ "$(grep -c 'FOAM FATAL' log.full)" -eq 1 ] || fail "a full disk: not one message"
rm -r bar/0.2   # as the next start would say

# nor for the lines of wallForces: all later ones would be missing
rm -rf walls log.full && cp -r bar walls && rm walls/constant/bodies
setEntry walls/system/controlDict writeInterval 100
echo 'wallForces { tank { patches (walls); } }' >> walls/system/controlDict
full walls
code=$?
[ $code -eq 1 ] && grep -q 'postProcessing/tank, force: cannot write the file to disk (File too large)$' log.full || fail "no room for forces: exit code $code, $(tail -n 30 log.full)"

# apart from the folder that it was built in
rm -rf installed && quietly cmake --install "$FLOTSAM_BUILD" --prefix "$work/installed"
(cd bar && env -i HOME="$work" PATH="$work/installed/bin:/usr/bin:/bin" WM_PROJECT_DIR="$WM_PROJECT_DIR" flotsamFoam -dry-run) > log.installed 2>&1 || fail "the installed program: $(tail log.installed)"
env -i PATH=/usr/bin:/bin "$work/installed/bin/flotsamReport" -h > log.installed 2>&1 || fail "the installed flotsamReport: $(tail log.installed)"
[ "$(unset FLOTSAM_BUILD; . installed/share/flotsam/scripts/environment.sh && command -v flotsamFoam)" = "$work/installed/bin/flotsamFoam" ] || fail "environment.sh of the installed program does not find it"
