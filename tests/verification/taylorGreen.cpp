// SPDX-License-Identifier: GPL-3.0-or-later
/// Decaying Taylor-Green vortex in a box of slip walls: velocity of order 2 with the time step refined with the mesh, pressure of order 1.5,
/// energy that decays at the exact rate and never grows.
#include "equations/fluid.hpp"
#include "support/errorTable.hpp"
#include "support/flowCases.hpp"
#include "support/forcedFlow.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double nu = 0.02, endTime = 2;

/// u = sin x cos y, v = -cos x sin y, p = (cos 2x + cos 2y)/4, times exp(-2 nu t) and its square.
ExactFlow taylorGreen()
{
    ExactFlow exact;
    exact.velocity = [](const double* x, double t, double* u)
    {
        u[0] = std::sin(x[0])*std::cos(x[1])*std::exp(-2*nu*t);
        u[1] = -std::cos(x[0])*std::sin(x[1])*std::exp(-2*nu*t);
    };
    exact.pressure = [](const double* x, double t) { return 0.25*(std::cos(2*x[0]) + std::cos(2*x[1]))*std::exp(-4*nu*t); };
    return exact;
}

/// Integral of u.u/2 of the P1 velocity.
double kineticEnergy(const SimplexMesh& mesh, const Halo& halo, const FlowState& state)
{
    double energy = 0;
    for (int e = 0; e < mesh.nElements; ++e)
        for (int d = 0; d < 2 && mesh.isOwnedElement[e]; ++d)
        {
            double sum = 0, squares = 0;
            for (int a = 0; a < 3; ++a)
            {
                const double u = state.u[std::size_t(mesh.elements[3*e + a])*2 + d];
                sum += u;
                squares += u*u;
            }
            energy += 0.5*mesh.volume[e]*(squares + sum*sum)/12;
        }
    return halo.sum(energy);
}

struct Decay { FlowErrors errors; double energy, largestGrowth; };

Decay run(int n)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {M_PI, M_PI, 1}, 0.15);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.isTwoPhase = false;
    properties.rhoLiquid = 1;
    properties.muLiquid = nu;
    NumericsControls controls;
    controls.tolerance = 1e-7;
    controls.restart = 100;
    Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    const ExactFlow exact = taylorGreen();
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        exact.velocity(&mesh.x[2*std::size_t(i)], 0, &state.u[2*std::size_t(i)]);
        state.p[i] = exact.pressure(&mesh.x[2*std::size_t(i)], 0);
    }
    state.uOld = state.u;
    fluid.start(state, false);
    const int steps = 2*n;
    const double start = kineticEnergy(mesh, halo, fluid.state());
    Decay decay{{}, start, -1e300};
    for (int k = 0; k < steps; ++k)
    {
        fluid.beginStep(endTime/steps);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
        const double energy = kineticEnergy(mesh, halo, fluid.state());
        decay.largestGrowth = std::max(decay.largestGrowth, energy/decay.energy - 1);
        decay.energy = energy;
    }
    decay.errors = flowErrors(mesh, halo, nullptr, fluid.state(), exact);
    decay.energy = std::abs(decay.energy/start*std::exp(4*nu*endTime) - 1);
    return decay;
}

} // namespace

TEST_CASE("Taylor-Green vortex")
{
    ErrorTable table("Taylor-Green vortex, nu 0.02, t = 2, Courant number 0.32, moved nodes");
    for (int n : {16, 32, 64})
    {
        const Decay decay = run(n);
        CHECK(decay.largestGrowth < 0);
        table.add(M_PI/n, {{"u L2", decay.errors.velocity}, {"u H1", decay.errors.gradient}, {"p L2", decay.errors.pressure},
            {"energy", decay.energy}});
    }
    table.print();
    CHECK(table.shownOrder("u L2") > 1.9);
    CHECK(table.shownOrder("u H1") > 0.95);
    CHECK(table.shownOrder("p L2") > 1.5);
    CHECK(table.shownOrder("energy") > 1.9);
}
