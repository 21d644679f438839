// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/surfaceFromCells.H"

#include "geometry/cutSimplex.hpp"
#include "geometry/shape.hpp"

#include <Eigen/QR>

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
constexpr int nMoments = 13;            // of a least-squares fit in 3D
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
        if (halo.any(!cells_.empty()))
        {
            const std::vector<double> touches = touchingCells(fraction);
            findProfiles(touches);
            addCellsAtFaces(fraction, touches);
        }
        for (const SurfaceCell& p : cells_) length_ = std::max(length_, 4*diagonal(p)); // keeps the level within 1/2
        length_ = halo.max(length_);
    }

    void run(std::vector<double>& alpha)
    {
        if (!halo_.any(!cells_.empty() || !profile_.empty())) return;
        dropMixtures(alpha, cells_);
        dropMixtures(alpha, profile_);
        std::vector<double> level(alpha.size());
        for (std::size_t i = 0; i < level.size(); ++i) level[i] = alpha[i] - 0.5;
        followProfiles(level);
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

    enum { Partly, Full, Empty, nKinds };

    /// Number of partly filled, full and empty cells at each node.
    std::vector<double> touchingCells(const std::vector<double>& fraction) const
    {
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
        return touches;
    }

    /// A profile over several cells (setExprFields with a smooth function, a field of interFoam) is no surface within each of them. Cells that a surface
    /// cuts have full and empty cells beside them, those within a profile neither; what is joined to these through cells without full, or without
    /// empty ones beside them belongs to the profile.
    void findProfiles(const std::vector<double>& touches)
    {
        const auto hasBeside = [&](const SurfaceCell& p, int kind)
        {
            return std::any_of(p.nodes.begin(), p.nodes.end(), [&](int i) { return touches[nKinds*std::size_t(i) + kind] > 0; });
        };
        enum { Kept, Profile, MayBeProfile };
        std::vector<int> kinds;
        for (const SurfaceCell& p : cells_)
        {
            const bool hasFull = hasBeside(p, Full), hasEmpty = hasBeside(p, Empty);
            kinds.push_back(hasFull && hasEmpty ? Kept : hasFull || hasEmpty ? MayBeProfile : Profile);
        }
        std::vector<double> isInProfile(mesh_.nNodes, 0.0);
        for (bool hasGrown = true; halo_.any(hasGrown);)
        {
            for (std::size_t k = 0; k < cells_.size(); ++k)
                if (kinds[k] == Profile)
                    for (int i : cells_[k].nodes) isInProfile[i] = 1;
            halo_.sumToOwners(isInProfile, 1);
            halo_.update(isInProfile, 1);
            hasGrown = false;
            for (std::size_t k = 0; k < cells_.size(); ++k)
            {
                const std::vector<int>& nodes = cells_[k].nodes;
                if (kinds[k] != MayBeProfile || std::none_of(nodes.begin(), nodes.end(), [&](int i) { return isInProfile[i] > 0; })) continue;
                kinds[k] = Profile;
                hasGrown = true;
            }
        }
        std::vector<SurfaceCell> cut;
        for (std::size_t k = 0; k < cells_.size(); ++k) (kinds[k] == Profile ? profile_ : cut).push_back(std::move(cells_[k]));
        cells_.swap(cut);
    }

    /// A surface that lies on faces leaves full and empty cells in places, beside cells with traces of either: their common nodes are on it. Without planes of
    /// their own these nodes would keep their level in another unit, and the surface next to the traces would be tilted.
    void addCellsAtFaces(const std::vector<double>& fraction, const std::vector<double>& touches)
    {
        std::vector<int> nodes;
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

    void dropMixtures(const std::vector<double>& alpha, std::vector<SurfaceCell>& cells) const
    {
        const auto isMixture = [&](const SurfaceCell& p)
        {
            const auto g = gradient(p, alpha);
            return std::hypot(g[0], g[1], g[2])*p.size < flattest;
        };
        cells.erase(std::remove_if(cells.begin(), cells.end(), isMixture), cells.end());
    }

    Vec3 centroid(const SurfaceCell& p) const
    {
        const int n = mesh_.dim + 1;
        Vec3 x = Vec3::Zero();
        for (int k = adapter_.cellStart[p.cell]; k < adapter_.cellStart[p.cell + 1]; ++k)
        {
            const std::size_t e = adapter_.cellElements[k];
            for (int a = 0; a < n; ++a) x += mesh_.volume[e]/(n*p.volume)*point(mesh_.elements[e*n + a]);
        }
        return x;
    }

    /// Level of the nodes of profiles: of a tanh profile atanh(2 alpha - 1) is linear, so means of the cells' values, carried to the node by their gradients, are
    /// exact on any mesh. (Means of alpha itself leave a level surface uneven beside cells of other sizes.)
    void followProfiles(std::vector<double>& level) const
    {
        if (!halo_.any(!profile_.empty())) return;
        const double unit = 8*std::atanh(1 - 2*sharp); // keeps the level within 1/2, beyond the profile's last cells as well
        std::vector<double> value;
        std::vector<Vec3> centre;
        for (const SurfaceCell& p : profile_)
        {
            value.push_back(std::atanh(2*p.fraction - 1)/unit);
            centre.push_back(centroid(p));
        }
        const std::vector<Vec3> slope = leastSquaresGradients(value, centre);
        const std::vector<double> nodal = toNodes(profile_, 1, [&](std::size_t k, int i, double* result)
        {
            *result = value[k] + slope[k].dot(point(i) - centre[k]);
        });
        for (std::size_t i = 0; i < level.size(); ++i)
            if (nodal[2*i + 1] > 0) level[i] = std::clamp(nodal[2*i], -0.5, 0.5);
    }

    /// Of values of the profiles' cells, from those around each of its nodes: exact of linear values.
    std::vector<Vec3> leastSquaresGradients(const std::vector<double>& value, const std::vector<Vec3>& centre) const
    {
        // moments about the node: r, value, r r, r value
        const std::vector<double> moments = toNodes(profile_, nMoments, [&](std::size_t k, int i, double* m)
        {
            const Vec3 r = centre[k] - point(i);
            *m++ = value[k];
            for (int a = 0; a < 3; ++a)
            {
                *m++ = r[a];
                *m++ = r[a]*value[k];
                for (int b = a; b < 3; ++b) *m++ = r[a]*r[b];
            }
        });
        std::vector<Vec3> result;
        for (std::size_t k = 0; k < profile_.size(); ++k)
        {
            double weight = 0, mean = 0;
            Vec3 first = Vec3::Zero(), mixed = Vec3::Zero();
            Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
            for (int i : profile_[k].nodes)
            {
                const double* m = &moments[(nMoments + 1)*std::size_t(i)];
                const double w = m[nMoments];
                const Vec3 shift = point(i) - centre[k];
                const double nodeMean = *m++;
                Vec3 r, rValue;
                Eigen::Matrix3d rr;
                for (int a = 0; a < 3; ++a)
                {
                    r[a] = *m++;
                    rValue[a] = *m++;
                    for (int b = a; b < 3; ++b) rr(a, b) = rr(b, a) = *m++;
                }
                weight += w;
                mean += w*nodeMean;
                first += w*(r + shift);
                mixed += w*(rValue + nodeMean*shift);
                second += w*(rr + r*shift.transpose() + shift*r.transpose() + shift*shift.transpose());
            }
            mean /= weight;
            first /= weight;
            const Eigen::Matrix3d spread = second/weight - first*first.transpose();
            // of least length where the cells lie in a plane or in a row
            Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> solve;
            solve.setThreshold(1e-6);
            solve.compute(spread);
            result.push_back(solve.solve(mixed/weight - mean*first));
        }
        return result;
    }

    Vec3 point(int node) const
    {
        Vec3 x = Vec3::Zero();
        for (int d = 0; d < mesh_.dim; ++d) x[d] = mesh_.x[std::size_t(node)*mesh_.dim + d];
        return x;
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
    std::vector<double> toNodes(const std::vector<SurfaceCell>& cells, int nComponents, CellValue cellValue) const
    {
        const std::size_t width = nComponents + 1;
        std::vector<double> sum(width*mesh_.nNodes, 0.0);
        for (std::size_t k = 0; k < cells.size(); ++k)
        {
            const SurfaceCell& p = cells[k];
            const double weight = p.volume*(&cells == &profile_ ? 1 : p.fraction*(1 - p.fraction) + faceWeight); // slivers say little about the surface
            for (int i : p.nodes)
            {
                double value[nMoments];
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
        const std::vector<double> nodal = toNodes(cells_, dim, [&](std::size_t k, int, double* value) { std::copy_n(result[k].data(), dim, value); });
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
        const std::vector<double> next = toNodes(cells_, 1, [&](std::size_t k, int i, double* value) { *value = (along(normal[k], i) - position[k])/length_; });
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
        const std::vector<double> nodal = toNodes(cells_, dim, [&](std::size_t k, int, double* value) { std::copy_n(normal[k].data(), dim, value); });
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
    std::vector<SurfaceCell> cells_, profile_;
    double length_ = 0;     // of the level's unit
};

} // namespace

void reconstructSurface(const MeshAdapter& adapter, const Halo& halo, const std::vector<double>& fraction, std::vector<double>& alpha)
{
    Reconstruction(adapter, halo, fraction).run(alpha);
}

} // namespace flotsam
