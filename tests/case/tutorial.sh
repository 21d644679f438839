#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tutorial.sh NAME: the first steps of a tutorial, with its own mesh and dictionaries; then numbers (shortRun.py).
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeCase "$1" case
cd case || exit
quietly blockMesh
for tool in setFields setExprFields setExprBoundaryFields; do
    if [ -f "system/${tool}Dict" ]; then quietly $tool; fi
done
case $1 in
    damBreak) end=0.1 ;;
    flowPastCylinder) end=0.2 ;;
    fallingSphere) end=0.1 ;;
    floatingBar) end=0.1 ;;
    barAgainstPost) end=0.1 ;;
    slitDam | bridgePier) end=0.02 ;;
    debrisRack) # a few logs at once
        end=0.02
        sed -i -e 's/^firstRelease .*/firstRelease 0.01;/' -e 's/^releaseInterval .*/releaseInterval 0.002;/' system/parameters
        ;;
    debrisBoom) # a few logs at once, and the boom, with skirts, soon let go
        end=0.04
        sed -i -e 's/^firstRelease .*/firstRelease 0.01;/' -e 's/^releaseInterval .*/releaseInterval 0.002;/' -e 's/^floatRelease .*/floatRelease 0.005;/' -e 's/^skirts .*/skirts yes;/' system/parameters
        ;;
    *) fail "no tutorial $1" ;;
esac
setEntry system/controlDict endTime $end
setEntry system/controlDict writeInterval $end
quietly flotsamFoam
python "$here/shortRun.py" "$1"
