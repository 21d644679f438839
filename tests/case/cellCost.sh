#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A block fills a side of a tank: decomposed by cost of the cells both processes get the same work, and the results are those of one process.
. "$(dirname "$0")/support.sh"
mkdir -p "$work" && cd "$work" || exit

makeFallingSphere serial && fixedSteps serial 0.005 0.025 5
setEntry serial/system/controlDict writeFormat ascii
setNumerics serial 'tolerance 1e-11; maxIterations 1000;'
echo 'structures { block { shape { type box; size (0.06 0.2 0.4); } position (0.045 0 0.08); } }' >> serial/constant/bodies
rm -rf parallel && cp -r serial parallel
(cd serial && quietly flotsamFoam) || exit
cd parallel || exit

echo 'weightField cellCost;' > system/nProcs
decomposePar > log.missing 2>&1 && fail "decomposed without its weights"
grep -q 'file.*0/cellCost' log.missing || fail "decomposePar does not name the missing file"
quietly flotsamFoam -cell-cost
mv log.flotsamFoam log.cellCost
[ -f 0/cellCost ] && [ ! -d 0.025 ] || fail "weights not written, or steps made"
quietly decomposePar && quietly mpirun -np 2 flotsamFoam -parallel && quietly reconstructPar

python - <<'END' || exit
import re
import sys

import numpy as np


def numbers(file):
    with open(file, encoding="utf-8") as source:
        return np.array(re.search(r"\n\d+\s*\(([^)]*)\)", source.read()).group(1).split(), float)


whole = numbers("0/cellCost")
parts = [whole[numbers(f"processor{k}/constant/polyMesh/cellProcAddressing").astype(int)] for k in (0, 1)]
with open("log.cellCost", encoding="utf-8") as log:
    counts = re.search(r"Elements: (\d+) of fluid, (\d+) cut by fixed structures, (\d+) inside them; cost ([\d.e+]+) ", log.read())
fluid, cut, solid, cost = map(float, counts.groups())
cells, works = [len(p) for p in parts], [p.sum() for p in parts]
print(f"{fluid:.0f} elements of fluid, {cut:.0f} cut, {solid:.0f} solid; cells {cells}, their costs {works}")
if fluid + cut + solid != 6 * len(whole) or not 0.2 < (cut + solid) / (6 * len(whole)) < 0.5:
    sys.exit("elements: 6 a cell, a third of the tank's length finely divided is the block's")
if abs(whole.sum() - cost) > 1e-3 * cost or abs(sum(works) - cost) > 1e-3 * cost:
    sys.exit(f"the weights sum up to {whole.sum()}, reported are {cost}")
if not (abs(works[0] - works[1]) < 0.02 * cost and cells[1] > 1.02 * cells[0]):
    sys.exit("allowed: costs that differ by 2 % of all, and more cells on the block's side")
END

cd .. && python "$here/compare.py" serial parallel 1e-6
