# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and evaluates the results of a case: fields at written times (serial or decomposed), bodies.h5, water levels.

Needs no OpenFOAM: python3-vtk9, python3-h5py, python3-numpy. Pictures are in flotsamScene.py. SI units throughout.
"""

import functools
import os
import re
import sys

try:
    import numpy as np
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    from bodyHistory import CaseError, History, Impact, Member, captured, history, historyFile, impacts, momentumLoad, stepTable, sumForce  # noqa: F401
except ImportError as error:
    sys.exit(f"{sys.executable}: {error}.\nNeeded: python3-numpy python3-h5py python3-vtk9 python3-matplotlib of the distribution and its "
             "interpreter, usually /usr/bin/python3; . scripts/environment.sh finds it as $FLOTSAM_PYTHON.")

ALPHA = "alpha.water"
NODAL = {ALPHA: "pointAlpha", "U": "pointU", "p": "pointP"}  # nodal twin of a volume field, where the solver wrote one


# --- fields -----------------------------------------------------------------------------------------------------------

def isTime(name):
    try:
        return float(name) >= 0
    except ValueError:
        return False


def _timeFolders(folder):
    """{time: folder name} of one case or processor folder; a folder without fields does not count."""
    found = {}
    for name in os.listdir(folder) if os.path.isdir(folder) else []:
        path = os.path.join(folder, name)
        if isTime(name) and os.path.isdir(path) and any(os.path.isfile(os.path.join(path, f)) for f in os.listdir(path)):
            found[float(name)] = name
    return found


def _processors(case):
    names = [n for n in os.listdir(case) if n.startswith("processor") and n[9:].isdigit()]
    return [os.path.join(case, n) for n in sorted(names, key=lambda n: int(n[9:]))]


def _parts(case, time=None):
    """Folders that hold the fields: the case itself, or its processors where these hold more (or the wanted) times."""
    if not os.path.isdir(case):
        raise CaseError(f"{case}: no such case folder")
    processors = _processors(case)
    own = _timeFolders(case)
    theirs = _timeFolders(processors[0]) if processors else {}
    hasMesh = os.path.isdir(os.path.join(case, "constant", "polyMesh"))
    if time is not None:
        wanted = min(set(own) | set(theirs), key=lambda t: abs(t - time), default=None)
        return [case] if wanted in own and (hasMesh or not processors) else processors
    return processors if len(theirs) > len(own) else [case]


def times(case):
    """Written times, ascending, of the case or of its processors (whichever holds more)."""
    return sorted(_timeFolders(_parts(case)[0]))


def nearestTime(case, time):
    """The written time nearest to `time`; "last" and "first" are allowed."""
    written = times(case)
    if not written:
        raise CaseError(f"{case}: no written times; has the solver been run?")
    if time == "last":
        return written[-1]
    if time == "first":
        return written[0]
    return min(written, key=lambda t: abs(t - time))


def _readPart(folder, time):
    reader = vtk.vtkOpenFOAMReader()
    reader.SetFileName(os.path.join(folder, "any.foam"))  # only its folder matters; the file need not exist
    reader.UpdateInformation()
    reader.EnableAllCellArrays()
    reader.EnableAllPointArrays()
    reader.DisableAllPatchArrays()
    reader.SetPatchArrayStatus("internalMesh", 1)
    reader.CreateCellToPointOff()  # done after the parts are joined: no seams
    reader.UpdateTimeStep(time)
    output = reader.GetOutput()
    block = output.GetBlock(0) if output.GetNumberOfBlocks() else None
    if block is None or block.GetNumberOfPoints() == 0:
        raise CaseError(f"{folder}: no mesh or fields could be read at time {time:g}")
    return block


def _addPointData(mesh):
    """Point values of the cell fields: the solver's nodal values where they are written, else the mean of the cells."""
    data = mesh.GetPointData()
    for name, nodal in NODAL.items():
        if data.HasArray(nodal) and not data.HasArray(name):
            twin = data.GetArray(nodal).NewInstance()
            twin.DeepCopy(data.GetArray(nodal))
            twin.SetName(name)
            data.AddArray(twin)
    bare = vtk.vtkUnstructuredGrid()
    bare.CopyStructure(mesh)
    bare.GetCellData().ShallowCopy(mesh.GetCellData())
    convert = vtk.vtkCellDataToPointData()
    convert.SetInputData(bare)
    convert.Update()
    means = convert.GetOutput().GetPointData()
    for i in range(means.GetNumberOfArrays()):
        if not data.HasArray(means.GetArrayName(i)):
            data.AddArray(means.GetArray(i))


@functools.lru_cache(maxsize=2)
def _grid(case, time, folders, _changed):
    parts = [_readPart(folder, time) for folder in folders]
    mesh = parts[0]
    if len(parts) > 1:
        join = vtk.vtkAppendFilter()
        join.MergePointsOn()
        for part in parts:
            join.AddInputData(part)
        join.Update()
        mesh = join.GetOutput()
    _addPointData(mesh)
    return mesh


def grid(case, time):
    """vtkUnstructuredGrid of the whole domain at the written time nearest to `time` (cell data and point data).

    Shared between calls: do not change it.
    """
    case = os.path.abspath(case)
    time = nearestTime(case, time)
    folders = _parts(case, time)
    folder = os.path.join(folders[0], _timeFolders(folders[0])[time])
    return _grid(case, time, tuple(folders), os.path.getmtime(folder))


def emptyAxis(case):
    """The axis across a 2D mesh; None in 3D. From the shape of the written mesh and its empty patches."""
    folder = _parts(case)[0]
    with open(os.path.join(folder, "constant", "polyMesh", "boundary"), encoding="utf-8", errors="replace") as file:
        if not re.search(r"type\s+empty;\s*(inGroups[^;]*;\s*)?nFaces\s+[1-9]", file.read()):
            return None
    bounds = grid(case, nearestTime(case, "last")).GetBounds()
    return int(np.argmin([bounds[2 * d + 1] - bounds[2 * d] for d in range(3)]))


def verticalAxis(case):
    """The axis that gravity acts along most, by constant/g; None without gravity."""
    file = next((name for name in (os.path.join(folder, "constant", "g") for folder in [case, *_processors(case)]) if os.path.isfile(name)), None)
    if file is None:
        return None
    with open(file, encoding="utf-8", errors="replace") as text:
        found = re.search(r"value\s*(?:uniform\s*)?\(\s*(\S+)\s+(\S+)\s+([^\s)]+)\s*\)", text.read())
    try:
        g = np.abs([float(component) for component in found.groups()]) if found else np.zeros(3)
    except ValueError:  # $gravity, #calc: what OpenFOAM makes of it is not known here
        return None
    return int(np.argmax(g)) if g.any() else None


def _array(data, name, what):
    if not data.HasArray(name):
        known = ", ".join(sorted(data.GetArrayName(i) for i in range(data.GetNumberOfArrays())))
        raise CaseError(f"no field {name} in {what}; there are: {known}")
    return vtk_to_numpy(data.GetArray(name))


_cells = {}     # centres and volumes: the mesh is the same at all times, and VTK takes its time over them


def _centresAndVolumes(case, time):
    mesh = grid(case, time)
    key = (os.path.abspath(case), tuple(_parts(case, nearestTime(case, time))), mesh.GetNumberOfCells())
    if key in _cells:
        return _cells[key]
    centres = vtk.vtkCellCenters()
    centres.SetInputData(mesh)
    centres.VertexCellsOff()
    centres.Update()
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(mesh)
    sizes.Update()
    _cells[key] = (vtk_to_numpy(centres.GetOutput().GetPoints().GetData()), vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume")))
    return _cells[key]


def fields(case, time, names):
    """{name: cell values} and "centre" (n x 3), "volume" (n) of the cells."""
    mesh = grid(case, time)
    result = {name: _array(mesh.GetCellData(), name, f"{case} at {time}") for name in names}
    result["centre"], result["volume"] = _centresAndVolumes(case, time)
    return result


def _probe(mesh, points, cellValues=False):
    """Point data of the mesh, interpolated linearly (or its cell data as they are); and a mask of the points inside it."""
    if cellValues:
        source = vtk.vtkUnstructuredGrid()
        source.CopyStructure(mesh)
        source.GetCellData().ShallowCopy(mesh.GetCellData())
        mesh = source
    cloud = vtk.vtkPolyData()
    vtkPoints = vtk.vtkPoints()
    vtkPoints.SetDataTypeToDouble()
    vtkPoints.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    cloud.SetPoints(vtkPoints)
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(cloud)
    probe.SetSourceData(mesh)
    probe.PassPointArraysOff()
    probe.Update()
    output = probe.GetOutput().GetPointData()
    return output, vtk_to_numpy(output.GetArray("vtkValidPointMask")).astype(bool)


def sample(case, time, points, names):
    """{name: values at the points (n x 3)}, linear in between; nan outside the mesh."""
    data, isInside = _probe(grid(case, time), np.atleast_2d(points))
    result = {}
    for name in names:
        values = _array(data, name, f"{case} at {time}").astype(float)
        values[~isInside] = np.nan
        result[name] = values
    return result


def _columns(mesh, stations, up, nSamples):
    """Points of vertical lines, stations x nSamples x 3, at the middles of equal intervals; the interval's length."""
    bounds = np.array(mesh.GetBounds()).reshape(3, 2)
    flat = [d for d in range(3) if d != up]
    heights = np.linspace(bounds[up, 0], bounds[up, 1], nSamples + 1)
    points = np.empty((len(stations), nSamples, 3))
    for i, station in enumerate(stations):
        here = np.atleast_1d(station).astype(float)
        middle = bounds[flat[1]].mean() + 1e-6 * np.ptp(bounds[flat[1]])  # off the faces of an even mesh
        points[i, :, flat[0]] = here[0]
        points[i, :, flat[1]] = here[1] if len(here) > 1 else middle
        points[i, :, up] = 0.5 * (heights[1:] + heights[:-1])
    return points, heights[1] - heights[0]


def _highestCrossing(alpha, heights, level=0.5):
    wet = np.flatnonzero(alpha >= level)
    if not len(wet):
        return np.nan
    k = wet[-1]
    if k + 1 == len(alpha):
        return heights[-1]
    return heights[k] + (alpha[k] - level) / (alpha[k] - alpha[k + 1]) * (heights[k + 1] - heights[k])


def waterLevel(case, time, stations, method="integral", up=2, alpha=ALPHA, nSamples=800):
    """Height of the water surface [m] at stations: x values (in the middle of the domain) or (x, y) pairs.

    "integral": lowest point of the column + the integral of alpha over it: water depth, splashes included, no matter how
    smeared the surface is. "highest": the highest point where alpha = 0.5. nan where there is no mesh (or no water).
    `up`: axis against gravity; the stations are given in the other two, in their order.
    """
    if method not in ("integral", "highest"):
        raise ValueError(f"waterLevel: method '{method}'; allowed: integral, highest")
    mesh = grid(case, time)
    points, step = _columns(mesh, [stations] if np.isscalar(stations) else stations, up, nSamples)
    # cell values conserve the volume, nodal ones place the surface within a cell
    data, isInside = _probe(mesh, points.reshape(-1, 3), cellValues=method == "integral")
    values = _array(data, alpha, f"{case} at {time}").reshape(points.shape[:2])
    isInside = isInside.reshape(points.shape[:2])
    levels = np.full(len(points), np.nan)
    for i, inside in enumerate(isInside):
        if not inside.any():
            continue
        heights, column = points[i, inside, up], np.clip(values[i, inside], 0, 1)
        levels[i] = _highestCrossing(column, heights) if method == "highest" else (
            heights[0] - 0.5 * step + step * column.sum())
    return levels


def waterVolume(case, time, alpha=ALPHA):
    """Liquid volume in the cells [m^3]: sum of alpha (1 - solid) V, alpha being that of a cell's fluid part. At the start there is no field `solid`: the sum of alpha V."""
    solid = "solid" if grid(case, time).GetCellData().HasArray("solid") else None
    data = fields(case, time, [alpha, *([solid] if solid else [])])
    fluid = 1 - data[solid] if solid else 1
    return float((data[alpha] * fluid * data["volume"]).sum())


def waterSurface(case, time, alpha=ALPHA, level=0.5):
    """vtkPolyData: the surface alpha = level, with the point data of the mesh."""
    mesh = grid(case, time)
    _array(mesh.GetPointData(), alpha, f"{case} at {time}")
    contour = vtk.vtkContourFilter()
    contour.SetInputData(mesh)
    contour.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, alpha)
    contour.SetValue(0, level)
    contour.Update()
    return contour.GetOutput()


def restraintLines(history, time):
    """vtkPolyData: the restraints as lines at the record nearest to `time`; None where there are none. Broken ones are left out."""
    stored = history.restraints
    if not stored or not len(stored["time"]):
        return None
    k = int(np.argmin(np.abs(stored["time"] - time)))
    ends = stored["points"].reshape(len(stored["time"]), -1, 2, 3)[k]
    join = vtk.vtkAppendPolyData()
    join.AddInputData(vtk.vtkPolyData())
    for begin, end in ends[np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) > 0]:
        line = vtk.vtkLineSource()
        line.SetPoint1(begin)
        line.SetPoint2(end)
        line.Update()
        join.AddInputData(line.GetOutput())
    join.Update()
    return join.GetOutput()


# --- report -----------------------------------------------------------------------------------------------------------

def writeSummary(file, title, rows, text=""):
    """Markdown page: rows of (what, value, unit, reference or ""). Numbers are written with four digits."""
    def shown(value):
        return f"{value:.4g}" if isinstance(value, (float, np.floating)) else str(value)
    lines = [f"# {title}", "", "| quantity | value | unit | reference |", "|---|---|---|---|"]
    lines += ["| " + " | ".join(shown(entry) for entry in row) + " |" for row in rows]
    if text:
        lines += ["", text]
    with open(file, "w", encoding="utf-8") as out:
        out.write("\n".join(lines) + "\n")
