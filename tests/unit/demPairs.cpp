// SPDX-License-Identifier: GPL-3.0-or-later
/// Mean forces of every pair in contact: they add up to what the bodies and walls feel, and cost the motion nothing.
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace flotsam;
using namespace demTest;

namespace
{

constexpr double interval = 1e-3;

/// Largest difference of any body's contact force from the sum over its contacts, over the largest force of a pair. restraints: on bodies.
double imbalance(const LiggghtsEngine& engine, const DemSetup& setup)
{
    std::vector<Vec3> rest(setup.bodies.size());
    for (size_t b = 0; b < rest.size(); ++b)
        rest[b] = engine.meanContactLoads()[b].force;
    double largest = 0;
    for (const MeanContact& c : engine.meanContacts())
    {
        rest[static_cast<size_t>(c.body)] -= c.force;
        if (c.other >= 0)
            rest[static_cast<size_t>(c.other)] += c.force;
        largest = std::max(largest, c.force.norm());
        CHECK(c.overlap > 0);
        CHECK(c.spheres > 0);
        CHECK(c.point.allFinite());
    }
    const std::vector<RestraintLoad> restraints = engine.restraintLoads();
    for (size_t r = 0; r < restraints.size(); ++r)
    {
        if (setup.restraints[r].end.body >= 0)
            rest[static_cast<size_t>(setup.restraints[r].end.body)] -= restraints[r].force;
        if (setup.restraints[r].other.body >= 0)
            rest[static_cast<size_t>(setup.restraints[r].other.body)] += restraints[r].force;
    }
    double worst = 0;
    for (const Vec3& r : rest)
        worst = std::max(worst, r.norm());
    REQUIRE(largest > 0);
    return worst / largest;
}

/// The same of walls and movers.
double wallImbalance(const LiggghtsEngine& engine)
{
    std::vector<Load> rest = engine.meanWallLoads();
    double largest = 0;
    for (const MeanContact& c : engine.meanContacts())
        if (c.other < 0)
        {
            rest[static_cast<size_t>(-1 - c.other)].force += c.force;
            largest = std::max(largest, c.force.norm());
        }
    double worst = 0;
    for (const Load& r : rest)
        worst = std::max(worst, r.force.norm());
    REQUIRE(largest > 0);
    return worst / largest;
}

/// Up to the time [s], the last interval of it tallied.
void settle(LiggghtsEngine& engine, const std::vector<Load>& loads, double time)
{
    engine.setLoads(loads);
    const long n = std::lround(time / interval);
    for (long i = 0; i < n; ++i)
    {
        engine.tallyPairs(i + 1 == n);
        engine.advance(interval);
    }
}

constexpr double roundOff = 1e-10;

} // namespace

TEST_CASE("a stack of two balls: each contact bears what lies on it")
{
    const double radius = 0.01, upper = 0.02, lower = 0.05;
    const DemSetup setup = scene({ball(radius, lower, Vec3(0, 0, radius)), ball(radius, upper, Vec3(0, 0, 3 * radius))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    LiggghtsEngine engine(setup);
    settle(engine, weights(setup), 0.3);
    const std::vector<MeanContact> contacts = engine.meanContacts();
    REQUIRE(contacts.size() == 2);
    for (const MeanContact& c : contacts)
    {
        CHECK(c.body == 0);
        CHECK(c.spheres == 1);
        const bool isFloor = c.other == -1;
        CHECK(c.force[2] == near(gravity * (isFloor ? lower + upper : -upper), 1e-6));
        CHECK(c.point[2] == within(isFloor ? 0 : 2 * radius, 1e-5));
    }
    CHECK(imbalance(engine, setup) < roundOff);
}

TEST_CASE("contacts of a heap add up to the forces of bodies and walls, at planes and at meshes")
{
    for (const bool hasMeshes : {false, true})
    {
        CAPTURE(hasMeshes);
        const DemSetup setup = heap(6, hasMeshes);
        LiggghtsEngine engine(setup);
        engine.setLoads(weights(setup));
        double worst = 0;
        int checked = 0;
        for (int i = 0; i < 250; ++i)
        {
            const bool isTallied = i % 10 == 9; // what comes before is not, and leaves its last sub-step
            engine.tallyPairs(isTallied);
            engine.advance(interval);
            if (!isTallied)
            {
                CHECK(engine.meanContacts().empty());
                continue;
            }
            if (!engine.hasContact())
                continue;
            worst = std::max(worst, imbalance(engine, setup));
            ++checked;
            if (!hasMeshes)
                CHECK(wallImbalance(engine) < roundOff);
        }
        CHECK(checked > 5);
        CHECK(worst < roundOff);
    }
}

TEST_CASE("a pile at pipes: the same contacts after a state was restored, and the same motion with and without the tally")
{
    const DemSetup setup = pile();
    const std::vector<Load> loads = pressing(setup);
    LiggghtsEngine engine(setup), plain(setup);
    settle(engine, loads, 0.05);
    CHECK(imbalance(engine, setup) < roundOff);
    CHECK(wallImbalance(engine) < 1e-6); // a sphere between two pipes shares its force out
    settle(plain, loads, 0.05);
    const DemState state = engine.save();
    CHECK(plain.save().data == state.data);

    engine.tallyPairs(true);
    engine.advance(interval);
    CHECK(imbalance(engine, setup) < roundOff);
    const std::vector<MeanContact> contacts = engine.meanContacts();
    LiggghtsEngine other(setup);
    for (LiggghtsEngine* const again : {&engine, &other})
    {
        again->restore(state);
        again->setLoads(loads);
        again->tallyPairs(true);
        again->advance(interval);
        CHECK(again->save().data == engine.save().data);
        const std::vector<MeanContact> found = again->meanContacts();
        REQUIRE(found.size() == contacts.size());
        for (size_t k = 0; k < contacts.size(); ++k)
        {
            const MeanContact &a = found[k], &b = contacts[k];
            CHECK((a.body == b.body && a.other == b.other && a.point == b.point && a.force == b.force && a.overlap == b.overlap && a.spheres == b.spheres));
        }
    }
    plain.tallyPairs(false);
    plain.advance(interval);
    CHECK(plain.save().data == engine.save().data);
    CHECK(plain.meanContacts().empty());
}

TEST_CASE("the first step of bodies that lie in each other at the start")
{
    const double radius = 0.01;
    const DemSetup setup = scene({ball(radius, 0.05, Vec3(0, 0, 0.999 * radius)), ball(radius, 0.02, Vec3(0.001, 0, 2.99 * radius))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    LiggghtsEngine engine(setup);
    settle(engine, weights(setup), interval);
    CHECK(engine.meanContacts().size() == 2);
    CHECK(imbalance(engine, setup) < roundOff);
}

TEST_CASE("what is gone presses on nothing")
{
    const double radius = 0.01;
    for (const bool hasMesh : {false, true})
    {
        CAPTURE(hasMesh);
        const WallDefinition floor = hasMesh ? block(Vec3(-0.1, -0.1, -0.05), Vec3(0.2, 0.1, 0)) : plane(Vec3::Zero(), Vec3::UnitZ());
        const DemSetup setup = scene({ball(radius, 0.05, Vec3(0, 0, radius)), ball(radius, 0.02, Vec3(0.1, 0, radius))}, {floor});
        LiggghtsEngine engine(setup);
        settle(engine, weights(setup), 0.1);
        CHECK(engine.meanWallLoads()[0].force[2] == near(-0.07 * gravity, 1e-4));
        engine.setHeld({1, 0});
        engine.setGone({1, 0});
        engine.advance(interval);
        CHECK(engine.meanWallLoads()[0].force[2] == near(-0.02 * gravity, 1e-3));
        CHECK(engine.meanWallLoads()[0].moment[1] == near(0.1 * 0.02 * gravity, 1e-3));
        CHECK(wallImbalance(engine) < roundOff);
        CHECK(engine.meanContacts().size() == 1);
        engine.setHeld({1, 1});
        engine.setGone({1, 1});
        engine.advance(interval);
        CHECK(engine.meanWallLoads()[0].force == Vec3(0, 0, 0));
        CHECK(engine.meanWallLoads()[0].moment == Vec3(0, 0, 0));
        CHECK(engine.meanContacts().empty());
        CHECK_FALSE(engine.hasContact());
    }
}

TEST_CASE("movers, restraints and bodies of a plane have their part")
{
    const double radius = 0.01;
    DemSetup setup = scene({ball(radius, 0.05, Vec3(0, 0, radius)), ball(radius, 0.05, Vec3(0.0201, 0, radius))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    for (BodyDefinition& body : setup.bodies)
    {
        body.isPlanar = true;
        body.planeAxis = 1;
    }
    MoverDefinition mover;
    mover.name = "mover";
    mover.spheres = {{Vec3(0, 0, 0), radius}};
    mover.motion = [=](double t, Pose& pose, Motion& motion)
    {
        pose = {Vec3(-0.0202 + 0.05 * t, 0, radius), Eigen::Quaterniond::Identity()};
        motion = {Vec3(0.05, 0, 0), Vec3::Zero()};
    };
    setup.movers = {mover};
    RestraintDefinition spring;
    spring.name = "spring";
    spring.end = {1, -1, Vec3::Zero()};
    spring.other = {-1, -1, Vec3(0.05, 0, radius)};
    spring.stiffness = 100;
    spring.length = 0.02;
    setup.restraints = {spring};
    LiggghtsEngine engine(setup);
    engine.setLoads(weights(setup));
    engine.tallyPairs(true);
    double withMover = 0;
    for (int i = 1; i <= 20; ++i)
    {
        std::vector<Pose> poses(1);
        Motion motion;
        mover.motion(i * interval, poses[0], motion);
        engine.moveTo(poses, interval);
        engine.advance(interval);
        CHECK(imbalance(engine, setup) < roundOff);
        CHECK(wallImbalance(engine) < roundOff);
        for (const MeanContact& c : engine.meanContacts())
            if (c.other == -2)
                withMover = std::max(withMover, c.force[0]);
    }
    CHECK(withMover > 0);
    CHECK(std::abs(engine.restraintLoads()[0].force[0]) > 0);
}
