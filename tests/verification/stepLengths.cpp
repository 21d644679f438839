// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies answer the water alike at all step lengths: what resists velocities in every step must not grow with the number of steps (docs/numerics, 2.14).
#include "support/bodyTank.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace bodyTank;

namespace
{

constexpr double dip = 0.03, duration = 0.3;    // [m], of the bar below its rest at the start; [s], two thirds of a swing

/// Heights of the bar over that at the start, at 0.1, 0.2, 0.3 s.
std::vector<double> heights(double dt, double penaltyRate)
{
    Tank tank;
    tank.controls.penaltyRate = penaltyRate;
    const Vec3 start(0.5, level + side/2 - 0.6*side - dip, 0.5);
    const DemSetup dem = makeDem({makeBar("bar", 0, start)});
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    std::vector<double> result;
    const int nSteps = int(std::lround(duration/dt));
    for (int k = 1; k <= nSteps; ++k)
    {
        REQUIRE(run->step(dt).isAccepted);
        if (3*k % nSteps == 0) result.push_back(run->records()[0].pose.position[1] - start[1]);
    }
    return result;
}

/// Largest difference from long steps to eight times as many, over the dip.
double difference(double penaltyRate)
{
    const std::vector<double> longSteps = heights(4e-3, penaltyRate), shortSteps = heights(5e-4, penaltyRate);
    double largest = 0;
    for (std::size_t k = 0; k < longSteps.size(); ++k) largest = std::max(largest, std::abs(longSteps[k] - shortSteps[k])/dip);
    std::printf("penaltyRate %g: risen [m] %.5f %.5f %.5f with steps of 4 ms, %.5f %.5f %.5f with 0.5 ms, difference over the dip %.4f\n", penaltyRate, longSteps[0], longSteps[1],
        longSteps[2], shortSteps[0], shortSteps[1], shortSteps[2], largest);
    return largest;
}

} // namespace

TEST_CASE("a floating bar that was pushed down rises alike with steps an eighth as long")
{
    CHECK(difference(NumericsControls().penaltyRate) < 0.02);
    CHECK(difference(1e9) > 0.06);   // the steps themselves in the penalties, as before
}
