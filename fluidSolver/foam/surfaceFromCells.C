// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/surfaceFromCells.H"

#include "geometry/cutSimplex.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double sharp = 1e-6;          // fractions nearer to 0 or 1 are full or empty
constexpr int maxSweeps = 200;          // a plane is found to round-off in 20 to 100
constexpr double smallestChange = 1e-13;  // of the level, per sweep, over the common length
constexpr int patience = 10;            // sweeps in which the change must halve: a surface that is no plane settles at a finite one
constexpr double faceWeight = 1e-9;     // of full and empty cells whose face is the surface, beside partly filled ones
constexpr double flattest = 0.05;       // change of alpha over a cell below which there is no surface (a mixture)

/// Partly filled, or full or empty where the surface lies between cells.
struct SurfaceCell
{
    int cell;
    double volume, fraction;            // fraction: of the liquid
    double size;                        // [m]
    std::vector<int> nodes;             // each once
};

class Reconstruction
{
public:
    Reconstruction(const MeshAdapter& adapter, const Halo& halo, const std::vector<double>& fraction)
    :   adapter_(adapter), mesh_(adapter.mesh), halo_(halo)
    {
        for (std::size_t c = 0; c < fraction.size(); ++c)
            if (isPartlyFilled(fraction[c])) add(c, fraction[c]);
        if (halo.any(!cells_.empty())) addCellsAtFaces(fraction);
        for (const SurfaceCell& p : cells_) length_ = std::max(length_, 4*diagonal(p)); // keeps the level within 1/2
        length_ = halo.max(length_);
    }

    void run(std::vector<double>& alpha)
    {
        if (!halo_.any(!cells_.empty())) return;
        dropMixtures(alpha);
        std::vector<double> level(alpha.size());
        for (std::size_t i = 0; i < level.size(); ++i) level[i] = alpha[i] - 0.5;
        double change = 1e300, before = 1e300;
        for (int sweep = 1; sweep <= maxSweeps && change > smallestChange; ++sweep)
        {
            change = average(level);
            if (sweep % patience != 0) continue;
            if (change > 0.5*before) break;
            before = change;
        }
        extend(level);
        for (std::size_t i = 0; i < level.size(); ++i) alpha[i] = 0.5 + level[i];
    }

private:
    static bool isPartlyFilled(double fraction) { return fraction > sharp && fraction < 1 - sharp; }

    /// A surface that lies on faces leaves full and empty cells in places, beside cells with traces of either: their common nodes are on it. Without planes of
    /// their own these nodes would keep their level in another unit, and the surface next to the traces would be tilted.
    void addCellsAtFaces(const std::vector<double>& fraction)
    {
        enum { Partly, Full, Empty, nKinds };
        std::vector<double> touches(nKinds*std::size_t(mesh_.nNodes), 0.0);
        std::vector<int> nodes;
        for (std::size_t c = 0; c < fraction.size(); ++c)
        {
            const int kind = isPartlyFilled(fraction[c]) ? Partly : fraction[c] > 0.5 ? Full : Empty;
            collectCell(adapter_, int(c), nodes);
            for (int i : nodes) touches[nKinds*std::size_t(i) + kind] += 1;
        }
        halo_.sumToOwners(touches, nKinds);
        halo_.update(touches, nKinds);
        const auto isOnFaces = [&](int i)
        {
            const double* t = &touches[nKinds*std::size_t(i)];
            return t[Partly] == 0 && t[Full] > 0 && t[Empty] > 0;
        };
        for (std::size_t c = 0; c < fraction.size(); ++c)
        {
            if (isPartlyFilled(fraction[c])) continue;
            collectCell(adapter_, int(c), nodes);
            if (std::any_of(nodes.begin(), nodes.end(), isOnFaces)) add(int(c), fraction[c] > 0.5);
        }
    }

    void add(int c, double fraction)
    {
        SurfaceCell p{c, 0, fraction, 0, {}};
        p.volume = collectCell(adapter_, c, p.nodes);
        p.size = std::pow(p.volume, 1.0/mesh_.dim);
        cells_.push_back(std::move(p));
    }

    double diagonal(const SurfaceCell& p) const
    {
        double sum = 0;
        for (int d = 0; d < mesh_.dim; ++d)
        {
            double low = 1e300, high = -1e300;
            for (int i : p.nodes)
            {
                low = std::min(low, mesh_.x[std::size_t(i)*mesh_.dim + d]);
                high = std::max(high, mesh_.x[std::size_t(i)*mesh_.dim + d]);
            }
            sum += (high - low)*(high - low);
        }
        return std::sqrt(sum);
    }

    /// Mean gradient of a P1 field over the cell.
    std::array<double, 3> gradient(const SurfaceCell& p, const std::vector<double>& field) const
    {
        const int dim = mesh_.dim, n = dim + 1;
        std::array<double, 3> g{};
        for (int k = adapter_.cellStart[p.cell]; k < adapter_.cellStart[p.cell + 1]; ++k)
        {
            const std::size_t e = adapter_.cellElements[k];
            for (int a = 0; a < n; ++a)
                for (int d = 0; d < dim; ++d) g[d] += mesh_.volume[e]/p.volume*field[mesh_.elements[e*n + a]]*mesh_.gradN[(e*n + a)*dim + d];
        }
        return g;
    }

    void dropMixtures(const std::vector<double>& alpha)
    {
        const auto isMixture = [&](const SurfaceCell& p)
        {
            const auto g = gradient(p, alpha);
            return std::hypot(g[0], g[1], g[2])*p.size < flattest;
        };
        cells_.erase(std::remove_if(cells_.begin(), cells_.end(), isMixture), cells_.end());
    }

    double along(const std::array<double, 3>& normal, int node) const
    {
        double sum = 0;
        for (int d = 0; d < mesh_.dim; ++d) sum += normal[d]*mesh_.x[std::size_t(node)*mesh_.dim + d];
        return sum;
    }

    /// Share of the cell above the plane, and minus its derivative to the offset [1/m].
    FluidFraction above(const SurfaceCell& p, const std::array<double, 3>& normal, double offset) const
    {
        const int n = mesh_.dim + 1;
        FluidFraction sum{0, 0};
        for (int k = adapter_.cellStart[p.cell]; k < adapter_.cellStart[p.cell + 1]; ++k)
        {
            const std::size_t e = adapter_.cellElements[k];
            double distance[4];
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
            const FluidFraction part = mesh_.dim == 2 ? fluidFraction<2>(distance) : fluidFraction<3>(distance);
            sum.value += share*part.value;
            sum.slope += share*part.slope;
        }
        return sum;
    }

    /// The plane normal.x = offset that cuts off the cell's fraction on its positive side.
    double offset(const SurfaceCell& p, const std::array<double, 3>& normal) const
    {
        double low = 1e300, high = -1e300;
        for (int i : p.nodes)
        {
            low = std::min(low, along(normal, i));
            high = std::max(high, along(normal, i));
        }
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

    /// Nodal means of a value of each surface cell, nComponents wide; nodes without surface cells get weight 0. Result: per node the means, the weight.
    template<class CellValue>
    std::vector<double> toNodes(int nComponents, CellValue cellValue) const
    {
        const std::size_t width = nComponents + 1;
        std::vector<double> sum(width*mesh_.nNodes, 0.0);
        for (std::size_t k = 0; k < cells_.size(); ++k)
        {
            const SurfaceCell& p = cells_[k];
            const double weight = p.volume*(p.fraction*(1 - p.fraction) + faceWeight); // slivers say little about the surface
            for (int i : p.nodes)
            {
                double value[3];
                cellValue(k, i, value);
                for (int j = 0; j < nComponents; ++j) sum[width*i + j] += weight*value[j];
                sum[width*i + nComponents] += weight;
            }
        }
        halo_.sumToOwners(sum, int(width));
        halo_.update(sum, int(width));
        for (int i = 0; i < mesh_.nNodes; ++i)
            for (int j = 0; j < nComponents; ++j)
                if (sum[width*i + nComponents] > 0) sum[width*i + j] /= sum[width*i + nComponents];
        return sum;
    }

    /// Unit normals of the cells: their gradients, averaged over the neighbours (a zigzag from cell to cell meets every fraction as well).
    std::vector<std::array<double, 3>> normals(const std::vector<double>& level) const
    {
        std::vector<std::array<double, 3>> result(cells_.size());
        for (std::size_t k = 0; k < cells_.size(); ++k) result[k] = gradient(cells_[k], level);
        const std::size_t dim = mesh_.dim;
        const std::vector<double> nodal = toNodes(dim, [&](std::size_t k, int, double* value) { std::copy_n(result[k].data(), dim, value); });
        for (std::size_t k = 0; k < cells_.size(); ++k)
        {
            std::array<double, 3> sum{};
            for (int i : cells_[k].nodes)
                for (std::size_t d = 0; d < dim; ++d) sum[d] += nodal[(dim + 1)*i + d];
            const double length = std::hypot(sum[0], sum[1], sum[2]);
            for (double& component : sum) component /= length > 0 ? length : 1;
            result[k] = sum;
        }
        return result;
    }

    /// One sweep: planes of the cells from the level's gradient, level of the nodes from the planes. Returns the largest change.
    double average(std::vector<double>& level) const
    {
        const std::vector<std::array<double, 3>> normal = normals(level);
        std::vector<double> position(cells_.size());
        for (std::size_t k = 0; k < cells_.size(); ++k) position[k] = offset(cells_[k], normal[k]);
        const std::vector<double> next = toNodes(1, [&](std::size_t k, int i, double* value) { *value = (along(normal[k], i) - position[k])/length_; });
        double change = 0;
        for (std::size_t i = 0; i < level.size(); ++i)
        {
            if (next[2*i + 1] <= 0) continue;
            change = std::max(change, std::abs(next[2*i] - level[i]));
            level[i] = next[2*i];
        }
        return halo_.max(change);
    }

    /// One ring further, by the planes of the neighbours: a surface through a node touches elements of full and empty cells.
    void extend(std::vector<double>& level) const
    {
        const std::size_t dim = mesh_.dim, n = dim + 1;
        const std::vector<std::array<double, 3>> normal = normals(level);
        const std::vector<double> nodal = toNodes(dim, [&](std::size_t k, int, double* value) { std::copy_n(normal[k].data(), dim, value); });
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
                    for (std::size_t d = 0; d < dim; ++d) value += nodal[n*j + d]*(mesh_.x[i*dim + d] - mesh_.x[j*dim + d])/length_;
                    sum[2*std::size_t(i)] += value;
                    sum[2*std::size_t(i) + 1] += 1;
                }
        }
        halo_.sumToOwners(sum, 2);
        halo_.update(sum, 2);
        for (std::size_t i = 0; i < level.size(); ++i)
        {
            if (isKnown(i) || sum[2*i + 1] <= 0) continue;
            const double value = sum[2*i]/sum[2*i + 1];
            if (value*level[i] > 0) level[i] = value; // the cells around it are full or empty: their side counts
        }
    }

    const MeshAdapter& adapter_;
    const SimplexMesh& mesh_;
    const Halo& halo_;
    std::vector<SurfaceCell> cells_;
    double length_ = 0;     // of the level's unit
};

} // namespace

void reconstructSurface(const MeshAdapter& adapter, const Halo& halo, const std::vector<double>& fraction, std::vector<double>& alpha)
{
    Reconstruction(adapter, halo, fraction).run(alpha);
}

} // namespace flotsam
