// SPDX-License-Identifier: GPL-3.0-or-later
/// Times of prescribed motions: what moves does so by its law, and begins and ends without jumps where it is given ramps.
#include "demCoupling/core/motionClock.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

const MotionClock ramped{1, 4, 0.5}, sudden{1, 4, 0}, endless{2, std::numeric_limits<double>::infinity(), 0.3};

}

TEST_CASE("a motion without times is that of its law from the start on")
{
    for (const double time : {0.0, 0.3, 1e6}) CHECK(MotionClock().at(time) == std::pair(time, 1.0));
    CHECK(MotionClock().jumps().empty());
}

TEST_CASE("the rate is the derivative of the law's time")
{
    for (const MotionClock& clock : {ramped, sudden, endless, MotionClock{0, 3, 1.5}, MotionClock{0, 3, 0}})
        for (double time = 0.05; time < 6; time += 0.1)
        {
            CAPTURE(time);
            const double h = 1e-6;
            CHECK((clock.at(time + h).first - clock.at(time - h).first)/(2*h) == within(clock.at(time).second, 1e-8));
        }
}

TEST_CASE("it stands before its start and after its end, and with ramps its rate and the rate's derivative do not jump")
{
    CHECK(ramped.at(1) == std::pair(0.0, 0.0));
    CHECK(ramped.at(1.25).second == near(0.5, 1e-15));
    CHECK(ramped.at(2.5) == std::pair(1.25, 1.0));
    CHECK(ramped.at(4).first == near(2.5, 1e-15));      // two halves of 0.5 s are lost
    CHECK(ramped.at(7) == std::pair(2.5, 0.0));
    CHECK(ramped.jumps().empty());
    for (const double turn : {1.0, 1.5, 3.5, 4.0})
    {
        const double h = 1e-5;
        CHECK(ramped.at(turn + h).second - ramped.at(turn - h).second == within(0, 1e-8));
    }
}

TEST_CASE("where the rate jumps it is that of the step that ends there")
{
    CHECK(sudden.jumps() == std::vector<double>{1, 4});
    CHECK(sudden.at(1).second == 0);
    CHECK(sudden.at(1.01).second == 1);
    CHECK(sudden.at(4) == std::pair(3.0, 1.0));
    CHECK(sudden.at(4 + 1e-15) == std::pair(3.0, 1.0)); // a step that ends there to round-off
    CHECK(sudden.at(1 + 1e-15).second == 0);
    CHECK(sudden.at(4.01) == std::pair(3.0, 0.0));
    CHECK(MotionClock{0, 4, 0}.at(0).second == 1);      // moves from the start
    CHECK(MotionClock{0, 4, 0}.jumps() == std::vector<double>{4});
}
