// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/simplexSplit.H"

#include "foam/faceTriangles.H"

#include <algorithm>

using namespace Foam;

namespace flotsam
{

void SimplexSplit::markFace(label cell, const int* vertices, int patch)
{
    const int n = dim + 1;
    for (label e = cellStart[cell]; e < cellStart[cell + 1]; ++e)
    {
        const int* nodes = &elements[static_cast<std::size_t>(e) * n];
        int nFound = 0, opposite = 0;
        for (int a = 0; a < n; ++a)
        {
            const bool isOnFace = std::find(vertices, vertices + dim, nodes[a]) != vertices + dim;
            nFound += isOnFace;
            opposite = isOnFace ? opposite : a;
        }
        if (nFound == dim)
        {
            facePatch[static_cast<std::size_t>(e) * n + opposite] = patch;
            return;
        }
    }
    FatalErrorInFunction << "a boundary face of cell " << cell << " is not the face of a simplex of that cell: "
                         << "the cell's faces do not close it. Run checkMesh." << exit(FatalError);
}

namespace
{

/// Tetrahedra below this fraction of their cell: accept the first apex above `good`, else the best; below `least`
/// (flat tetrahedra of a cell with coplanar faces) take a point at the centre.
constexpr scalar goodFraction = 0.02, leastFraction = 1e-4;

/// Difference of such fractions, and of lengths over the cell's, that may be round-off: other processes have a cell's faces in another order.
constexpr scalar tieMargin = 1e-9;

using Tetrahedron = std::array<int, 4>;

class CellSplitter
{
public:
    CellSplitter(const polyMesh& mesh, const labelList& order)
        : mesh_(mesh), order_(order), faces_(mesh, order), volumes_(mesh.cellVolumes())
    {}

    SimplexSplit split(const labelList& patchOfFace)
    {
        split_.cellStart.setSize(mesh_.nCells() + 1);
        split_.elements.reserve(24 * static_cast<std::size_t>(mesh_.nCells()));
        for (label celli = 0; celli < mesh_.nCells(); ++celli)
        {
            split_.cellStart[celli] = label(split_.elements.size() / 4);
            splitCell(celli);
            for (const Tetrahedron& t : best_)
            {
                split_.elements.insert(split_.elements.end(), t.begin(), t.end());
            }
        }
        split_.cellStart[mesh_.nCells()] = label(split_.elements.size() / 4);
        split_.facePatch.assign(split_.elements.size(), -1);
        split_.pointVertex = identity(mesh_.nPoints());
        markBoundary(patchOfFace);
        return std::move(split_);
    }

private:
    void splitCell(label celli)
    {
        listPoints(celli);
        scalar best = -VGREAT;
        best_.clear();
        for (const label apex : cellPoints_)
        {
            const scalar quality = pull(celli, apex, mesh_.points()[apex]);
            if (quality > best + tieMargin)
            {
                best = quality;
                best_.swap(trial_);
            }
            if (best > goodFraction)
            {
                return;
            }
        }
        if (best < leastFraction)
        {
            splitFromCentre(celli);
        }
    }

    void splitFromCentre(label celli)
    {
        const int vertex = mesh_.nPoints() + int(split_.centres.size());
        const point centre = visiblePoint(celli);
        const scalar quality = pull(celli, vertex, centre);
        if (!(quality > VSMALL))
        {
            FatalErrorInFunction << "cell " << celli << " with its centre at " << mesh_.cellCentres()[celli]
                                 << " cannot be split into tetrahedra of positive volume: it is strongly concave or warped (smallest one "
                                 << quality << " of the cell's volume). Run checkMesh -allGeometry and improve the mesh there."
                                 << exit(FatalError);
        }
        split_.centreCell.push_back(celli);
        split_.centres.push_back(centre);
        best_.swap(trial_);
    }

    /// The point that sees all triangles of the cell from the inside at the largest distance, nearly: from the cell's centre,
    /// away from the triangle that is nearest (or on the wrong side), with steps that shrink.
    point visiblePoint(label celli)
    {
        point x = mesh_.cellCentres()[celli], best = x;
        const scalar length = Foam::cbrt(volumes_[celli]);
        scalar bestDistance = -VGREAT, step = 0.2 * length;
        constexpr int nSteps = 100;
        for (int i = 0; i < nSteps; ++i, step *= 0.96)
        {
            vector inward;
            const scalar distance = nearestTriangle(celli, x, tieMargin * length, inward);
            if (distance > bestDistance + tieMargin * length)
            {
                bestDistance = distance;
                best = x;
            }
            x += step * inward;
        }
        return best;
    }

    /// Signed distance to the plane of the nearest triangle of the cell (positive inside) and that triangle's inward normal; of several within the margin the one whose
    /// points come first.
    scalar nearestTriangle(label celli, const point& x, scalar margin, vector& inward)
    {
        const pointField& p = mesh_.points();
        scalar nearest = VGREAT;
        planes_.clear();
        for (const label facei : mesh_.cells()[celli])
        {
            const scalar sign = mesh_.faceOwner()[facei] == celli ? -1 : 1;
            for (int k = faces_.start[facei]; k < faces_.start[facei + 1]; ++k)
            {
                const Triangle& t = faces_.triangles[k];
                const vector area = (p[t[1]] - p[t[0]]) ^ (p[t[2]] - p[t[0]]);
                const vector normal = sign * area / (mag(area) + VSMALL);
                const scalar distance = (x - p[t[0]]) & normal;
                nearest = min(nearest, distance);
                std::array<label, 3> orders{order_[t[0]], order_[t[1]], order_[t[2]]};
                std::sort(orders.begin(), orders.end());
                planes_.push_back({orders, distance, normal});
            }
        }
        const Plane* first = nullptr;
        for (const Plane& plane : planes_)
            if (plane.distance <= nearest + margin && (!first || plane.orders < first->orders)) first = &plane;
        inward = first->normal;
        return nearest;
    }

    /// The cell's points, lowest order first.
    void listPoints(label celli)
    {
        cellPoints_.clear();
        for (const label facei : mesh_.cells()[celli])
        {
            const face& f = mesh_.faces()[facei];
            cellPoints_.insert(cellPoints_.end(), f.begin(), f.end());
        }
        std::sort(cellPoints_.begin(), cellPoints_.end(), [&](label a, label b) { return order_[a] < order_[b]; });
        cellPoints_.erase(std::unique(cellPoints_.begin(), cellPoints_.end()), cellPoints_.end());
    }

    /// Do all triangles of a face hold the apex? Appends the edges opposite to it.
    bool isFannedFrom(label facei, int apex)
    {
        for (int k = faces_.start[facei]; k < faces_.start[facei + 1]; ++k)
        {
            const Triangle& t = faces_.triangles[k];
            const int at = t[0] == apex ? 0 : t[1] == apex ? 1 : 2;
            if (t[at] != apex)
            {
                return false;
            }
            rim_.push_back(std::minmax(t[(at + 1) % 3], t[(at + 2) % 3]));
        }
        return true;
    }

    /// The same triangle in two faces of the cell (on both sides of a fold): nothing lies between them.
    bool hasRepeatedRim()
    {
        std::sort(rim_.begin(), rim_.end());
        return std::adjacent_find(rim_.begin(), rim_.end()) != rim_.end();
    }

    /// Fills trial_ with the tetrahedra from the apex; smallest volume over the cell's, -VGREAT when they would not fill the cell conformingly (not over a cell's volume: in cells of
    /// millimetres that is beyond what numbers hold, which OpenFOAM traps).
    scalar pull(label celli, int apex, const point& x)
    {
        trial_.clear();
        rim_.clear();
        scalar smallest = VGREAT;
        for (const label facei : mesh_.cells()[celli])
        {
            if (!mesh_.faces()[facei].found(apex))
            {
                smallest = min(smallest, joinFace(facei, mesh_.faceOwner()[facei] == celli, apex, x));
            }
            else if (!isFannedFrom(facei, apex))
            {
                return -VGREAT;
            }
        }
        return trial_.empty() || hasRepeatedRim() ? -VGREAT : smallest / volumes_[celli];
    }

    /// The point of lowest order first: how cut elements are divided goes by the order of their corners, which must not be that in which the face has its points.
    Triangle fromLowest(Triangle t) const
    {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end(), [&](int a, int b) { return order_[a] < order_[b]; }), t.end());
        return t;
    }

    scalar joinFace(label facei, bool isOwner, int apex, const point& x)
    {
        const pointField& p = mesh_.points();
        scalar smallest = VGREAT;
        for (int k = faces_.start[facei]; k < faces_.start[facei + 1]; ++k)
        {
            const Triangle t = fromLowest(faces_.triangles[k]);
            const int b = t[isOwner ? 1 : 2], c = t[isOwner ? 2 : 1];
            smallest = min(smallest, (((p[t[0]] - x) ^ (p[b] - x)) & (p[c] - x)) / 6);
            trial_.push_back({apex, t[0], b, c});
        }
        return smallest;
    }

    void markBoundary(const labelList& patchOfFace)
    {
        forAll(patchOfFace, i)
        {
            const label facei = mesh_.nInternalFaces() + i;
            for (int k = faces_.start[facei]; k < faces_.start[facei + 1] && patchOfFace[i] >= 0; ++k)
            {
                split_.markFace(mesh_.faceOwner()[facei], faces_.triangles[k].data(), patchOfFace[i]);
            }
        }
    }

    const polyMesh& mesh_;
    const labelList& order_;
    const FaceTriangles faces_;
    const scalarField& volumes_;
    SimplexSplit split_;
    struct Plane { std::array<label, 3> orders; scalar distance; vector normal; }; // of a triangle, orders of its points
    std::vector<Plane> planes_;
    std::vector<label> cellPoints_;
    std::vector<Tetrahedron> trial_, best_;
    std::vector<std::pair<int, int>> rim_; // of the faces that hold the apex
};

} // namespace

SimplexSplit splitIntoTetrahedra(const polyMesh& mesh, const labelList& order, const labelList& patchOfFace)
{
    return CellSplitter(mesh, order).split(patchOfFace);
}

} // namespace flotsam
