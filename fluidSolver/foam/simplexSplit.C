// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/simplexSplit.H"

#include "foam/faceFan.H"

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

using Tetrahedron = std::array<int, 4>;

class CellSplitter
{
public:
    CellSplitter(const polyMesh& mesh, const labelList& order)
        : mesh_(mesh), order_(order), fan_(fanStarts(mesh, order)), volumes_(mesh.cellVolumes())
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
            const scalar quality = pull(celli, apex, mesh_.points()[apex]) / volumes_[celli];
            if (quality > best)
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
        const point& centre = mesh_.cellCentres()[celli];
        const int vertex = mesh_.nPoints() + int(split_.centres.size());
        const scalar quality = pull(celli, vertex, centre) / volumes_[celli];
        if (!(quality > VSMALL))
        {
            FatalErrorInFunction << "cell " << celli << " with its centre at " << centre
                                 << " cannot be split into tetrahedra of positive volume: it is strongly concave or warped (smallest one "
                                 << quality << " of the cell's volume). Run checkMesh -allGeometry and improve the mesh there."
                                 << exit(FatalError);
        }
        split_.centreCell.push_back(celli);
        split_.centres.push_back(centre);
        best_.swap(trial_);
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

    bool isFannedFrom(label facei, label pointi) const
    {
        const face& f = mesh_.faces()[facei];
        const label k = fan_[facei];
        return f.size() == 3 || f[k] == pointi || (f.size() == 4 && f[(k + 2) % 4] == pointi);
    }

    /// Fills trial_ with the tetrahedra from the apex; smallest volume, -VGREAT when a face that holds the apex is fanned otherwise.
    scalar pull(label celli, int apex, const point& x)
    {
        trial_.clear();
        scalar smallest = VGREAT;
        for (const label facei : mesh_.cells()[celli])
        {
            const face& f = mesh_.faces()[facei];
            if (!f.found(apex))
            {
                smallest = min(smallest, joinFace(facei, mesh_.faceOwner()[facei] == celli, apex, x));
            }
            else if (!isFannedFrom(facei, apex))
            {
                return -VGREAT;
            }
        }
        return trial_.empty() ? -VGREAT : smallest;
    }

    scalar joinFace(label facei, bool isOwner, int apex, const point& x)
    {
        const pointField& p = mesh_.points();
        const face& f = mesh_.faces()[facei];
        const label n = f.size(), k = fan_[facei];
        scalar smallest = VGREAT;
        for (label i = 1; i + 1 < n; ++i)
        {
            const label a = f[k];
            const label b = f[(k + (isOwner ? i : i + 1)) % n], c = f[(k + (isOwner ? i + 1 : i)) % n];
            smallest = min(smallest, (((p[a] - x) ^ (p[b] - x)) & (p[c] - x)) / 6);
            trial_.push_back({apex, a, b, c});
        }
        return smallest;
    }

    void markBoundary(const labelList& patchOfFace)
    {
        forAll(patchOfFace, i)
        {
            const label facei = mesh_.nInternalFaces() + i;
            const face& f = mesh_.faces()[facei];
            const label n = f.size(), k = fan_[facei];
            for (label j = 1; j + 1 < n && patchOfFace[i] >= 0; ++j)
            {
                const int triangle[3] = {f[k], f[(k + j) % n], f[(k + j + 1) % n]};
                split_.markFace(mesh_.faceOwner()[facei], triangle, patchOfFace[i]);
            }
        }
    }

    const polyMesh& mesh_;
    const labelList& order_;
    const labelList fan_;
    const scalarField& volumes_;
    SimplexSplit split_;
    std::vector<label> cellPoints_;
    std::vector<Tetrahedron> trial_, best_;
};

} // namespace

SimplexSplit splitIntoTetrahedra(const polyMesh& mesh, const labelList& order, const labelList& patchOfFace)
{
    return CellSplitter(mesh, order).split(patchOfFace);
}

} // namespace flotsam
