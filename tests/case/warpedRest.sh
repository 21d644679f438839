#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Water at rest stays at rest where cells have warped faces, whether its surface is given by exact fractions (setAlphaField) or by a smooth profile (setExprFields): 3D blocks over
# a doubly curved bed, polyhedra of polyDualMesh; on one and two processes.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit
rm -rf ./*

# makeTank CASE: a cube of 0.2 m without a mesh
makeTank() {
    makeCase floatingBar "$1"
    rm "$1/constant/bodies"
    sed -i "s/nu  *1e-03;/nu 1e-06;/" "$1/constant/transportProperties"
    local header="FoamFile { version 2.0; format ascii; class dictionary; object x; }"
    cat > "$1/system/blockMeshDict" << END
$header
scale 1;
vertices ((0 0 0) (0.2 0 0) (0.2 0.2 0) (0 0.2 0) (0 0 0.2) (0.2 0 0.2) (0.2 0.2 0.2) (0 0.2 0.2));
blocks (hex (0 1 2 3 4 5 6 7) (12 12 12) simpleGrading (1 1 1));
boundary (walls { type wall; faces ((0 1 5 4) (0 4 7 3) (1 2 6 5) (0 3 2 1) (4 5 6 7)); } atmosphere { type patch; faces ((3 7 6 2)); });
END
    echo "$header field alpha.water; type plane; direction (0 1 0); origin (0 0.107 0);" > "$1/system/setAlphaFieldDict"
    echo "$header expressions ( water { field alpha.water; dimensions [0 0 0 0 0 0 0]; expression \"0.5*(1 + tanh((0.107 - pos().y())/0.015))\"; } );" \
        > "$1/system/setExprFieldsDict"
    setEntry "$1/system/controlDict" writeFormat ascii
    setEntry "$1/system/controlDict" writePrecision 15
    fixedSteps "$1" 0.01 0.5 50
}

makeTank bed
(cd bed && quietly blockMesh) || exit
python - << 'PY'
import math
import re

path = "bed/constant/polyMesh/points"
with open(path, encoding="utf-8") as file:
    head, points = re.split(r"(?<=\n)(?=\d+\n)", file.read(), maxsplit=1)

def moved(match):
    x, y, z = (float(v) for v in match.groups())
    bed = 0.04 * math.sin(10 * math.pi * x + 0.3) * math.sin(10 * math.pi * z + 0.5)
    return f"({x} {y + bed * (0.2 - y) / 0.2:.15g} {z})"

with open(path, "w", encoding="utf-8") as file:
    file.write(head + re.sub(r"\((\S+) (\S+) (\S+)\)", moved, points))
PY

# six tetrahedra in each of 7^3 boxes, their inner points moved; polyDualMesh makes a polyhedron of each point
makeTank polyhedra
python - << 'PY'
import itertools
import os

import numpy as np

n, size = 7, 0.2
grid = np.stack(np.meshgrid(*3 * [np.arange(n + 1)], indexing="ij"), -1).reshape(-1, 3)
isInner = (grid > 0) & (grid < n)
points = (grid + 0.2 * np.random.default_rng(1).uniform(-1, 1, grid.shape) * isInner) * size / n
number = {tuple(g): i for i, g in enumerate(grid)}
faces = {}
nCells = 0
for corner in itertools.product(range(n), repeat=3):
    for order in itertools.permutations(range(3)):
        at = np.array(corner)
        tet = [number[tuple(at)]]
        for axis in order:
            at[axis] += 1
            tet.append(number[tuple(at)])
        centre = points[tet].mean(0)
        for left in range(4):
            face = tet[:left] + tet[left + 1:]
            a, b, c = points[face]
            outwards = np.dot(np.cross(b - a, c - a), a - centre) > 0
            faces.setdefault(tuple(sorted(face)), []).append((nCells, face if outwards else face[::-1]))
        nCells += 1
inner, walls, top = [], [], []
for sides in faces.values():
    if len(sides) == 2:
        inner.append((sides[0][0], sides[1][0], sides[0][1]))
    else:
        (top if all(abs(points[i][1] - size) < 1e-9 for i in sides[0][1]) else walls).append((sides[0][0], -1, sides[0][1]))
inner.sort(key=lambda f: f[:2])
listed = inner + walls + top

def write(name, kind, entries):
    path = "polyhedra/constant/polyMesh/" + name
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as out:
        print(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}", len(entries), "(", *entries, ")", sep="\n", file=out)

write("points", "vectorField", ["({:.15g} {:.15g} {:.15g})".format(*p) for p in points])
write("faces", "faceList", ["3({} {} {})".format(*f[2]) for f in listed])
write("owner", "labelList", [f[0] for f in listed])
write("neighbour", "labelList", [f[1] for f in inner])
write("boundary", "polyBoundaryMesh", [f"{name} {{ type {kind}; nFaces {len(part)}; startFace {start}; }}" for name, kind, part, start in
                                        (("walls", "wall", walls, len(inner)), ("atmosphere", "patch", top, len(inner) + len(walls)))])
PY
(cd polyhedra && quietly polyDualMesh 75 -overwrite) || exit

for case in bed polyhedra; do
    cp -r $case $case.profile
    [ $case = bed ] || fixedSteps $case.profile 0.01 3 300 # cells that have no front for the transport let a motion grow: before 1e-5 m/s in the water, 8e-5 in the gas
    (cd $case.profile && quietly setExprFields && solve 1) || exit
    (cd $case && quietly setAlphaField) || exit
    cp -r $case $case.two
    (cd $case && solve 1) || exit
    (cd $case.two && quietly decomposePar && solve 2 && quietly reconstructPar -latestTime) || exit
done

python - << 'PY'
import glob
import sys

import numpy as np

import flotsam

failed = []
for case in sorted(glob.glob("bed*") + glob.glob("polyhedra*")):
    field = flotsam.fields(case, "last", ["U", flotsam.ALPHA])
    speed, isWater = np.linalg.norm(field["U"], axis=1), field[flotsam.ALPHA] > 0.5
    print(f"{case}: largest speed in the water {speed[isWater].max():.1e} m/s, in the gas {speed[~isWater].max():.1e} m/s")
    # from fractions 6e-5 m/s are left on polyhedra, before 5e-4 and more; why is not known
    if speed[isWater].max() > (2e-4 if case in ("polyhedra", "polyhedra.two") else 1e-5):
        failed.append(case)
    if case == "polyhedra.profile" and (speed[isWater].max() > 2e-6 or speed[~isWater].max() > 2e-5):
        failed.append(case + " (after 3 s)")
if failed:
    sys.exit(f"FAILED: water at rest moves in {', '.join(failed)}")
PY
