// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodyGroup.H"
#include "geometry/planeFaces.hpp"
#include "geometry/primitives.hpp"

namespace flotsam
{

namespace
{

template<class... Types>
bool isOneOf(const Shape& shape) { return (... || (dynamic_cast<const Types*>(&shape) != nullptr)); }

Vec3 slope(const Shape& shape, const Vec3& x, double h)
{
    Vec3 g;
    for (int d = 0; d < 3; ++d) g[d] = shape.distance(x + h*Vec3::Unit(d)) - shape.distance(x - h*Vec3::Unit(d));
    return g;
}

/// Whether a ball of radius r inside the shape comes within r of the surface's point x: right corners have it at 0.73 r. Looked for by going inwards.
bool isNearBall(const Shape& shape, const Vec3& x, double r)
{
    constexpr int nSteps = 20;
    constexpr double length = 0.2, fits = 0.97;
    Vec3 c = x;
    for (int i = 0; i < nSteps; ++i)
    {
        const Vec3 g = slope(shape, c, 0.1*r);
        if (g.isZero(0)) return false;
        c -= length*r*g.normalized();
        if ((c - x).squaredNorm() > 4*r*r) return false;
        if (shape.distance(c) <= -fits*r) return true;
    }
    return false;
}

} // namespace

double touchingThickness(const std::shared_ptr<const Shape>& shape, const SceneFrame& frame)
{
    const auto* placed = dynamic_cast<const PlacedShape*>(shape.get());
    double thickness = thinnestExtent(*shape, frame);
    if (frame.isPlanar || isOneOf<UnionShape, BoxShape, SphereShape, CylinderShape, CapsuleShape>(placed ? placed->inner() : *shape)) return thickness;
    if (shape->hasPlaneFaces()) return largestBall(*shape); // bare places at its acute edges would ask for ever smaller spheres
    constexpr std::size_t most = 400;       // sample points
    constexpr double bare = 0.05, smaller = 0.75;
    constexpr int nTries = 12;              // down to a thirtieth
    const std::shared_ptr<const SampledShape> sampled = sampleShape(shape, thickness);
    const std::vector<Vec3>& points = sampled->points();
    const std::size_t stride = points.size()/most + 1;
    for (int i = 0; i < nTries; ++i, thickness *= smaller)
    {
        std::size_t n = 0, nBare = 0;
        for (std::size_t k = 0; k < points.size(); k += stride, ++n) nBare += !isNearBall(*shape, points[k], 0.25*thickness);
        if (nBare <= bare*n) break;
    }
    return thickness;
}

} // namespace flotsam
