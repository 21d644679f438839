// SPDX-License-Identifier: GPL-3.0-or-later
/// A body that floats in water at rest stays where it is whatever the surface's profile is beside it: nothing pushes it to where the profile is wide.
#include "support/floatingBodies.hpp"

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nPlaces = 6;
constexpr double radius = 0.15; // three elements a diameter

struct Largest { double along = 0, up = 0; };

/// Largest acceleration in the first step, along the surface and upward, over gravity. Half immersed, density half of water's.
Largest accelerations(int dim, std::shared_ptr<const Shape> shape, const std::function<double(const double* x)>& profile)
{
    FloatingBodies body(dim, shape, 500, radius);
    Largest largest;
    for (int k = 0; k < nPlaces; ++k)
    {
        const Vec3 position = Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/FloatingBodies::n;
        Vec3 a = body.release(position, position[dim - 1], profile).velocity/FloatingBodies::gravity;
        largest.up = std::max(largest.up, std::abs(a[dim - 1]));
        a[dim - 1] = 0;
        largest.along = std::max(largest.along, a.norm());
    }
    std::printf("%dD: along %.1e, up %.1e of gravity\n", dim, largest.along, largest.up);
    return largest;
}

} // namespace

TEST_CASE("floating bodies do not feel the profile's width")
{
    const std::function<double(const double*)> alike = {};
    const auto wideOnOneSide = [](const double* x) { return x[0] > 0.5 ? 1.5 : 1/1.5; };
    struct Body { int dim; std::shared_ptr<const Shape> shape; };
    for (const auto& [dim, shape] : {Body{2, makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), radius)}, Body{2, makeBox(Vec3::Zero(), Vec3(2*radius, 2*radius, 1))},
             Body{3, makeCylinder(Vec3(0, -0.3, 0), Vec3(0, 0.3, 0), radius)}, Body{3, makeSphere(Vec3::Zero(), radius)}})
    {
        // along: with the pressure of the profile 1.5e-3 to 5e-3, on one side wide 0.022 to 0.027
        CHECK(accelerations(dim, shape, alike).along < 5e-4);
        const Largest uneven = accelerations(dim, shape, wideOnOneSide);
        CHECK(uneven.along < 8e-3);
        CHECK(uneven.up < 8e-3);
    }
}
