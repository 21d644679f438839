// SPDX-License-Identifier: GPL-3.0-or-later
/// Small spheres in the corners of boxes, about which they tip.
#include "geometry/primitives.hpp"

#include <cmath>

namespace flotsam
{
namespace
{

using Spheres = std::vector<SurfaceSphere>;

/// A box in the frame of the shape it was found in.
struct FoundBox { const BoxShape* box = nullptr; const PlacedShape* placed = nullptr; };

FoundBox findBox(const Shape& shape)
{
    const auto* placed = dynamic_cast<const PlacedShape*>(&shape);
    return {dynamic_cast<const BoxShape*>(placed ? &placed->inner() : &shape), placed};
}

/// across: of 2D, the direction in which there is one layer only; -1: none.
Spheres ofBox(const FoundBox& found, double radius, int across)
{
    const Vec3 inner = (found.box->half().array() - radius).max(0.0);
    Spheres corners;
    for (int k = 0; k < 8; ++k)
    {
        Vec3 side(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
        if (across >= 0 && side[across] > 0) continue;
        if (across >= 0) side[across] = 0;
        const Vec3 centre = found.box->centre() + side.cwiseProduct(inner);
        corners.push_back({found.placed ? found.placed->toOuter(centre) : centre, radius});
    }
    return corners;
}

} // namespace

std::vector<SurfaceSphere> cornerSpheres(const Shape& shape, double radius)
{
    const FoundBox found = findBox(shape);
    return found.box ? ofBox(found, radius, -1) : Spheres();
}

std::vector<SurfaceSphere> sectionCorners(const Shape& shape, const Vec3& point, const Vec3& normal, double radius)
{
    const FoundBox found = findBox(shape);
    if (!found.box) return {};
    const Vec3 axis = found.placed ? Vec3(found.placed->toInner(point + normal) - found.placed->toInner(point)) : normal;
    for (int d = 0; d < 3; ++d)
        if (std::abs(axis[d]) > 1 - 1e-9)
        {
            Spheres corners = ofBox(found, radius, d);
            for (SurfaceSphere& s : corners) s.centre -= (s.centre - point).dot(normal) * normal;
            return corners;
        }
    return {};
}

} // namespace flotsam
