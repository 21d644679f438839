# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of the mesh's patches, for pictures."""

import os
import re

import numpy as np
import vtkmodules.all as vtk
from vtkmodules.util.numpy_support import vtk_to_numpy

import flotsam


def ofPatches(case, time, names):
    """Surfaces of mesh patches (a sloping or stepped bed)."""
    join = vtk.vtkAppendPolyData()
    for folder in flotsam._parts(case, time):
        reader = vtk.vtkOpenFOAMReader()
        reader.SetFileName(os.path.join(folder, "any.foam"))
        reader.UpdateInformation()
        known = [reader.GetPatchArrayName(i) for i in range(reader.GetNumberOfPatchArrays())]
        reader.DisableAllPatchArrays()
        for name in names:
            if "patch/" + name not in known:
                patches = ", ".join(k[6:] for k in known if k.startswith("patch/"))
                raise flotsam.CaseError(f"{case}: no patch {name}; there are: {patches}")
            reader.SetPatchArrayStatus("patch/" + name, 1)
        reader.UpdateTimeStep(time)
        collect = vtk.vtkCompositeDataGeometryFilter()
        collect.SetInputConnection(reader.GetOutputPort())
        collect.Update()
        join.AddInputData(collect.GetOutput())
    join.Update()
    return join.GetOutput()


def _walls(folder):
    """Names of the patches of type wall that have faces there."""
    with open(os.path.join(folder, "constant", "polyMesh", "boundary"), encoding="utf-8", errors="replace") as file:
        text = re.sub(r"/\*.*?\*/|//[^\n]*", "", file.read(), flags=re.S)
    return [name for name, entries in re.findall(r"(\w[^\s{}()]*)\s*\{([^}]*)\}", text) if re.search(r"\btype\s+wall\s*;", entries) and re.search(r"nFaces\s+[1-9]", entries)]


def innerWalls(case, time, bounds):
    """vtkPolyData: faces of wall patches that lie in none of the box's planes; None where there are none."""
    names = sorted({name for folder in flotsam._parts(case, time) for name in _walls(folder)})
    if not names:
        return None
    surface = ofPatches(case, time, names)
    near = 1e-6 * max(bounds[2 * d + 1] - bounds[2 * d] for d in range(3))
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float) if surface.GetNumberOfCells() else np.zeros((0, 3))
    cells = surface.GetPolys()
    begin, node = vtk_to_numpy(cells.GetOffsetsArray()), vtk_to_numpy(cells.GetConnectivityArray())
    isOutside = np.zeros(len(begin) - 1, dtype=bool)
    for plane, bound in enumerate(bounds):
        isOff = np.abs(points[node, plane // 2] - bound) > near
        isOutside |= np.add.reduceat(isOff.astype(int), begin[:-1]) == 0 if len(isOutside) else False
    if isOutside.all():
        return None
    chosen = vtk.vtkExtractCells()
    chosen.SetInputData(surface)
    list_ = vtk.vtkIdList()
    for cell in np.flatnonzero(~isOutside):
        list_.InsertNextId(int(cell))
    chosen.SetCellList(list_)
    geometry = vtk.vtkGeometryFilter()
    geometry.SetInputConnection(chosen.GetOutputPort())
    geometry.Update()
    return geometry.GetOutput()
