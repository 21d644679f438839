// SPDX-License-Identifier: GPL-3.0-or-later
/// Closed tanks: no boundary gives the pressure a level, and it does not drift.
#include "demCoupling/coupling/coupledStep.hpp"
#include "support/flowCases.hpp"

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
