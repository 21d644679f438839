#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# restraints of constant/bodies: a bar under water on a tether to the bed and one on a spring to it, in water at rest. The tether's force is buoyancy less weight; histories and momentum; the
# same on two processes; a run that goes on is the one without a stop, to round-off, a tether that breaks included; what a state cannot go on with is refused.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

makeFloatingBar one
cat > one/constant/bodies << 'END'
FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
bodies
{
    bar  { shape { type box; size (0.02 0.02 0.05); } density 600; position (0 -0.06 0.025); }
    next { shape { type box; size (0.02 0.02 0.05); } density 600; position (0.035 -0.06 0.025); }
}
restraints
{
    mooring { type tether; body bar; refAttachmentPt (0 -0.07 0); anchor (0 -0.1 0); stiffness 5000; damping 5; }
    link    { type linearSpring; body next; refAttachmentPt (0.025 -0.06 0); otherBody bar; otherRefAttachmentPt (0.01 -0.06 0); stiffness 200; damping 0.5; }
    weak    { type tether; body next; refAttachmentPt (0.035 -0.07 0); anchor (0.035 -0.1 0); stiffness 5000; damping 5; breakingForce 0.05; }
}
END
fixedSteps one 0.002 0.08 20
cp -r one rest
sed -i '/^    next/d; /^    link/d; /^    weak/d' rest/constant/bodies
cp -r one two
cp -r one parts
(cd one && flotsamFoam -dry-run > log.dry) || fail "dry run"
grep -q '^Restraints: 3, in sub-steps of' one/log.dry || fail "the dry run does not tell of the restraints"
grep -q '    link: linear spring from next to bar, 0.015 m long, unstretched 0.015 m: 0 N; dry period' one/log.dry || fail "the dry run does not tell of the link: $(grep -A4 Restraints one/log.dry)"
(cd one && solve 1) || exit
(cd two && quietly decomposePar && solve 2) || exit
setEntry parts/system/controlDict endTime 0.04
(cd parts && solve 1) || exit
setEntry parts/system/controlDict endTime 0.08
(cd parts && solve 1) || exit
python "$here/compare.py" one parts 1e-13 || exit
for name in mooring link weak; do
    cat parts/postProcessing/restraints/{0,0.04}/$name.dat | grep -v '#' | diff - <(grep -v '#' one/postProcessing/restraints/0/$name.dat) || fail "the history of $name differs after a restart"
done
diff <(sed -n '/^  restraints/,/^$/p' one/log.flotsamFoam) <(sed -n '/^  restraints/,/^$/p' parts/log.flotsamFoam) || fail "the summaries differ"
grep -q 'restraint weak is broken: its force exceeded 0.05 N' one/log.flotsamFoam || fail "weak does not break"
python "$here/momentum.py" parts "0 -9.81 0" bar next || exit

python "$here/restraintLines.py" one parts || exit

# refuses ENTRY WORDS: what is changed in a run that is to go on
setEntry parts/system/controlDict endTime 0.1
refuses() {
    rm -rf other && cp -r parts other && sed -i "$1" other/constant/bodies
    if (cd other && flotsamFoam > log.other 2>&1); then fail "a run goes on with other restraints: $1"; fi
    grep -q "$2" other/log.other || fail "$1: no '$2': $(tail -n 12 other/log.other)"
}
refuses '/^    weak/d' 'whose restraints are mooring, link, weak; now they are mooring, link'
refuses '/^restraints/,$d' 'whose restraints are mooring, link, weak; now they are none'

# a chain is its lines, to the last bit (points that have no round-off), where a run goes on as well
rm -rf singly && cp -r rest singly && rm -rf singly/{0.[0-9]*,postProcessing}
sed -i '/^bodies/,$d' singly/constant/bodies
echo 'bodies { float { shape { type box; size (0.02 0.02 0.05); } density 600; position (0 -0.0625 0.025); array { count (2 1 1); spacing (0.0625 0 0); } } }' >> singly/constant/bodies
fixedSteps singly 0.002 0.02 5
cp -r singly chained
cat >> singly/constant/bodies << 'END'
restraints
{
    boom.0 { type tether; body float.0; refAttachmentPt (-0.0078125 -0.0625 0); anchor (-0.0625 -0.09375 0); stiffness 5000; damping 5; }
    boom.1 { type tether; body float.0; refAttachmentPt (0.0078125 -0.0625 0); otherBody float.1; otherRefAttachmentPt (0.0546875 -0.0625 0); stiffness 5000; damping 5; }
    boom.2 { type tether; body float.1; refAttachmentPt (0.0703125 -0.0625 0); anchor (0.125 -0.09375 0); stiffness 5000; damping 5; }
}
END
cat >> chained/constant/bodies << 'END'
restraints
{
    boom { type chain; links tether; bodies float; front (-0.0078125 0 0); back (0.0078125 0 0); firstAnchor (-0.0625 -0.09375 0); lastAnchor (0.125 -0.09375 0); stiffness 5000; damping 5; }
}
END
(cd singly && solve 1) || exit
(cd chained && solve 1) || exit
for name in boom.0 boom.1 boom.2; do
    diff singly/postProcessing/restraints/0/$name.dat chained/postProcessing/restraints/0/$name.dat || fail "line $name of a chain differs from the same line on its own"
done
grep -v '#' chained/postProcessing/restraints/0/boom.0.dat | awk '$5 > 0 { n++ } END { exit n < 5 }' || fail "the first line of the chain does not pull"
python "$here/compare.py" singly chained 0 || exit
cp chained/constant/bodies singly/constant/bodies
setEntry singly/system/controlDict endTime 0.024
(cd singly && solve 1 && grep -q 'continuing the stored state of time 0.02' log.flotsamFoam) || fail "the lines' run does not go on as a chain's"

# a run without restraints goes on with some
setEntry rest/system/controlDict endTime 0.5
setEntry rest/system/controlDict deltaT 0.005
setEntry rest/system/controlDict writeInterval 100
cp -r rest late
sed -i '/^restraints/,$d' late/constant/bodies
setEntry late/system/controlDict endTime 0.01
setEntry late/system/controlDict writeInterval 2
(cd late && solve 1) || exit
cp rest/constant/bodies late/constant/bodies
setEntry late/system/controlDict endTime 0.02
(cd late && solve 1) || exit
grep -v '#' late/postProcessing/restraints/0.01/mooring.dat | awk '$5 > 0 { n++ } END { exit n != 2 }' || fail "a restraint that is added to a run does not pull"
(cd rest && solve 1) || exit

python - << 'PY'
import sys

import numpy as np

import checks

import flotsam



def table(case, name):
    return np.loadtxt(f"{case}/postProcessing/restraints/0/{name}.dat")


mooring = table("rest", "mooring")
lift = 400*0.02**2*0.05*9.81
last = mooring[mooring[:, 0] > 0.1025]
history = flotsam.history("rest/postProcessing/flotsam")
water = history["bar"].fluidForce[history.time > 0.1025, 1] - 600*0.02**2*0.05*9.81
checks.check("mean tension: the water's force less weight [N]", last[:, 4].mean(), water.mean(), 1e-3*lift)
checks.check("buoyancy less weight; the surface sloshes by what the cells make of it at the start [N]", last[:, 4].mean(), lift, 0.04*lift)
checks.check("force along y [N]", np.abs(last[:, 2] + last[:, 4]).max(), 0, 2e-3*lift)
checks.check("contact force of bodies.h5 [N]", np.abs(history["bar"].contactForce[history.time > 0.1025, 1] - last[:, 2]).max(), 0, 1e-9)
checks.check("length [m]", last[-1, 6], 0.03 + last[-1, 4]/5000, 1e-3*lift/5000)
for name in ("mooring", "link", "weak"):
    one, two = table("one", name), table("two", name)
    checks.check(f"{name}, two processes", np.abs(one[:, 1:5] - two[:, 1:5]).max(), 0, 5e-3*lift)
checks.check("broken", table("one", "weak")[-1, 7], 1, 0)
checks.check("not broken", table("one", "mooring")[-1, 7], 0, 0)
sys.exit(checks.count())
PY
