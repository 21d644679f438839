#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# OpenFOAM's function objects see the fields from the first step on, with what they were a step before, and may end the run; edits of fvSolution are answered.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeFloatingBar bar
fixedSteps bar 0.001 0.02 10
setEntry bar/system/controlDict writeFormat ascii
cat >> bar/system/controlDict << 'END'
functions
{
    points { type probes; libs (sampling); fields (U solid); probeLocations ((0 0 0.025) (0.05 -0.02 0.025)); writeControl timeStep; }
    rate { type ddt; libs (fieldFunctionObjects); field p; writeControl writeTime; }
    enough { type runTimeControl; libs (utilityFunctionObjects); conditions { time { type maxDuration; duration 0.0145; } } }
}
END
cd bar || exit
quietly flotsamFoam
log=log.flotsamFoam
[ -f postProcessing/points/0/solid ] || fail "probes do not find the field solid at the start: $(ls postProcessing/points)"
awk '$1 == 0.001 && $2 > 0.99 && $3 == 0 { ok = 1 } END { exit !ok }' postProcessing/points/0/solid || fail "solid at the probes: $(tail -n 1 postProcessing/points/0/solid)"
rates=$(sed -n '/nonuniform/,/^)/p' '0.01/ddt(p)' | awk '/^-?[0-9]/ && NF == 1 && $1 + 0 != 0' | wc -l)
[ "$rates" -gt 1000 ] || fail "ddt(p) is 0 in all but $rates cells"
grep -q '^Ended by a function object of system/controlDict at 0.01[0-9]* s, before endTime, 0.02 s' $log && grep -q '^End' $log \
    || fail "the log does not say that a function object has ended the run: $(tail -n 5 $log)"
