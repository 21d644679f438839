// SPDX-License-Identifier: GPL-3.0-or-later
/// Motions that leave the mesh for good or are faster than anything in it: told, the first of each kind. What gates, flaps and rotors do is not.
#include "demCoupling/foam/motionChecks.H"
#include "support/bodiesScene.H"

#include <doctest/doctest.h>

#include <mpi.h>

using namespace flotsam;

namespace
{

std::vector<std::string> doubts(BodiesScene& s, const std::string& motion, const std::string& ofBody = "", double gravity = 9.81)
{
    const std::string gate = "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.8 0.5 0.2); motion { " + motion + " } } }";
    return doubtfulMotions(s.read((motion.empty() ? "" : gate) + bodies(bar + "position (0.5 0.5 0.2); " + ofBody)), gravity, 5);
}

} // namespace

TEST_CASE("what gates, flaps and rotors do")
{
    BodiesScene s;  // 2 m x 1 m x 0.4 m, diagonal 2.27 m
    for (const char* motion : {"type linear; velocity (0 0.5 0);", "type linear; velocity (0 50 0); timeEnd 0.02;", "type oscillating; direction (0 1 0); amplitude 0.3; period 2;",
            "type rotating; axis (0 0 1); rpm 600;", "type tabulated; displacement ((0 (0 0 0)) (1 (0 2 0)));"})
        CHECK(doubts(s, motion).empty());
    CHECK(doubts(s, "", "velocity (5 0 0); angularVelocity (0 0 50);").empty());
}

TEST_CASE("amplitudes, ways and speeds of other units")
{
    BodiesScene s;
    auto said = doubts(s, "type oscillating; direction (0 1 0); amplitude 50; period 100;");
    REQUIRE(said.size() == 1);
    CHECK(has(said[0], "structure gate moves far out of the mesh: at 5 s it is 14.9"));     // 50 sin(18 degrees), from half a metre below its top
    CHECK(has(said[0], "whose diagonal is 2.27156 m"));
    said = doubts(s, "type tabulated; displacement ((0 (0 0 0)) (4 (0 300 0)));");          // in mm
    REQUIRE(said.size() == 2);
    CHECK(has(said[0], "moves far out of the mesh"));
    CHECK(has(said[1], "structure gate moves, at "));
    said = doubts(s, "type rotating; axis (0 0 1); omega 6000;");
    REQUIRE(said.size() == 1);
    CHECK(has(said[0], "structure gate moves, at 0 s, with 424.264 m/s: faster than what has fallen 100 times through the mesh (66.7593 m/s)"));
    said = doubts(s, "", "velocity (0 0 120);");
    REQUIRE(said.size() == 1);
    CHECK(has(said[0], "body bar begins with 120 m/s"));
    CHECK(doubts(s, "", "velocity (0 0 120);", 0).empty());     // nothing to compare it with
}
