// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/meshAdapter.H"

#include "algebra/meshHalo.hpp"
#include "foam/simplexSplit.H"
#include "foam/splitOrder.H"

#include "cyclicPolyPatch.H"
#include "emptyPolyPatch.H"
#include "globalIndex.H"
#include "globalMeshData.H"
#include "labelIOList.H"
#include "processorCyclicPolyPatch.H"
#include "processorPolyPatch.H"
#include "syncTools.H"
#include "wedgePolyPatch.H"

using namespace Foam;

#include <algorithm>

namespace flotsam
{
namespace
{

void checkPatches(const polyMesh& mesh)
{
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        const bool isCyclic = patch.coupled() && (!isA<processorPolyPatch>(patch) || isA<processorCyclicPolyPatch>(patch));
        if (isCyclic || isA<wedgePolyPatch>(patch))
        {
            FatalErrorInFunction << "patch " << patch.name() << " of " << mesh.meshDir() << " is of type " << patch.type()
                                 << ", which this solver does not have." << nl
                                 << "Types it has: patch, wall, symmetryPlane, symmetry, empty (2D), processor." << nl
                                 << (isCyclic ? "Model the whole domain, or use symmetryPlane on both sides."
                                              : "Model an axisymmetric flow in 3D, or a sector of it between symmetryPlane patches.")
                                 << exit(FatalError);
        }
    }
}

/// Baffles: two faces on the same points. The unknowns are those of points, so that both sides would have the same fluid.
void checkBaffles(const polyMesh& mesh)
{
    struct Side { std::vector<label> points; label face; };
    std::vector<Side> sides;
    for (label f = mesh.nInternalFaces(); f < mesh.nFaces(); ++f)
    {
        sides.push_back({{mesh.faces()[f].begin(), mesh.faces()[f].end()}, f});
        std::sort(sides.back().points.begin(), sides.back().points.end());
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.points < b.points; });
    const auto pair = std::adjacent_find(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.points == b.points; });
    const bool isAny = pair != sides.end();
    if (!returnReduce(isAny, orOp<bool>())) return;
    const polyBoundaryMesh& patches = mesh.boundaryMesh();
    FatalErrorInFunction << "the mesh in " << mesh.meshDir() << " has baffles, pairs of faces on the same points";
    if (isAny)
        FatalError << ": patches " << patches[patches.whichPatch(pair->face)].name() << " and " << patches[patches.whichPatch((pair + 1)->face)].name() << " at "
                   << mesh.faceCentres()[pair->face];
    FatalError << "." << nl << "This solver's unknowns are those of points: the fluid would go through. Give each side points of its own: mergeOrSplitBaffles -split -overwrite"
               << " (before decomposePar)." << exit(FatalError);
}

bool isPlanar(const polyMesh& mesh)
{
    label nEmpty = 0;
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        nEmpty += isA<emptyPolyPatch>(patch) ? patch.size() : 0;
    }
    reduce(nEmpty, sumOp<label>());
    if (nEmpty > 0 && mesh.nGeometricD() != 2)
    {
        FatalErrorInFunction << "the empty patches of " << mesh.meshDir() << " leave " << mesh.nGeometricD()
                             << " dimensions; 2 (one empty direction) or 3 (none) are possible. "
                             << "Give the faces of one direction only the type empty." << exit(FatalError);
    }
    return nEmpty > 0;
}

/// A processor addressing file of decomposePar; empty when any rank has none that fits.
labelList readAddressing(const polyMesh& mesh, const word& name, label size)
{
    labelIOList addressing(IOobject(name, mesh.facesInstance(), polyMesh::meshSubDir, mesh, IOobject::READ_IF_PRESENT, IOobject::NO_WRITE, false));
    return returnReduce(addressing.size() == size, andOp<bool>()) ? labelList(addressing) : labelList();
}

/// Do all copies of a point carry the same number? Not when the mesh was changed after decomposePar.
bool isSameOnAllRanks(const polyMesh& mesh, const labelList& number)
{
    labelList highest(number), lowest(number);
    syncTools::syncPointList(mesh, highest, maxEqOp<label>(), label(-1));
    syncTools::syncPointList(mesh, lowest, minEqOp<label>(), labelMax);
    return returnReduce(highest == lowest, andOp<bool>());
}

/// A number per point, the same on every rank that has the point: that of the undecomposed mesh where it is known
/// (the split then does not depend on the decomposition).
labelList pointKeys(const polyMesh& mesh)
{
    if (!Pstream::parRun())
    {
        return identity(mesh.nPoints());
    }
    labelList keys = readAddressing(mesh, "pointProcAddressing", mesh.nPoints());
    const bool isRead = returnReduce(keys.size() == mesh.nPoints(), andOp<bool>());
    if (!isRead || !isSameOnAllRanks(mesh, keys))
    {
        labelList uniquePoints;
        mesh.globalData().mergePoints(keys, uniquePoints);
    }
    return keys;
}

/// Keys of the centre points: after those of all points, by the number of the cell.
std::vector<std::int64_t> centreKeys(const polyMesh& mesh, const labelList& keys, const std::vector<label>& centreCell)
{
    label highest = -1;
    for (const label key : keys)
    {
        highest = max(highest, key);
    }
    reduce(highest, maxOp<label>());
    const labelList original = Pstream::parRun() ? readAddressing(mesh, "cellProcAddressing", mesh.nCells()) : identity(mesh.nCells());
    const globalIndex cells(mesh.nCells());
    std::vector<std::int64_t> result;
    for (const label celli : centreCell)
    {
        const label cell = original.size() == mesh.nCells() ? original[celli] : cells.toGlobal(celli);
        result.push_back(std::int64_t(highest) + 1 + cell);
    }
    return result;
}

/// Names and types of the patches the solver sees, and their numbers per boundary face (-1: processor, empty).
labelList listPatches(const polyMesh& mesh, LocalSimplices& local)
{
    labelList patchOfFace(mesh.nFaces() - mesh.nInternalFaces(), -1);
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        if (isA<processorPolyPatch>(patch) || isA<emptyPolyPatch>(patch))
        {
            continue;
        }
        forAll(patch, i)
        {
            patchOfFace[patch.start() - mesh.nInternalFaces() + i] = label(local.patchNames.size());
        }
        local.patchNames.push_back(patch.name());
        local.patchTypes.push_back(patch.type());
    }
    return patchOfFace;
}

/// Vertices of the split -> nodes without gaps, in the order of the vertices; -1 for points no simplex uses.
std::vector<int> numberVertices(const SimplexSplit& split, label nPoints)
{
    std::vector<int> node(nPoints + split.centres.size(), -1);
    for (const int vertex : split.elements)
    {
        node[vertex] = 0;
    }
    int next = 0;
    for (int& number : node)
    {
        number = number < 0 ? -1 : next++;
    }
    return node;
}

void fillNodes(const polyMesh& mesh, const SimplexSplit& split, const labelList& keys, const std::array<int, 3>& axes,
    const std::vector<int>& node, LocalSimplices& local)
{
    const label nPoints = mesh.nPoints();
    const std::vector<std::int64_t> centreKey = centreKeys(mesh, keys, split.centreCell);
    for (std::size_t vertex = 0; vertex < node.size(); ++vertex)
    {
        if (node[vertex] < 0)
        {
            continue;
        }
        const bool isPoint = label(vertex) < nPoints;
        const point& x = isPoint ? mesh.points()[vertex] : split.centres[vertex - nPoints];
        local.nodeKey.push_back(isPoint ? std::int64_t(keys[vertex]) : centreKey[vertex - nPoints]);
        for (int d = 0; d < local.dim; ++d)
        {
            local.x.push_back(x[axes[d]]);
        }
    }
    local.elements.reserve(split.elements.size());
    for (const int vertex : split.elements)
    {
        local.elements.push_back(node[vertex]);
    }
}

} // namespace

MeshAdapter makeSimplexMesh(const polyMesh& mesh, MPI_Comm comm, int vertical)
{
    checkPatches(mesh);
    checkBaffles(mesh);
    const bool planar = isPlanar(mesh);
    const labelList keys = pointKeys(mesh);
    const MeshPlane plane = planar ? findPlane(mesh) : MeshPlane{{0, 1, 2}, -0.5, 0.5};

    LocalSimplices local;
    local.dim = planar ? 2 : 3;
    const labelList patchOfFace = listPatches(mesh, local);
    const bool isAcrossPlane = planar && vertical == plane.axes[2];
    const labelList order = splitOrder(mesh, keys, vertical < 0 || isAcrossPlane ? plane.axes[planar ? 1 : 2] : vertical);
    SimplexSplit split = planar ? splitIntoTriangles(mesh, plane, order, patchOfFace) : splitIntoTetrahedra(mesh, order, patchOfFace);
    const std::vector<int> node = numberVertices(split, mesh.nPoints());
    fillNodes(mesh, split, keys, plane.axes, node, local);
    local.facePatch.swap(split.facePatch);

    DistributedSimplices distributed = distributeSimplices(local, comm);
    MeshAdapter adapter;
    adapter.mesh = std::move(distributed.mesh);
    adapter.mesh.axes = plane.axes;
    adapter.mesh.planeOffset = planar ? 0.5 * (plane.lower + plane.upper) : 0;
    adapter.mesh.thickness = plane.upper - plane.lower;

    adapter.pointNode.setSize(mesh.nPoints());
    forAll(adapter.pointNode, i)
    {
        const int input = node[split.pointVertex[i]];
        adapter.pointNode[i] = input < 0 ? -1 : distributed.nodeOfInput[input];
    }
    adapter.cellStart.transfer(split.cellStart);
    adapter.cellElements.setSize(label(distributed.elementOfInput.size()));
    std::copy(distributed.elementOfInput.begin(), distributed.elementOfInput.end(), adapter.cellElements.begin());
    return adapter;
}

double collectCell(const MeshAdapter& adapter, int cell, std::vector<int>& nodes)
{
    const SimplexMesh& mesh = adapter.mesh;
    const int n = mesh.dim + 1;
    nodes.clear();
    double volume = 0;
    for (int k = adapter.cellStart[cell]; k < adapter.cellStart[cell + 1]; ++k)
    {
        const std::size_t e = adapter.cellElements[k];
        volume += mesh.volume[e];
        nodes.insert(nodes.end(), &mesh.elements[e*n], &mesh.elements[e*n] + n);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return volume;
}

} // namespace flotsam
