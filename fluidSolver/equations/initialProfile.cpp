// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/initialProfile.hpp"

#include "equations/dualCells.hpp"
#include "equations/interfacePlanes.hpp"
#include "equations/surfaceLevel.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// The profile has reached 0 or 1 to 1e-15 within this many rings of nodes or widths.
constexpr int profileRings = 12;
constexpr double profileWidths = 35;

/// Signed distance [m]. The plane's sign is wrong behind corners of the surface: there the sharp field knows better.
double profileDistance(const SimplexMesh& mesh, const InterfacePlanes& planes, int i, double sharp)
{
    double d = planes.distance(i);
    const bool isBulk = sharp < 1e-6 || sharp > 1 - 1e-6;
    if (isBulk && (sharp > 0.5) != (d > 0))
    {
        double s = 0;
        for (int k = 0; k < mesh.dim; ++k)
        {
            const double r = mesh.x[static_cast<std::size_t>(i)*mesh.dim + k] - planes.point(i)[k];
            s += r*r;
        }
        d = sharp > 0.5 ? std::sqrt(s) : -std::sqrt(s);
    }
    return d;
}

/// {int alpha, d(int alpha)/d(shift)} over owned nodes of all ranks, for d shifted by `shift` [m].
std::array<double, 2> volumeOfProfile(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& volume,
    const std::vector<ProfileSlab>& slabs, const std::vector<double>& width, double shift)
{
    double sums[2] = {0, 0};
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const ProfileSlab slab{slabs[i].middle + shift/width[i], slabs[i].thickness};
        sums[0] += volume[i]*slab.mean();
        sums[1] += volume[i]*slab.slope()/width[i];
    }
    halo.sum(sums, 2);
    return {sums[0], sums[1]};
}

/// Shift of the surface [m] that gives the profile the volume `target`: Newton steps no longer than half a width.
double volumeKeepingShift(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& volume,
    const std::vector<ProfileSlab>& slabs, const std::vector<double>& width, double target)
{
    double smallest = 1e300;
    for (int i = 0; i < mesh.nOwned; ++i)
        smallest = std::min(smallest, width[i]);
    const double longestStep = 0.5*halo.min(smallest);

    double shift = 0;
    for (int iteration = 0; iteration < 50; ++iteration)
    {
        const auto [value, slope] = volumeOfProfile(mesh, halo, volume, slabs, width, shift);
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

std::vector<double> interfaceWidth(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, double factor)
{
    std::vector<double> width(mesh.nNodes, 0);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const int begin = graph.nodeElementStart[i], end = graph.nodeElementStart[i + 1];
        for (int k = begin; k < end; ++k)
            width[i] += mesh.h[graph.nodeElement[k]];
        width[i] *= factor/(end - begin);
    }
    halo.update(width, 1);
    return width;
}

void makeStartProfile(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo,
    const std::vector<double>& width, std::vector<double>& alpha, double liquid, const DualCells* cells)
{
    std::vector<double> level(alpha);
    for (double& l : level)
        l -= 0.5;
    InterfacePlanes planes;
    planes.propagate(mesh, graph, halo, level, {profileRings, &width, profileWidths});
    if (!halo.any(!planes.nodes().empty()))
        return;

    const std::vector<double> volume = dualVolumes(mesh, nullptr);
    if (liquid < 0)
    {
        liquid = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
            liquid += volume[i]*alpha[i];
        liquid = halo.sum(liquid);
    }

    constexpr double far = 1e3;     // widths: 0 or 1 exactly
    std::vector<ProfileSlab> slabs(mesh.nOwned);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (planes.has(i)) slabs[i] = profileSlab(cells, i, planes.normal(i), profileDistance(mesh, planes, i, alpha[i]), width[i]);
        else slabs[i] = {alpha[i] > 0.5 ? far : -far, 0};
    }
    const double shift = volumeKeepingShift(mesh, halo, volume, slabs, width, liquid);
    for (int i = 0; i < mesh.nOwned; ++i)
        alpha[i] = ProfileSlab{slabs[i].middle + shift/width[i], slabs[i].thickness}.mean();
    halo.update(alpha, 1);
}

} // namespace flotsam
