// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/nextTimeStep.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cfenv>

using namespace flotsam;

TEST_CASE("the time step is the shortest of what limits it")
{
    TimeControls time;
    time.maxCo = 0.5;
    time.maxBodyCo = 0.25;
    time.maxDeltaT = 0.1;
    CHECK(nextTimeStep(100, 1, time, 0.01) == std::pair(0.005, std::string("flow")));
    CHECK(nextTimeStep(1, 100, time, 0.01) == std::pair(0.0025, std::string("body")));
    CHECK(nextTimeStep(1, 1, time, 1) == std::pair(0.1, std::string("cap")));
    CHECK(nextTimeStep(1, 1, time, 0.01) == std::pair(1.2*0.01, std::string("growth")));
    time.adjustTimeStep = false;
    time.deltaT = 0.3;
    CHECK(nextTimeStep(100, 100, time, 0.01) == std::pair(0.3, std::string("fixed")));
}

TEST_CASE("in the first step what falls goes no farther than maxCo elements")
{
    const double maxCo = 0.5, h = 0.02, g = 9.81, dt = firstTimeStep(1, maxCo, h, g);
    CHECK(g*dt*dt/h == near(maxCo, 1e-14));
    CHECK(firstTimeStep(0.1*dt, maxCo, h, g) == 0.1*dt);
    CHECK(firstTimeStep(1, maxCo, h, 0) == 1);
}

TEST_CASE("bodies that have come to rest do not overflow the time step")
{
    std::feclearexcept(FE_ALL_EXCEPT);
    for (const double rate : {0.0, 1e-300, 1e-310, 5e-324}) CHECK(nextTimeStep(rate, rate, TimeControls(), 0.01).second == "growth");
    CHECK(std::fetestexcept(FE_OVERFLOW | FE_DIVBYZERO | FE_INVALID) == 0);
}
