// SPDX-License-Identifier: GPL-3.0-or-later
/// Restraints and fluid together: the tension of a tether is what the water does to the body that it holds.
#include "support/barInCurrent.hpp"
#include "support/bodyTank.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

RestraintDefinition tether(const Vec3& place, const Vec3& anchor, double length, double stiffness, double damping)
{
    RestraintDefinition r;
    r.name = "tether";
    r.kind = RestraintDefinition::Kind::Tether;
    r.end = {0, -1, place};
    r.other = {-1, -1, anchor};
    r.length = length;
    r.stiffness = stiffness;
    r.damping = damping;
    return r;
}

} // namespace

TEST_CASE("a tether holds a bar in a current with the drag of the bar fixed")
{
    const Vec3 position(0.7, 0.5, 0.5);
    barInCurrent::Channel channel;
    DemSetup dem;
    dem.bodies = {barInCurrent::makeBar(590, position)};
    dem.laws = {ContactLaw()};
    dem.box = {Vec3(0, 0, 0), Vec3(2, 1, 1)};
    dem.restraints = {tether(Vec3(-barInCurrent::side/2, 0, 0), Vec3(0.3, 0.5, 0.5), 0.3, 2e6, 1e4)};
    CoupledStep held(channel.mesh, channel.halo, channel.fluid, channel.controls, channel.patches, Scene({}, dem.bodies, Vec3::Zero()), &dem, channel.timers);
    const auto [drag, repeats] = barInCurrent::runBesideFixed(channel, held, dem.bodies[0]);
    const RestraintLoad line = held.coupling()->restraintLoads()[0];
    const BodyRecord record = held.records()[0];
    std::printf("drag fixed %.4f N, of the held bar %.4f N, tension %.4f N (%.3f %%), stretched by %.3g m, speed %.2g m/s, turned by %.2g, largest number of repeats %d\n", drag, record.fluidForce[0],
        line.tension, 100*(line.tension/drag - 1), line.length - 0.3, record.motion.velocity[0], record.pose.orientation.vec().norm(), repeats);
    CHECK(line.tension == near(drag, 1e-3));
    CHECK(record.fluidForce[0] == near(drag, 1e-3));
    CHECK(line.force[0] == near(-line.tension, 1e-4));
    CHECK((line.force - record.contactForce).norm() < 1e-9*drag);
    CHECK(line.tension == near(2e6*(line.length - 0.3), 1e-3));
    CHECK(std::abs(record.motion.velocity[0]) < 1e-4);
}

TEST_CASE("a buoyant bar tethered to the bed: tension is buoyancy less weight; a saved state goes on the same")
{
    using namespace bodyTank;
    Tank tank;
    BodyDefinition bar = bodyTank::makeBar("bar", 0, Vec3(0.5, 0.25, 0.5));
    DemSetup dem = makeDem({bar});
    dem.restraints = {tether(Vec3(0, -bodyTank::side/2, 0), Vec3(0.5, 0, 0.5), 0.2, 1e5, 500)};
    const double lift = (1000 - 600)*bar.volume*g;
    const auto run = makeRun(tank, dem), other = makeRun(tank, dem);
    run->start(tank.rest(), true);
    for (int k = 0; k < 60; ++k) REQUIRE(run->step(0.01).isAccepted);
    run->forgetUnwritten();
    FlowState state = run->fluid().state();
    CoupledStep::Arrays arrays = run->save();
    arrays.merge(run->saveOfProcess());
    other->restore(state, arrays, CoupledStep::Fields::Exact);
    for (int k = 0; k < 40; ++k)
    {
        REQUIRE(run->step(0.01).isAccepted);
        REQUIRE(other->step(0.01).isAccepted);
    }
    const RestraintLoad line = run->coupling()->restraintLoads()[0];
    std::printf("tension %.5f N, buoyancy less weight %.5f N (%.4f %%), speed %.2g m/s\n", line.tension, lift, 100*(line.tension/lift - 1), run->records()[0].motion.velocity.norm());
    CHECK(line.tension == near(lift, 2e-3));
    CHECK(line.force[1] == near(-lift, 2e-3));
    CHECK(other->coupling()->restraintLoads()[0].tension == line.tension);
    CHECK(other->records()[0].pose.position == run->records()[0].pose.position);
}

TEST_CASE("a light bar on a tether of little damping: the engine has what the fluid answers, the tension stays")
{
    using namespace bodyTank;
    Tank tank;
    BodyDefinition bar = bodyTank::makeBar("bar", 0, Vec3(0.5, 0.25, 0.5));
    bar.mass /= 12;     // 50 kg/m3
    bar.principalInertia /= 12;
    DemSetup dem = makeDem({bar});
    dem.restraints = {tether(Vec3(0, -bodyTank::side/2, 0), Vec3(0.5, 0, 0.5), 0.2, 1e5, 100)};    // damping ratio 0.05 with the water that moves along
    const double lift = (1000 - 50)*bar.volume*g;
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    double tension = 0, most = 0; // [N], of the last steps
    for (int k = 0; k < 150; ++k)
    {
        REQUIRE(run->step(0.01).isAccepted);
        tension = run->coupling()->restraintLoads()[0].tension;
        if (k >= 100) most = std::max(most, std::abs(tension - lift));
    }
    std::printf("light: tension %.5f N, buoyancy less weight %.5f N (%.4f %%), in the last 50 steps at most %.4f %% off\n", tension, lift, 100*(tension/lift - 1), 100*most/lift);
    CHECK(most < 1e-3*lift); // with factors of mass 4 %
}

namespace
{

/// Of a bar on a soft spring in a shut box of water at rest: period [s] and amplitude of a swing over that of the one before.
struct Swing { double period, decrement; };

Swing swingInWater(double dt)
{
    CoupledRig box(makeBoxMesh(MPI_COMM_WORLD, 2, {25, 25, 1}, {0, 0, 0}, {1, 1, 1}));
    box.fluid.rhoLiquid = 1000;
    box.fluid.muLiquid = 0.1;
    for (int p = 0; p < 4; ++p) box.patches.push_back(makePatch(box.mesh, p, BoundaryPatch::Velocity::Slip));
    DemSetup dem;
    dem.bodies = {barInCurrent::makeBar(590, Vec3(0.5, 0.5, 0.5))};
    dem.laws = {ContactLaw()};
    dem.box = {Vec3(0, 0, 0), Vec3(1, 1, 1)};
    dem.restraints = {tether(Vec3::Zero(), Vec3(0, 0.5, 0.5), 0.48, 3000, 0)};
    dem.restraints[0].kind = RestraintDefinition::Kind::LinearSpring;
    CoupledStep run(box.mesh, box.halo, box.fluid, box.controls, box.patches, Scene({}, dem.bodies, Vec3::Zero()), &dem, box.timers);
    run.start(restState(box.mesh), true);
    std::vector<double> crossings, peaks;
    double before = 0.02, peak = 0;
    for (int k = 1; crossings.size() < 5; ++k)
    {
        REQUIRE(run.step(dt).isAccepted);
        const double now = run.records()[0].pose.position[0] - 0.48;
        peak = std::max(peak, std::abs(now));
        if ((now > 0) != (before > 0))
        {
            crossings.push_back((k - 1 + before/(before - now))*dt);
            peaks.push_back(peak);
            peak = 0;
        }
        before = now;
        REQUIRE(k < 2000);
    }
    return {crossings[4] - crossings[2], peaks[4]/peaks[2]};
}

} // namespace

TEST_CASE("a bar on a soft spring under water: period and decay are those of the water, not of the step")
{
    const double dry = 2*M_PI*std::sqrt(590*barInCurrent::side*barInCurrent::side/3000);
    const Swing coarse = swingInWater(0.02), fine = swingInWater(0.005);
    for (const Swing& s : {coarse, fine}) std::printf("period %.4f s (dry %.4f s), amplitude over that of the swing before %.4f\n", s.period, dry, s.decrement);
    CHECK(fine.period > 1.6*dry); // added mass: 1.19 times a square's displaced mass in open water
    CHECK(fine.period < 2*dry);
    CHECK(coarse.period == near(fine.period, 0.01));
    CHECK(coarse.decrement == near(fine.decrement, 0.03));
}

TEST_CASE("a tether that breaks lets the bar rise")
{
    using namespace bodyTank;
    Tank tank;
    DemSetup dem = makeDem({bodyTank::makeBar("bar", 0, Vec3(0.5, 0.25, 0.5))});
    dem.restraints = {tether(Vec3(0, -bodyTank::side/2, 0), Vec3(0.5, 0, 0.5), 0.2, 1e5, 500)};
    dem.restraints[0].breakingForce = 20; // lift 39 N
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    for (int k = 0; k < 20; ++k) REQUIRE(run->step(0.01).isAccepted);
    CHECK(run->coupling()->restraintLoads()[0].isBroken);
    CHECK(run->records()[0].motion.velocity[1] > 0.1);
    CHECK(run->records()[0].contactForce.isZero(0));
}
