#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# /contacts of bodies.h5: forces of every pair at the write times, which add up to the contactForce of bodies and structures; contacts.xdmf. Bars that jam at pipes (3D), and bars
# on the bed of a tank, one on a spring, pushed by a structure that moves (2D): on one process and on two, after a stop, with write times that steps are cut to meet. Bars that leave the mesh
# while they touch the bed and each other, at every step.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

# stopped CASE TIME END: the case in two runs
stopped() {
    setEntry "$1/system/controlDict" endTime "$2"
    (cd "$1" && solve 1) || exit
    setEntry "$1/system/controlDict" endTime "$3"
    (cd "$1" && solve 1) || exit
}

# threeWays CASE TIME END: on one process, on two, and stopped at TIME
threeWays() {
    cp -r "$1" "$1Two"
    cp -r "$1" "$1Parts"
    (cd "$1" && solve 1) || exit
    (cd "$1Two" && quietly decomposePar && solve 2) || exit
    stopped "$1Parts" "$2" "$3"
}

makeJam jam
setEntry jam/system/controlDict endTime 0.05
threeWays jam 0.03 0.05

makeFloatingBar tank
cat > tank/constant/bodies << 'END'
FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
structures
{
    sill   { shape { type box; size (0.04 0.01 0.05); } position (0.034 -0.0955 0.025); }
    pusher { shape { type box; size (0.02 0.02 0.05); } position (-0.0205 -0.088 0.025); motion { type linear; velocity (0.05 0 0); } }
}
bodies
{
    lower { shape { type box; size (0.02 0.02 0.05); } density 2500; position (0 -0.09 0.025); }
    upper { shape { type box; size (0.02 0.02 0.05); } density 2000; position (0.012 -0.07 0.025); }
}
restraints
{
    rope { type tether; body lower; refAttachmentPt (0 -0.09 0); otherBody upper; otherRefAttachmentPt (0.012 -0.07 0); stiffness 200; damping 0.5; length 0.02; }
    line { type linearSpring; body upper; refAttachmentPt (0.012 -0.06 0); anchor (0.012 0.02 0); stiffness 5; damping 0.1; restLength 0.06; }
}
END
fixedSteps tank 0.002 0.04 5
threeWays tank 0.02 0.04

makeJam leave
sed -i -e '/^structures$/,/^}$/d' -e 's/density     590/density     1500/' -e 's/velocity    (0.5 0 0)/velocity    (1.2 0 0)/' -e 's/(-0.0225 0 0.167)/(0.03 0 0.0105)/' -e 's/(-0.046 0.01 0.166)/(0.007 0.01 0.0105)/' \
    -e 's/(-0.05 -0.01 0.189)/(0.02 -0.01 0.036)/' -e 's/velocity (0.3 0 -0.3); releaseTime 0.01;/velocity (1.2 0 -0.3);/' leave/constant/bodies
fixedSteps leave 0.004 0.12 1
echo 'wallForces { bed { patches (bed); } }' >> leave/system/controlDict
(cd leave && solve 1) || exit
[ "$(grep -c '^body bar.* has left' leave/log.flotsamFoam)" = 3 ] || fail "not all bars have left: $(grep '^body' leave/log.flotsamFoam)"

python "$here/contacts.py" body,structure jam jamTwo jamParts || exit
python "$here/contacts.py" body,structure,patch tank tankTwo tankParts || exit
python "$here/contacts.py" body,patch leave > log.leave || { grep FAILED log.leave; exit 1; }
python - << 'PY'
import sys

import numpy as np

import checks

import flotsam

# a stop changes nothing
for case in ("jam", "tank"):
    one, parts = flotsam.history(case).contacts, flotsam.history(case + "Parts").contacts
    for name in ("time", "begin", "first", "second", "spheres"):
        checks.check(f"{case}: {name} after a stop", float(np.array_equal(one[name], parts[name])), 1, 0)
    scale = np.abs(one["force"]).max()
    checks.check(f"{case}: forces after a stop, over the largest", np.abs(one["force"] - parts["force"]).max() / scale, 0, 1e-9)
h = flotsam.history("tank")
checks.check("the pusher pushes [N]", float((h.contacts["second"] == h["structures/pusher"].number).any()), 1, 0)
checks.check("the bed is patch", float(h.contacts["walls"] == ["walls"]), 1, 0)

# the bed's contact force is that of its rows
h = flotsam.history("leave")
c, table = h.contacts, flotsam.stepTable("leave", "bed", "force.dat")
bed = len(h.bodies) + c["walls"].index("bed")
rows = [c["second"][begin:end] == bed for begin, end in zip(c["begin"], c["begin"][1:])]
sums = np.array([-c["force"][begin:end][isBed].sum(0) for begin, end, isBed in zip(c["begin"], c["begin"][1:], rows)])
checks.check("contact force on the bed [N]", np.abs(sums[1:] - table[:, 10:13]).max(), 0, 1e-8)
checks.check("it is pressed, and is not at the end [N]", float(np.abs(sums).max() > 1 and not sums[-1].any()), 1, 0)

# what the spring and the rope do is no contact
pull = flotsam.stepTable("tank", "restraints", "line.dat")[-1, 1:4]
checks.check("the spring pulls [N]", float(np.abs(pull).max() > 0.01), 1, 0)
sys.exit(checks.count())
PY
