// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/initialProfile.hpp"

#include "equations/dualCells.hpp"
#include "equations/interfacePlanes.hpp"
#include "equations/surfaceLevel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

/// The profile has reached 0 or 1 to 1e-15 within this many rings of nodes or widths.
constexpr int profileRings = 12;
constexpr double profileWidths = 35;

constexpr double ringShare = 0.6;

/// Parts of the surface whose volumes are kept apart, as StartLiquid::isAtSide numbers them.
enum { Level, Side, nParts };

constexpr double none = std::numeric_limits<double>::infinity();

/// Of nodes of elements that the surface cuts: distance from the zero of the level's linear interpolation, the least of those of the elements [m]; elsewhere `none`.
/// Unlike that from the nearest plane it cannot be on the wrong side.
std::vector<double> interpolatedDistance(const SimplexMesh& mesh, const std::vector<double>& level)
{
    const std::size_t dim = mesh.dim, n = dim + 1;
    std::vector<double> result(mesh.nNodes, none);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        const int* nodes = &mesh.elements[e*n];
        const auto isWet = [&](int i) { return level[i] >= 0; };
        if (std::all_of(nodes, nodes + n, isWet) || std::none_of(nodes, nodes + n, isWet)) continue;
        double slope = 0;
        for (std::size_t d = 0; d < dim; ++d)
        {
            double gradient = 0;
            for (std::size_t a = 0; a < n; ++a) gradient += level[nodes[a]]*mesh.gradN[(e*n + a)*dim + d];
            slope += gradient*gradient;
        }
        for (std::size_t a = 0; a < n; ++a) result[nodes[a]] = std::min(result[nodes[a]], std::abs(level[nodes[a]])/std::sqrt(slope));
    }
    return result;
}

/// What the surface is away at least, by the rings of elements between [m]: behind edges of the surface the nearest plane goes on where there is no surface.
std::vector<double> leastDistance(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& interpolated)
{
    const int dim = mesh.dim, n = dim + 1;
    std::vector<double> result(interpolated), height(mesh.nElements, none);
    for (int e = 0; e < mesh.nElements; ++e)
        for (int a = 0; a < n; ++a)
        {
            const double* g = &mesh.gradN[(static_cast<std::size_t>(e)*n + a)*dim];
            height[e] = std::min(height[e], 1/std::hypot(g[0], g[1], dim == 3 ? g[2] : 0));
        }
    for (int ring = 0; ring < profileRings; ++ring)
    {
        halo.update(result, 1);
        const std::vector<double> last = result;
        for (int e = 0; e < mesh.nElements; ++e)
        {
            const int* nodes = &mesh.elements[static_cast<std::size_t>(e)*n];
            double least = none;
            for (int a = 0; a < n; ++a) least = std::min(least, last[nodes[a]]);
            for (int a = 0; a < n; ++a) result[nodes[a]] = std::min(result[nodes[a]], least + ringShare*height[e]);
        }
    }
    halo.update(result, 1);
    return result;
}

/// Signed distance [m]. interpolated, least: of the node, as above.
double profileDistance(const SimplexMesh& mesh, const InterfacePlanes& planes, int i, double level, double interpolated, double least)
{
    const double d = planes.distance(i);
    if (level*d > 0 || (level == 0 && interpolated == none)) return std::copysign(least < none ? std::max(least, std::abs(d)) : std::abs(d), d);
    if (interpolated < none) return std::copysign(interpolated, level);
    double s = 0;
    for (int k = 0; k < mesh.dim; ++k)
    {
        const double r = mesh.x[static_cast<std::size_t>(i)*mesh.dim + k] - planes.point(i)[k];
        s += r*r;
    }
    return std::copysign(std::sqrt(s), level);
}

/// The surface as it was found, and the nodes of one part of it.
struct StartSurface
{
    const std::vector<double> &volume, &width;
    const std::vector<ProfileSlab>& slabs;
    const std::vector<char>& part;  ///< number of the part of every node

    ProfileSlab shifted(int i, double shift) const { return {slabs[i].middle + shift/width[i], slabs[i].thickness}; }
};

/// {int alpha, d(int alpha)/d(shift)} over owned nodes of all ranks, for d shifted by `shift` [m].
std::array<double, 2> volumeOfProfile(const SimplexMesh& mesh, const Halo& halo, const StartSurface& surface, int part, double shift)
{
    double sums[2] = {0, 0};
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (surface.part[i] != part) continue;
        const ProfileSlab slab = surface.shifted(i, shift);
        sums[0] += surface.volume[i]*slab.mean();
        sums[1] += surface.volume[i]*slab.slope()/surface.width[i];
    }
    halo.sum(sums, 2);
    return {sums[0], sums[1]};
}

/// Shift of the surface [m] that gives the profile the volume `target`: Newton steps no longer than half a width.
double volumeKeepingShift(const SimplexMesh& mesh, const Halo& halo, const StartSurface& surface, int part, double target)
{
    double smallest = 1e300;
    for (int i = 0; i < mesh.nOwned; ++i)
        smallest = std::min(smallest, surface.width[i]);
    const double longestStep = 0.5*halo.min(smallest);

    double shift = 0;
    for (int iteration = 0; iteration < 50; ++iteration)
    {
        const auto [value, slope] = volumeOfProfile(mesh, halo, surface, part, shift);
        if (slope <= 0 || std::abs(value - target) <= 1e-14*std::abs(target))
            break;
        const double step = std::clamp((target - value)/slope, -longestStep, longestStep);
        shift += step;
        if (std::abs(step) < 1e-14*longestStep)
            break;
    }
    return shift;
}

} // namespace

void makeStartProfile(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo,
    const std::vector<double>& width, std::vector<double>& alpha, const StartLiquid& liquid, const DualCells* cells)
{
    std::vector<double> level(alpha);
    for (double& l : level)
        l -= 0.5;
    InterfacePlanes planes;
    planes.propagate(mesh, graph, halo, level, {profileRings, &width, profileWidths});
    if (!halo.any(!planes.nodes().empty()))
        return;

    const std::vector<double> volume = dualVolumes(mesh, nullptr);
    const std::vector<char> part = liquid.isAtSide.empty() ? std::vector<char>(mesh.nNodes, Level) : liquid.isAtSide;
    double target[nParts] = {};
    for (int i = 0; i < mesh.nOwned; ++i)
        target[int(part[i])] += liquid.volume.empty() ? volume[i]*alpha[i] : liquid.volume[i];
    halo.sum(target, nParts);

    constexpr double far = 1e3;     // widths: 0 or 1 exactly
    const std::vector<double> interpolated = interpolatedDistance(mesh, level);
    const std::vector<double> least = leastDistance(mesh, halo, interpolated);
    std::vector<ProfileSlab> slabs(mesh.nOwned);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (planes.has(i)) slabs[i] = profileSlab(cells, i, planes.normal(i), profileDistance(mesh, planes, i, level[i], interpolated[i], least[i]), width[i]);
        else slabs[i] = {alpha[i] > 0.5 ? far : -far, 0};
    }
    const StartSurface surface{volume, width, slabs, part};
    double shift[nParts];
    for (int p = 0; p < nParts; ++p) shift[p] = volumeKeepingShift(mesh, halo, surface, p, target[p]);
    for (int i = 0; i < mesh.nOwned; ++i) alpha[i] = surface.shifted(i, shift[int(part[i])]).mean();
    halo.update(alpha, 1);
}

} // namespace flotsam
