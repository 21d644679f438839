// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <iterator>

using namespace flotsam;
using namespace demTest;

namespace
{

long openFiles()
{
    using Iterator = std::filesystem::directory_iterator;
    return std::distance(Iterator("/proc/self/fd"), Iterator());
}

} // namespace

TEST_CASE("bodies start exactly where they were put")
{
    BodyDefinition a = debris(Vec3(0.1, 0.2, 0.3)), b = ball(0.01, 0.2, Vec3(-0.2, 0, 0));
    a.pose.orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
    a.motion = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
    const LiggghtsEngine engine(scene({a, b}, {}));
    const auto states = engine.states();
    CHECK(states[0].pose.position == a.pose.position);
    CHECK(states[0].pose.orientation.coeffs() == a.pose.orientation.coeffs());
    CHECK(states[0].motion.velocity == a.motion.velocity);
    CHECK((states[0].motion.angularVelocity - a.motion.angularVelocity).norm() < 1e-14);
    CHECK(states[1].pose.position == b.pose.position);
}

TEST_CASE("a constant load gives the exact parabola in one step or many")
{
    const DemSetup setup = scene({debris(Vec3::Zero())}, {});
    for (const double largest : {1e-2, 1e-4, 1e-5})
    {
        LiggghtsEngine engine(setup);
        Vec3 v = Vec3::Zero(), x = Vec3::Zero();
        const double duration = 0.01;
        for (const Vec3& force : {Vec3(0.3, -0.7, 1.1), Vec3(-1.0, 0.2, 0.4)})
        {
            const Vec3 moment = 1e-4 * force;
            const Vec3 before = engine.states()[0].angularMomentum;
            engine.setLoads({{force, moment}});
            engine.advance(duration, largest);
            const Vec3 acceleration = force / setup.bodies[0].mass;
            x += v * duration + 0.5 * acceleration * duration * duration;
            v += acceleration * duration;
            const BodyState state = engine.states()[0];
            CHECK((state.motion.velocity - v).norm() < 1e-12);
            CHECK((state.pose.position - x).norm() < 1e-14);
            CHECK((state.angularMomentum - before - moment * duration).norm() < 1e-17);
            CHECK_FALSE(engine.hasContact());
            CHECK(engine.meanContactLoads()[0].force.norm() == 0);
            CHECK(engine.subSteps() == std::lround(duration / largest));
        }
    }
}

TEST_CASE("contact steps longer than those of a free flight are taken as they are")
{
    DemSetup setup = scene({ball(0.5, 500, Vec3(0, 0, 0.499))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    LiggghtsEngine chosen(setup);
    REQUIRE(chosen.timeStep() > 2e-4);
    setup.timeStep = 1e-3;
    LiggghtsEngine given(setup);
    for (LiggghtsEngine* engine : {&chosen, &given})
    {
        engine->setLoads(weights(setup));
        engine->advance(0.02);
        CHECK(engine->hasContact());
        CHECK(engine->subSteps() == std::lround(std::ceil(0.02 / engine->timeStep() - 1e-9)));
    }
}

TEST_CASE("large steps while nothing is near, contact steps otherwise")
{
    DemSetup setup = scene({ball(0.01, 0.01, Vec3(0, 0, 0.1))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    setup.bodies[0].motion.velocity = Vec3(0, 0, -1);
    LiggghtsEngine engine(setup);
    engine.advance(1e-3, 1e-4);
    CHECK(engine.subSteps() == 10);
    for (int i = 0; i < 88; ++i)
        engine.advance(1e-3, 1e-4);
    CHECK(engine.subSteps() == 10);
    engine.advance(2e-3, 1e-4);
    // touches about 1 ms after the start: free until shortly before, then contact steps
    CHECK(engine.subSteps() > std::lround(0.5e-3 / engine.timeStep()));
    CHECK(engine.subSteps() < std::lround(1.3e-3 / engine.timeStep()));
    CHECK(engine.hasContact());
    for (int i = 0; i < 20; ++i)
        engine.advance(1e-3, 1e-4);
    CHECK_FALSE(engine.hasContact());
    CHECK(engine.subSteps() == 10);
}

TEST_CASE("slender bars that turn a centimetre apart are not taken for touching")
{
    DemSetup setup = scene({debris(Vec3::Zero()), debris(Vec3(0, 0, 0.03))}, {});
    setup.bodies[0].motion = {Vec3(0.5, 0, 0), Vec3(0, 0, 3)};
    LiggghtsEngine engine(setup);
    engine.advance(1e-3, 1e-3);
    CHECK(engine.subSteps() == 1);
}

TEST_CASE("held bodies stay, carry their contact load, and fall when released")
{
    DemSetup setup = scene({ball(0.01, 0.1, Vec3(0, 0, 0.05)), ball(0.01, 0.1, Vec3(0, 0, 0.0699))}, {});
    LiggghtsEngine engine(setup);
    engine.setHeld({1, 0});
    engine.setLoads(weights(setup));
    for (int i = 0; i < 200; ++i)
        engine.advance(1e-3);
    CHECK(engine.states()[0].pose.position == setup.bodies[0].pose.position);
    CHECK(engine.meanContactLoads()[0].force.z() == near(-0.1 * gravity, 1e-13));
    CHECK((engine.meanContactLoads()[0].force + engine.meanContactLoads()[1].force).norm() < 1e-12);
    engine.setHeld({0, 0});
    for (int i = 0; i < 100; ++i)
        engine.advance(1e-3);
    CHECK(engine.states()[0].motion.velocity.z() == near(-0.1 * gravity, 2e-3));
}

TEST_CASE("planar bodies keep to their plane")
{
    BodyDefinition disc = ball(0.01, 0.01, Vec3(0, 0, 0.0099));
    disc.isPlanar = true;
    disc.planeAxis = 1;
    DemSetup setup = scene({disc}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    LiggghtsEngine engine(setup);
    engine.setLoads({{Vec3(0.05, 0.3, -0.1), Vec3(1e-4, 2e-5, 1e-4)}});
    for (int i = 0; i < 50; ++i)
        engine.advance(1e-3);
    const BodyState state = engine.states()[0];
    CHECK(state.pose.position.y() == 0);
    CHECK(state.pose.position.x() > 0.001);
    CHECK(state.motion.angularVelocity.x() == 0);
    CHECK(state.motion.angularVelocity.z() == 0);
    CHECK(std::abs(state.motion.angularVelocity.y()) > 1);
}

TEST_CASE("errors inside LIGGGHTS are thrown, and the next engine works")
{
    DemSetup bad = scene({ball(0.01, 0.1, Vec3::Zero())}, {});
    bad.walls.push_back(block(Vec3::Zero(), Vec3::Ones()));
    bad.walls[0].name = "broken";
    bad.walls[0].surface.triangles.clear();
    CHECK_THROWS_WITH_AS(LiggghtsEngine {bad}, doctest::Contains("broken"), DemError);
    bad.walls.clear();
    bad.bodies[0].spheres.clear();
    CHECK_THROWS_WITH_AS(LiggghtsEngine {bad}, doctest::Contains("ball"), DemError);
    bad = scene({ball(0.01, 0.1, Vec3::Zero())}, {});
    bad.laws[0].restitution = 0;
    CHECK_THROWS_AS(LiggghtsEngine {bad}, DemError);
    LiggghtsEngine good(scene({ball(0.01, 0.1, Vec3::Zero())}, {}));
    good.advance(1e-3);
}

TEST_CASE("a body that leaves flies on")
{
    DemSetup setup = scene({ball(0.01, 0.1, Vec3(0, 0, 0.05))}, {});
    setup.bodies[0].motion.velocity = Vec3(1000, 0, 0);
    LiggghtsEngine engine(setup);
    engine.advance(0.05, 1e-3);
    CHECK(engine.states()[0].pose.position.x() == near(50, 1e-14));
}

TEST_CASE("a share changes a free path by nothing, and a landing as the mass that it stands for")
{
    constexpr double height = 0.012, fall = 0.5, more = 8; // [m, m/s], times the mass
    DemSetup setup = scene({ball(0.01, 0.1, Vec3(0, 0, height))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    setup.bodies[0].motion.velocity = Vec3(0.1, 0, -fall);
    LiggghtsEngine shared(setup), plain(setup);
    shared.setShares({{0, LoadShare::Identity()/more}});
    for (LiggghtsEngine* engine : {&shared, &plain}) engine->setLoads({{Vec3(0.3, -0.2, 0), Vec3(1e-4, 2e-4, 0)}});
    for (LiggghtsEngine* engine : {&shared, &plain}) engine->advance(1e-3);
    CHECK(shared.states()[0].pose.position == plain.states()[0].pose.position);
    CHECK(shared.states()[0].motion.angularVelocity == plain.states()[0].motion.angularVelocity);
    double deepest = 0, shallow = 0;
    for (int k = 0; k < 400; ++k)
    {
        for (LiggghtsEngine* engine : {&shared, &plain}) engine->advance(2e-5);
        for (const Contact& c : shared.contacts()) deepest = std::max(deepest, c.overlap);
        for (const Contact& c : plain.contacts()) shallow = std::max(shallow, c.overlap);
    }
    CHECK(plain.states()[0].motion.velocity.z() > 0);
    CHECK(shared.states()[0].motion.velocity.z() > 0);
    CHECK(deepest > 1.5*shallow); // the spring takes eight times the energy, beside a dashpot
    shared.setShares({});
    CHECK(shared.states()[0].motion.velocity.allFinite());
}

TEST_CASE("many bodies of a tenth of a millimetre are not all neighbours")
{
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < 64; ++i)
    {
        bodies.push_back(bar(Vec3(2e-3, 2e-4, 2e-4), 1e-4, 1e-4, Vec3(0, 3e-4 * (i % 8), 3e-4 * (i / 8))));
        bodies.back().name += std::to_string(i);
    }
    const DemSetup setup = scene(bodies, {});
    LiggghtsEngine engine(setup);
    engine.setLoads(weights(setup));
    engine.advance(1e-4);
    CHECK(engine.states()[63].motion.velocity.norm() == near(9.81 * 1e-4, 1e-9));
}

TEST_CASE("opening and closing leaks no file")
{
    const DemSetup setup = heap(2, true);
    { LiggghtsEngine first(setup); }
    const long before = openFiles();
    for (int i = 0; i < 100; ++i)
        LiggghtsEngine engine(setup);
    CHECK(openFiles() == before);
}
