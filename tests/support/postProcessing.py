# SPDX-License-Identifier: GPL-3.0-or-later
"""Test of tutorials/common/flotsam.py and driftwood.py. Usage: postProcessing.py PROGRAM, PROGRAM writes a known body history."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tutorials", "common"))
import driftwood  # noqa: E402
import flotsam  # noqa: E402
import flotsamScene  # noqa: E402
import vtk  # noqa: E402

LENGTH, WIDTH, HEIGHT = 2.0, 0.5, 1.0
LEVEL = 0.4375  # in the middle of a cell of height 0.125


def _write(path, kind, body, **extra):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    entries = "".join(f"{k} {v};" for k, v in extra.items())
    with open(path, "w", encoding="ascii") as out:
        out.write(f"FoamFile {{ version 2.0; format ascii; class {kind}; {entries} object {os.path.basename(path)}; }}\n{body}\n")


def _list(entries):
    return f"{len(entries)}\n(\n" + "\n".join(entries) + "\n)\n"


def writeMesh(folder, x0, x1, nx, nz=8):
    """A box of nx x 1 x nz cells in OpenFOAM's format; returns the cell centres."""
    xs, ys, zs = np.linspace(x0, x1, nx + 1), (0.0, WIDTH), np.linspace(0, HEIGHT, nz + 1)
    number = lambda i, j, k: i + (nx + 1) * (j + 2 * k)  # noqa: E731
    cell = lambda i, k: i + nx * k  # noqa: E731
    points = [f"({x} {y} {z})" for z in zs for y in ys for x in xs]
    inner, outer = [], []
    for k in range(nz):
        for i in range(nx):
            high = [number(i + 1, 0, k), number(i + 1, 1, k), number(i + 1, 1, k + 1), number(i + 1, 0, k + 1)]
            top = [number(i, 0, k + 1), number(i + 1, 0, k + 1), number(i + 1, 1, k + 1), number(i, 1, k + 1)]
            if i + 1 < nx:
                inner.append((cell(i, k), cell(i + 1, k), high))
            else:
                outer.append((cell(i, k), high))
            if k + 1 < nz:
                inner.append((cell(i, k), cell(i, k + 1), top))
            else:
                outer.append((cell(i, k), top))
            if i == 0:
                outer.append((cell(i, k), [number(0, 0, k), number(0, 0, k + 1), number(0, 1, k + 1), number(0, 1, k)]))
            if k == 0:
                outer.append((cell(i, k), [number(i, 0, 0), number(i, 1, 0), number(i + 1, 1, 0), number(i + 1, 0, 0)]))
            outer.append((cell(i, k), [number(i, 0, k), number(i + 1, 0, k), number(i + 1, 0, k + 1), number(i, 0, k + 1)]))
            outer.append((cell(i, k), [number(i, 1, k), number(i, 1, k + 1), number(i + 1, 1, k + 1), number(i + 1, 1, k)]))
    inner.sort(key=lambda f: f[:2])
    mesh = os.path.join(folder, "constant", "polyMesh", "")
    faces = [f[2] for f in inner] + [f[1] for f in outer]
    _write(mesh + "points", "vectorField", _list(points))
    _write(mesh + "faces", "faceList", _list(["4(" + " ".join(map(str, f)) + ")" for f in faces]))
    _write(mesh + "owner", "labelList", _list([str(f[0]) for f in inner + outer]))
    _write(mesh + "neighbour", "labelList", _list([str(f[1]) for f in inner]))
    _write(mesh + "boundary", "polyBoundaryMesh",
           f"1\n(\nwalls {{ type wall; nFaces {len(outer)}; startFace {len(inner)}; }}\n)\n")
    return np.array([(0.5 * (xs[i] + xs[i + 1]), 0.5 * WIDTH, 0.5 * (zs[k] + zs[k + 1])) for k in range(nz) for i in range(nx)])


def writeAlpha(folder, time, centres, level, nz=8):
    alpha = np.clip((level - centres[:, 2]) * nz / HEIGHT + 0.5, 0, 1)
    _write(os.path.join(folder, time, "alpha.water"), "volScalarField",
           "dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar>\n" + _list([repr(float(a)) for a in alpha])
           + ";\nboundaryField { walls { type zeroGradient; } }")


def writeCase(folder, isDecomposed):
    os.makedirs(os.path.join(folder, "system"))
    _write(os.path.join(folder, "system", "controlDict"), "dictionary", "startTime 0; endTime 1; deltaT 1; writeInterval 1;")
    halves = [("processor0", 0, 1, 4), ("processor1", 1, 2, 4)] if isDecomposed else [("", 0, 2, 8)]
    for name, x0, x1, nx in halves:
        part = os.path.join(folder, name) if name else folder
        centres = writeMesh(part, x0, x1, nx)
        writeAlpha(part, "0", centres, LEVEL)
        writeAlpha(part, "0.5", centres, LEVEL + 0.125 * (centres[:, 0] > 1))


class Fields(unittest.TestCase):
    def test_levels_volumes_and_samples(self):
        for isDecomposed in (False, True):
            with self.subTest(decomposed=isDecomposed), tempfile.TemporaryDirectory() as folder:
                writeCase(folder, isDecomposed)
                self.assertEqual(flotsam.times(folder), [0, 0.5])
                self.assertEqual(flotsam.nearestTime(folder, "last"), 0.5)
                self.assertAlmostEqual(flotsam.waterVolume(folder, 0), LENGTH * WIDTH * LEVEL, places=6)
                levels = flotsam.waterLevel(folder, 0.5, [0.1, (1.9, 0.2), 3])
                np.testing.assert_allclose(levels, [LEVEL, LEVEL + 0.125, np.nan], atol=2e-3)
                highest = flotsam.waterLevel(folder, 0, [0.6], method="highest")
                np.testing.assert_allclose(highest, LEVEL, atol=2e-3)
                values = flotsam.sample(folder, 0, [(1.0, 0.25, 0.1), (0.5, 0.2, 0.9)], ["alpha.water"])["alpha.water"]
                np.testing.assert_allclose(values, [1, 0], atol=1e-6)
                bounds = flotsam.waterSurface(folder, 0).GetBounds()
                np.testing.assert_allclose(bounds, [0, LENGTH, 0, WIDTH, LEVEL, LEVEL], atol=1e-6)
                self.assertEqual(flotsam.grid(folder, 0).GetNumberOfPoints(), 9 * 2 * 9)

    def test_volume_beside_solids(self):
        with tempfile.TemporaryDirectory() as folder:
            writeCase(folder, False)
            _write(os.path.join(folder, "0.5", "solid"), "volScalarField",
                   "dimensions [0 0 0 0 0 0 0];\ninternalField uniform 0.25;\nboundaryField { walls { type zeroGradient; } }")
            self.assertAlmostEqual(flotsam.waterVolume(folder, 0), LENGTH * WIDTH * LEVEL, places=6)
            self.assertAlmostEqual(flotsam.waterVolume(folder, 0.5), 0.75 * LENGTH * WIDTH * (LEVEL + 0.5 * 0.125), places=6)

    def test_mistakes_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            writeCase(folder, False)
            with self.assertRaisesRegex(flotsam.CaseError, "no field T .* there are: alpha.water"):
                flotsam.sample(folder, 0, [(0, 0, 0)], ["T"])
            with self.assertRaisesRegex(flotsam.CaseError, "no such file"):
                flotsam.history(folder)
        with self.assertRaisesRegex(flotsam.CaseError, "no such case"):
            flotsam.times(folder)


class BodyHistory(unittest.TestCase):
    def test_series_are_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, os.path.join(folder, "bodies.h5")], check=True)
            h = flotsam.history(folder)
        self.assertEqual((h.bodies, h.structures), (["bar"], ["post"]))
        self.assertEqual((h["bar"].mass, h["post"].volume, h["bar"].longest, h["bar"].thinnest), (0.5, 2e-3, 1.5, 0.25))
        np.testing.assert_allclose(h["bar"].position[:, 0], h.time)
        np.testing.assert_allclose(h["bar"].orientation[-1], [1, 0, 0, 0])
        np.testing.assert_allclose(h.at("bar", "position", 0.123), [0.123, 0, 0])
        np.testing.assert_allclose(h.mean("post", "fluidForce", 0.2, 0.4), [0.3, 0, 2])
        self.assertEqual(h["bar"].contacts.sum(), 51)
        np.testing.assert_allclose(flotsam.sumForce(h, ["bar", "post"])[-1], [1, 0, 2])
        np.testing.assert_allclose(flotsam.captured(h, lambda x: x[:, 0] > 0.5).sum(), 50)
        np.testing.assert_allclose(flotsam.captured(h, lambda x: x[:, 0] < 0.5).sum(), 40)  # not before it has come in
        np.testing.assert_array_equal(h.isThere("bar"), (np.arange(101) >= 10) & (np.arange(101) <= 80))
        impact, = flotsam.impacts(h, "post", 1)
        np.testing.assert_allclose(impact[:4], [0.19, 0.23, 5, 0.21])
        np.testing.assert_allclose(impact.impulse, [0.08, 0, 0])
        self.assertEqual((len(flotsam.impacts(h, "post", 4)), flotsam.impacts(h, "post", 6), flotsam.impacts(h, "bar")), (1, [], []))
        np.testing.assert_allclose(h.run["dt"], 0.01)
        np.testing.assert_allclose(h.surface["time"], [0, 0.5, 1])
        np.testing.assert_allclose(h.surface["points"][8 + 1], [1.5, 0, 0])
        self.assertEqual(h.restraints["names"], ["mooring"])
        np.testing.assert_allclose(h.restraints["tension"], [0, 1.5, 3])
        drawn = [flotsam.restraintLines(h, time) for time in (0, 0.4, 1)]
        self.assertEqual([lines.GetNumberOfLines() for lines in drawn], [1, 1, 0])      # the broken one is left out
        np.testing.assert_allclose(drawn[1].GetBounds(), [0, 0.5, 0, 2, 0, 0])

    def test_tables_of_runs_that_went_on(self):
        parts = {"0/left.dat": [1, 2, 3], "2/left.dat": [9], "2/left_1.dat": [3.5, 4, 5], "10/left.dat": [11], "11/left.dat": []}  # later files of a time are newer; the last run was at its end
        with tempfile.TemporaryDirectory() as folder:
            for name, times in parts.items():
                path = os.path.join(folder, "postProcessing", "restraints", name)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w", encoding="utf-8") as out:
                    out.write("# Time\n" + "".join(f"{time} {name.split('/')[0]}\n" for time in times))
            table = flotsam.stepTable(folder, "restraints", "left.dat")
            with self.assertRaisesRegex(flotsam.CaseError, "right.dat: no such file; there are: left.dat"):
                flotsam.stepTable(folder, "restraints", "right.dat")
        np.testing.assert_array_equal(table, [[1, 0], [2, 0], [3.5, 2], [4, 2], [5, 2], [11, 10]])

    def test_outside_of_the_water_has_no_faces_within_it(self):
        """Columns of a hexahedron and a polyhedron, as snappyHexMesh makes them, side by side and half full."""
        grid, points, level, corners = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), vtk.vtkDoubleArray(), {}
        level.SetName("water")
        for x in range(4):
            for y in range(2):
                for z in range(3):
                    corners[x, y, z] = points.InsertNextPoint(x, y, z)
                    level.InsertNextValue(1.25 - 0.5 * z)   # 0.5 at z = 1.5
        grid.SetPoints(points)
        grid.GetPointData().AddArray(level)
        for x in range(3):
            for z in range(2):
                p = [corners[x + i, j, z + k] for i, j, k in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
                faces = [[p[i] for i in face] for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (0, 4, 7, 3), (1, 2, 6, 5))]
                if x != 1:
                    grid.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, p)
                    continue
                stream = vtk.vtkIdList()
                for n in [len(faces)] + [n for face in faces for n in [len(face)] + face]:
                    stream.InsertNextId(n)
                grid.InsertNextCell(vtk.VTK_POLYHEDRON, stream)
        read, flotsam.grid = flotsam.grid, lambda case, time: grid
        try:
            body = flotsamScene.waterBody("", 0, alpha="water")
        finally:
            flotsam.grid = read
        triangles, mass = vtk.vtkTriangleFilter(), vtk.vtkMassProperties()
        triangles.SetInputData(body)
        mass.SetInputConnection(triangles.GetOutputPort())
        self.assertAlmostEqual(mass.GetSurfaceArea(), 2 * (3 * 1 + 3 * 1.5 + 1 * 1.5), 6)    # of a box of 3 x 1 x 1.5

    def test_largest_mean_over_a_second(self):
        time = np.linspace(0, 4, 401)
        bump = np.where((time > 1.5) & (time <= 2), 6.0, 0.0)   # a heap that breaks up long before the end
        self.assertLess(abs(driftwood.largestMean(time, bump) - 3.0), 0.05)
        self.assertLess(abs(driftwood.largestMean(time[:50], bump[:50] + 2) - 2.0), 1e-12)   # shorter than a second: of all


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
