// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: the part that makes volumes cut out and their centres exact. A linear cut loses percents of a round log at 4-8 elements across,
/// more on one side than on the other; weight and buoyancy would then not balance.
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
constexpr int maxNewtonSteps = 3;
constexpr int maxSteps = 12;
constexpr double largestGain = 4;       // of volume, over what a step expects
constexpr double nearVolume = 0.01;     // missing over the volume: the step from here is the last
constexpr double rightVolume = 0.004;   // of thin parts: no step from here
constexpr double rightPlanes = 1e-6;    // of plane faces, whose cut is the same in every place: volume, and centre over the radius; no step from here
constexpr double thinVolume = 0.6;      // over surface times element: of a plate half of its thickness, of a rod half of its radius, over the element

struct Section { double area; bool isMean; };

/// Volume of the shape in the plane's sense: see CoverBuilder::exactVolume.
Section planeSection(const Shape& shape, const Vec3& direction, double height)
{
    const double section = shape.sectionArea(height * direction, direction);
    const auto [lower, upper] = shape.bounds();
    const TriSurface surface = shape.surface((upper - lower).minCoeff() / 100);
    double low = 1e300, high = -1e300;
    for (const Vec3& x : surface.points)
    {
        low = std::min(low, direction.dot(x));
        high = std::max(high, direction.dot(x));
    }
    const double mean = shape.moments().volume / (high - low);
    const bool isPrismatic = std::abs(mean - section) < 0.01 * section;
    return {isPrismatic ? mean : section, isPrismatic};
}

} // namespace

/// A shape with all faces plane is cut exactly as it is, and so is what is cut in place of a round one; not so what round parts of a union share.
bool CoverBuilder::needsOffsets(const Solid& solid)
{
    const int n = solid.shape->nParts();
    if (n == 1 && !solid.planeFaces.empty()) return false;
    for (int k = 0; k < n; ++k)
        if (!solid.shape->part(k).hasPlaneFaces()) return true;
    return false;
}

const CoverBuilder::KnownVolume& CoverBuilder::known(const Solid& solid)
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
            && std::abs(known.height - height) <= tolerance * solid.radius())
            return known;
    const VolumeMoments moments = solid.shape->moments();
    const Section section = mesh_.dim == 3 ? Section{moments.volume, true} : planeSection(*solid.shape, direction, height);
    return knownVolumes_.emplace_back(KnownVolume{solid.shape, direction, height, section.area, moments.centroid, section.isMean});
}

template <int dim>
void CoverBuilder::addAlone(OwnCut& own, const Solid& solid, int element) const
{
    Eigen::Matrix<double, 4, dim + 1> nodes = Eigen::Matrix<double, 4, dim + 1>::Zero(); // (1, r) of each
    for (int a = 0; a <= dim; ++a)
    {
        const int i = nodesOf(element)[a];
        if (isBoundaryNode_[i] && aloneDistance_[i] < -touchTolerance * mesh_.h[element]) own.reachesThrough = 1;
        nodes(0, a) = 1;
        for (int d = 0; d < dim; ++d) nodes(1 + d, a) = mesh_.x[std::size_t(i) * dim + d] - solid.pose.position[mesh_.axes[d]];
    }
    using Shares = Eigen::Matrix<double, dim + 1, 1>;
    visitCutAlone<dim>(solid, element, [&](const SimplexMoments<dim>& fluid, const SimplexFacet<dim>* facets, int nFacets)
    {
        own.volume += nodes * (Shares::Constant(mesh_.volume[element] / (dim + 1)) - Eigen::Map<const Shares>(fluid.first));
        for (int f = 0; f < nFacets; ++f)
        {
            own.areaTimesH += facets[f].area * mesh_.h[element];
            for (int q = 0; q < dim; ++q)
            {
                const Eigen::Vector4d point = nodes * Eigen::Map<const Shares>(facets[f].shape[q]);
                own.surface += facets[f].weight[q] * point * point.transpose();
            }
        }
    });
}

CoverBuilder::OwnCut CoverBuilder::cutAlone(const Solid& solid, const std::vector<Sample>& samples)
{
    OwnCut own;
    nodeFaces_.clear(); // the offsets are others
    forEachElementAlone(solid, samples, [&](int e)
    {
        if (!mesh_.isOwnedElement[e]) return;
        mesh_.dim == 2 ? addAlone<2>(own, solid, e) : addAlone<3>(own, solid, e);
    }, [](int) { return true; });
    return own;
}

/// The next place to try for the surface, or the last one: false. A Newton step that begins near the right volume needs no look at where it ends, but between
/// nodes on both sides of a thin part volumes jump: there every step is looked at, and the best place taken.
bool CoverBuilder::moveSurface(OffsetSearch& search, Solid& solid, const OwnCut& own)
{
    const auto settle = [&]
    {
        solid.offset = search.bestOffset;
        solid.offsetSlope = search.bestSlope;
        return false;
    };
    const double area = own.surface(0, 0);
    const bool isLast = ++search.nSteps == maxSteps;
    if (!(area > 0) && search.nSteps > 1 && !isLast) // lost between the nodes by the last step
    {
        search.low = solid.offset;
        solid.offset = 0.5 * (solid.offset + (search.high < 1e300 ? search.high : search.offset));
        search.expected *= 0.5;
        return true;
    }
    if (!(area > 0) && search.least < 1e300) return settle();
    if (!(area > 0) || own.reachesThrough > 0) return false;
    const KnownVolume& exact = known(solid);
    const Vec3 centroid = solid.pose.orientation * exact.centroid;
    Eigen::Vector4d missing = -own.volume;
    missing[0] += exact.volume;
    for (int d = 0; d < mesh_.dim; ++d) missing[1 + d] += exact.volume * centroid[mesh_.axes[d]];

    const bool isThin = exact.volume < thinVolume * own.areaTimesH;
    if (std::abs(missing[0]) < search.least)
    {
        search.least = std::abs(missing[0]);
        search.bestOffset = solid.offset;
        search.bestSlope = solid.offsetSlope;
    }
    const double right = solid.isThin ? rightPlanes * exact.volume : 0;
    if (std::abs(missing[0]) < right && missing.tail<3>().norm() < right * solid.radius()) return false;
    if (isLast || (isThin && search.nSteps > 1 && search.least < rightVolume * exact.volume)) return settle();
    if (search.nSteps > maxNewtonSteps) return bracketSurface(search, solid, missing[0], own) || settle();
    takeNewtonStep(search, solid, missing, own, exact.hasCentroid);
    return isThin || std::abs(missing[0]) > nearVolume * exact.volume;
}

/// A displacement c of the surface outwards changes the integrals of (1, r) by those of c (1, r) over the surface. Between nodes on both sides of a thin part the
/// volume changes faster than that: the second step and later ones are scaled by what the last one gained.
void CoverBuilder::takeNewtonStep(OffsetSearch& search, Solid& solid, const Eigen::Vector4d& missing, const OwnCut& own, bool hasCentroid) const
{
    const int n = hasCentroid ? 1 + mesh_.dim : 1;
    const double gained = search.expected != 0 ? (search.missing - missing[0]) / search.expected : 1;
    const Eigen::VectorXd change = own.surface.topLeftCorner(n, n).ldlt().solve(missing.head(n)) / std::clamp(gained, 1.0, largestGain);
    const double limit = offsetLimit(own), offset = std::clamp(solid.offset + change[0], -limit, limit);
    search.missing = missing[0];
    search.offset = solid.offset;
    search.expected = own.surface(0, 0) * (offset - solid.offset);
    for (int d = 0; d + 1 < n; ++d) search.expected += own.surface(0, 1 + d) * change[1 + d];
    solid.offset = offset;
    for (int d = 0; d + 1 < n; ++d) solid.offsetSlope[mesh_.axes[d]] += change[1 + d];
    solid.offsetSlope *= std::min(1.0, limit / std::max(solid.offsetSlope.norm() * solid.radius(), 1e-300));
}

/// Where Newton's steps do not settle: the volume grows with the offset at a given slope, so that offsets on both sides of the right one enclose it.
bool CoverBuilder::bracketSurface(OffsetSearch& search, Solid& solid, double missing, const OwnCut& own) const
{
    (missing > 0 ? search.low : search.high) = solid.offset;
    const double limit = offsetLimit(own);
    const bool isEnclosed = search.low > -1e300 && search.high < 1e300;
    const double offset = isEnclosed ? 0.5 * (search.low + search.high) : std::clamp(solid.offset + missing / own.surface(0, 0), -limit, limit);
    if (offset == solid.offset) return false;
    solid.offset = offset;
    return true;
}

void CoverBuilder::correctOffsets(std::vector<Solid>& solids)
{
    constexpr int width = 22;
    std::vector<OffsetSearch> searches;
    for (std::size_t s = 0; s < solids.size(); ++s)
        if (solids[s].kind == Solid::Kind::Free && needsOffsets(solids[s])) searches.push_back({s});
    while (!searches.empty())
    {
        std::vector<double> sums;
        for (const OffsetSearch& search : searches)
        {
            const OwnCut own = cutAlone(solids[search.solid], samples_[search.solid]);
            sums.insert(sums.end(), own.volume.data(), own.volume.data() + 4);
            sums.insert(sums.end(), own.surface.data(), own.surface.data() + 16);
            sums.insert(sums.end(), {own.areaTimesH, own.reachesThrough});
        }
        halo_.sum(sums.data(), static_cast<int>(sums.size()));
        std::vector<OffsetSearch> next;
        const double* at = sums.data();
        for (OffsetSearch& search : searches)
        {
            Solid& solid = solids[search.solid];
            if (moveSurface(search, solid, {Eigen::Vector4d(at), Eigen::Matrix4d(at + 4), at[20], at[21]})) next.push_back(search);
            at += width;
        }
        searches.swap(next);
    }
}

} // namespace flotsam
