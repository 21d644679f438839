// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/motionCheck.hpp"
#include "demCoupling/coupling/scene.hpp"

#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double side = 0.2;

BodyDefinition makeCube(const std::string& name)
{
    BodyDefinition cube;
    cube.name = name;
    cube.shape = makeBox(Vec3::Zero(), Vec3::Constant(side));
    cube.mass = 8;
    for (const double x : {-0.08, 0.08})
        for (const double y : {-0.08, 0.08})
            for (const double z : {-0.08, 0.08}) cube.spheres.push_back({Vec3(x, y, z), 0.02});
    return cube;
}

BodyDefinition makeBar(const std::string& name)
{
    BodyDefinition bar;
    bar.name = name;
    for (const double x : {-0.49, 0.0, 0.49}) bar.spheres.push_back({Vec3(x, 0, 0), 0.01});
    return bar;
}

BodyState at(double x, double y, double z)
{
    BodyState state;
    state.pose.position = Vec3(x, y, z);
    return state;
}

/// Square of 1 m around the origin, normal to x.
WallDefinition makeSquare()
{
    WallDefinition wall;
    wall.name = "square";
    wall.kind = WallDefinition::Kind::Surface;
    wall.surface.points = {{0, -0.5, -0.5}, {0, 0.5, -0.5}, {0, 0.5, 0.5}, {0, -0.5, 0.5}};
    wall.surface.triangles = {{0, 1, 2}, {0, 2, 3}};
    return wall;
}

WallDefinition makeFloor()
{
    WallDefinition wall;
    wall.name = "floor";
    wall.point = Vec3(0, -1, 0);
    wall.normal = Vec3::UnitY();
    return wall;
}

} // namespace

TEST_CASE("centres of spheres on the other side of a wall or in another body")
{
    const MotionCheck check({makeCube("first"), makeCube("second")}, {makeFloor(), makeSquare()});
    const BodyState far = at(5, 0, 0);
    const std::vector<char> none(2, 0);
    const std::vector<Load> touching(2, Load{Vec3::UnitX(), Vec3::Zero()});
    auto passage = [&](const BodyState& before, const BodyState& after) { return check.passage({before, far}, {after, far}, touching, none); };
    CHECK(passage(at(0.09, 0.03, 0.02), at(0.081, 0.03, 0.02)) == "");              // overlap 0.019
    CHECK(passage(at(0.09, 0.03, 0.02), at(0.079, 0.03, 0.02)) == "body 'first' passes through 'square'");
    CHECK(passage(at(-0.09, 0.03, 0.02), at(-0.079, 0.03, 0.02)) == "body 'first' passes through 'square'");
    CHECK(passage(at(0.09, 0.7, 0.02), at(-0.5, 0.7, 0.02)) == "");                  // beside it
    CHECK(passage(at(0, 0.7, 0.02), at(0, 0.05, 0.02)) == "");                       // around it already, along it
    BodyState turned = at(0.09, 0.03, 0.02);
    turned.pose.orientation = Eigen::AngleAxisd(0.5, Vec3::UnitZ());
    CHECK(passage(at(0.09, 0.03, 0.02), turned) == "body 'first' passes through 'square'");
    CHECK(passage(at(2, -0.91, 0), at(2, -0.919, 0)) == "");
    CHECK(passage(at(2, -0.91, 0), at(2, -0.921, 0)) == "body 'first' passes through 'floor'");

    const BodyState other = at(3, 0, 0);
    CHECK(check.passage({at(2.81, 0, 0), other}, {at(2.819, 0, 0), other}, touching, none) == "");
    CHECK(check.passage({at(2.81, 0, 0), other}, {at(2.821, 0, 0), other}, touching, none) == "body 'first' passes into body 'second'");
    CHECK(check.passage({other, at(2.81, 0, 0)}, {other, at(2.821, 0, 0)}, touching, none) == "body 'second' passes into body 'first'");
    CHECK(check.passage({at(2.9, 0, 0), other}, {at(2.91, 0, 0), other}, touching, none) == "");     // was inside: not this step's doing
    CHECK(check.passage({at(2.81, 0.06, 0), other}, {at(2.83, 0.06, 0), other}, touching, none) == "");   // between spheres, above their centres: nothing pushes inward
    CHECK(check.passage({at(2.81, 0.06, 0), other}, {at(2.841, 0.06, 0), other}, touching, none) == "body 'first' passes into body 'second'");
}

TEST_CASE("the spheres of a thin body touch a rounder one than its edges are: no passage in front of them")
{
    BodyDefinition chip = makeCube("chip");
    chip.spheres = {{Vec3::Zero(), 0.002}};
    const MotionCheck check({chip, makeCube("cube")}, {});
    const std::vector<char> none(2, 0);
    const std::vector<Load> touching(2, Load{Vec3::UnitX(), Vec3::Zero()});
    const BodyState cube = at(0, 0, 0);
    auto corner = [&](double x) { return at(x, x, x); };
    CHECK(check.passage({corner(0.101), cube}, {corner(0.0925), cube}, touching, none) == "");            // in the shape, but 0.002 outside the sphere
    CHECK(check.passage({corner(0.101), cube}, {corner(0.0915), cube}, touching, none) == "body 'chip' passes into body 'cube'");
}

TEST_CASE("a body that contact throws faster than anything there is")
{
    const MotionCheck check({makeCube("first"), makeCube("second")}, {});
    BodyState slow = at(0, 0, 0), quick = at(1, 0, 0);
    slow.motion.velocity = Vec3(1, 0, 0);
    const std::vector<Load> touching{{Vec3(1, 0, 0), Vec3::Zero()}, {Vec3(-1, 0, 0), Vec3::Zero()}}, apart(2);
    auto thrown = [&](double speed, const std::vector<Load>& contact, double fluid)
    {
        quick.motion.velocity = Vec3(0, speed, 0);
        return check.thrownBody({slow, at(1, 0, 0)}, {slow, quick}, contact, fluid, 0.1);
    };
    CHECK(thrown(3.0, touching, 0) == "");
    CHECK(thrown(3.2, touching, 0) == "second");
    CHECK(thrown(3.2, apart, 0) == "");
    CHECK(thrown(3.2, touching, 2) == "");
    CHECK(thrown(std::nan(""), touching, 0) == "second");
}

TEST_CASE("a body far from its prediction")
{
    const MotionCheck check({makeCube("first")}, {});
    BodyState turned = at(0, 0, 0);
    turned.pose.orientation = Eigen::AngleAxisd(0.1, Vec3::UnitZ());
    CHECK(check.strayBody({at(0, 0, 0)}, {at(0.1, 0, 0)}, 0.11) == "");
    CHECK(check.strayBody({at(0, 0, 0)}, {at(0.1, 0, 0)}, 0.09) == "first");
    CHECK(check.strayBody({at(0, 0, 0)}, {turned}, 0.02) == "");
    CHECK(check.strayBody({at(0, 0, 0)}, {turned}, 0.01) == "first");
}

TEST_CASE("speed of a body's surface: what it rolls about does not count, in 2D its extent across neither")
{
    Pose pose;
    pose.orientation = Eigen::AngleAxisd(0.7, Vec3::UnitZ());
    const Vec3 along = pose.orientation*Vec3::UnitX();
    const std::array<Vec3, 2> bar{Vec3(-0.5, -0.05, -0.05), Vec3(0.5, 0.05, 0.05)}, sheet{Vec3(-0.1, -0.05, -5), Vec3(0.1, 0.05, 5)};
    CHECK(fastestCorner(bar, pose, {Vec3::Zero(), 20*along}) == near(20*0.05*std::sqrt(2.), 1e-13));
    CHECK(fastestCorner(bar, pose, {along, Vec3::Zero()}) == near(1, 1e-13));
    CHECK(fastestCorner(bar, pose, {Vec3::Zero(), 2*Vec3::UnitZ()}) == near(2*std::hypot(0.5, 0.05), 1e-13));
    CHECK(fastestCorner(sheet, pose, {0.3*along, 2*Vec3::UnitZ()}) == near(std::hypot(0.3 + 2*0.05, 2*0.1), 1e-13));
}

TEST_CASE("a bar that rolls about its length goes less far than one that turns across it")
{
    const MotionCheck check({makeBar("bar")}, {}); // half a metre long to each side, 0.02 m thick
    BodyState rolled = at(0, 0, 0), turned = at(0, 0, 0);
    rolled.pose.orientation = Eigen::AngleAxisd(0.2, Vec3::UnitX());
    turned.pose.orientation = Eigen::AngleAxisd(0.2, Vec3::UnitY());
    CHECK(check.strayBody({at(0, 0, 0)}, {rolled}, 0.0042) == "");
    CHECK(check.strayBody({at(0, 0, 0)}, {rolled}, 0.0028) == "bar"); // its edges
    CHECK(check.strayBody({at(0, 0, 0)}, {turned}, 0.099) == "bar");
    CHECK(check.strayBody({at(0, 0, 0)}, {turned}, 0.102) == "");
}

TEST_CASE("structures outside of the mesh do not limit time steps, unless they may come into it within the next one")
{
    SceneStructure gate;
    gate.solid.name = "gate";
    gate.solid.shape = makeBox(Vec3::Zero(), Vec3::Constant(side));
    gate.solid.kind = Solid::Kind::Prescribed;
    gate.motion = [](double time, Pose& pose, Motion& motion)   // leaves a mesh of 1 m upwards with 3 m/s
    {
        pose = {Vec3(0.5, 0.5, 0.5 + 3*time), Eigen::Quaterniond::Identity()};
        motion = {Vec3(0, 0, 3), Vec3::Zero()};
    };
    Scene scene({gate}, {}, Vec3(0, 0, -9.81));
    const auto fastest = [&](double now, double ahead)
    {
        scene.place(now, nullptr);
        return scene.fastest(now + ahead, ahead).second;
    };
    CHECK(fastest(10, 0) == 3);         // without a mesh everything counts
    scene.liesIn({Vec3::Zero(), Vec3::Ones()});
    CHECK(fastest(0, 0.1) == 3);
    CHECK(fastest(0.199, 0.001) == 3);  // its lower side is in it
    CHECK(fastest(0.21, 0.0001) == 0);  // 3 cm above it
    CHECK(fastest(0.21, 0.1) == 3);     // it could be back within that time
    CHECK(scene.fastest(10, 0.1).first == "gate");
    CHECK(fastest(10, 0.1) == 0);
    CHECK(fastest(-0.3, 0.0001) == 0);  // below it, on its way
    CHECK(fastest(-0.3, 0.15) == 3);
}
