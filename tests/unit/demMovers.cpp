// SPDX-License-Identifier: GPL-3.0-or-later
/// Structures that move as prescribed, as the bodies in the DEM engine feel them.
#include "support/near.hpp"
#include "unit/demSupport.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;
using namespace demTest;

namespace
{

constexpr double speed = 0.2, restitution = 0.2, mass = 0.05, radius = 0.01, interval = 2e-3;

using Path = std::function<void(double, Pose&, Motion&)>;

/// A ball of a mover, `arm` from the origin of its frame.
MoverDefinition mover(const Vec3& arm, Path path)
{
    MoverDefinition m;
    m.name = "mover";
    m.spheres = {{arm, radius}};
    m.motion = std::move(path);
    return m;
}

Path straight(const Vec3& start, const Vec3& velocity)
{
    return [=](double t, Pose& pose, Motion& motion)
    {
        pose = {start + t * velocity, Eigen::Quaterniond::Identity()};
        motion = {velocity, Vec3::Zero()};
    };
}

Path turning(double rate)
{
    return [=](double t, Pose& pose, Motion& motion)
    {
        pose = {Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(rate * t, Vec3::UnitZ()))};
        motion = {Vec3::Zero(), rate * Vec3::UnitZ()};
    };
}

struct Push { Vec3 velocity = Vec3::Zero(), impulseOnMover = Vec3::Zero(), momentOnMover = Vec3::Zero(); bool hasTouched = false; };

/// The first body, and what the first mover has felt.
Push advance(LiggghtsEngine& engine, const DemSetup& setup, double duration, double start = 0)
{
    Push push;
    for (int i = 0; i < std::lround(duration / interval); ++i)
    {
        std::vector<Pose> poses;
        for (const MoverDefinition& m : setup.movers)
        {
            poses.emplace_back();
            Motion motion;
            m.motion(start + (i + 1) * interval, poses.back(), motion);
        }
        engine.moveTo(poses, interval);
        engine.advance(interval);
        push.hasTouched = push.hasTouched || engine.hasContact();
        const Load load = engine.meanWallLoads()[setup.walls.size()];
        push.impulseOnMover += interval * load.force;
        push.momentOnMover += interval * load.moment;
    }
    push.velocity = engine.states()[0].motion.velocity;
    return push;
}

DemSetup oneBall(const Vec3& position)
{
    ContactLaw law;
    law.restitution = restitution;
    return scene({ball(radius, mass, position)}, {}, law);
}

} // namespace

TEST_CASE("a body that a mover hits leaves it with the restitution, and the mover feels the opposite")
{
    DemSetup setup = oneBall(Vec3(0.3, 0.1, 0.2));
    setup.movers = {mover(Vec3(0, 0, 0.05), straight(Vec3(0.25, 0.1, 0.15), Vec3(speed, 0, 0)))};
    LiggghtsEngine engine(setup);
    const Push push = advance(engine, setup, 0.4);
    CHECK(push.velocity.x() == near((1 + restitution) * speed, 0.01));
    CHECK(push.velocity.tail<2>().norm() < 1e-12);
    CHECK((push.impulseOnMover + mass * push.velocity).norm() < 1e-9 * mass * speed);
    CHECK((push.momentOnMover - Vec3(0, 0.1, 0.2).cross(push.impulseOnMover)).norm() < 1e-9 * mass * speed); // the force acts along x through the ball
    const auto contacts = engine.contacts();
    CHECK(contacts.empty());
}

TEST_CASE("a mover that turns keeps its rate, whatever it hits")
{
    constexpr double rate = 4, arm = 0.1;
    DemSetup setup = oneBall(Vec3(-arm, 0.002, 0)); // half a turn away
    setup.movers = {mover(Vec3(arm, 0, 0), turning(rate)), mover(Vec3(arm, 0, 1), turning(rate))};
    LiggghtsEngine engine(setup);
    const Push push = advance(engine, setup, 1);
    const double angle = std::acos(1 - 0.5 * std::pow(2 * radius / arm, 2)); // between the arms at contact
    MESSAGE("speed ", push.velocity.norm(), ", of the mover ", rate * arm, ", angle ", angle);
    CHECK(push.hasTouched);
    CHECK(push.velocity.norm() == near((1 + restitution) * rate * arm * std::cos(0.5 * angle), 0.02)); // along the line between the centres
    CHECK((push.impulseOnMover + mass * push.velocity).norm() < 1e-9 * mass * rate * arm);
}

TEST_CASE("movers touch neither each other nor walls")
{
    DemSetup setup = oneBall(Vec3(0.5, 0.5, 0.5));
    setup.walls = {plane(Vec3::Zero(), Vec3::UnitZ()), block(Vec3(0.1, -0.1, 0), Vec3(0.2, 0.1, 0.1))};
    setup.movers = {mover(Vec3::Zero(), straight(Vec3(0.05, 0, 0.005), Vec3(speed, 0, 0))), mover(Vec3::Zero(), straight(Vec3(0.055, 0, 0.005), Vec3(speed, 0, 0)))};
    LiggghtsEngine engine(setup);
    const Push push = advance(engine, setup, 0.4);
    CHECK_FALSE(push.hasTouched);
    CHECK(push.velocity.norm() == 0);
    CHECK(engine.meanWallLoads().size() == 4);
}

TEST_CASE("contact with a mover goes on from a stored state to the last bit, and counts as a wall's")
{
    DemSetup setup = oneBall(Vec3(0.271, 0.1, 0.2));
    setup.walls = {plane(Vec3(0.2815, 0, 0), -Vec3::UnitX())}; // pressed against it
    setup.movers = {mover(Vec3::Zero(), straight(Vec3(0.25, 0.1, 0.2), Vec3(speed, 0, 0)))};
    LiggghtsEngine engine(setup);
    advance(engine, setup, 0.02);
    const DemState state = engine.save();
    advance(engine, setup, 0.004, 0.02);
    const BodyState once = engine.states()[0];
    bool hasMover = false;
    for (const Contact& c : engine.contacts()) hasMover = hasMover || c.other == -2;
    CHECK(hasMover);
    engine.restore(state);
    advance(engine, setup, 0.004, 0.02);
    CHECK(engine.states()[0].pose.position == once.pose.position);
    CHECK(engine.states()[0].motion.velocity == once.motion.velocity);
}
