// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies of parts that overlap float as deep as bodies of parts side by side.
#include "support/floatingBodies.hpp"
#include "support/flowCases.hpp"

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

using Shapes = std::vector<std::shared_ptr<const Shape>>;

constexpr double h = 1.0/FloatingBodies::n;

std::shared_ptr<const Shape> boxFrom(const Vec3& lower, const Vec3& upper) { return makeBox(0.5*(lower + upper), upper - lower); }

std::shared_ptr<const Shape> aboutCentroid(const Shapes& parts)
{
    const auto shape = makeUnion(parts);
    return makePlaced(shape, Eigen::Quaterniond::Identity(), -shape->moments().centroid);
}

/// Largest acceleration over gravity of a body alike above and below that floats half immersed, density half of water's.
double largestAcceleration(int dim, const Shapes& parts)
{
    FloatingBodies bodies(dim, aboutCentroid(parts), 500, 2*h);
    double largest = 0;
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 middle = Vec3(0.5, 0.5, 0.5) + h*(haltonPoint(k) - Vec3::Constant(0.5));
        largest = std::max(largest, bodies.release(middle, middle[dim - 1]).velocity.norm()/FloatingBodies::gravity);
    }
    return largest;
}

} // namespace

TEST_CASE("2D: a trunk that reaches into its root wad, lapped planks and a plank twice float half immersed")
{
    const double l = 3*h, t = h, w = 2*h;    // half of the length; of the trunk's and the wad's thickness
    const auto wad = boxFrom({-l, -w, -0.5}, {-l + h, w, 0.5});
    const auto trunk = boxFrom({-l, -t, -0.5}, {l, t, 0.5});
    const std::pair<const char*, Shapes> cases[] = {{"trunk beside its wad", {wad, boxFrom({-l + h, -t, -0.5}, {l, t, 0.5})}},
                                                    {"trunk in its wad", {wad, trunk}},
                                                    {"lapped planks", {boxFrom({-l, -t, -0.5}, {h, t, 0.5}), boxFrom({-h, -t, -0.5}, {l, t, 0.5})}},
                                                    {"twice the same", {trunk, trunk}}};
    for (const auto& [name, parts] : cases)
    {
        CAPTURE(name);
        const double acceleration = largestAcceleration(2, parts);
        std::printf("2D, %s: %.1e g\n", name, acceleration);
        CHECK(acceleration < 0.01);
    }
}

TEST_CASE("unions of parts thinner than an element float half immersed: a trunk with its wad, a cross")
{
    for (const int dim : {2, 3})
        for (const double thickness : {0.4, 0.8, 1.3})
        {
            const double t = 0.5*thickness*h, l = 2.5*h, z = dim == 2 ? 0.5 : t;
            const auto rod = [&](const Vec3& from, const Vec3& to) { return dim == 2 ? makeBox(0.5*(from + to), Vec3((to - from).norm(), 2*t, 1)) : makeCylinder(from, to, t); };
            const Shapes tree = {rod({-l, 0, 0}, {l, 0, 0}), boxFrom({-l, -2*t, dim == 2 ? -z : -2*z}, {-l + 3*t, 2*t, dim == 2 ? z : 2*z})};
            std::vector<std::pair<const char*, Shapes>> cases = {{"trunk with its wad", tree}, {"plus", {boxFrom({-l, -t, -z}, {l, t, z}), boxFrom({-t, -l, -z}, {t, l, z})}}};
            if (dim == 3) cases[1] = {"cross", {rod({-l, 0, 0}, {l, 0, 0}), makeCapsule({0, -l, 0}, {0, l, 0}, t)}};
            for (const auto& [name, parts] : cases)
            {
                CAPTURE(name);
                CAPTURE(thickness);
                const double acceleration = largestAcceleration(dim, parts);
                std::printf("%dD, %s, %.1f elements thick: %.1e g\n", dim, name, thickness, acceleration);
                CHECK(acceleration < 0.01);
            }
        }
}
