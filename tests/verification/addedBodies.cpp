// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies put into a run that goes on: those of the state and the flow go on as without them, the liquid at their place gives way, and they begin as at a start.
#include "support/bodyTank.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cstdio>

using namespace bodyTank;

namespace
{

constexpr double dt = 0.004;

struct Stored
{
    FlowState state;
    CoupledStep::Arrays arrays;
};

Stored storedState(CoupledStep& run)
{
    Stored stored{run.fluid().state(), run.save()};
    stored.arrays.merge(run.saveOfProcess());
    run.forgetUnwritten();
    return stored;
}

/// A wall that parts the tank in two.
std::vector<SceneStructure> divider()
{
    SceneStructure wall;
    wall.solid.name = "divider";
    wall.solid.shape = makeBox(Vec3::Zero(), Vec3(0.1, 3, 3));
    wall.solid.pose.position = Vec3(0.5, 0.5, 0.5);
    return {wall};
}

std::unique_ptr<CoupledStep> makeParted(Tank& tank, const DemSetup* dem)
{
    return std::make_unique<CoupledStep>(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches, Scene(divider(), dem ? dem->bodies : std::vector<BodyDefinition>(), gravity), dem,
        tank.timers);
}

void advance(CoupledStep& run, int times)
{
    for (int k = 0; k < times; ++k)
    {
        const StepResult result = run.step(dt);
        CAPTURE(result.failure);
        REQUIRE(result.isAccepted);
    }
}

/// Two bars in the left half: one afloat, thrown against the wall, one so heavy that it lies on the floor.
std::vector<BodyDefinition> oldBars()
{
    std::vector<BodyDefinition> bars{makeBar("floating", 0, Vec3(0.1, 0.49, 0.5)), makeBar("sunken", 0, Vec3(0.3, 0.5*side - 1e-6, 0.5))};
    bars[0].motion.velocity = Vec3(-0.5, 0, 0);
    bars[1].mass *= 3;
    bars[1].principalInertia *= 3;
    return bars;
}

double largestDifference(const Tank& tank, const std::vector<double>& a, const std::vector<double>& b, double from, double to)
{
    double largest = 0;
    for (int i = 0; i < tank.mesh.nNodes; ++i)
    {
        const double x = tank.mesh.x[2*std::size_t(i)];
        if (x < from || x > to) continue;
        for (int d = 0; d < 2; ++d) largest = std::max(largest, std::abs(a[2*std::size_t(i) + d] - b[2*std::size_t(i) + d]));
    }
    return tank.halo.max(largest);
}

} // namespace

TEST_CASE("a body that comes later than the state changes nothing of what goes on, to the last bit, wherever it stands in the list")
{
    Tank tank;
    const DemSetup few = makeDem(oldBars());
    const auto run = makeParted(tank, &few);
    run->start(tank.rest(), true);
    advance(*run, 30);
    REQUIRE(run->bodiesInContact() > 0);
    const Stored stored = storedState(*run);
    std::vector<BodyDefinition> bars = oldBars();
    bars.insert(bars.begin() + 1, makeBar("late", 100, Vec3(0.8, 0.8, 0.5)));
    bars[1].entersAtRelease = true;
    const DemSetup more = makeDem(bars);
    const auto other = makeParted(tank, &more);
    other->restore(stored.state, stored.arrays, CoupledStep::Fields::Exact, {{0}, {0, 2}, {}});
    CHECK(other->displaced() == 0);
    CHECK(other->records()[2].isAwaited);
    advance(*run, 20);
    advance(*other, 20);
    CHECK(run->fluid().state().u == other->fluid().state().u);
    CHECK(run->fluid().state().alpha == other->fluid().state().alpha);
    CHECK(run->records()[1].pose.position == other->records()[1].pose.position);
    CHECK(run->records()[2].pose.position == other->records()[3].pose.position);
    CHECK(run->records()[2].contactForce == other->records()[3].contactForce);
}

TEST_CASE("a body put into the water of another basin changes what goes on by no more than the solver leaves")
{
    Tank tank;
    tank.controls.tolerance = 1e-10;
    const DemSetup few = makeDem(oldBars());
    const auto run = makeParted(tank, &few);
    run->start(tank.rest(), true);
    advance(*run, 30);
    const Stored stored = storedState(*run);
    const double liquid = run->fluid().liquidVolume();
    std::vector<BodyDefinition> bars = oldBars();
    bars.insert(bars.begin(), makeBar("new", 100, Vec3(0.8, 0.25, 0.5)));    // held: how exactly the surface is searched for follows from the largest speed anywhere
    const DemSetup more = makeDem(bars);
    const auto other = makeParted(tank, &more);
    other->restore(stored.state, stored.arrays, CoupledStep::Fields::Exact, {{0}, {1, 2}, {}});
    CHECK(other->displaced() == near(side*side, 1e-6));
    CHECK(other->fluid().liquidVolume() == near(liquid - other->displaced(), 1e-13));
    advance(*run, 20);
    advance(*other, 20);
    const std::vector<double>&a = run->fluid().state().u, &b = other->fluid().state().u;
    const double here = largestDifference(tank, a, b, 0, 0.45), there = largestDifference(tank, a, b, 0.55, 1);
    std::printf("velocities differ by %.1e m/s in the old bars' basin, by %.1e m/s in the new one's\n", here, there);
    CHECK(here < 1e-7);
    for (int b0 = 0; b0 < 2; ++b0)
    {
        const BodyRecord was = run->records()[1 + b0], is = other->records()[2 + b0];
        CHECK((was.pose.position - is.pose.position).norm() < 1e-9);
        CHECK((was.contactForce - is.contactForce).norm() < 1e-6*600*side*side*g);
    }
    CHECK(other->fluid().liquidVolume() == near(liquid - other->displaced(), 1e-13));
    CHECK(other->records()[1].fluidForce[1] == near(1000*g*side*side, 0.01));    // water has found its way around it: its buoyancy
}

TEST_CASE("a body put into water at rest moves as one that was there from the start, also without any structure or body before")
{
    Tank tank;
    const DemSetup dem = makeDem({makeBar("bar", 0, Vec3(0.5, 0.45, 0.5))});
    const auto fromStart = makeRun(tank, dem), added = makeRun(tank, dem);
    fromStart->start(tank.rest(), true);
    const auto water = std::make_unique<CoupledStep>(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches, Scene({}, {}, gravity), nullptr, tank.timers);
    water->start(tank.rest(), true);
    advance(*water, 10);
    const Stored stored = storedState(*water);
    added->restore(stored.state, stored.arrays, CoupledStep::Fields::Exact, {});
    CHECK(added->displaced() > 0.008);    // of 0.01, but for what the surface's profile has above the level
    CHECK(added->fluid().liquidVolume() == near(fromStart->fluid().liquidVolume(), 1e-9));
    double fastest = 0, apart = 0;
    for (int k = 0; k < 50; ++k)
    {
        advance(*fromStart, 1);
        advance(*added, 1);
        const BodyRecord a = fromStart->records()[0], b = added->records()[0];
        fastest = std::max(fastest, a.motion.velocity.norm());
        apart = std::max(apart, (a.motion.velocity - b.motion.velocity).norm());
    }
    std::printf("speed up to %.3f m/s, apart by %.1e m/s\n", fastest, apart);
    CHECK(fastest > 0.1);
    CHECK(apart < 0.02*fastest);
}

TEST_CASE("a body that is let go beside others has its first step as one released in any run; one held longer stays")
{
    Tank tank;
    const DemSetup few = makeDem({makeBar("first", 0, Vec3(0.2, 0.9, 0.5))});
    const auto run = makeRun(tank, few);
    run->start(tank.rest(), true);
    advance(*run, 3);
    const Stored stored = storedState(*run);
    BodyDefinition thrown = makeBar("thrown", 0.001, Vec3(0.7, 0.9, 0.5));
    thrown.motion.velocity = Vec3(0.5, 0, 0);
    const DemSetup more = makeDem({few.bodies[0], thrown, makeBar("held", 0.1, Vec3(0.45, 0.9, 0.5))});
    const auto other = makeRun(tank, more);
    other->restore(stored.state, stored.arrays, CoupledStep::Fields::Exact, {{}, {0}, {}});
    for (int k = 1; k <= 5; ++k)
    {
        advance(*other, 1);
        const std::vector<BodyRecord> records = other->records();
        CHECK(records[1].motion.velocity[1] == near(-g*k*dt, 0.01));
        CHECK(records[1].motion.velocity[0] == near(0.5, 0.01));
        CHECK(records[0].motion.velocity[1] == near(-g*(k + 3)*dt, 0.01));
        CHECK(records[2].pose.position == more.bodies[2].pose.position);
    }
}
