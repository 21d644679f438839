// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/simplexSplit.H"

#include "emptyPolyPatch.H"
#include "foam/faceTriangles.H"

#include <algorithm>

using namespace Foam;

namespace flotsam
{
namespace
{

/// Distance of a point from its plane that is still round-off of the mesh file, over the thickness.
constexpr scalar planeTolerance = 1e-4;

/// Smallest triangle of a face over its area before a point at the centre is taken.
constexpr scalar leastFraction = 1e-4;

[[noreturn]] void failLayers(const polyMesh& mesh, const MeshPlane& plane, const point& where)
{
    FatalErrorInFunction << "the mesh " << mesh.meshDir() << " has empty patches, but it is not one cell thick between two planes normal to "
                         << "xyz"[plane.axes[2]] << " (" << plane.lower << " and " << plane.upper << "): see the cell or point at "
                         << where << "." << nl << "A 2D mesh needs one layer of cells, aligned with the axes; "
                         << "for a 3D flow give the patches another type than empty." << exit(FatalError);
    std::abort();
}

/// For each point the point of the lower plane on the same edge across.
labelList findLowerPoints(const polyMesh& mesh, const MeshPlane& plane)
{
    const scalar tolerance = planeTolerance * (plane.upper - plane.lower);
    labelList lowerPoint(mesh.nPoints(), -1);
    forAll(lowerPoint, i)
    {
        const scalar z = mesh.points()[i][plane.axes[2]];
        if (mag(z - plane.lower) < tolerance)
        {
            lowerPoint[i] = i;
        }
        else if (mag(z - plane.upper) > tolerance)
        {
            failLayers(mesh, plane, mesh.points()[i]);
        }
    }
    for (const face& f : mesh.faces())
    {
        forAll(f, k)
        {
            const label a = f[k], b = f.nextLabel(k);
            if (lowerPoint[a] == a && lowerPoint[b] != b)
            {
                lowerPoint[b] = a;
            }
            else if (lowerPoint[b] == b && lowerPoint[a] != a)
            {
                lowerPoint[a] = b;
            }
        }
    }
    const label lonely = lowerPoint.find(-1);
    if (lonely >= 0)
    {
        failLayers(mesh, plane, mesh.points()[lonely]);
    }
    return lowerPoint;
}

bool liesInLowerPlane(const face& f, const labelList& lowerPoint)
{
    return std::all_of(f.begin(), f.end(), [&](label i) { return lowerPoint[i] == i; });
}

/// The face of each cell in the lower plane.
labelList findLowerFaces(const polyMesh& mesh, const MeshPlane& plane, const labelList& lowerPoint)
{
    labelList lowerFace(mesh.nCells(), -1);
    for (const polyPatch& patch : mesh.boundaryMesh())
    {
        for (label i = 0; i < patch.size() && isA<emptyPolyPatch>(patch); ++i)
        {
            if (liesInLowerPlane(patch[i], lowerPoint))
            {
                label& facei = lowerFace[patch.faceCells()[i]];
                if (facei >= 0)
                {
                    failLayers(mesh, plane, mesh.faceCentres()[patch.start() + i]);
                }
                facei = patch.start() + i;
            }
        }
    }
    const label open = lowerFace.find(-1);
    if (open >= 0)
    {
        failLayers(mesh, plane, mesh.cellCentres()[open]);
    }
    return lowerFace;
}

scalar signedArea(const point& a, const point& b, const point& c, const MeshPlane& plane)
{
    const int i = plane.axes[0], j = plane.axes[1];
    return 0.5 * ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]));
}

void addTriangle(const MeshPlane& plane, const point& x, int apex, const pointField& p, int b, int c, SimplexSplit& split)
{
    if (signedArea(x, p[b], p[c], plane) < 0)
    {
        std::swap(b, c);
    }
    split.elements.insert(split.elements.end(), {apex, b, c});
}

/// Without a new point, or from the face's centre when that leaves (nearly) flat triangles.
void splitFace(const polyMesh& mesh, const MeshPlane& plane, const labelList& order, label celli, label facei,
    std::vector<Triangle>& triangles, SimplexSplit& split)
{
    const pointField& p = mesh.points();
    const face& f = mesh.faces()[facei];
    if (triangulate(p, f, order, {}, triangles) > leastFraction)
    {
        for (const Triangle& t : triangles)
        {
            addTriangle(plane, p[t[0]], t[0], p, t[1], t[2], split);
        }
        return;
    }
    const point& centre = mesh.faceCentres()[facei];
    const vector normal = mesh.faceAreas()[facei];
    const int vertex = mesh.nPoints() + int(split.centres.size());
    split.centreCell.push_back(celli);
    split.centres.push_back(centre);
    forAll(f, k)
    {
        const label b = f[k], c = f.nextLabel(k);
        if ((((p[b] - centre) ^ (p[c] - centre)) & normal) <= 0)
        {
            FatalErrorInFunction << "the cell at " << centre << " cannot be split into triangles of positive area: "
                                 << "it is strongly concave. Run checkMesh -allGeometry and improve the mesh there." << exit(FatalError);
        }
        addTriangle(plane, centre, vertex, p, b, c, split);
    }
}

void markBoundary(const polyMesh& mesh, const labelList& patchOfFace, SimplexSplit& split)
{
    forAll(patchOfFace, i)
    {
        const face& f = mesh.faces()[mesh.nInternalFaces() + i];
        int edge[2], nLower = 0;
        for (label k = 0; k < f.size() && patchOfFace[i] >= 0; ++k)
        {
            if (split.pointVertex[f[k]] == f[k] && nLower < 2)
            {
                edge[nLower++] = f[k];
            }
        }
        if (nLower == 2)
        {
            split.markFace(mesh.faceOwner()[mesh.nInternalFaces() + i], edge, patchOfFace[i]);
        }
    }
}

} // namespace

MeshPlane findPlane(const polyMesh& mesh)
{
    MeshPlane plane{{0, 1, 2}, VGREAT, -VGREAT};
    for (int d = 0; d < 3; ++d)
    {
        if (mesh.geometricD()[d] < 0)
        {
            plane.axes = {(d + 1) % 3, (d + 2) % 3, d};
        }
    }
    for (const point& x : mesh.points())
    {
        plane.lower = min(plane.lower, x[plane.axes[2]]);
        plane.upper = max(plane.upper, x[plane.axes[2]]);
    }
    reduce(plane.lower, minOp<scalar>());
    reduce(plane.upper, maxOp<scalar>());
    return plane;
}

SimplexSplit splitIntoTriangles(const polyMesh& mesh, const MeshPlane& plane, const labelList& order, const labelList& patchOfFace)
{
    SimplexSplit split;
    split.dim = 2;
    split.pointVertex = findLowerPoints(mesh, plane);
    const labelList lowerFace = findLowerFaces(mesh, plane, split.pointVertex);
    split.cellStart.setSize(mesh.nCells() + 1);
    split.elements.reserve(6 * static_cast<std::size_t>(mesh.nCells()));
    std::vector<Triangle> triangles;
    forAll(lowerFace, celli)
    {
        split.cellStart[celli] = label(split.elements.size() / 3);
        splitFace(mesh, plane, order, celli, lowerFace[celli], triangles, split);
    }
    split.cellStart[mesh.nCells()] = label(split.elements.size() / 3);
    split.facePatch.assign(split.elements.size(), -1);
    markBoundary(mesh, patchOfFace, split);
    return split;
}

} // namespace flotsam
