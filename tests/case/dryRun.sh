#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# flotsamFoam -dry-run checks a case and leaves it as it is, to the last file: fresh and with a stored state, with function objects, on one process and
# on two. So does the help; an option that is not known ends the run. The entries that it prints are those of docs/dictionaries.md.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

# contents CASE: its files and folders, with what is in them
contents() { (cd "$1" && find . -type d && find . -type f -exec cksum {} + | sort -k 3); }

# leavesAlone CASE STATUS WORD COMMAND...: the command ends with that exit code, says the word and changes nothing
leavesAlone() {
    local case=$1 status=$2 word=$3
    shift 3
    contents "$case" > before.txt
    (cd "$case" && "$@") > log.txt 2>&1
    [ $? -eq "$status" ] || fail "$* in $case: $(tail -n 20 log.txt)"
    grep -q -- "$word" log.txt || fail "$* in $case: no '$word'"
    contents "$case" | diff before.txt - || fail "$* has changed $case"
}

makeFloatingBar bar
fixedSteps bar 0.001 0.004 2
cat >> bar/system/controlDict << 'DICT'
functions
{
    level { type probes; libs (sampling); writeControl timeStep; fields (p); probeLocations ((0 -0.01 0.025)); }
    now   { type writeDictionary; libs (utilityFunctionObjects); dictNames (fvSolution); }
}
DICT
leavesAlone bar 0 'anew from the volume fields' flotsamFoam -dry-run
leavesAlone bar 0 'anew from the volume fields' flotsamFoam -dry-run -cell-cost -noFunctionObjects
leavesAlone bar 0 'Usage: flotsamFoam' flotsamFoam -help
leavesAlone bar 1 'Invalid option: -dryrun' flotsamFoam -dryrun
(cd bar && quietly flotsamFoam) || exit
setEntry bar/system/controlDict endTime 0.008
rm bar/log.*
leavesAlone bar 0 'the stored state continues, exactly' flotsamFoam -dry-run

# pipes of a few elements: fluid seeps through, the same nodes on one process and on two
makeJam jam
leavesAlone jam 0 '^Warning: fluid seeps through .*: pipes.0, [0-9]* nodes around' flotsamFoam -dry-run
grep '^Warning: fluid seeps' log.txt > serial.txt
(cd jam && quietly decomposePar) || exit
leavesAlone jam 0 '^End' mpirun -np 2 flotsamFoam -parallel -dry-run
diff <(sed 's/(.*//' serial.txt) <(grep '^Warning: fluid seeps' log.txt | sed 's/(.*//') || fail "other nodes on two processes"

# docs/dictionaries.md has every entry of `flotsam` with its default, and no other
(cd bar && flotsamFoam -dry-run) | sed -n 's/^    \([A-Za-z]*\) *\([^ ;]*\); *\/\/.*/\1 \2/p' | awk '{ print $1, $2 ~ /^[0-9]/ ? $2 + 0 : $2 }' > printed.txt
sed -n '/^## .*sub-dictionary flotsam/,/^## constant/ s/^| `\([A-Za-z]*\)` |[^|]*| `*\([^ `|]*\)`* |.*/\1 \2/p' "$here/../../docs/dictionaries.md" | awk '{ print $1, $2 ~ /^[0-9]/ ? $2 + 0 : $2 }' > documented.txt
[ "$(wc -l < printed.txt)" -gt 30 ] || fail "the dry run prints $(wc -l < printed.txt) entries of flotsam"
diff printed.txt documented.txt || fail "entries of flotsam and their defaults: < by the dry run, > in docs/dictionaries.md"
