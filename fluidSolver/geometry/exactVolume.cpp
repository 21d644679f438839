// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: the part that makes cut volumes exact. A linear cut loses 1-4 % of a bar's volume at 4-8 elements a side;
/// weight and buoyancy would then not balance.
#include "geometry/coverBuilder.hpp"
#include "geometry/cutSimplex.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

constexpr double touchTolerance = 0.02; // a body lying on a wall may overlap it by this, over the element length

/// Volume of the shape in the plane's sense: see CoverBuilder::exactVolume.
double planeSection(const Shape& shape, const Vec3& direction, double height)
{
    const auto [lower, upper] = shape.bounds();
    const TriSurface surface = shape.surface((upper - lower).maxCoeff() / 100);
    const double section = sectionArea(surface, height * direction, direction);
    double low = 1e300, high = -1e300;
    for (const Vec3& x : surface.points)
    {
        low = std::min(low, direction.dot(x));
        high = std::max(high, direction.dot(x));
    }
    const double mean = shape.moments().volume / (high - low);
    return std::abs(mean - section) < 0.01 * section ? mean : section;
}

} // namespace

double CoverBuilder::exactVolume(const Solid& solid)
{
    Vec3 direction = Vec3::Zero();
    double height = 0;
    if (mesh_.dim == 2)
    {
        direction = solid.pose.orientation.conjugate() * Vec3::Unit(mesh_.axes[2]);
        height = mesh_.planeOffset - solid.pose.position[mesh_.axes[2]];
    }
    const double tolerance = 1e-6;
    for (const KnownVolume& known : knownVolumes_)
        if (known.shape == solid.shape && (known.direction - direction).norm() < tolerance
            && std::abs(known.height - height) <= tolerance * std::abs(height))
            return known.volume;
    const double volume = mesh_.dim == 3 ? solid.shape->moments().volume : planeSection(*solid.shape, direction, height);
    knownVolumes_.push_back({solid.shape, direction, height, volume});
    return volume;
}

CoverBuilder::OwnCut CoverBuilder::cutAlone(const Solid& solid, const std::vector<Sample>& samples)
{
    OwnCut own;
    for (const Sample& s : samples) aloneDistance_[s.node] = snapped(s.node, s.distance - solid.offset);
    ++mark_;
    for (const Sample& s : samples)
    {
        if (aloneDistance_[s.node] >= 0) continue;
        for (int k = graph_.nodeElementStart[s.node]; k < graph_.nodeElementStart[s.node + 1]; ++k)
        {
            const int e = graph_.nodeElement[k];
            if (!mesh_.isOwnedElement[e] || !firstVisit(elementMark_, e)) continue;
            double distance[4];
            int nSolid = 0;
            for (int a = 0; a <= mesh_.dim; ++a)
            {
                distance[a] = aloneDistance_[nodesOf(e)[a]];
                if (distance[a] < 0) ++nSolid;
                if (isBoundaryNode_[nodesOf(e)[a]] && distance[a] < -touchTolerance * mesh_.h[e]) own.reachesThrough = 1;
            }
            FluidFraction fluid{0, 0};
            if (nSolid <= mesh_.dim) fluid = mesh_.dim == 2 ? fluidFraction<2>(distance) : fluidFraction<3>(distance);
            const double area = fluid.slope * mesh_.volume[e];
            own.volume += (1 - fluid.value) * mesh_.volume[e];
            own.area += area;
            own.areaTimesH += area * mesh_.h[e];
        }
    }
    for (const Sample& s : samples) aloneDistance_[s.node] = farDistance;
    return own;
}

void CoverBuilder::correctOffsets(std::vector<Solid>& solids)
{
    std::vector<double> sums;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].kind != Solid::Kind::Free) continue;
        const OwnCut own = cutAlone(solids[s], samples_[s]);
        sums.insert(sums.end(), {own.volume, own.area, own.areaTimesH, own.reachesThrough});
    }
    if (sums.empty()) return;
    halo_.sum(sums.data(), static_cast<int>(sums.size()));
    const double* own = sums.data();
    for (Solid& solid : solids)
    {
        if (solid.kind != Solid::Kind::Free) continue;
        const double volume = own[0], area = own[1], h = own[2] / std::max(own[1], 1e-300), reachesThrough = own[3];
        own += 4;
        if (!(area > 0) || reachesThrough > 0) continue;
        const double limit = largestOffset * h;
        solid.offset = std::clamp(solid.offset + (exactVolume(solid) - volume) / area, -limit, limit);
    }
}

} // namespace flotsam
