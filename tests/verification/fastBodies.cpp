// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that go several elements in a step: the fluid is solved around where contact lets them end.
#include "support/bodyTank.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cstdio>

using namespace bodyTank;

namespace
{

constexpr double element = 0.04, speed = 10, dt = 0.02; // five elements a step

BodyDefinition thrown(const std::string& name, const Vec3& position, const Vec3& velocity)
{
    BodyDefinition bar = makeBar(name, 0, position);
    bar.motion.velocity = velocity;
    return bar;
}

/// Distance of the place that the fluid was solved around from the one that a body has.
double astray(const CoupledStep& run, int body) { return (run.scene().solids()[body].pose.position - run.records()[body].pose.position).norm(); }

} // namespace

TEST_CASE("bodies that walls and others stop within a step end where the fluid was solved around them")
{
    Tank tank;
    const DemSetup dem = makeDem({thrown("stopped", {0.12, 0.8, 0.5}, {-speed, 0, 0}), thrown("free", {0.5, 1, 0.5}, {speed, 0, 0}),
        thrown("meeting", {0.48, 0.7, 0.5}, {speed, 0, 0}), thrown("met", {0.6, 0.7, 0.5}, {-speed, 0, 0})});
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    const StepResult result = run->step(dt);
    CAPTURE(result.failure);
    REQUIRE(result.isAccepted);
    const double drift = speed*dt; // way without contact
    const std::vector<BodyRecord> records = run->records();
    for (int b : {0, 2, 3})
    {
        CAPTURE(b);
        CHECK((records[b].pose.position - dem.bodies[b].pose.position).norm() < 0.5*drift);
        CHECK(astray(*run, b) < 0.1*element); // gas of 1/600 of their density
    }
    CHECK(records[1].pose.position[0] - 0.5 == near(drift, 5e-3));
    CHECK(run->scene().solids()[1].pose.position[0] == near(0.5 + drift, 1e-15)); // touches nothing: its drift
    std::printf("astray by %.1e, %.1e, %.1e, %.1e elements\n", astray(*run, 0)/element, astray(*run, 1)/element, astray(*run, 2)/element, astray(*run, 3)/element);
}
