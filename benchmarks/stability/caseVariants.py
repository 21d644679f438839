# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of the families refined and mixed: meshes by meshFiles.py and OpenFOAM's tools, runs in two parts."""
import os
import re
import shutil

import numpy as np

import caseFiles
import judge
import meshFiles
from runner import environment
from support import files

BEGUN = "log.begun"     # of the first part of a run that is stopped


def of(scene, root):
    """The case that a scene needs."""
    special = scene.element != "hex" or scene.halved or scene.blocks
    return (StoppedCase if scene.stop else MeshCase if special else caseFiles.SceneCase)(scene, root)


class MeshCase(caseFiles.SceneCase):
    """blockMesh gives the points; cells, holes and boundary are written anew, then halved, snapped or made into their duals."""

    def files(self, run, folder):
        self._folder = folder
        return super().files(run, folder)

    def _patches(self):
        """Patches without faces are in no file."""
        s = self.scene
        return {**super()._patches(), **({"blocks": (s.blockType, "")} if s.blocks else {})}

    def prepare(self, run, do):
        s = self.scene
        if s.element == "hex" and not s.halved and not s.blocks:
            super().prepare(run, do)
            return
        do("blockMesh")
        points = caseFiles.movePoints(s, os.path.join(self._folder, "constant", "polyMesh", "points"))
        kind = {"dual": "tet", "snap": "hex"}.get(s.element, s.element)
        meshFiles.write(self._folder, points, self._patches(), kind, self._holes(points), s.rng)
        for number, place in enumerate(s.halved):
            self._halve(place, number, do)
        if s.element == "dual":
            do("polyDualMesh", "75", "-overwrite")
        if s.snapped:
            self._write(self._snappy())
            do("snappyHexMesh", "-overwrite")
        shutil.rmtree(os.path.join(self._folder, "0"), ignore_errors=True)      # refineMesh makes one
        self.mesh = meshFiles.AnyCells(self._folder)
        self._write(self._fields())

    def _write(self, texts):
        for path, text in texts.items():
            path = os.path.join(self._folder, path)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)

    def _holes(self, points):
        """Cells whose centres are in a block."""
        s = self.scene
        centre = judge.Cells(points, s.cells).centre / s.length
        inside = np.zeros(len(centre), bool)
        for low, high in s.blocks if not s.snapped else []:
            inside |= ((centre > low) & (centre < high))[:, :s.dim].all(axis=1)
        return inside.reshape(s.cells[::-1])

    def _halve(self, place, number, do):
        centre, half, shape, directions = place
        s = self.scene
        shrink = 0.8 if number >= len({id(p) for p in s.halved}) else 1
        centre, half = centre * s.length, shrink * half * s.length
        source = f"source boxToCell; sourceInfo {{ box {_vector(centre - half)} {_vector(centre + half)}; }}"
        if shape == "ball" and s.dim == 3:
            source = f"source sphereToCell; sourceInfo {{ centre {_vector(centre)}; radius {half.min():.9g}; }}"
        elif shape == "ball":
            ends = f"p1 {_vector(centre - [0, 0, 9 * s.length])}; p2 {_vector(centre + [0, 0, 9 * s.length])};"
            source = f"source cylinderToCell; sourceInfo {{ {ends} radius {half[:2].min():.9g}; }}"
        self._write({"system/topoSetDict": files.dictionary("topoSetDict", f"actions ({{ name fine; type cellSet; action new; {source} }});"),
                     "system/refineMeshDict": files.dictionary("refineMeshDict", "set fine; coordinateSystem global; globalCoeffs { tan1 (1 0 0); tan2 (0 1 0); } "
                                                               f"directions ({directions}); useHexTopology yes; geometricCut no; writeMesh no;")})
        do("topoSet")
        do("refineMesh", "-overwrite")

    def _snappy(self):
        s = self.scene
        foot, top, radius = s.snapped
        inside = s.size * [0.03137, 0.61713, 0.51317]
        return {"system/snappyHexMeshDict": files.dictionary("snappyHexMeshDict", f"""castellatedMesh true; snap true; addLayers false; mergeTolerance 1e-6;
geometry {{ blocks {{ type searchableCylinder; point1 {_vector(foot * s.length)}; point2 {_vector(top * s.length)}; radius {radius * s.length:.9g}; }} }}
castellatedMeshControls
{{
    maxLocalCells 1000000; maxGlobalCells 2000000; minRefinementCells 0; nCellsBetweenLevels 1; features (); resolveFeatureAngle 30; allowFreeStandingZoneFaces false;
    refinementSurfaces {{ blocks {{ level (1 1); patchInfo {{ type {s.blockType}; }} }} }} refinementRegions {{}} locationInMesh {_vector(inside)};
}}
snapControls {{ nSmoothPatch 3; tolerance 2; nSolveIter 20; nRelaxIter 5; nFeatureSnapIter 0; }}
addLayersControls {{ layers {{}} relativeSizes true; expansionRatio 1; finalLayerThickness 0.3; minThickness 0.1; nGrow 0; featureAngle 60; nRelaxIter 3; nSmoothSurfaceNormals 1;
    nSmoothNormals 3; nSmoothThickness 10; maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3; minMedialAxisAngle 90; nBufferCellsNoExtrude 0; nLayerIter 5; }}
meshQualityControls {{ maxNonOrtho 65; maxBoundarySkewness 20; maxInternalSkewness 4; maxConcave 80; minVol 1e-20; minTetQuality 1e-15; minArea -1; minTwist 0.02;
    minDeterminant 0.001; minFaceWeight 0.05; minVolRatio 0.01; minTriangleTwist -1; nSmoothScale 4; errorReduction 0.75; }}""")}

    def _start(self):
        """Fractions of the cells by sample points, velocity of the liquid in them."""
        if isinstance(self.mesh, judge.Cells):
            return super()._start()
        s = self.scene
        x = self.mesh.samplePlace.copy()
        x[:, 0] -= s.slant * x[:, 1]
        wet, velocity = np.zeros(len(x), bool), np.zeros((len(x), 3))
        for inside, v in s.liquid:
            isIn = inside(x / s.length)
            velocity[isIn & ~wet] = v
            wet |= isIn
        return self.mesh.mean(wet.astype(float)), np.stack([self.mesh.mean(velocity[:, d]) for d in range(3)], axis=1)


class StoppedCase(MeshCase):
    """Runs to `stop` on ranks[0] processes, then goes on with ranks[1] and the late bodies too."""

    def files(self, run, folder):
        s, made = self.scene, super().files(run, folder)
        self._whole = {name: made[name] for name in ("system/controlDict", "constant/bodies") if name in made}
        if any(b.isLate for b in s.bodies):
            made["constant/bodies"] = files.bodies(self._solids([b for b in s.bodies if not b.isLate]))["constant/bodies"]
        made["system/controlDict"] = re.sub(r"endTime .*;", f"endTime {s.stop * s.endTime:.9g};", made["system/controlDict"])
        made["system/decomposeParDict"] = files.dictionary("decomposeParDict", f"numberOfSubdomains {max(s.ranks)};\nmethod simple; coeffs {{ n ({max(s.ranks)} 1 1); }}")
        return made

    def prepare(self, run, do):
        super().prepare(run, do)
        self._do = do
        first, then = self.scene.ranks
        program = environment.program(self.root, run.solver, run.rebuilt)
        if first > 1:
            do("decomposePar")
        limit = ["timeout", "600"]
        try:
            do(*limit, *([*launcher(first), program, "-parallel"] if first > 1 else [program]))
        finally:
            os.replace(os.path.join(self._folder, "log.timeout"), os.path.join(self._folder, BEGUN))
        if first > 1:
            do("reconstructPar")
            if first != then:
                self._removeProcessors()
        elif then > 1:
            do("decomposePar", "-latestTime")
        self._write({**self._whole, "system/controlDict": re.sub(r"startFrom .*;", "startFrom latestTime;", self._whole["system/controlDict"])})
        if then > 1:
            run.options = {"launcher": launcher(then), "arguments": ["-parallel"]}

    def _removeProcessors(self):
        for name in os.listdir(self._folder):
            if re.fullmatch(r"processor\d+", name):
                shutil.rmtree(os.path.join(self._folder, name))

    def errors(self, run, folder):
        if self.scene.ranks[1] > 1:
            self._do("reconstructPar", "-newTimes")
        return super().errors(run, folder)


def launcher(n):
    return ["mpirun", "--oversubscribe", "--allow-run-as-root", "-np", str(n)]


def _vector(v):
    return "(" + " ".join(f"{x:.9g}" for x in v) + ")"
