// SPDX-License-Identifier: GPL-3.0-or-later
/// The collapse of a column of water at two time steps: with inertia of second order where the surface passes (`surfaceTimeOrder 2`) its energy
/// hardly depends on the step, with first order it grows with it.
#include "support/budgets.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

/// Energy after 0.25 s, before the water reaches the far wall, over the potential energy that the column has at the start.
double energyLeft(int surfaceTimeOrder, double dt)
{
    const int n = 24;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = 1e-7;
    controls.surfaceTimeOrder = surfaceTimeOrder;
    FluidProperties properties;
    properties.gravity[1] = -9.81;
    Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i) state.alpha[i] = mesh.x[2*i] < 0.3 && mesh.x[2*i + 1] < 0.6;
    fluid.start(state, true);
    const double start = fluidBudget(fluid, properties, controls, nullptr).potential;
    for (int k = 0; k < std::lround(0.25/dt); ++k)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
    const FluidBudget end = fluidBudget(fluid, properties, controls, nullptr);
    return (end.kinetic + end.potential)/start;
}

} // namespace

TEST_CASE("energy of a collapsing column at two time steps")
{
    usePetsc();
    double change[2];
    for (int order = 1; order <= 2; ++order)
    {
        const double coarse = energyLeft(order, 8e-3), fine = energyLeft(order, 2e-3);
        change[order - 1] = std::abs(coarse - fine);
        std::printf("order %d: energy left %.5f at dt 8 ms, %.5f at 2 ms\n", order, coarse, fine);
        if (order == 2)
        {
            CHECK(coarse < 1);
            CHECK(fine < 1);
        }
    }
    CHECK(change[1] < 0.5*change[0]);
}
