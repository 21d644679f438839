#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# flotsamReport after short runs: bars at pipes (3D), a bar afloat (2D), bars on a rack and a bank (2D), bars that hang on each other (2D): page, figures, plots and pictures; what rests on the bank is
# not held by the rack; patches and anchors of restraints may be what holds; what is wrong with the command line is said.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*
report=$flotsamRoot/scripts/flotsamReport

makeJam jam
fixedSteps jam 0.005 0.05 5
makeFloatingBar bar
fixedSteps bar 0.01 0.02 2
makeFloatingBar bank
cat > bank/constant/bodies << 'END'
FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
structures
{
    rack { shape { type box; size (0.06 0.02 0.05); } position (0.05 -0.09 0.025); }
    bank { shape { type box; size (0.06 0.02 0.05); } position (-0.05 -0.09 0.025); }
}
bodies
{
    bar
    {
        shape { type box; size (0.02 0.02 0.05); } density 2500; velocity (0 -0.1 0);
        // on the rack; on that one; on the bank; on the bed
        poses ( { position (0.05 -0.068 0.025); } { position (0.054 -0.046 0.025); } { position (-0.05 -0.068 0.025); } { position (0 -0.088 0.025); } );
    }
}
END
fixedSteps bank 0.002 0.2 5
makeFloatingBar hanging
cat > hanging/constant/bodies << 'END'
FoamFile { version 2.0; format ascii; class dictionary; object bodies; }
bodies
{
    bar
    {
        shape { type box; size (0.02 0.02 0.05); } density 2500; velocity (0 -0.1 0);
        // on a line; on the one above; on the bed
        poses ( { position (0.05 -0.03 0.025); } { position (0.05 -0.06 0.025); } { position (-0.05 -0.088 0.025); } );
    }
}
restraints
{
    line { type tether; body bar.0; refAttachmentPt (0.05 -0.02 0.025); anchor (0.05 0.01 0.025); length 0.032; stiffness 1000; damping 10; }
    link { type tether; stiffness 1000; damping 10; body bar.1; refAttachmentPt (0.05 -0.05 0.025); otherBody bar.0; otherRefAttachmentPt (0.05 -0.04 0.025); length 0.012; }
}
END
fixedSteps hanging 0.002 0.3 10
makeCase damBreak house
python - > house/system/blockMeshDict << 'PY'
point = lambda i, j, k: i + 4 * (j + 4 * k)
print("FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; } vertices (",
      *(f"({i} {j} {k})" for k in range(3) for j in range(4) for i in range(4)), "); blocks (")
for i, j, k in ((i, j, k) for k in range(2) for j in range(3) for i in range(3) if (i, j, k) != (1, 1, 0)):
    corners = " ".join(str(point(i + a, j + b, k + c)) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
    print(f"hex ({corners}) (1 1 1) simpleGrading (1 1 1)")
top = " ".join(f"({point(i, j, 2)} {point(i + 1, j, 2)} {point(i + 1, j + 1, 2)} {point(i, j + 1, 2)})" for i in range(3) for j in range(3))
print("); boundary ( atmosphere { type patch; faces (", top, "); } ); defaultPatch { name walls; type wall; }")
PY
sed -i 's/(0 -9.81 0)/(0 0 -9.81)/' house/constant/g
sed -i '/boundaryField/,$d' house/0/alpha.water
echo 'boundaryField { ".*" { type zeroGradient; } }' >> house/0/alpha.water
(cd house && quietly blockMesh && quietly setFields && rm -r 0/U 0/p_rgh) || exit
for name in jam bar bank hanging; do
    (cd $name && solve 1) || exit
    (cd $name && quietly "$report") || exit
done
(cd jam && quietly "$report" --start 0.02 --at -0.1 --direction=x --structures pipes --no-pictures) || exit
cp -r bank unknown
python -c 'import h5py; del h5py.File("unknown/postProcessing/flotsam/bodies.h5", "r+")["contacts"]' || exit
for name in bank unknown; do (cd $name && quietly "$report" --direction=x --structures rack) || exit; done
cp -r hanging bed
for name in "hanging line" "bed walls"; do
    (cd "${name% *}" && quietly "$report" --direction=x --structures "${name#* }" --at 1 --no-pictures) || exit
done
for mistake in "nowhere" "jam --start 99" "jam --structures rack" "hanging --structures line"; do
    # shellcheck disable=SC2086
    "$report" $mistake > log.mistake 2>&1 && fail "no error of: flotsamReport $mistake"
    grep -q "^flotsamReport: " log.mistake && ! grep -q Traceback log.mistake || fail "message of: flotsamReport $mistake: $(cat log.mistake)"
done

python - << 'PY'
import json
import os
import sys

import numpy as np

import checks
import flotsam

h = flotsam.history("jam")
with open("jam/postProcessing/flotsam/report/report.json", encoding="utf-8") as file:
    figures = json.load(file)
dt = h.run["dt"] * (h.time >= 0.02)
for what, quantity in (("water", "fluidForce"), ("bodies", "contactForce")):
    mean = dt @ sum(getattr(h["structures/" + name], quantity) for name in h.structures) / dt.sum()
    checks.check(f"force of the {what} on the pipes [N]", np.abs(np.array(figures["forces"]["pipes"][what]) - mean).max(), 0, 1e-9)
s = np.array([h["bodies/" + name].position[-1, 0] for name in h.bodies])
checks.check("bars beyond -0.1 m", figures["bodies"]["passed"], (s > -0.1).sum(), 0)
checks.check("bars in all", sum(figures["bodies"][fate] for fate in ("awaited", "coming", "held", "passed", "left")), 3, 0)
for name, held, elsewhere in (("bank", 2, 2), ("unknown", 4, 0)):
    with open(f"{name}/postProcessing/flotsam/report/report.json", encoding="utf-8") as file:
        bodies = json.load(file)["bodies"]
    checks.check(f"{name}: bars held by the rack", bodies["held"], held, 0)
    checks.check(f"{name}: bars at rest elsewhere", bodies["elsewhere"], elsewhere, 0)
    checks.check(f"{name}: share held of those that came", bodies["retention"], 1, 0)
    if name == "bank":
        key = bodies["keys"][0]
        checks.check("the bar on the rack holds the one on it", float(key["name"] == "bar.0") * key["holds"], 1, 0)
        checks.check("its force on the rack: weights less buoyancy [N]", key["force"], 2 * 1500 * 0.02**2 * 0.05 * 9.81, 0.05)
for name, heldBy, held in (("hanging", "line", 2), ("bed", "walls", 1)):
    with open(f"{name}/postProcessing/flotsam/report/report.json", encoding="utf-8") as file:
        bodies = json.load(file)["bodies"]
    checks.check(f"{name}: bars held by {bodies['heldBy']}", bodies["held"], held, 0)
    checks.check(f"{name}: bars at rest elsewhere", bodies["elsewhere"], 3 - held, 0)
    checks.check(f"{name}: bodies that the first one holds", bodies["keys"][0]["holds"], held - 1, 0)
    checks.check(f"{name}: its force on what holds it: weights less buoyancy [N]", bodies["keys"][0]["force"], held * 1500 * 0.02**2 * 0.05 * 9.81, 0.05)
    checks.check(f"{name}: what holds is on its page", float(f"with {heldBy}," in open(f"{name}/postProcessing/flotsam/report/report.md", encoding="utf-8").read()), 1, 0)
for name, pictures in (("jam", ["series.png", "scene_0.05s.png"]), ("bar", ["series.png", "scene_0.02s.png"]), ("bank", ["series.png", "scene_0.2s.png", "contacts_0.2s.png"])):
    folder = f"{name}/postProcessing/flotsam/report"
    text = open(f"{folder}/report.md", encoding="utf-8").read()
    for picture in pictures:
        checks.check(f"{name}: {picture} [kB at least 5]", float(os.path.getsize(f"{folder}/{picture}") > 5000), 1, 0)
        if name != "jam":   # the page of jam is that of the second call
            checks.check(f"{name}: {picture} on its page", float(f"({picture})" in text), 1, 0)

# walls within the box of the mesh (a building): its four sides and its roof, none of the box's own
import flotsamScene  # noqa: E402
import patchSurfaces  # noqa: E402

walls = patchSurfaces.innerWalls("house", 0, flotsam.grid("house", 0).GetBounds())
checks.check("faces of the house", walls.GetNumberOfCells(), 5, 0)
checks.check("its height", walls.GetBounds()[5], 1, 1e-6)
checks.check("inner walls of a box", float(patchSurfaces.innerWalls("bar", 0, flotsam.grid("bar", 0).GetBounds()) is None), 1, 0)
for name, axis in (("house", 2), ("bar", 1)):
    checks.check(f"{name}: the vertical", flotsam.verticalAxis(name), axis, 0)
flotsamScene.renderScene("house", 0, "house.png")
flotsamScene.renderField2d("bar", 0, "bar.png")
sys.exit(checks.count())
PY
