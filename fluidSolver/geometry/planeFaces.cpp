// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planeFaces.hpp"

#include "geometry/primitives.hpp"

#include <cmath>

namespace flotsam
{
namespace
{

constexpr int nSides = 6;   // of a prism

/// Regular prism around the axis, its section as large as the circle's.
std::shared_ptr<const PlaneFaces> makePrism(const Vec3& centre, const Vec3& axis, double halfLength, double radius)
{
    const double angle = M_PI / nSides, apothem = radius * std::sqrt(angle / std::tan(angle));
    const Vec3 across = axis.unitOrthogonal(), other = axis.cross(across);
    const auto faces = std::make_shared<PlaneFaces>();
    for (int k = 0; k < nSides; ++k)
    {
        const Vec3 normal = std::cos(2 * k * angle) * across + std::sin(2 * k * angle) * other;
        faces->planes.push_back({normal, apothem + normal.dot(centre)});
    }
    for (const double side : {1., -1.}) faces->planes.push_back({side * axis, halfLength + side * axis.dot(centre)});
    return faces;
}

/// Regular, with the sphere's volume.
std::shared_ptr<const PlaneFaces> makeDodecahedron(const Vec3& centre, double radius)
{
    const double golden = 0.5 * (1 + std::sqrt(5.));
    const double volume = 10 * std::sqrt(130 - 58 * std::sqrt(5.)); // of the one with inscribed radius 1
    const double inner = radius * std::cbrt(4 * M_PI / 3 / volume);
    const auto faces = std::make_shared<PlaneFaces>();
    for (int d = 0; d < 3; ++d)
        for (const double a : {-1., 1.})
            for (const double b : {-golden, golden})
            {
                Vec3 normal = Vec3::Zero();
                normal[d] = a;
                normal[(d + 1) % 3] = b;
                normal.normalize();
                faces->planes.push_back({normal, inner + normal.dot(centre)});
            }
    return faces;
}

std::shared_ptr<const PlaneFaces> place(std::shared_ptr<const PlaneFaces> inner, const PlacedShape& placed)
{
    if (!inner) return nullptr;
    const auto faces = std::make_shared<PlaneFaces>();
    const Vec3 origin = placed.toOuter(Vec3::Zero());
    for (const PlaneFaces::Plane& plane : inner->planes)
    {
        const Vec3 normal = placed.toOuter(plane.normal) - origin;
        faces->planes.push_back({normal, plane.distance + normal.dot(origin)});
    }
    return faces;
}

} // namespace

int PlaneFaces::distances(const Vec3& x, double* distances) const
{
    int n = 0;
    for (const Plane& plane : planes) distances[n++] = plane.normal.dot(x) - plane.distance;
    return n;
}

double roundThickness(const Shape& shape)
{
    if (const auto* placed = dynamic_cast<const PlacedShape*>(&shape)) return roundThickness(placed->inner());
    if (const auto* cylinder = dynamic_cast<const CylinderShape*>(&shape)) return 2 * cylinder->radius();
    if (const auto* capsule = dynamic_cast<const CapsuleShape*>(&shape)) return 2 * capsule->radius();
    if (const auto* sphere = dynamic_cast<const SphereShape*>(&shape)) return 2 * sphere->radius();
    return 0;
}

std::shared_ptr<const PlaneFaces> makePlaneFaces(const Shape& shape)
{
    if (const auto* placed = dynamic_cast<const PlacedShape*>(&shape)) return place(makePlaneFaces(placed->inner()), *placed);
    if (const auto* cylinder = dynamic_cast<const CylinderShape*>(&shape))
        return makePrism(cylinder->centre(), cylinder->axis(), cylinder->halfLength(), cylinder->radius());
    if (const auto* capsule = dynamic_cast<const CapsuleShape*>(&shape)) // a half sphere has the volume of a cylinder as long as 2/3 of its radius
        return makePrism(capsule->centre(), capsule->axis(), capsule->halfLength() + 2. / 3 * capsule->radius(), capsule->radius());
    if (const auto* sphere = dynamic_cast<const SphereShape*>(&shape)) return makeDodecahedron(sphere->centre(), sphere->radius());
    return nullptr;
}

} // namespace flotsam
