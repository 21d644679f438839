// SPDX-License-Identifier: GPL-3.0-or-later
/// constant/bodies: places of bodies, given and random, and what they conflict with.
#include "demCoupling/foam/bodyPlacement.hpp"
#include "support/bodiesScene.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

TEST_CASE("random: the group's releaseTime is that of the first body; what would do nothing is refused")
{
    BodiesScene s;
    const auto group = [](const std::string& ofGroup, const std::string& ofRandom)
    { return bodies(bar + ofGroup + "random { count 3; box ((0.1 0.02 0.02) (1 0.9 0.38)); orientation fixed; " + ofRandom + "}"); };
    const auto releases = [&](const std::string& contents)
    {
        std::vector<double> times;
        for (const BodyDefinition& b : s.read(contents).bodies) times.push_back(b.releaseTime);
        return times;
    };
    CHECK(releases(group("", "")) == std::vector<double>{0, 0, 0});
    CHECK(releases(group("releaseTime 3; ", "")) == std::vector<double>{3, 3, 3});
    CHECK(releases(group("releaseTime 3; ", "release { interval 0.5; } ")) == std::vector<double>{3, 3.5, 4});
    CHECK(releases(group("", "release { from 1; interval 0.5; } ")) == std::vector<double>{1, 1.5, 2});
    CHECK(has(s.message(group("releaseTime 3; ", "release { from 1; } ")), "Both 'releaseTime' of the group and 'from' of 'release'"));
    CHECK(has(s.message(group("position (0.5 0.5 0.2); ", "")), "'position' does nothing"));
}

TEST_CASE("random places: inside the box, apart, the same for the same seed")
{
    BodiesScene s;
    const auto contents = [](int seed, const std::string& orientation)
    {
        return "structures { post { shape { type cylinder; end1 (0.5 0 0.2); end2 (0.5 1 0.2); radius 0.05; } } }"
            + bodies(bar + "random { count 20; box ((0.1 0.02 0.02) (1 0.9 0.38)); seed " + std::to_string(seed) + "; minGap 0.005; orientation " + orientation
                + "; release { from 1; interval 0.5; } }");
    };
    const BodiesInput input = s.read(contents(3, "random"));
    REQUIRE(input.bodies.size() == 20);
    CHECK(input.bodies[4].releaseTime == 3);
    const auto sampled = std::make_shared<SampledShape>(input.bodies[0].shape, 0.005);
    for (std::size_t i = 0; i < input.bodies.size(); ++i)
    {
        const ShapeAtPose a{"", sampled, input.bodies[i].pose};
        const auto box = a.spaceBounds();
        for (int d = 0; d < 3; ++d)
        {
            CHECK(box[0][d] >= Vec3(0.1, 0.02, 0.02)[d] - 1e-12);
            CHECK(box[1][d] <= Vec3(1, 0.9, 0.38)[d] + 1e-12);
        }
        for (const Vec3& p : sampled->points())
            CHECK(input.structures[0].solid.distance(a.pose.orientation*p + a.pose.position) >= 0.005 - 1e-9);
        for (std::size_t j = 0; j < i; ++j) CHECK(gap(a, {"", sampled, input.bodies[j].pose}, 0.01) >= 0.004);
    }
    const BodiesInput again = s.read(contents(3, "random")), other = s.read(contents(4, "uniformYaw"));
    CHECK(again.bodies[7].pose.position == input.bodies[7].pose.position);
    CHECK(other.bodies[7].pose.position != input.bodies[7].pose.position);
    for (const auto& b : other.bodies) CHECK(std::abs((b.pose.orientation*Vec3::UnitX()).y()) < 1e-12); // yaw about y, which is up
}

TEST_CASE("bodies that come in at their release may have one place; structures and walls must be out of it")
{
    BodiesScene s;
    const std::string absent = bar + "beforeRelease absent; ", at = "position (0.5 0.5 0.2); ";
    const BodiesInput input = s.read(bodies(absent + "poses ( { position (0.5 0.5 0.2); releaseTime 1; } { position (0.5 0.5 0.2); releaseTime 2; } );"));
    REQUIRE(input.bodies.size() == 2);
    for (const BodyDefinition& body : input.bodies) CHECK(body.entersAtRelease);
    CHECK(!s.read(bodies(bar + at)).bodies[0].entersAtRelease);
    const BodiesInput stream = s.read(bodies(absent + "random { count 200; box ((0.3 0.4 0.1) (0.6 0.5 0.3)); orientation uniformYaw; release { from 1; interval 0.5; } }"));
    CHECK(stream.bodies.size() == 200);
    CHECK(s.message("structures { post { shape { type cylinder; end1 (0.5 0 0.2); end2 (0.5 1 0.2); radius 0.05; } } }" + bodies(absent + at)).find("into structure post")
        != std::string::npos);
    CHECK(s.message(bodies(absent + "position (0.5 0.005 0.2);")).find("wall floor") != std::string::npos);
    CHECK(s.message(bodies(bar + at + "beforeRelease abesnt;")).find("Did you mean: absent") != std::string::npos);
}

TEST_CASE("gaps of placed shapes")
{
    const auto box = std::make_shared<SampledShape>(makeBox(Vec3::Zero(), Vec3(1, 0.1, 0.1)), 0.02);
    const Pose crossed{Vec3(0, 0, 0.15), Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/2, Vec3::UnitZ()))};
    CHECK(gap({"", box, {}}, {"", box, crossed}, 1) == near(0.05, 1e-14));
    const Pose through{Vec3(0, 0, 0.08), crossed.orientation};
    CHECK(gap({"", box, {}}, {"", box, through}, 1) == near(-0.02, 1e-14));
    CHECK(gap({"", box, {}}, {"", box, {Vec3(9, 0, 0), {1, 0, 0, 0}}}, 0.5) == 0.5);
    CHECK(gap({"", box, {}}, {"", box, {}}, 0) == near(-0.05, 1e-14)); // in the same place: no point of a surface is inside the other
    CHECK(gap({"", box, {}}, {"", box, {Vec3(0, 0, 0.1), {1, 0, 0, 0}}}, 0) == within(0, 1e-17));
}

TEST_CASE("a place is free where nothing conflicts with it")
{
    const auto box = std::make_shared<SampledShape>(makeBox(Vec3::Zero(), Vec3(1, 0.1, 0.1)), 0.02);
    Obstacles obstacles;
    obstacles.box = {Vec3(-2, -2, -2), Vec3(2, 2, 2)};
    obstacles.planes = {{"floor", Vec3(0, 0, -1), Vec3::UnitZ()}};
    obstacles.bodies = {{"first", box, {}}, {"second", box, {Vec3(0, 0.5, 0), {1, 0, 0, 0}}}};
    RandomNumbers numbers(1);
    int nFree = 0, nTaken = 0;
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 place(2*numbers.uniform() - 1, 2*numbers.uniform() - 1, 2.4*numbers.uniform() - 1.2);
        const ShapeAtPose body{"", box, {place, numbers.rotation()}};
        const bool isFree = isPlaceFree(body, obstacles, 0.01);
        CHECK(isFree == !findConflict(body, obstacles, 0.01));
        ++(isFree ? nFree : nTaken);
    }
    CHECK(nFree > 20);
    CHECK(nTaken > 20);
}

TEST_CASE("bodies may touch the sides of the mesh exactly, at coordinates of a map, whose last digit is nanometres, too")
{
    const auto brick = std::make_shared<SampledShape>(makeBox(Vec3::Zero(), Vec3::Constant(0.3)), 0.1);
    Obstacles obstacles;
    for (int k = 0; k < 100; ++k)
    {
        const auto place = [&](double along) { return Vec3(523456.7, 9601234.9 + (along + 0.01*k), 350.3 + along); };
        obstacles.box = {place(0), place(0.3)};
        obstacles.box[1][0] += 1;
        CHECK(isPlaceFree({"", brick, {place(0.15) + Vec3(0.4, 0, 0)}}, obstacles, 0));
        CHECK(!isPlaceFree({"", brick, {place(0.15) + Vec3(0.4, 1e-6, 0)}}, obstacles, 0));
    }
}

TEST_CASE("points of narrow triangles")
{
    TriSurface strip;
    strip.points = {Vec3(0, 0, 0), Vec3(0, 0.01, 0), Vec3(1, 0, 0)};
    strip.triangles = {{0, 1, 2}};
    const std::vector<Vec3> points = pointsOnSurface(strip, 0.02);
    CHECK(points.size() > 100);     // both long edges
    CHECK(points.size() < 120);
}
