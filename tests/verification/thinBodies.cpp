// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies thinner than an element float as deep as others: alone, and in a raft whose logs touch.
#include "support/floatingBodies.hpp"

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int nPlaces = 6;

/// Largest acceleration over gravity of logs side by side that float half immersed, density half of water's.
double largestAcceleration(int dim, double thickness, bool isBox, int nLogs)
{
    const double d = thickness/FloatingBodies::n;
    const double length = dim == 2 ? 1 : 0.5;
    const auto shape = isBox ? makeBox(Vec3::Zero(), dim == 2 ? Vec3(d, d, length) : Vec3(d, length, d))
                             : dim == 2 ? makeCylinder(Vec3(0, 0, -0.5*length), Vec3(0, 0, 0.5*length), 0.5*d) : makeCylinder(Vec3(0, -0.5*length, 0), Vec3(0, 0.5*length, 0), 0.5*d);
    FloatingBodies bodies(dim, shape, 500, 0.5*d);
    double largest = 0;
    for (int k = 0; k < nPlaces; ++k)
    {
        const Vec3 middle = Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/FloatingBodies::n;
        std::vector<Vec3> places;
        for (int j = 0; j < nLogs; ++j) places.push_back(middle + (j - 0.5*(nLogs - 1))*d*Vec3::UnitX());
        for (const Motion& motion : bodies.release(places, middle[dim - 1])) largest = std::max(largest, motion.velocity.norm()/FloatingBodies::gravity);
    }
    std::printf("%dD, %s of %.1f elements, %d side by side: %.1e g\n", dim, isBox ? "planks" : "logs", thickness, nLogs, largest);
    return largest;
}

} // namespace

TEST_CASE("bodies thinner than an element float")
{
    for (const int dim : {2, 3})
        for (const double thickness : {0.3, 0.6, 1.0, 1.4})
            for (const bool isBox : {false, true})
                for (const int nLogs : {1, 3}) CHECK(largestAcceleration(dim, thickness, isBox, nLogs) < 0.01);   // by the distance at the nodes, with the volume exact, at 1.5 elements: 0.027 to 0.077
}
