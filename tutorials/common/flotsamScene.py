# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a case: renderScene (three dimensions, VTK) and renderField2d (two dimensions, matplotlib).

Needs no screen: VTK of Debian draws through X, so an Xvfb is started for the life of the script where there is no DISPLAY.
"""

import atexit
import os
import select
import shutil
import subprocess

import numpy as np
import vtkmodules.all as vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import flotsam
import patchSurfaces

COLOURS = {"water": (0.20, 0.47, 0.75), "body": (0.52, 0.33, 0.16), "structure": (0.55, 0.56, 0.58),
           "line": (0.75, 0.10, 0.10), "floor": (0.86, 0.82, 0.74), "text": (0.10, 0.10, 0.10)}
DIRECTIONS = {"perspective": (-0.55, -1.0, 0.55), "side": (0, -1, 0), "top": (0, 0, 1), "front": (-1, 0, 0),
              "back": (1, 0, 0), "downstream": (0.75, -1.0, 0.55)}  # from the scene to the eye
FLAT = ("side", "top", "front", "back")  # drawn without perspective: lengths can be compared


# --- display ----------------------------------------------------------------------------------------------------------

def ensureDisplay():
    """Starts an Xvfb when there is no DISPLAY; it ends with the script."""
    if os.environ.get("DISPLAY"):
        return
    if not shutil.which("Xvfb"):
        raise flotsam.CaseError("pictures need an X display or Xvfb: install the package xvfb")
    reading, writing = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    atexit.register(_end, server, reading)  # the server ends at once when nobody holds the pipe's reading end
    os.close(writing)
    ready, _, _ = select.select([reading], [], [], 30)
    number = os.read(reading, 16).decode().strip() if ready else ""
    if not number:
        raise flotsam.CaseError("Xvfb did not start within 30 s; try it by hand: Xvfb :99")
    os.environ["DISPLAY"] = ":" + number


def _end(server, pipe):
    server.terminate()
    server.wait()
    os.close(pipe)


# --- parts of a scene -------------------------------------------------------------------------------------------------

def _actor(data, colour, opacity=1.0, smooth=False):
    source = data
    if smooth:
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(data)
        normals.SetFeatureAngle(40)
        normals.Update()
        source = normals.GetOutput()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(source)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*colour)
    look.SetOpacity(opacity)
    look.SetAmbient(0.25)
    look.SetDiffuse(0.85)
    look.SetSpecular(0.3 if opacity < 1 else 0.1)
    look.SetSpecularPower(30)
    return actor


def _surface(data):
    geometry = vtk.vtkGeometryFilter()
    geometry.SetInputData(data)
    geometry.Update()
    return geometry.GetOutput()


def waterBody(case, time, alpha=flotsam.ALPHA, level=0.5):
    """vtkPolyData: the closed outside of the water (alpha > level), with the walls it stands at.

    Its free surface and the wet part of the mesh's outside, each on its own: the outside of a clipped mesh would have faces within the water wherever
    polyhedra (of snappyHexMesh) are divided otherwise than their neighbours."""
    mesh = flotsam.grid(case, time)
    if not mesh.GetPointData().HasArray(alpha):
        raise flotsam.CaseError(f"{case}: no field {alpha} at time {time}")
    mesh.GetPointData().SetActiveScalars(alpha)
    free = vtk.vtkContourFilter()
    free.SetInputData(mesh)
    free.SetValue(0, level)
    wet = vtk.vtkClipPolyData()
    wet.SetInputData(_surface(mesh))
    wet.SetValue(level)
    both = vtk.vtkAppendPolyData()
    both.AddInputConnection(free.GetOutputPort())
    both.AddInputConnection(wet.GetOutputPort())
    both.Update()
    return both.GetOutput()


def memberSurfaces(history, time):
    """[(name, isStructure, vtkPolyData)] of the bodies and structures at the surface record nearest to `time`, but bodies that have left or are to come."""
    stored = history.surface
    if not stored or not len(stored["time"]):
        return []
    k = int(np.argmin(np.abs(stored["time"] - time)))
    nPoints = len(stored["points"]) // len(stored["time"])
    points = stored["points"][k * nPoints:(k + 1) * nPoints].astype(float)
    result = []
    for names, isStructure in ((history.bodies, False), (history.structures, True)):
        for name in names:
            path = ("structures/" if isStructure else "bodies/") + name
            member = history[path]
            triangles = stored["triangles"][stored["member"] == member.number]
            isThere = np.interp(stored["time"][k], history.time, history.isThere(path)) > 0.5
            if len(triangles) and isThere:
                result.append((name, isStructure, _polyData(points, triangles)))
    return result


def _polyData(points, triangles):
    used, local = np.unique(triangles, return_inverse=True)
    data = vtk.vtkPolyData()
    vtkPoints = vtk.vtkPoints()
    vtkPoints.SetData(numpy_to_vtk(np.ascontiguousarray(points[used]), deep=True))
    data.SetPoints(vtkPoints)
    cells = vtk.vtkCellArray()
    cells.SetData(3, numpy_to_vtkIdTypeArray(local.reshape(-1).astype(np.int64), deep=True))
    data.SetPolys(cells)
    return data


def _floor(bounds, up):
    """The lower face of the domain's box, a little below it: in one plane with the water's own it shows through in specks."""
    plane = vtk.vtkPlaneSource()
    corner = [bounds[0], bounds[2], bounds[4]]
    corner[up] -= 2e-3 * (bounds[2 * up + 1] - bounds[2 * up])
    ends = []
    for d in (d for d in range(3) if d != up):
        end = list(corner)
        end[d] = bounds[2 * d + 1]
        ends.append(end)
    plane.SetOrigin(corner)
    plane.SetPoint1(ends[0])
    plane.SetPoint2(ends[1])
    plane.Update()
    return plane.GetOutput()


# --- three dimensions -------------------------------------------------------------------------------------------------

def renderScene(case, time, file, camera="perspective", bounds=None, size=(1600, 900), zoom=1.0, up=2, history=None,
                patches=None, floor=True, waterOpacity=0.45, title=None, colours=None, alpha=flotsam.ALPHA):
    """Writes a PNG of the scene at the written time nearest to `time`: water, bodies (brown), structures (grey), restraints (red lines), floor, walls of the mesh
    within its box (buildings, steps, banks).

    camera   one of DIRECTIONS, or (dx, dy, dz) from the scene to the eye, or a dict with position, focus[, viewUp]
    bounds   (xmin, xmax, ymin, ymax, zmin, zmax) the camera frames; default: the whole mesh
    zoom     > 1 comes nearer
    history  a flotsam.History; default: the case's, where it has one
    patches  names of mesh patches to draw as the floor instead of the bottom of the domain's box and the walls within it
    title    text in the upper left corner; default: the time; "" for none
    colours  {member name: (r, g, b)} for single bodies or structures
    Returns the written time that is shown.
    """
    ensureDisplay()
    time = flotsam.nearestTime(case, time)
    mesh = flotsam.grid(case, time)
    if history is None and flotsam.historyFile(case):
        history = flotsam.history(case)

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    renderer.SetBackground2(0.80, 0.87, 0.94)
    renderer.GradientBackgroundOn()
    if floor:
        ground = patchSurfaces.ofPatches(case, time, patches) if patches else _floor(mesh.GetBounds(), up)
        renderer.AddActor(_actor(ground, COLOURS["floor"]))
    inner = patchSurfaces.innerWalls(case, time, mesh.GetBounds()) if floor and not patches else None
    if inner:
        actor = _actor(inner, COLOURS["floor"])
        actor.GetProperty().FrontfaceCullingOn()    # normals point out of the fluid: walls between it and the eye are not drawn
        renderer.AddActor(actor)
    for name, isStructure, data in memberSurfaces(history, time) if history else []:
        colour = (colours or {}).get(name, COLOURS["structure" if isStructure else "body"])
        renderer.AddActor(_actor(data, colour, smooth=True))
    lines = flotsam.restraintLines(history, time) if history else None
    if lines:
        actor = _actor(lines, COLOURS["line"])
        actor.GetProperty().SetLineWidth(max(2, size[1] // 150))
        renderer.AddActor(actor)
    if waterOpacity > 0 and mesh.GetPointData().HasArray(alpha):
        water = waterBody(case, time, alpha)
        if water.GetNumberOfCells():
            renderer.AddActor(_actor(water, COLOURS["water"], waterOpacity, smooth=True))
    outline = vtk.vtkOutlineFilter()
    outline.SetInputData(mesh)
    outline.Update()
    renderer.AddActor(_actor(outline.GetOutput(), (0.45, 0.45, 0.45)))
    _addTitle(renderer, f"t = {time:.3f} s" if title is None else title, size)
    _aim(renderer, camera, mesh.GetBounds() if bounds is None else bounds, zoom, up, size[0] / size[1])
    _addLights(renderer, up)
    _writePng(renderer, file, size)
    return time


def stack(pictures, file, width=1000):
    """Pictures below each other, small enough for a page."""
    import matplotlib.image
    from PIL import Image   # comes with matplotlib

    rows = [matplotlib.image.imread(name)[..., :3] for name in pictures]
    image = Image.fromarray((255 * np.concatenate(rows)).astype(np.uint8))
    image.resize((width, round(width * image.height / image.width)), Image.LANCZOS).save(file, optimize=True)


def _addLights(renderer, up):
    """One light at the eye, one fixed above the scene: a horizontal bed must not be black in a flat view."""
    renderer.AutomaticLightCreationOff()
    eye = vtk.vtkLight()
    eye.SetLightTypeToHeadlight()
    eye.SetIntensity(0.5)
    renderer.AddLight(eye)
    sun = vtk.vtkLight()
    sun.SetLightTypeToSceneLight()
    direction = [-0.3, -0.3, -0.3]
    direction[up] = 1.0
    sun.SetPosition(*direction)
    sun.SetFocalPoint(0, 0, 0)
    sun.SetIntensity(0.55)
    renderer.AddLight(sun)


def _addTitle(renderer, text, size):
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    look = actor.GetTextProperty()
    look.SetFontSize(max(12, size[1] // 30))
    look.SetColor(*COLOURS["text"])
    look.SetVerticalJustificationToTop()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(0.015, 0.975)
    renderer.AddActor2D(actor)


def _aim(renderer, camera, bounds, zoom, up, aspect):
    eye = renderer.GetActiveCamera()
    viewUp = [0.0, 0.0, 0.0]
    viewUp[up] = 1.0
    if isinstance(camera, dict):
        eye.SetPosition(*camera["position"])
        eye.SetFocalPoint(*camera["focus"])
        eye.SetViewUp(*camera.get("viewUp", viewUp))
        renderer.ResetCameraClippingRange()
    else:
        if isinstance(camera, str) and camera not in DIRECTIONS:
            raise ValueError(f"renderScene: camera '{camera}'; allowed: {', '.join(DIRECTIONS)}, a direction or a dict")
        direction = np.array(DIRECTIONS[camera] if isinstance(camera, str) else camera, dtype=float)
        if up == 1:  # the named directions are given for z upwards
            direction = direction[[0, 2, 1]] * (1, 1, -1) if isinstance(camera, str) else direction
        if np.linalg.norm(np.cross(direction, viewUp)) < 1e-6 * np.linalg.norm(direction):
            viewUp = [0.0, 1.0, 0.0] if up != 1 else [0.0, 0.0, -1.0]
        middle = 0.5 * (np.array(bounds[0::2]) + np.array(bounds[1::2]))
        eye.SetFocalPoint(*middle)
        eye.SetPosition(*(middle + direction))
        eye.SetViewUp(*viewUp)
        eye.SetViewAngle(25)
        eye.SetParallelProjection(isinstance(camera, str) and camera in FLAT)
        _frame(renderer, np.array(bounds, dtype=float), aspect)
    eye.Zoom(zoom)


def _frame(renderer, bounds, aspect):
    """Moves the eye along its direction until the box just fits (VTK's ResetCamera frames the sphere around it)."""
    eye = renderer.GetActiveCamera()
    focus, position = np.array(eye.GetFocalPoint()), np.array(eye.GetPosition())
    back = (position - focus) / np.linalg.norm(position - focus)
    right = np.cross(np.array(eye.GetViewUp()), back)
    right /= np.linalg.norm(right)
    top = np.cross(back, right)
    corners = np.array([[x, y, z] for x in bounds[:2] for y in bounds[2:4] for z in bounds[4:]]) - focus
    tangent = np.tan(np.radians(eye.GetViewAngle() / 2))
    needed = [c @ back + max(abs(c @ top) / tangent, abs(c @ right) / (tangent * aspect)) for c in corners]
    eye.SetPosition(*(focus + back * 1.06 * max(needed)))
    eye.SetParallelScale(1.04 * max(max(abs(c @ top), abs(c @ right) / aspect) for c in corners))
    renderer.ResetCameraClippingRange()


def _writePng(renderer, file, size):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(*size)
    window.SetMultiSamples(0)
    window.SetAlphaBitPlanes(1)
    renderer.SetUseDepthPeeling(1)  # several translucent layers in the right order
    renderer.SetMaximumNumberOfPeels(12)
    renderer.SetOcclusionRatio(0.0)
    renderer.UseFXAAOn()
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(file)
    writer.SetInputData(image.GetOutput())
    writer.Write()
    window.Finalize()


# --- two dimensions ---------------------------------------------------------------------------------------------------

def renderField2d(case, time, file, field=flotsam.ALPHA, normal=2, limits=None, colourMap="Blues", label=None,
                  history=None, bounds=None, size=(10, 5), title=None):
    """Writes a PNG of a field of a 2D case (a vector field: its magnitude), with bodies and structures on top.

    normal   the axis of the empty direction; limits (low, high) of the colours; bounds (left, right, lower, upper)
    """
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import PolyCollection

    time = flotsam.nearestTime(case, time)
    polygons, values = _facesOfPlane(flotsam.grid(case, time), field, normal)
    axes2d = [d for d in range(3) if d != normal]
    figure, axes = plt.subplots(figsize=size, dpi=150)
    faces = PolyCollection(polygons, array=values, cmap=colourMap, edgecolors="face", linewidths=0.2)
    if limits or field.startswith("alpha."):
        faces.set_clim(*(limits or (0, 1)))
    axes.add_collection(faces)
    if history is None and flotsam.historyFile(case):
        history = flotsam.history(case)
    for _, isStructure, data in memberSurfaces(history, time) if history else []:
        points = vtk_to_numpy(data.GetPoints().GetData())[:, axes2d]
        triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        colour = COLOURS["structure" if isStructure else "body"]
        axes.add_collection(PolyCollection(points[triangles], facecolors=[colour], edgecolors=[colour], linewidths=0.3))
    axes.set_aspect("equal")
    axes.autoscale()
    if bounds:
        axes.set_xlim(*bounds[:2])
        axes.set_ylim(*bounds[2:])
    axes.set_xlabel("xyz"[axes2d[0]] + " [m]")
    axes.set_ylabel("xyz"[axes2d[1]] + " [m]")
    axes.set_title(f"t = {time:.3f} s" if title is None else title)
    figure.colorbar(faces, ax=axes, label=label or field, shrink=0.8)
    os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)
    figure.savefig(file, bbox_inches="tight")
    plt.close(figure)
    return time


def _facesOfPlane(mesh, field, normal):
    """Polygons (in the plane) and values of the cells' faces on the lower side of a one-cell-thick mesh."""
    surface = _surface(mesh)
    if not surface.GetCellData().HasArray(field):
        names = [surface.GetCellData().GetArrayName(i) for i in range(surface.GetCellData().GetNumberOfArrays())]
        raise flotsam.CaseError(f"no field {field}; there are: {', '.join(names)}")
    points = vtk_to_numpy(surface.GetPoints().GetData())
    low, high = points[:, normal].min(), points[:, normal].max()
    isLow = points[:, normal] < low + 1e-3 * (high - low)
    offsets = vtk_to_numpy(surface.GetPolys().GetOffsetsArray())
    connectivity = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    values = vtk_to_numpy(surface.GetCellData().GetArray(field))
    values = np.linalg.norm(values, axis=1) if values.ndim > 1 else values
    flat = points[:, [d for d in range(3) if d != normal]]
    polygons, chosen = [], []
    for i in range(len(offsets) - 1):
        corners = connectivity[offsets[i]:offsets[i + 1]]
        if isLow[corners].all():
            polygons.append(flat[corners])
            chosen.append(i)
    return polygons, values[chosen]
