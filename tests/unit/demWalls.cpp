// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/thinTriangles.hpp"
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;
using namespace demTest;

namespace
{

struct Totals
{
    Vec3 bodies = Vec3::Zero(), walls = Vec3::Zero(), bodyMoments = Vec3::Zero(), wallMoments = Vec3::Zero();
};

Totals totals(const LiggghtsEngine& engine)
{
    Totals t;
    const auto contact = engine.meanContactLoads();
    const auto states = engine.states();
    for (size_t b = 0; b < contact.size(); ++b)
    {
        t.bodies += contact[b].force;
        t.bodyMoments += states[b].pose.position.cross(contact[b].force) + contact[b].moment;
    }
    for (const Load& load : engine.meanWallLoads())
    {
        t.walls += load.force;
        t.wallMoments += load.moment;
    }
    return t;
}

} // namespace

TEST_CASE("walls feel the opposite of what bodies feel, and bodies gain what they feel")
{
    for (const bool hasMeshes : {false, true})
    {
        CAPTURE(hasMeshes);
        const DemSetup setup = heap(6, hasMeshes);
        LiggghtsEngine engine(setup);
        const auto loads = weights(setup);
        engine.setLoads(loads);
        double worstForce = 0, worstBalance = 0, scale = 0;
        for (int i = 0; i < 200; ++i)
        {
            const double duration = 2e-3;
            const auto before = engine.states();
            engine.advance(duration);
            const auto after = engine.states();
            const auto contact = engine.meanContactLoads();
            for (size_t b = 0; b < contact.size(); ++b)
            {
                const Vec3 gained = setup.bodies[b].mass * (after[b].motion.velocity - before[b].motion.velocity);
                const Vec3 turned = after[b].angularMomentum - before[b].angularMomentum;
                worstBalance = std::max(worstBalance, (gained - (contact[b].force + loads[b].force) * duration).norm());
                worstBalance = std::max(worstBalance, (turned - contact[b].moment * duration).norm());
            }
            const Totals t = totals(engine);
            worstForce = std::max(worstForce, (t.bodies + t.walls).norm());
            scale = std::max(scale, t.bodies.norm());
        }
        CHECK(scale > 1);
        CHECK(worstForce < 1e-12 * scale);
        CHECK(worstBalance < 1e-14);
    }
}

TEST_CASE("at rest the floor carries the weight and the moment about the origin")
{
    for (const bool hasMesh : {false, true})
    {
        CAPTURE(hasMesh);
        DemSetup setup = scene({debris(Vec3(0.07, 0.03, 0.0099999))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
        if (hasMesh)
            setup.walls = {block(Vec3(-0.4, -0.4, -0.1), Vec3(0.4, 0.4, 0))};
        LiggghtsEngine engine(setup);
        engine.setLoads(weights(setup));
        for (int i = 0; i < 100; ++i)
            engine.advance(1e-3);
        const Load floor = engine.meanWallLoads()[0];
        const double weight = 0.0472 * gravity;
        CHECK(floor.force.z() == near(-weight, 1e-13));
        CHECK(floor.moment.x() == near(-0.03 * weight, 1e-13));
        CHECK(floor.moment.y() == near(0.07 * weight, 1e-13));
        const auto contacts = engine.contacts();
        REQUIRE(contacts.size() == 1);
        CHECK(contacts[0].body == 0);
        CHECK(contacts[0].other == -1);
        CHECK(contacts[0].force.z() == near(weight, 1e-13));
        CHECK((contacts[0].point - Vec3(0.07, 0.03, 0)).norm() < 1e-5);
        CHECK(contacts[0].overlap == near(weight / 1e6, 5e-10)); // the whole face shares K
    }
}

TEST_CASE("triangles without width, three corners on one line as CAD programs leave them, do not end the run and carry nothing")
{
    std::vector<double> carried;
    for (const double thickness : {-1.0, 0.0, 1e-9, 8e-6}) // over the extent; -1: no such triangle
    {
        CAPTURE(thickness);
        DemSetup setup = scene({debris(Vec3(0.07, 0.03, 0.0099999))}, {});
        setup.walls = {block(Vec3(-0.4, -0.4, -0.1), Vec3(0.4, 0.4, 0))};
        TriSurface& s = setup.walls[0].surface;
        const int n = static_cast<int>(s.points.size());
        s.points.insert(s.points.end(), {Vec3(-0.4, -0.4, -0.1), Vec3(0, -0.4, -0.1 - thickness), Vec3(0.4, -0.4, -0.1)}); // below its lower edge
        if (thickness >= 0)
            s.triangles.push_back({n, n + 1, n + 2});
        LiggghtsEngine engine(setup);
        engine.setLoads(weights(setup));
        for (int i = 0; i < 20; ++i)
            engine.advance(1e-3);
        carried.push_back(engine.meanWallLoads()[0].force.z());
    }
    for (const double force : carried)
        CHECK(force == carried[0]);
}

TEST_CASE("the thinnest triangle that counts as no needle is taken, and a thinner one is not")
{
    const auto takes = [](double width)
    {
        DemSetup setup = scene({ball(0.01, 0.05, Vec3(0, 0, 0.02))}, {block(Vec3(-0.4, -0.4, -0.1), Vec3(0.4, 0.4, 0))});
        setup.walls[0].surface.points = {Vec3(-0.4, 0, 0), Vec3(0.4, 0, 0), Vec3(0.4, width, 0)};
        setup.walls[0].surface.triangles = {{0, 1, 2}};
        try
        {
            LiggghtsEngine engine(setup);
        }
        catch (const DemError&)
        {
            return false;
        }
        return true;
    };
    const auto isRefused = [](double width) { return ThinTriangle(Vec3(-0.4, 0, 0), Vec3(0.4, 0, 0), Vec3(0.4, width, 0)).isRefused; };
    for (const double width : {0.8 * 1.01e-3, 0.1})
    {
        CHECK(takes(width));
        CHECK(!isRefused(width));
    }
    CHECK(!takes(0.8 * 0.99e-3));
    CHECK(isRefused(0.8 * 0.99e-3));
    CHECK(isRefused(0));
}

TEST_CASE("planes of any direction act alike")
{
    std::vector<double> speeds;
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 2, 3), Vec3(-1, 1, 0)})
    {
        const Vec3 n = normal.normalized();
        DemSetup setup = scene({ball(0.01, 0.05, 0.0101 * n)}, {plane(Vec3::Zero(), 5 * n)});
        setup.bodies[0].motion.velocity = -0.2 * n;
        LiggghtsEngine engine(setup);
        engine.advance(5e-3);
        speeds.push_back(engine.states()[0].motion.velocity.dot(n));
        CHECK(engine.states()[0].motion.velocity.cross(n).norm() < 1e-12);
        CHECK(engine.meanWallLoads()[0].force.dot(n) * 5e-3 == near(-0.05 * (0.2 + speeds.back()), 1e-13));
    }
    for (const double v : speeds)
        CHECK(v == near(speeds[0], 1e-11));
}

TEST_CASE("what is pressed on a mirror plane slides along it freely, with its image, beside walls of the same material that hold it")
{
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8)}) // a plane to LIGGGHTS, and triangles
    {
        DemSetup setup = scene({ball(0.05, 1, 0.0499 * normal), ball(0.05, 1, 0.0499 * normal + Vec3(0, 5, 0))}, {plane(Vec3::Zero(), normal), plane(Vec3(0, 5.05, 0), -Vec3::UnitY())});
        setup.box = {Vec3(-1, -1, -1), Vec3(1, 6, 1)};
        setup.walls[0].isMirror = true;
        const Vec3 along = Vec3::UnitY().cross(normal);
        setup.bodies[0].motion.velocity = along;
        setup.bodies[1].motion.velocity = along;
        LiggghtsEngine engine(setup);
        engine.setLoads({{-10 * normal, Vec3::Zero()}, {Vec3(0, 10, 0), Vec3::Zero()}});
        engine.advance(0.2);
        const auto states = engine.states();
        CHECK(states[0].motion.velocity.dot(along) == near(1, 1e-12));
        CHECK(states[0].motion.angularVelocity.norm() < 1e-12);
        CHECK(states[1].motion.velocity.dot(along) < 0.9); // rolls
    }
}

TEST_CASE("pipes: a bar across two of them leans on both")
{
    DemSetup setup = scene({debris(Vec3(-0.0208, 0, 0.1))},
                           {pipe(Vec3(0, -0.05, 0), 0.0109, 0.3, 32), pipe(Vec3(0, 0.05, 0), 0.0109, 0.3, 32)});
    setup.bodies[0].pose.orientation = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ());
    LiggghtsEngine engine(setup);
    engine.setLoads({{Vec3(2, 0, 0), Vec3::Zero()}});
    for (int i = 0; i < 100; ++i)
        engine.advance(1e-3);
    const auto walls = engine.meanWallLoads();
    CHECK(walls[0].force.x() == near(1, 2e-13));
    CHECK(walls[1].force.x() == near(1, 2e-13));
    CHECK(engine.contacts().size() == 2);
    CHECK(engine.states()[0].motion.velocity.norm() < 1e-4);
}

TEST_CASE("pipes that share a mesh each feel what bars press on them, and at its place")
{
    DemSetup setup = pile();
    LiggghtsEngine engine(setup);
    engine.setLoads(pressing(setup));
    const double duration = 1e-3;
    double worstForce = 0, worstMoment = 0, worstArm = 0, pressed = 0;
    for (int k = 0; k < 40; ++k)
    {
        engine.advance(duration);
        const Totals t = totals(engine);
        worstForce = std::max(worstForce, (t.bodies + t.walls).norm());
        worstMoment = std::max(worstMoment, (t.bodyMoments + t.wallMoments).norm());
    }
    const auto walls = engine.meanWallLoads();
    for (size_t w = 3; w < walls.size(); ++w)
    {
        // the force along x acts on the pipe's front: moment about z over force is the pipe's place across
        const double force = walls[w].force.x(), place = setup.walls[w].surface.points.front().y();
        pressed += force;
        if (force > 0.1)
            worstArm = std::max(worstArm, std::abs(-walls[w].moment.z() / force - place));
    }
    CHECK(worstForce < 1e-9);
    CHECK(worstMoment < 2e-3);
    CHECK(worstArm < 0.01085);
    CHECK(pressed > 1);
}

TEST_CASE("a body squeezed evenly between two walls loads both")
{
    DemSetup setup = scene({ball(0.01, 0.05, Vec3::Zero())},
                           {plane(Vec3(0, 0, -0.00999), Vec3::UnitZ()), plane(Vec3(0, 0, 0.00999), -Vec3::UnitZ())});
    LiggghtsEngine engine(setup);
    engine.advance(1e-3);
    CHECK(engine.hasContact());
    CHECK(engine.meanWallLoads()[0].force.z() == near(-10, 2e-13));
    CHECK(engine.meanWallLoads()[1].force.z() == near(10, 2e-13));
}
