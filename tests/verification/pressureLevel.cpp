// SPDX-License-Identifier: GPL-3.0-or-later
/// Closed tanks: no boundary gives the pressure a level, and it does not drift. Open boundaries: their level changes nothing but the level.
#include "demCoupling/coupling/coupledStep.hpp"
#include "support/coupledRig.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

/// A tank that slips on all sides, with a tilted surface or full of one fluid that a plate stirs.
struct Tank
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {20, 20, 1}, {0, 0, 0}, {1, 1, 1});
    Halo halo{mesh, MPI_COMM_WORLD};
    FluidProperties fluid;
    PhaseTimers timers;

    Tank()
    {
        usePetsc();
        fluid.gravity[1] = -9.81;
        fluid.pRefValue = 500;
    }

    FlowState start() const
    {
        FlowState state = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i)
            if (fluid.isTwoPhase) state.alpha[i] = mesh.x[2*std::size_t(i) + 1] < 0.5 + 0.4*(mesh.x[2*std::size_t(i)] - 0.5);
        return state;
    }

    Scene scene() const
    {
        SceneStructure plate;
        plate.solid.kind = Solid::Kind::Prescribed;
        plate.solid.shape = makeBox(Vec3::Zero(), Vec3(0.12, 0.33, 1));
        plate.motion = [](double time, Pose& pose, Motion& motion)
        {
            pose.position = Vec3(0.51 + 0.2*std::sin(5*time), 0.48, 0.5);
            motion.velocity = Vec3(std::cos(5*time), 0, 0);
        };
        return fluid.isTwoPhase ? Scene({}, {}, Vec3::Zero()) : Scene({plate}, {}, Vec3::Zero());
    }

    /// Mean pressure of the gas, or of all, by nodes.
    double level(const FlowState& state) const
    {
        double sums[2] = {};
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (fluid.isTwoPhase && state.alpha[i] > 0.01) continue;
            sums[0] += 1;
            sums[1] += state.p[i];
        }
        halo.sum(sums, 2);
        return sums[1]/sums[0];
    }
};

} // namespace

TEST_CASE("the pressure of a closed tank keeps its level")
{
    for (const bool isTwoPhase : {true, false})
    {
        Tank tank;
        tank.fluid.isTwoPhase = isTwoPhase;
        const NumericsControls controls;
        const std::vector<BoundaryPatch> patches = allPatches(tank.mesh, BoundaryPatch::Velocity::Slip);
        CoupledStep run(tank.mesh, tank.halo, tank.fluid, controls, patches, tank.scene(), nullptr, tank.timers);
        run.start(tank.start(), true);
        double farthest = 0;
        for (int k = 0; k < 200; ++k)
        {
            REQUIRE(run.step(k % 7 == 0 ? 0.004 : 0.01).isAccepted);
            farthest = std::max(farthest, std::abs(tank.level(run.fluid().state()) - tank.fluid.pRefValue));
        }
        std::printf("%s: level %.1f Pa off at most\n", isTwoPhase ? "water and gas" : "one fluid, plate", farthest);
        CHECK(farthest < (isTwoPhase ? 10 : 1000)); // the plate's nodes count here; 9810 Pa from floor to ceiling
    }
}

/// Water that flows around a fixed square bar, under gas or all over the channel, and out against the pressure of the outlet.
struct OpenChannel : CoupledRig
{
    double level;

    OpenChannel(bool isTwoPhase, double l) : CoupledRig(makeBoxMesh(MPI_COMM_WORLD, 2, {48, 24, 1}, {0, 0, 0}, {2, 1, 1})), level(l)
    {
        fluid.isTwoPhase = isTwoPhase;
        if (isTwoPhase) fluid.gravity[1] = -9.81;
        const auto inflow = [](const double* x, double) { return std::array<double, 3>{x[1] < 0.61 ? 0.5 : 0, 0, 0}; };
        patches.push_back(makePatch(mesh, 0, BoundaryPatch::Velocity::Fixed, inflow));
        patches.push_back(makePatch(mesh, 1, isTwoPhase ? BoundaryPatch::Velocity::Slip : BoundaryPatch::Velocity::Open));
        patches.push_back(makePatch(mesh, 2, BoundaryPatch::Velocity::Slip));
        patches.push_back(makePatch(mesh, 3, isTwoPhase ? BoundaryPatch::Velocity::Open : BoundaryPatch::Velocity::Slip));
        for (BoundaryPatch& patch : patches)
            patch.evaluate = [plain = patch.evaluate, l](const BoundaryState& state, PatchValues& values)
            {
                plain(state, values);
                for (double& p : values.pressure) p += l;
            };
    }

    /// The state after some steps; the iterations of all but the first.
    FlowState run(long& iterations)
    {
        SceneStructure bar;
        bar.solid.shape = makeBox(Vec3::Zero(), Vec3(0.2, 0.2, 1));
        bar.solid.pose.position = Vec3(0.7, 0.51, 0.5);
        CoupledStep steps(mesh, halo, fluid, controls, patches, Scene({bar}, {}, Vec3::Zero()), nullptr, timers);
        FlowState state = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double y = mesh.x[2*std::size_t(i) + 1];
            if (fluid.isTwoPhase) state.alpha[i] = y < 0.6;
            state.p[i] = level + (fluid.isTwoPhase ? 9.81*(y < 0.6 ? 0.4 + 1000*(0.6 - y) : 1 - y) : 0);
        }
        steps.start(std::move(state), true);
        iterations = 0;
        for (int k = 0; k < 40; ++k)
        {
            const StepResult result = steps.step(0.01);
            CAPTURE(result.failure);
            CAPTURE(k);
            REQUIRE(result.isAccepted);
            if (k > 0) iterations += result.linearIterations;   // the first step of one fluid at rest has no right-hand side: it is solved to round-off
        }
        return steps.fluid().state();
    }
};

TEST_CASE("a constant that is added to the prescribed pressures adds itself to the pressure, and changes neither flow nor iterations")
{
    for (const bool isTwoPhase : {false, true})
    {
        long before = 0;
        OpenChannel plain(isTwoPhase, 0);
        const FlowState at0 = plain.run(before);
        for (const double level : {1e5, -2e4})
        {
            CAPTURE(level);
            long iterations = 0;
            OpenChannel channel(isTwoPhase, level);
            const FlowState state = channel.run(iterations);
            double ofVelocity = 0, ofPressure = 0;
            for (std::size_t k = 0; k < state.u.size(); ++k) ofVelocity = std::max(ofVelocity, std::abs(state.u[k] - at0.u[k]));
            for (std::size_t i = 0; i < state.p.size(); ++i) ofPressure = std::max(ofPressure, std::abs(state.p[i] - at0.p[i] - level));
            std::printf("%s, level %g Pa: %ld and %ld iterations, velocity %.1e m/s, pressure %.1e Pa\n", isTwoPhase ? "water and gas" : "one fluid", level, before, iterations,
                channel.halo.max(ofVelocity), channel.halo.max(ofPressure));
            CHECK(std::abs(iterations - before) <= 2);
            CHECK(channel.halo.max(ofVelocity) < 1e-8);
            CHECK(channel.halo.max(ofPressure) < 1e-4);
        }
    }
}

// Cut by other planes on the boundary than within, a bar of 0.8 elements made 0.1 m/s of 1 kPa, gas through a rack in the open top 13 m/s 200 m above sea level.
TEST_CASE("fluid at rest under a pressure stays at rest around thin structures that reach through an open boundary")
{
    for (const int dim : {2, 3})
        for (const double thickness : {0.5, 0.8, 1.0, 1.4})
            for (const double angle : {0.0, 0.3})
            {
                CAPTURE(dim);
                CAPTURE(thickness);
                CoupledRig tank(makeBoxMesh(MPI_COMM_WORLD, dim, {10, 10, 10}, {0, 0, 0}, {1, 1, 1}));
                constexpr double level = 1e5;
                for (std::size_t p = 0; p < tank.mesh.patches.size(); ++p)
                    tank.patches.push_back(makePatch(tank.mesh, int(p), p == 1 ? BoundaryPatch::Velocity::Open : BoundaryPatch::Velocity::Slip));
                tank.patches[1].evaluate = [plain = tank.patches[1].evaluate](const BoundaryState& state, PatchValues& values)
                {
                    plain(state, values);
                    for (double& p : values.pressure) p += level;
                };
                std::vector<SceneStructure> bars(2);
                const double t = 0.1*thickness;
                for (int k = 0; k < 2; ++k)     // in space two that cross on the boundary
                {
                    bars[k].solid.shape = makeBox(Vec3::Zero(), Vec3(0.6, t, dim == 2 ? 1 : t));
                    if (dim == 3 && k == 0) bars[k].solid.shape = makeCylinder({-0.3, 0, 0}, {0.3, 0, 0}, 0.5*t);
                    bars[k].solid.pose.position = dim == 2 ? Vec3(0.95, 0.3 + 0.41*k, 0.5) : Vec3(0.97, 0.513, 0.487);
                    bars[k].solid.pose.orientation = Eigen::AngleAxisd((k == 0 ? 1 : -1)*angle, Vec3::UnitZ());
                }
                CoupledStep run(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches, Scene(bars, {}, Vec3::Zero()), nullptr, tank.timers);
                FlowState state = restState(tank.mesh);
                std::fill(state.p.begin(), state.p.end(), level);
                run.start(std::move(state), true);
                for (int k = 0; k < 3; ++k)
                {
                    const StepResult result = run.step(0.01);
                    CAPTURE(result.failure);
                    CAPTURE(k);
                    CAPTURE(angle);
                    REQUIRE(result.isAccepted);
                }
                double fastest = 0;
                for (const double u : run.fluid().state().u) fastest = std::max(fastest, std::abs(u));
                CHECK(tank.halo.max(fastest) < 1e-8);
            }
}
