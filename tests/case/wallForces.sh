#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# wallForces of controlDict: a bar under water that lies on the bed and against a dam, both patches of the mesh, gravity off the vertical so that it is pressed on
# both. Water's weight, the bar's weight under water in the column of contact, moments; the same on one and on two processes; a run that goes on writes into
# the folder of its start what the run without a stop has, and nothing is written over.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*
header="FoamFile { version 2.0; format ascii; class dictionary; object x; }"

makeCase floatingBar one
sed -i "s/(0 -9.81 0)/(2 -9.6 0)/" one/constant/g
sed -i 's/    walls$/    "bed|dam|walls"/' one/0/{U,p_rgh,alpha.water}
cat > one/system/blockMeshDict << END
$header
scale 1;
vertices ((0 0 0) (0.4 0 0) (0.4 0.25 0) (0 0.25 0) (0 0 0.05) (0.4 0 0.05) (0.4 0.25 0.05) (0 0.25 0.05));
blocks (hex (0 1 2 3 4 5 6 7) (40 25 1) simpleGrading (1 1 1));
boundary (bed { type wall; faces ((0 1 5 4)); } walls { type wall; faces ((0 4 7 3)); } dam { type wall; faces ((1 2 6 5)); } atmosphere { type patch; faces ((3 7 6 2)); }
    frontAndBack { type empty; faces ((0 3 2 1) (4 5 6 7)); });
END
cat > one/constant/bodies << END
$header
contact { default { frictionAngle 0; } }
bodies { bar { shape { type box; size (0.04 0.03 0.05); } density 2000; position (0.38 0.015 0.025); } }
END
echo "$header field alpha.water; type plane; direction (-2 9.6 0); origin (0.2 0.12 0);" > one/system/setAlphaFieldDict
cat >> one/system/controlDict << 'END'
wallForces
{
    bed { patches (bed); }
    dam { patches ("d.*"); origin (0.4 0 0); }
    all { patches (wall); }
}
END
fixedSteps one 0.005 0.6 60
(cd one && quietly blockMesh && quietly setAlphaField) || exit
cp -r one two
cp -r one parts
(cd one && solve 1) || exit
(cd two && quietly decomposePar && solve 2) || exit
setEntry parts/system/controlDict endTime 0.3
(cd parts && solve 1) || exit
cp -r parts/postProcessing/dam/0 before
setEntry parts/system/controlDict endTime 0.6
(cd parts && solve 1) || exit
diff -r before parts/postProcessing/dam/0 || fail "a run that goes on has changed what was there"
cat parts/postProcessing/dam/{0,0.3}/force.dat | grep -v '#' | diff - <(grep -v '#' one/postProcessing/dam/0/force.dat) || fail "forces of a run that goes on differ"
setEntry parts/system/controlDict startFrom startTime
setEntry parts/system/controlDict endTime 0.01
(cd parts && solve 1) || exit
diff before/force.dat parts/postProcessing/dam/0/force.dat || fail "a run from the start has written over force.dat"
[ "$(grep -vc '#' parts/postProcessing/dam/0/force_1.dat)" = 2 ] || fail "no force_1.dat with two lines"

python - << 'PY'
import sys

import numpy as np

import checks

PARTS = {"force": ("total", "pressure", "viscous", "contact", "peak"), "moment": ("total", "pressure", "viscous", "contact")}
thickness, g, rest = 0.05, np.array([2, -9.6]), 0.4     # [m], [m/s2], time from which on all rests [s]


def mean(case, name, file="force"):
    table = np.loadtxt(f"{case}/postProcessing/{name}/0/{file}.dat")
    return {part: table[table[:, 0] > rest][:, 1 + 3*k:4 + 3*k].mean(axis=0) for k, part in enumerate(PARTS[file])}


level = lambda x: 0.12 + (x - 0.2)*2/9.6
bar, submerged = 0.04*0.03*thickness, 1000*0.04*0.03*thickness
water = 1000*thickness*0.4*0.12 - submerged             # at x = 0.2 the level is the mean one
bed, dam, all_ = (mean("one", name) for name in ("bed", "dam", "all"))
checks.check("contact on the bed", bed["contact"][1], submerged*g[1], 0.04*submerged*9.6)    # measured 2.8 %
checks.check("largest contact within a step at rest, on the bed", bed["peak"][1], bed["contact"][1], 0.01*submerged*9.6)
checks.check("the same on the dam", dam["peak"][0], dam["contact"][0], 0.01*submerged*9.6)
checks.check("the same on all walls together", np.linalg.norm(all_["peak"]), np.linalg.norm(all_["contact"]), 0.01*submerged*9.6)
checks.check("contact on the dam", dam["contact"][0], submerged*g[0], 0.01*submerged*9.6)
for d in (0, 1):
    checks.check(f"water and bar on all walls, {'xy'[d]}", all_["total"][d], (water + 2000*bar)*g[d], 1e-3*water*9.6)
depth = level(0.4)
checks.check("water on the dam", dam["pressure"][0], 0.5*1000*9.6*depth**2*thickness, 0.005*0.5*1000*9.6*depth**2*thickness)
moment = mean("one", "dam", "moment")
checks.check("arm of the water on the dam", -moment["pressure"][2]/dam["pressure"][0], depth/3, 5e-3*depth)
checks.check("arm of the bar on the dam", -moment["contact"][2]/dam["contact"][0], 0.015, 2e-3)
checks.check("its total", moment["total"][2], moment["pressure"][2] + moment["viscous"][2] + moment["contact"][2], 1e-9)
lines = [line.split() for line in open("one/log.flotsamFoam", encoding="utf-8")]
lines = lines[[line[:3] for line in lines].index(["forces", "on", "patches"]) + 1:]
for words, name in zip(lines, ("bed", "dam", "all")):   # the table at the end: means of water and contact, largest of them, of their sum, of an impact
    table = np.loadtxt(f"one/postProcessing/{name}/0/force.dat")[:, 1:].reshape(-1, 5, 3)
    fluid, sizes = table[:, 1] + table[:, 2], lambda v: np.linalg.norm(v, axis=1).max()
    expected = [*fluid.mean(axis=0), *table[:, 3].mean(axis=0), sizes(fluid), sizes(table[:, 3]), sizes(table[:, 0]), sizes(table[:, 4])]
    difference = np.abs(np.array(words[1:], float) - expected)/np.maximum(np.abs(expected), 1e-6*water)
    checks.check(f"{name}: its line of the summary", difference.max(), 0, 6e-4)    # four digits
    checks.check("and its name", float(words[0] == name), 1, 0)
for name in ("bed", "dam", "all"):
    one, two = mean("one", name), mean("two", name)
    for part in one:
        checks.check(f"{name}, {part}, two processes", np.abs(one[part] - two[part]).max(), 0, 1e-5*water*9.6)
sys.exit(checks.count())
PY
