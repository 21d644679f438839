// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that come in at their release: each through the gas at the place of the ones before, once that is free; none is there before, and no
/// liquid is lost.
#include "support/bodyTank.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace bodyTank;

namespace
{

constexpr double dt = 0.004;
const Vec3 place(0.5, 0.8, 0.5);

BodyDefinition entering(const std::string& name, double releaseTime, const Vec3& position = place)
{
    BodyDefinition bar = makeBar(name, releaseTime, position);
    bar.entersAtRelease = true;
    return bar;
}

double speedOfLiquid(const Tank& tank, const FlowState& state)
{
    double fastest = 0;
    for (int i = 0; i < tank.mesh.nNodes; ++i)
        if (state.alpha[i] > 0.9) fastest = std::max(fastest, std::hypot(state.u[2*std::size_t(i)], state.u[2*std::size_t(i) + 1]));
    return tank.halo.max(fastest);
}

} // namespace

TEST_CASE("a body that comes in falls freely from its place, and neither liquid nor gas is set in motion by its coming")
{
    Tank tank;
    const DemSetup dem = makeDem({entering("bar", 0.02)});
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    const double liquid = run->fluid().liquidVolume();
    for (int k = 0; k < 5; ++k) REQUIRE(run->step(dt).isAccepted);
    CHECK(run->records()[0].isAwaited);
    CHECK(run->records()[0].pose.position == place);
    CHECK(run->cover()->cuts.empty());
    const double before = largestSpeed(tank.mesh, tank.halo, run->fluid().state().u);
    for (int k = 0; k < 25; ++k)
    {
        REQUIRE(run->step(dt).isAccepted);
        const BodyRecord record = run->records()[0];
        const double t = (k + 1)*dt;
        CHECK_FALSE(record.isAwaited);
        CHECK(record.motion.velocity[1] == near(-g*t, 0.01)); // gas of 1/600 of its density
        CHECK(record.pose.position[1] == within(place[1] - 0.5*g*t*t, 5e-4));
        const double fastest = largestSpeed(tank.mesh, tank.halo, run->fluid().state().u);
        CHECK(fastest < before + 3*g*t);
        CHECK(speedOfLiquid(tank, run->fluid().state()) < 1e-2);
    }
    std::printf("speed of the liquid under the falling bar %.1e m/s, liquid made %.1e\n", speedOfLiquid(tank, run->fluid().state()),
        run->fluid().liquidVolume()/liquid - 1);
    CHECK(run->fluid().liquidVolume() == near(liquid, 2e-14));
}

TEST_CASE("a light body comes in as any other; until then the steps are those without light bodies")
{
    Tank tank;
    BodyDefinition bar = entering("bar", 0.008);
    bar.mass /= 60; // 10 kg/m3
    bar.principalInertia /= 60;
    const DemSetup dem = makeDem({bar});
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    for (int k = 0; k < 2; ++k) REQUIRE(run->step(dt).isAccepted);
    CHECK_FALSE(run->coupling()->hasLightBodies());
    const double share = (1 - 0.1)/(1 + 1.188*0.1); // gas of a tenth of its density, added mass of a square
    for (int k = 0; k < 3; ++k)
    {
        REQUIRE(run->step(dt).isAccepted);
        CHECK(run->coupling()->hasLightBodies());
        CHECK(run->records()[0].motion.velocity[1] == near(-share*g*(k + 1)*dt, 0.05));
    }
}

TEST_CASE("a step that fails when a body comes in leaves no trace")
{
    Tank tank;
    BodyDefinition sunken = makeBar("sunken", 0, Vec3(0.8, 0.5*side - 1e-6, 0.5)); // on the floor
    sunken.mass *= 3;
    sunken.principalInertia *= 3;
    BodyDefinition waiting = entering("waiting", 0.02);
    waiting.motion.velocity = Vec3(0, -100, 0);
    const DemSetup dem = makeDem({entering("bar", 0.02), waiting, sunken});
    const auto run = makeRun(tank, dem), direct = makeRun(tank, dem);
    for (CoupledStep* r : {run.get(), direct.get()})
    {
        r->start(tank.rest(), true);
        for (int k = 0; k < 5; ++k) REQUIRE(r->step(dt).isAccepted);
    }
    CHECK(run->bodyCourantRate(0) < 1); // of one that is not there nothing is felt
    const std::vector<int> contacts = run->coupling()->wallContactCounts();
    const Vec3 push = run->coupling()->wallLoads()[2].force;
    REQUIRE(push[1] < 0);
    const StepResult failed = run->step(0.2); // the bar would fall by five elements
    REQUIRE_FALSE(failed.isAccepted);
    CHECK(failed.failure.find("body 'bar' ends more than") != std::string::npos);
    CHECK(failed.waiting.empty());
    CHECK(run->coupling()->wallContactCounts() == contacts);
    CHECK(run->coupling()->wallLoads()[2].force == push);
    for (CoupledStep* r : {run.get(), direct.get()}) r->forgetUnwritten(); // a failed step forgets the preconditioner
    for (int k = 0; k < 5; ++k)
    {
        const StepResult again = run->step(dt), first = direct->step(dt);
        REQUIRE(again.isAccepted);
        CHECK(again.waiting == first.waiting);
        CHECK(again.waiting.size() == (k == 0));
        CHECK(run->save() == direct->save());
        CHECK(run->fluid().state().u == direct->fluid().state().u);
    }
}

TEST_CASE("one place serves many: each waits until it is free; one whose place is in the water does not come; a restart goes on with the same bits")
{
    Tank tank;
    const DemSetup dem = makeDem({entering("first", 0), entering("second", 0), entering("third", 0.1), entering("sunk", 0, Vec3(0.2, 0.3, 0.5))});
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    const double liquid = run->fluid().liquidVolume();
    std::vector<double> entered(4, -1);
    std::vector<std::string> waiting;
    CoupledStep::Arrays arrays, ofProcess;
    FlowState state;
    for (int k = 0; k < 150; ++k)
    {
        if (k == 20) // the first is there, the second waits
        {
            arrays = run->save();
            ofProcess = run->saveOfProcess();
            state = run->fluid().state();
            run->forgetUnwritten();
        }
        const StepResult result = run->step(dt);
        CAPTURE(k);
        CAPTURE(result.failure);
        REQUIRE(result.isAccepted);
        waiting.insert(waiting.end(), result.waiting.begin(), result.waiting.end());
        const std::vector<BodyRecord> records = run->records();
        for (int b = 0; b < 4; ++b)
            if (!records[b].isAwaited && entered[b] < 0) entered[b] = k*dt;
    }
    std::printf("came in at %.3f, %.3f, %.3f s; liquid made %.1e\n", entered[0], entered[1], entered[2], run->fluid().liquidVolume()/liquid - 1);
    CHECK(entered[0] == 0);
    const double fall = std::sqrt(2*1.05*side/g); // free of the place
    CHECK(entered[1] == within(fall, dt));
    CHECK(entered[2] > entered[1] + fall);
    CHECK(entered[3] == -1);
    CHECK(run->records()[3].isAwaited);
    REQUIRE(waiting.size() == 3);
    CHECK(waiting[0] == "body second is to come in, but there is body 'first' at its place: it waits");
    CHECK(waiting[1] == "body sunk is to come in, but there is liquid (alpha up to 1) in the elements at its place: it waits until there is none. Give it a place two elements above the highest level (constant/bodies)");
    CHECK(run->fluid().liquidVolume() == near(liquid, 2e-14));

    const auto again = makeRun(tank, dem);
    for (const auto& array : ofProcess) arrays.insert(array);
    again->restore(std::move(state), arrays, CoupledStep::Fields::Exact);
    for (int k = 20; k < 150; ++k) REQUIRE(again->step(dt).isAccepted);
    CHECK(again->fluid().state().u == run->fluid().state().u);
    CHECK(again->fluid().state().alpha == run->fluid().state().alpha);
    CHECK(again->save() == run->save());
}
