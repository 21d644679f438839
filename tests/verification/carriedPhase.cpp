// SPDX-License-Identifier: GPL-3.0-or-later
/// A phase of the same density and viscosity weighs nothing: the transport's fluxes, means over the step, do not convect momentum where the density does not vary.
#include "equations/fluid.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

/// Of a vortex between slip walls after 0.4 s. hasDisc: a disc of the other phase goes round with it.
std::vector<double> velocities(const SimplexMesh& mesh, const Halo& halo, bool hasDisc)
{
    FluidProperties properties = oneFluid(1, 1e-3);
    properties.isTwoPhase = hasDisc;
    properties.rhoGas = properties.rhoLiquid;
    properties.muGas = properties.muLiquid;
    NumericsControls controls;
    controls.tolerance = 1e-11;
    controls.tauContBulk = 1;   // the same with and without a surface
    Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const double x = mesh.x[2*i], y = mesh.x[2*i + 1];
        state.u[2*i] = std::sin(M_PI*x)*std::cos(M_PI*y);
        state.u[2*i + 1] = -std::cos(M_PI*x)*std::sin(M_PI*y);
        if (hasDisc) state.alpha[i] = 1/(1 + std::exp((std::hypot(x - 0.5, y - 0.7) - 0.15)*24/0.35));
    }
    state.uOld = state.u;
    state.alphaOld = state.alphaOlder = state.alpha;
    fluid.start(state, false);
    for (int k = 0; k < 20; ++k)
    {
        fluid.beginStep(0.02);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
    return fluid.state().u;
}

double rmsDifference(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0;
    for (std::size_t k = 0; k < 2*std::size_t(mesh.nOwned); ++k) sum += (a[k] - b[k])*(a[k] - b[k]);
    return std::sqrt(halo.sum(sum)/halo.sum(long(mesh.nOwned)));
}

} // namespace

TEST_CASE("a phase of the same density and viscosity leaves the flow as it is")
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {24, 24, 1}, {0, 0, 0}, {1, 1, 1}, 0.15);
    const Halo halo(mesh, MPI_COMM_WORLD);
    const double difference = rmsDifference(mesh, halo, velocities(mesh, halo, false), velocities(mesh, halo, true));
    std::printf("passive phase: velocities differ by %.1e m/s\n", difference);
    CHECK(difference < 1e-9);
}
