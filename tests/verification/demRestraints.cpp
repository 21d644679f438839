// SPDX-License-Identifier: GPL-3.0-or-later
/// Springs and tethers in the engine against exact solutions: periods, damping, conservation, pendulum, breaking.
#include "demCoupling/liggghts/restraintStep.hpp"
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;
using namespace demTest;

namespace
{

using Kind = RestraintDefinition::Kind;

constexpr double mass = 2, radius = 0.02;

RestraintDefinition restraint(Kind kind, double length, double stiffness, double damping, const RestraintEnd& end, const RestraintEnd& other)
{
    RestraintDefinition r;
    r.name = "line";
    r.kind = kind;
    r.end = end;
    r.other = other;
    r.length = length;
    r.stiffness = stiffness;
    r.damping = damping;
    return r;
}

RestraintEnd ofBody(int body, const Vec3& place = Vec3::Zero()) { return {body, -1, place}; }
RestraintEnd ofSpace(const Vec3& place) { return {-1, -1, place}; }

double energyOf(const BodyState& s, double bodyMass) { return 0.5 * bodyMass * s.motion.velocity.squaredNorm() + 0.5 * s.angularMomentum.dot(s.motion.angularVelocity); }

/// A ball on a spring along x, let go 0.1 m off its rest.
DemSetup oscillator(double stiffness, double damping, double timeStep)
{
    DemSetup setup = scene({ball(radius, mass, Vec3(1.1, 0.2, 0.3))}, {});
    setup.restraints = {restraint(Kind::LinearSpring, 1, stiffness, damping, ofBody(0), ofSpace(Vec3(0, 0.2, 0.3)))};
    setup.timeStep = timeStep;
    return setup;
}

/// Distance from the exact solution after some periods, over the amplitude, largest of all looks.
double errorOfOscillator(double dampingRatio, double timeStep, int periods)
{
    const double omega = 20, stiffness = mass * omega * omega, damped = omega * std::sqrt(1 - dampingRatio * dampingRatio), decay = dampingRatio * omega;
    LiggghtsEngine engine(oscillator(stiffness, 2 * dampingRatio * omega * mass, timeStep));
    const double interval = 2 * M_PI / omega / 16;
    double worst = 0;
    for (int i = 1; i <= 16 * periods; ++i)
    {
        engine.advance(interval);
        const double t = i * interval, exact = std::exp(-decay * t) * (std::cos(damped * t) + decay / damped * std::sin(damped * t));
        worst = std::max(worst, std::abs((engine.states()[0].pose.position.x() - 1) / 0.1 - exact));
    }
    return worst;
}

} // namespace

TEST_CASE("a mass on a spring: period, amplitude and energy over 20 periods, of second order in the sub-step")
{
    const double coarse = errorOfOscillator(0, 4e-3, 20), fine = errorOfOscillator(0, 2e-3, 20);
    MESSAGE("error of the place over the amplitude after 20 periods: ", coarse, ", ", fine);
    CHECK(coarse / fine == near(4, 0.05));
    CHECK(fine < 0.01); // phase 20 x 2 pi (omega dt)^2/24

    DemSetup setup = oscillator(800, 0, 0);
    LiggghtsEngine engine(setup);
    CHECK(engine.timeStep() <= restraintTimeStep(setup));
    double least = 1e300, most = 0;
    for (int i = 0; i < 20 * 50; ++i)
    {
        engine.advance(2 * M_PI / 20 / 50);
        const BodyState s = engine.states()[0];
        const double total = energyOf(s, mass) + 0.5 * 800 * std::pow(s.pose.position.x() - 1, 2);
        least = std::min(least, total);
        most = std::max(most, total);
        CHECK(s.pose.position.tail<2>() == Vec3(1.1, 0.2, 0.3).tail<2>());
    }
    MESSAGE("energy between 1 - ", 1 - least / 4, " and 1 + ", most / 4 - 1);
    CHECK(least > 4 * (1 - 1e-6)); // (omega dt)^2/4 of a swing, without a trend
    CHECK(most < 4 * (1 + 1e-9));
}

TEST_CASE("damping: the exact decay, of second order in the sub-step")
{
    for (const double ratio : {0.05, 0.5})
    {
        const double coarse = errorOfOscillator(ratio, 4e-3, 3), fine = errorOfOscillator(ratio, 2e-3, 3);
        MESSAGE("damping ratio ", ratio, ": ", coarse, ", ", fine);
        CHECK(coarse / fine > 3.4);
        CHECK(fine < 2e-3);
    }
}

TEST_CASE("the mean force over an advance is the change of momentum, to round-off; it is the body's contact load")
{
    DemSetup setup = oscillator(800, 5, 0);
    setup.restraints[0].end.place = Vec3(0, 0.01, 0); // at an arm
    LiggghtsEngine engine(setup);
    const std::vector<Load> push = {{Vec3(3, -2, 1), Vec3(0.001, 0, 0.002)}};
    engine.setLoads(push);
    for (int i = 0; i < 40; ++i)
    {
        const BodyState before = engine.states()[0];
        engine.advance(7e-3);
        const BodyState after = engine.states()[0];
        const RestraintLoad line = engine.restraintLoads()[0];
        const Load load = engine.meanContactLoads()[0];
        CHECK((mass * (after.motion.velocity - before.motion.velocity) - 7e-3 * (load.force + push[0].force)).norm() < 1e-12);
        CHECK((after.angularMomentum - before.angularMomentum - 7e-3 * (load.moment + push[0].moment)).norm() < 1e-14);
        CHECK((line.force - load.force).norm() < 1e-12 * (1 + load.force.norm()));
        CHECK(engine.hasContact());
    }
}

TEST_CASE("two bodies on a spring at arms: momentum and angular momentum stay, to round-off; energy without a trend")
{
    std::vector<BodyDefinition> bodies = {debris(Vec3(0.3, 0.5, 0.5)), debris(Vec3(0.7, 0.5, 0.5))};
    bodies[1].name = "second";
    bodies[0].motion = {Vec3(-0.1, 0.05, 0), Vec3(0.5, 0, 1)};
    DemSetup setup = scene(bodies, {});
    setup.restraints = {restraint(Kind::LinearSpring, 0.18, 40, 0, ofBody(0, Vec3(0.1, 0.01, 0)), ofBody(1, Vec3(-0.1, 0, 0.01)))};
    LiggghtsEngine engine(setup);
    const auto sums = [&]
    {
        Vec3 momentum = Vec3::Zero(), turning = Vec3::Zero();
        double energy = 0;
        const auto states = engine.states();
        for (size_t b = 0; b < 2; ++b)
        {
            momentum += bodies[b].mass * states[b].motion.velocity;
            turning += states[b].angularMomentum + states[b].pose.position.cross(bodies[b].mass * states[b].motion.velocity);
            energy += energyOf(states[b], bodies[b].mass);
        }
        const double length = engine.restraintLoads()[0].length;
        return std::tuple(momentum, turning, energy + 20 * std::pow(length - 0.18, 2));
    };
    const auto [momentum, turning, energy] = sums();
    double worst = 0;
    for (int i = 0; i < 200; ++i)
    {
        engine.advance(5e-3);
        const auto [m, l, e] = sums();
        CHECK((m - momentum).norm() < 1e-14);
        CHECK((l - turning).norm() < 1e-13);
        worst = std::max(worst, std::abs(e / energy - 1));
        REQUIRE(engine.contacts().empty());
    }
    MESSAGE("energy within ", worst);
    CHECK(worst < 5e-6);
}

TEST_CASE("a pendulum on a tether, let go at 90 degrees: three times its weight at the lowest point")
{
    DemSetup setup = scene({ball(radius, mass, Vec3(1, 0, 0))}, {});
    setup.restraints = {restraint(Kind::Tether, 1, 2e5, 0, ofBody(0), ofSpace(Vec3::Zero()))};
    LiggghtsEngine engine(setup);
    engine.setLoads({{Vec3(0, 0, -mass * gravity), Vec3::Zero()}});
    double largest = 0, lowest = 0;
    for (int i = 0; i < 700; ++i)
    {
        engine.advance(1e-3);
        const RestraintLoad line = engine.restraintLoads()[0];
        largest = std::max(largest, line.tension);
        lowest = std::min(lowest, engine.states()[0].pose.position.z());
    }
    MESSAGE("largest tension over the weight ", largest / (mass * gravity), ", lowest point ", lowest);
    CHECK(largest == near(3 * mass * gravity, 0.003));
    CHECK(lowest == near(-1, 0.001));
}

TEST_CASE("a slack tether costs nothing: large steps until it may become taut, and the same path as without")
{
    DemSetup setup = scene({ball(radius, mass, Vec3(0, 0, 0))}, {});
    setup.bodies[0].motion.velocity = Vec3(1, 0, 0);
    DemSetup without = setup;
    setup.restraints = {restraint(Kind::Tether, 0.5, 1e4, 0, ofBody(0), ofSpace(Vec3::Zero()))};
    LiggghtsEngine engine(setup), free(without);
    constexpr double large = 7e-3; // of the steps in free flight [s]
    for (int i = 0; i < 23; ++i)
    {
        engine.advance(2e-2, large);
        free.advance(2e-2, large);
        CHECK(engine.subSteps() == 3);
        CHECK(engine.states()[0].pose.position == free.states()[0].pose.position);
        CHECK_FALSE(engine.hasContact());
    }
    for (int i = 0; i < 8; ++i)
        engine.advance(2e-2, large);
    // back with what it came with, the spring has no losses
    CHECK(engine.states()[0].motion.velocity.x() == near(-1, 2e-4));
    CHECK_FALSE(engine.hasContact());
    CHECK(engine.subSteps() == 3);
}

TEST_CASE("a restraint breaks where its force exceeds what it bears, for good; a state remembers it")
{
    DemSetup setup = oscillator(800, 0, 0);
    setup.restraints[0].breakingForce = 81;   // 80 N at the start
    LiggghtsEngine holds(setup);
    for (int i = 0; i < 50; ++i)
        holds.advance(1e-2);
    CHECK_FALSE(holds.restraintLoads()[0].isBroken);

    setup.bodies[0].motion.velocity = Vec3(1, 0, 0); // 0.05 m further: 89 N
    LiggghtsEngine engine(setup);
    const DemState whole = engine.save();
    double largest = 0;
    for (int i = 0; i < 50; ++i)
    {
        engine.advance(1e-2);
        largest = std::max(largest, engine.restraintLoads()[0].largest);
    }
    const RestraintLoad line = engine.restraintLoads()[0];
    CHECK(line.isBroken);
    CHECK(largest <= 81);
    CHECK(largest > 80);
    CHECK(line.tension == 0);
    CHECK_FALSE(engine.hasContact());
    const Vec3 velocity = engine.states()[0].motion.velocity;
    CHECK(0.5 * mass * velocity.squaredNorm() == near(0.5 * mass + 0.5 * 800 * (0.01 - std::pow(81.0 / 800, 2)), 0.01));

    LiggghtsEngine other(setup);
    other.restore(engine.save());
    CHECK(other.restraintLoads()[0].isBroken);
    other.advance(1e-2);
    CHECK(other.states()[0].motion.velocity == velocity);
    other.restore(whole);
    other.advance(1e-4);
    CHECK_FALSE(other.restraintLoads()[0].isBroken);
    CHECK(other.hasContact());
}

TEST_CASE("a restored state goes on the same to the last bit; one of a run without restraints begins them")
{
    DemSetup setup = scene({debris(Vec3(0, 0, 0.05)), debris(Vec3(0.25, 0, 0.06))}, {plane(Vec3::Zero(), Vec3::UnitZ())});
    setup.bodies[1].name = "second";
    const DemSetup without = setup;
    setup.restraints = {restraint(Kind::Tether, 0.1, 300, 0.5, ofBody(0, Vec3(0.1, 0, 0)), ofSpace(Vec3(0, 0, 0.2))),
                        restraint(Kind::LinearSpring, 0.04, 300, 0.1, ofBody(1, Vec3(-0.1, 0, 0)), ofBody(0, Vec3(0.1, 0.01, 0)))};
    LiggghtsEngine engine(setup), other(setup);
    engine.setLoads(weights(setup));
    for (int i = 0; i < 60; ++i)
        engine.advance(2e-3);
    const DemState state = engine.save();
    other.restore(state);
    for (int k = 0; k < 2; ++k) // and once more in the same engine
    {
        for (LiggghtsEngine* e : {&engine, &other})
            for (int i = 0; i < 20; ++i)
                e->advance(2e-3);
        for (size_t b = 0; b < 2; ++b)
        {
            CHECK(engine.states()[b].pose.position == other.states()[b].pose.position);
            CHECK(engine.states()[b].angularMomentum == other.states()[b].angularMomentum);
        }
        CHECK(engine.restraintLoads()[0].force == other.restraintLoads()[0].force);
        CHECK(engine.restraintLoads()[1].tension == other.restraintLoads()[1].tension);
        engine.restore(state);
        other.restore(state);
    }
    LiggghtsEngine plain(without);
    other.restore(plain.save());
    CHECK(other.restraintLoads()[0].length == near(Vec3(0.1, 0, -0.15).norm(), 1e-12));
    CHECK_THROWS_AS(plain.restore(state), DemError);
}

TEST_CASE("ends at a held body and at a mover: the held one is a fixed point, the mover feels the opposite")
{
    DemSetup setup = scene({ball(radius, mass, Vec3(0.3, 0, 0)), ball(radius, mass, Vec3(0, 0, 0))}, {});
    setup.bodies[1].name = "held";
    setup.restraints = {restraint(Kind::LinearSpring, 0.2, 800, 0, ofBody(0), ofBody(1))};
    LiggghtsEngine engine(setup);
    engine.setHeld({0, 1});
    engine.advance(2 * M_PI / 20);
    CHECK(engine.states()[0].pose.position.x() == near(0.3, 1e-4)); // one period of this body alone
    CHECK(engine.states()[1].pose.position == Vec3::Zero());
    CHECK((engine.meanContactLoads()[0].force + engine.meanContactLoads()[1].force).norm() < 1e-12);

    DemSetup towed = scene({ball(radius, mass, Vec3(0.3, 0, 0))}, {});
    MoverDefinition gate;
    gate.name = "gate";
    gate.spheres = {{Vec3(0, 0, 5), radius}};
    gate.motion = [](double t, Pose& pose, Motion& motion)
    {
        pose = {Vec3(-0.5 * t, 0, 0), Eigen::Quaterniond::Identity()};
        motion = {Vec3(-0.5, 0, 0), Vec3::Zero()};
    };
    towed.movers = {gate};
    towed.restraints = {restraint(Kind::Tether, 0.3, 1e4, 100, ofBody(0), {-1, 0, Vec3::Zero()})};
    LiggghtsEngine tow(towed);
    Vec3 impulse = Vec3::Zero();
    for (int i = 1; i <= 100; ++i)
    {
        Pose pose;
        Motion motion;
        gate.motion(i * 1e-2, pose, motion);
        tow.moveTo({pose}, 1e-2);
        tow.advance(1e-2);
        impulse += 1e-2 * tow.meanWallLoads()[0].force;
    }
    CHECK(tow.states()[0].motion.velocity.x() < -0.4);
    CHECK((impulse + mass * tow.states()[0].motion.velocity).norm() < 1e-10);
}

TEST_CASE("a body to come is on its restraint from when it comes in; one that is gone pulls no more")
{
    DemSetup setup = scene({ball(radius, mass, Vec3(0.3, 0, 0)), ball(radius, mass, Vec3(0, 0, 0))}, {});
    setup.bodies[1].name = "late";
    setup.bodies[1].entersAtRelease = true;
    setup.restraints = {restraint(Kind::LinearSpring, 0.2, 800, 0, ofBody(0), ofBody(1))};
    LiggghtsEngine engine(setup);
    engine.advance(1e-2);
    CHECK_FALSE(engine.hasContact());
    CHECK(engine.states()[0].motion.velocity == Vec3::Zero());
    engine.setGone({0, 0});
    engine.advance(2 * M_PI / 20);
    CHECK(engine.hasContact());
    CHECK(engine.states()[0].pose.position.x() == near(0.3, 1e-4)); // it is held still
    engine.setGone({0, 1});
    engine.advance(1e-2);
    const Vec3 velocity = engine.states()[0].motion.velocity;
    engine.advance(1e-2);
    CHECK(engine.states()[0].motion.velocity == velocity);
    CHECK_FALSE(engine.hasContact());
}

TEST_CASE("the sub-step resolves the lightest body at its arm; a given one that does not is refused")
{
    DemSetup setup = scene({debris(Vec3(0, 0, 1))}, {});
    setup.restraints = {restraint(Kind::LinearSpring, 0, 1e6, 0, ofBody(0), ofSpace(Vec3(0, 0, 1)))};
    const double centred = restraintTimeStep(setup);
    CHECK(centred == near(M_PI / std::sqrt(1e6 / setup.bodies[0].mass) / 40, 1e-12));
    setup.restraints[0].end.place = Vec3(0.1, 0, 0); // a slender bar at its end: 1/m + (L/2)^2 12/(m L^2) = 4/m
    CHECK(restraintTimeStep(setup) == near(0.5 * centred, 0.01));
    setup.restraints.push_back(setup.restraints[0]);
    CHECK(restraintTimeStep(setup) == near(0.5 * centred / std::sqrt(2), 0.01));
    setup.restraints = {setup.restraints[0]};
    setup.timeStep = 1e-3;
    CHECK_THROWS_AS(LiggghtsEngine {setup}, DemError);
    setup.timeStep = 0;
    setup.restraints[0].stiffness = 1e15;
    CHECK_THROWS_AS(LiggghtsEngine {setup}, DemError);
    setup.restraints[0].stiffness = 100;
    setup.restraints[0].damping = 50; // far beyond critical: overdamped, stable
    LiggghtsEngine engine(setup);
    CHECK(engine.timeStep() <= 0.25 * setup.bodies[0].mass / 50 / 3.9);
    for (int i = 0; i < 50; ++i)
        engine.advance(1e-2);
    CHECK(engine.states()[0].motion.velocity.norm() < 0.1);
    const RestraintPeriod period = naturalPeriod(setup.restraints[0], setup.bodies, {}, 0);
    CHECK(period.period == near(2 * M_PI / std::sqrt(100 / setup.bodies[0].mass), 1e-9)); // pulled along its length
}
