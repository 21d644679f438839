// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that touch in water at rest stay where they are, afloat and under water: whatever the cut leaves between them, each has the buoyancy of what it displaces.
#include "support/floatingBodies.hpp"

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nPlaces = 4;
constexpr double radius = 0.13; // 2.6 elements a diameter

std::shared_ptr<const Shape> discOrLog(int dim)
{
    return dim == 2 ? makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), radius) : makeCylinder(Vec3(0, -0.3, 0), Vec3(0, 0.3, 0), radius);
}

/// Places of touching logs about their middle [m].
std::vector<Vec3> around(int dim, const Vec3& middle, const std::vector<std::array<double, 2>>& places)
{
    std::vector<Vec3> result;
    for (const auto& [along, up] : places)
    {
        Vec3 x = middle;
        x[0] += along;
        x[dim - 1] += up;
        result.push_back(x);
    }
    return result;
}

struct Largest { double along = 0, up = 0; };

/// Largest acceleration of any of them along the surface and upward over gravity, at places in an element; over: level over their middle [m].
Largest accelerations(int dim, double density, const std::vector<std::array<double, 2>>& places, double over)
{
    FloatingBodies bodies(dim, discOrLog(dim), density, radius);
    Largest largest;
    for (int k = 0; k < nPlaces; ++k)
    {
        Vec3 middle = Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/FloatingBodies::n;
        middle[dim - 1] -= 0.1;
        for (const Motion& motion : bodies.release(around(dim, middle, places), middle[dim - 1] + over))
        {
            Vec3 a = motion.velocity/FloatingBodies::gravity;
            largest.up = std::max(largest.up, std::abs(a[dim - 1]));
            a[dim - 1] = 0;
            largest.along = std::max(largest.along, a.norm());
        }
    }
    std::printf("%dD, density %g: along %.1e, up %.1e of gravity\n", dim, density, largest.along, largest.up);
    return largest;
}

} // namespace

TEST_CASE("bodies that touch have the buoyancy of what they displace")
{
    const double up = std::sqrt(3.0)*radius;
    const std::vector<std::array<double, 2>> raft{{-2*radius, 0}, {0, 0}, {2*radius, 0}}, pile{{-radius, 0}, {radius, 0}, {0, up}};
    for (int dim : {2, 3})
    {
        const Largest afloat = accelerations(dim, 500, raft, 0), under = accelerations(dim, 1000, pile, 0.5);
        CHECK(afloat.along < 2e-3); // without what the layers have of weight, gravity and the surface's pressure 0.06 to 0.07, under water, too
        CHECK(afloat.up < 2e-2);    // flat facets in the surface
        CHECK(under.along < 2e-6);
        CHECK(under.up < 2e-6);
    }
}
