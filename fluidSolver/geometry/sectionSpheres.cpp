// SPDX-License-Identifier: GPL-3.0-or-later
/// Surface spheres of shapes that reach through a 2D mesh: what touches there is their section, whatever their extent across.
#include "geometry/primitives.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

using Spheres = std::vector<SurfaceSphere>;

struct Plane
{
    Vec3 point, normal;

    double height(const Vec3& x) const { return (x - point).dot(normal); }
    Vec3 project(const Vec3& x) const { return x - height(x) * normal; }
    bool isAcross(const Vec3& direction) const { return std::abs(direction.dot(normal)) > 1 - 1e-9; }
};

struct Sizes { double radius, spacing, rowSpacing; };

Spheres inPlane(const Shape& shape, const Plane& plane, const Sizes& sizes);

/// The rim: the middle of three layers of a box that is just thick enough to have them.
Spheres ofBox(const BoxShape& box, int across, const Plane& plane, const Sizes& sizes)
{
    double radius = sizes.radius;
    for (int d = 0; d < 3; ++d)
        if (d != across) radius = std::min(radius, box.half()[d]);
    Vec3 size = 2 * box.half();
    size[across] = 2 * (radius + sizes.spacing);
    Spheres rim;
    for (const SurfaceSphere& s : surfaceSpheres(*makeBox(plane.project(box.centre()), size), radius, sizes.spacing, sizes.rowSpacing))
        if (std::abs(plane.height(s.centre)) < sameSphere * radius) rim.push_back(s);
    return rim;
}

Spheres ofPlaced(const PlacedShape& placed, const Plane& plane, const Sizes& sizes)
{
    const Vec3 point = placed.toInner(plane.point);
    Spheres spheres = inPlane(placed.inner(), {point, placed.toInner(plane.point + plane.normal) - point}, sizes);
    for (SurfaceSphere& s : spheres) s.centre = placed.toOuter(s.centre);
    return spheres;
}

/// Of spheres all over the surface those nearest to the plane, moved onto it. All, where these have not all of those at the rim.
Spheres middleLayer(const Spheres& all, const Shape& shape, const Plane& plane)
{
    constexpr double clear = 1.01;  // deeper than its radius inside: of the front and the back

    double nearest = 1e300;
    for (const SurfaceSphere& s : all)
        if (std::abs(plane.height(s.centre)) < std::abs(nearest)) nearest = plane.height(s.centre);
    Spheres layer;
    for (const SurfaceSphere& s : all)
        if (std::abs(plane.height(s.centre) - nearest) < sameSphere * s.radius) layer.push_back({plane.project(s.centre), s.radius});
    const auto isNeedless = [&](const SurfaceSphere& s)
    {
        const Vec3 place = plane.project(s.centre);
        return shape.distance(place) < -clear * s.radius || hasSphereAt(layer, place, s.radius);
    };
    return std::all_of(all.begin(), all.end(), isNeedless) ? layer : all;
}

Spheres inPlane(const Shape& shape, const Plane& plane, const Sizes& sizes)
{
    if (const auto* placed = dynamic_cast<const PlacedShape*>(&shape)) return ofPlaced(*placed, plane, sizes);
    if (const auto* joined = dynamic_cast<const UnionShape*>(&shape)) return unionSpheres(*joined, [&](const Shape& part) { return inPlane(part, plane, sizes); });
    if (const auto* cylinder = dynamic_cast<const CylinderShape*>(&shape); cylinder && plane.isAcross(cylinder->axis()))
        return {{plane.project(cylinder->centre()), cylinder->radius()}};
    if (const auto* box = dynamic_cast<const BoxShape*>(&shape))
        for (int d = 0; d < 3; ++d)
            if (plane.isAcross(Vec3::Unit(d))) return ofBox(*box, d, plane, sizes);
    return middleLayer(surfaceSpheres(shape, sizes.radius, sizes.spacing, sizes.rowSpacing), shape, plane);
}

} // namespace

std::vector<SurfaceSphere> sectionSpheres(const Shape& shape, const Vec3& point, const Vec3& normal, double radius, double spacing, double rowSpacing)
{
    return inPlane(shape, {point, normal}, {radius, spacing, rowSpacing});
}

} // namespace flotsam
