// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/surfaceFromCells.H"

#include "foam/cellShare.H"
#include "foam/profileLevel.H"
#include "foam/surfaceCells.H"
#include "geometry/cutSimplex.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace flotsam
{

namespace
{

constexpr int maxSweeps = 200;          // a plane is found to round-off in 20 to 100
constexpr double smallestChange = 1e-13;  // of the level, per sweep, over the common length
constexpr double onSurface = 1e-11;     // level of nodes that the surface goes through: round-off must not say which elements it cuts
constexpr int mostReturns = 2;          // of a cell to those that are trusted: whether a plane fits it may hang on itself, and then never settles
constexpr int patience = 10;            // sweeps in which the change must halve: a surface that is no plane settles at a finite one

class Reconstruction
{
public:
    Reconstruction(const Foam::polyMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const std::vector<double>& fraction)
    :   adapter_(adapter), mesh_(adapter.mesh), halo_(halo), fraction_(fraction), cells_(mesh, adapter, halo, fraction), shareOfCell_(mesh), weight_(mesh_.nNodes, 1.0)
    {}

    std::vector<char> run(std::vector<double>& alpha)
    {
        if (!cells_.areAny()) return {};
        cells_.dropMixtures(alpha);
        std::vector<double> level(alpha.size());
        for (std::size_t i = 0; i < level.size(); ++i) level[i] = alpha[i] - 0.5;
        returns_.assign(cells_.cut().size(), 0);
        std::vector<char> isAtSide = followProfiles(adapter_, halo_, cells_, fraction_, level);
        double change = 1e300, before = 1e300;
        for (int sweep = 1; sweep <= maxSweeps && change > smallestChange; ++sweep)
        {
            change = average(level);
            if (sweep % patience != 0) continue;
            const bool isOther = halo_.any(std::exchange(hasOtherTrust_, false));
            if (change > 0.5*before && !isOther) break;
            before = change;
        }
        extend(level);
        for (std::size_t i = 0; i < level.size(); ++i) alpha[i] = std::abs(level[i]) < onSurface ? 0.5 : 0.5 + level[i];
        return isAtSide;
    }

private:
    double along(const std::array<double, 3>& normal, int node) const
    {
        double sum = 0;
        for (int d = 0; d < mesh_.dim; ++d) sum += normal[d]*mesh_.x[std::size_t(node)*mesh_.dim + d];
        return sum;
    }

    /// Share of the cell above the plane, and minus its derivative to the offset [1/m]. In 2D, where cells have no warped faces, by the triangles.
    FluidFraction above(const SurfaceCell& p, const std::array<double, 3>& normal, double offset)
    {
        if (mesh_.dim == 3) return shareOfCell_(p.cell, {normal[0], normal[1], normal[2]}, offset);
        const int n = mesh_.dim + 1;
        FluidFraction sum{0, 0};
        for (int k = adapter_.cellStart[p.cell]; k < adapter_.cellStart[p.cell + 1]; ++k)
        {
            const std::size_t e = adapter_.cellElements[k];
            double distance[3];
            int nWet = 0;
            for (int a = 0; a < n; ++a)
            {
                distance[a] = along(normal, mesh_.elements[e*n + a]) - offset;
                if (distance[a] == 0) distance[a] = 1e-300; // the kernel wants signs
                nWet += distance[a] > 0;
            }
            const double share = mesh_.volume[e]/p.volume;
            if (nWet == n) sum.value += share;
            if (nWet == 0 || nWet == n) continue;
            const FluidFraction part = fluidFraction<2>(distance);
            sum.value += share*part.value;
            sum.slope += share*part.slope;
        }
        return sum;
    }

    /// The plane normal.x = offset that cuts off the cell's fraction on its positive side.
    double offset(const SurfaceCell& p, const std::array<double, 3>& normal)
    {
        double low = 1e300, high = -1e300;
        for (int i : p.nodes)
        {
            low = std::min(low, along(normal, i));
            high = std::max(high, along(normal, i));
        }
        // through its last corner: the share is flat there, beside warped faces not even monotone, and round-off would choose the root
        if (p.fraction == 1) return low;
        if (p.fraction == 0) return high;
        double at = p.fraction*low + (1 - p.fraction)*high;
        for (int k = 0; k < 60 && high - low > 1e-15*p.size; ++k) // Newton within a bracket: the fraction falls from 1 to 0
        {
            const FluidFraction now = above(p, normal, at);
            if (std::abs(now.value - p.fraction) < 1e-15) break;
            (now.value > p.fraction ? low : high) = at;
            const double next = now.slope > 0 ? at + (now.value - p.fraction)/now.slope : 0.5*(low + high);
            const double last = at;
            at = next > low && next < high ? next : 0.5*(low + high);
            if (std::abs(at - last) < 1e-16*p.size) break;
        }
        return at;
    }

    /// The plane's offset as the nodes have it from other cells.
    double offsetOfNeighbours(const SurfaceCell& p, const std::array<double, 3>& normal, const std::vector<double>& level) const
    {
        double sum = 0, weights = 0;
        for (int i : p.nodes)
        {
            sum += weight_[i]*(along(normal, i) - level[i]*cells_.length());
            weights += weight_[i];
        }
        return sum/weights;
    }

    /// Unit normals of the cells: their gradients, averaged over the neighbours (a zigzag from cell to cell meets every fraction as well).
    std::vector<std::array<double, 3>> normals(const std::vector<double>& level) const
    {
        std::vector<std::array<double, 3>> result(cells_.cut().size());
        for (std::size_t k = 0; k < cells_.cut().size(); ++k) result[k] = cells_.gradient(cells_.cut()[k], level);
        const std::size_t dim = mesh_.dim;
        const std::vector<double> nodal = cells_.toNodes(cells_.cut(), dim, [&](std::size_t k, int, double* value) { std::copy_n(result[k].data(), dim, value); });
        for (std::size_t k = 0; k < cells_.cut().size(); ++k)
        {
            std::array<double, 3> sum{};
            for (int i : cells_.cut()[k].nodes)
                for (std::size_t d = 0; d < dim; ++d) sum[d] += nodal[(dim + 1)*i + d];
            const double length = std::hypot(sum[0], sum[1], sum[2]);
            for (double& component : sum) component /= length > 0 ? length : 1;
            result[k] = sum;
        }
        return result;
    }

    /// Not where the surface cuts a face of the cell twice, which no plane does.
    bool mayBeTrusted(std::size_t k, const std::vector<double>& level) const
    {
        if (mesh_.dim == 2) return true;
        return returns_[k] <= mostReturns && !shareOfCell_.cutsFaceTwice(cells_.cut()[k].cell, [&](Foam::label i) { return level[adapter_.pointNode[i]] > 0; });
    }

    /// One sweep: planes of the cells from the level's gradient, level of the nodes from the planes. Returns the largest change.
    double average(std::vector<double>& level)
    {
        const std::vector<std::array<double, 3>> normal = normals(level);
        std::vector<double> position(cells_.cut().size());
        for (std::size_t k = 0; k < cells_.cut().size(); ++k)
        {
            const SurfaceCell& p = cells_.cut()[k];
            const bool isTrusted = mayBeTrusted(k, level);
            if (cells_.setTrust(k, isTrusted))
            {
                hasOtherTrust_ = true;
                returns_[k] += isTrusted;
            }
            position[k] = isTrusted ? offset(p, normal[k]) : offsetOfNeighbours(p, normal[k], level);
        }
        const auto levelOfPlane = [&](std::size_t k, int i, double* value) { *value = (along(normal[k], i) - position[k])/cells_.length(); }; // within 1/2
        const std::vector<double> next = cells_.toNodes(cells_.cut(), 1, levelOfPlane);
        double change = 0;
        for (std::size_t i = 0; i < level.size(); ++i)
        {
            if (next[2*i + 1] <= 0) continue;
            change = std::max(change, std::abs(next[2*i] - level[i]));
            level[i] = next[2*i];
            weight_[i] = next[2*i + 1];
        }
        return halo_.max(change);
    }

    /// One ring further, by the planes of the neighbours: a surface through a node touches elements of full and empty cells.
    void extend(std::vector<double>& level) const
    {
        if (cells_.length() == 0) return;   // profiles alone
        const std::size_t dim = mesh_.dim, n = dim + 1;
        const std::vector<std::array<double, 3>> normal = normals(level);
        const std::vector<double> nodal = cells_.toNodes(cells_.cut(), dim, [&](std::size_t k, int, double* value) { std::copy_n(normal[k].data(), dim, value); });
        const auto isKnown = [&](int i) { return nodal[n*i + dim] > 0; };
        std::vector<double> sum(2*level.size(), 0.0);
        for (int e = 0; e < mesh_.nElements; ++e)
        {
            if (!mesh_.isOwnedElement[e]) continue;
            const int* nodes = &mesh_.elements[e*n];
            for (std::size_t a = 0; a < n; ++a)
                for (std::size_t b = 0; b < n; ++b)
                {
                    const int i = nodes[a], j = nodes[b];
                    if (isKnown(i) || !isKnown(j)) continue;
                    double value = level[j];
                    for (std::size_t d = 0; d < dim; ++d) value += nodal[n*j + d]*(mesh_.x[i*dim + d] - mesh_.x[j*dim + d])/cells_.length();
                    sum[2*std::size_t(i)] += value;
                    sum[2*std::size_t(i) + 1] += 1;
                }
        }
        halo_.sumToOwners(sum, 2);
        halo_.update(sum, 2);
        const std::vector<double> least = smallestHeights(), ofProfiles = cells_.toNodes(cells_.profile(), 0, [](std::size_t, int, double*) {});
        for (std::size_t i = 0; i < level.size(); ++i)
        {
            if (isKnown(i) || sum[2*i + 1] <= 0 || level[i] == 0 || ofProfiles[i] > 0) continue;
            const double value = sum[2*i]/sum[2*i + 1];
            level[i] = std::copysign(std::max(std::copysign(1, level[i])*value, least[i]), level[i]); // the cells around it are full or empty: their side counts
        }
    }

    /// Of the elements around each node, over the common length: no surface within them is nearer.
    std::vector<double> smallestHeights() const
    {
        const std::size_t dim = mesh_.dim, n = dim + 1;
        std::vector<double> result(mesh_.nNodes, 0.5);
        for (std::size_t e = 0; e < std::size_t(mesh_.nElements); ++e)
        {
            double steepest = 0;
            for (std::size_t a = 0; a < n; ++a)
            {
                const double* g = &mesh_.gradN[(e*n + a)*dim];
                steepest = std::max(steepest, std::hypot(g[0], g[1], dim == 3 ? g[2] : 0));
            }
            for (std::size_t a = 0; a < n; ++a) result[mesh_.elements[e*n + a]] = std::min(result[mesh_.elements[e*n + a]], 1/(steepest*cells_.length()));
        }
        halo_.update(result, 1);
        return result;
    }

    const MeshAdapter& adapter_;
    const SimplexMesh& mesh_;
    const Halo& halo_;
    const std::vector<double>& fraction_;
    SurfaceCells cells_;
    CellShare shareOfCell_;
    bool hasOtherTrust_ = false;    // than some sweeps ago
    std::vector<int> returns_;      // of each cell to those that are trusted
    std::vector<double> weight_;    // of the nodes in the last sweep
};

} // namespace

std::vector<char> reconstructSurface(const Foam::polyMesh& mesh, const MeshAdapter& adapter, const Halo& halo, const std::vector<double>& fraction, std::vector<double>& alpha)
{
    return Reconstruction(mesh, adapter, halo, fraction).run(alpha);
}

} // namespace flotsam
