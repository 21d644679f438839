# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a jam's contacts: lines from body to body and to what holds them, and restraints, as thick and as bright as the force."""
import os

import numpy as np
import vtkmodules.all as vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import contactNetwork
import flotsamScene

COLOUR_MAP = "inferno_r"
FAINTEST = 0.25     # of the colour map: what is fainter is not seen on white


def _contacts(h, time):
    """Those of the write time nearest to `time`, the lines of restraints behind them in `line` and `force`; None where nothing touches."""
    if not len(h.contacts.get("time", [])):
        return None
    found = contactNetwork.at(h, int(np.argmin(np.abs(h.contacts["time"] - time))))
    if not len(found.force):
        return None
    restraints = contactNetwork.linesAt(h, found.time)
    lines = restraints.ends[:, [0, 0, 1]]
    lines[:, 1] = restraints.ends.mean(1)
    return found._replace(line=np.concatenate([found.line, lines]), force=np.concatenate([found.force, restraints.force]))


def _lookup(largest):
    import matplotlib

    colours = matplotlib.colormaps[COLOUR_MAP](np.linspace(FAINTEST, 1, 256))
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for k, colour in enumerate(colours):
        table.SetTableValue(k, *colour)
    table.SetTableRange(0, largest)
    return table


def _tubes(contacts, thickest):
    """Polylines as tubes, whose cross section is as the force."""
    force = np.linalg.norm(contacts.force, axis=1)
    data, points, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    for line in contacts.line:
        cells.InsertNextCell(len(line))
        for p in line:
            cells.InsertCellPoint(points.InsertNextPoint(*p))
    data.SetPoints(points)
    data.SetLines(cells)
    for name, values in (("radius", thickest * np.sqrt(np.repeat(force, 3) / force.max())), ("force", np.repeat(force, 3))):
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("radius")
    tube = vtk.vtkTubeFilter()
    tube.SetInputData(data)
    tube.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    tube.SetNumberOfSides(12)
    tube.CappingOn()
    tube.Update()
    return tube.GetOutput(), force.max()


def _bar(table):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("force [N]")
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.3g")
    bar.SetPosition(0.9, 0.1)
    bar.SetWidth(0.08)
    bar.SetHeight(0.7)
    bar.UnconstrainedFontSizeOn()
    for text, height in ((bar.GetTitleTextProperty(), 22), (bar.GetLabelTextProperty(), 20)):
        text.SetFontSize(height)
        text.SetColor(*flotsamScene.COLOURS["text"])
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    return bar


def _bounds(contacts, surfaces):
    """Of the bodies that touch something."""
    numbers = set(contacts.first) | set(contacts.second)
    points = np.concatenate([contacts.line[: len(contacts.first)].reshape(-1, 3)] + [vtk_to_numpy(data.GetPoints().GetData()) for number, isStructure, data in surfaces if number in numbers and not isStructure])
    margin = 0.05 * np.ptp(points, axis=0).max()
    return np.stack((points.min(0) - margin, points.max(0) + margin), axis=1).ravel()


def renderContacts(time, file, history, camera="perspective", size=(1600, 900), zoom=1.0, up=2):
    """Writes a PNG of the bodies that touch something, seen through, and of the lines of their contacts at the write time nearest to `time`. False where nothing touches."""
    contacts = _contacts(history, time)
    if contacts is None:
        return False
    flotsamScene.ensureDisplay()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    surfaces = [(history[("structures/" if isStructure else "bodies/") + name].number, isStructure, data) for name, isStructure, data in flotsamScene.memberSurfaces(history, contacts.time)]
    for _, isStructure, data in surfaces:
        renderer.AddActor(flotsamScene._actor(data, flotsamScene.COLOURS["structure" if isStructure else "body"], 0.25 if isStructure else 0.16, smooth=True))
    bounds = _bounds(contacts, surfaces)
    tubes, largest = _tubes(contacts, 0.016 * max(np.ptp(bounds.reshape(3, 2), axis=1)))
    table = _lookup(largest)
    actor = flotsamScene._actor(tubes, (0, 0, 0))
    mapper = actor.GetMapper()
    mapper.ScalarVisibilityOn()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("force")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    renderer.AddActor(actor)
    renderer.AddActor2D(_bar(table))
    flotsamScene._addTitle(renderer, f"contacts at t = {contacts.time:.3f} s", size)
    flotsamScene._aim(renderer, camera, bounds, zoom, up, size[0] / size[1])
    flotsamScene._addLights(renderer, up)
    flotsamScene._writePng(renderer, file, size)
    return True


def renderContacts2d(time, file, history, normal=2, size=(10, 5)):
    """The same of a 2D case."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.colors import ListedColormap

    contacts = _contacts(history, time)
    if contacts is None:
        return False
    plane = [d for d in range(3) if d != normal]
    figure, axes = plt.subplots(figsize=size, dpi=150)
    surfaces = []
    for name, isStructure, data in flotsamScene.memberSurfaces(history, contacts.time):
        surfaces.append((history[("structures/" if isStructure else "bodies/") + name].number, isStructure, data))
        points = vtk_to_numpy(data.GetPoints().GetData())[:, plane]
        triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        colour = flotsamScene.COLOURS["structure" if isStructure else "body"]
        axes.add_collection(PolyCollection(points[triangles], facecolors=[colour], linewidths=0, alpha=0.3))
    force = np.linalg.norm(contacts.force, axis=1)
    colours = ListedColormap(matplotlib.colormaps[COLOUR_MAP](np.linspace(FAINTEST, 1, 256)))
    lines = axes.add_collection(LineCollection(contacts.line[:, :, plane], array=force, cmap=colours, linewidths=1 + 4 * np.sqrt(force / force.max()), capstyle="round"))
    lines.set_clim(0, force.max())
    bounds = _bounds(contacts, surfaces).reshape(3, 2)[plane]
    axes.set(aspect="equal", xlim=bounds[0], ylim=bounds[1], xlabel="xyz"[plane[0]] + " [m]", ylabel="xyz"[plane[1]] + " [m]", title=f"contacts at t = {contacts.time:.3f} s")
    figure.colorbar(lines, ax=axes, label="force of a contact or restraint [N]", shrink=0.8)
    os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)
    figure.savefig(file, bbox_inches="tight")
    plt.close(figure)
    return True
