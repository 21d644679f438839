// SPDX-License-Identifier: GPL-3.0-or-later
/// A drop that moves with its surroundings: density that travels with the fluid exerts no force, at any density ratio, so a uniform
/// velocity stays uniform. This fails when momentum and phase are carried by different mass fluxes.
#include "equations/fluid.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>

using namespace flotsam;

TEST_CASE("a drop in uniform motion leaves the velocity uniform")
{
    usePetsc();
    const int n = 24;
    const double speed[2] = {1, 0.4};
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {1, 1, 1}, 0.15);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;     // water and air, no gravity
    properties.isTwoPhase = true;
    properties.rhoLiquid = 1000;
    properties.muLiquid = 1e-3;
    properties.rhoGas = 1;
    properties.muGas = 1.5e-5;
    NumericsControls controls;
    controls.tolerance = 1e-10;
    std::vector<BoundaryPatch> patches;
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    {
        patches.push_back(makePatch(mesh, int(p), BoundaryPatch::Velocity::Fixed,
            [&](const double*, double) { return std::array<double, 3>{speed[0], speed[1], 0}; }));
        patches.back().phase = BoundaryPatch::Phase::Inflow;
    }
    Fluid fluid(mesh, halo, properties, controls, patches);
    FlowState start = restState(mesh);
    start.alpha.assign(mesh.nNodes, 0);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        start.u[2*i] = speed[0];
        start.u[2*i + 1] = speed[1];
        const double distance = std::hypot(mesh.x[2*i] - 0.35, mesh.x[2*i + 1] - 0.4) - 0.15;
        start.alpha[i] = 1/(1 + std::exp(distance*n/0.35));
    }
    start.uOld = start.u;
    start.alphaOld = start.alphaOlder = start.alpha;
    fluid.start(start, false);
    double largest = 0;
    for (int step = 0; step < 20; ++step)   // 0.3 of the box
    {
        fluid.beginStep(0.35/n);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
        for (int i = 0; i < mesh.nOwned; ++i)
            for (int d = 0; d < 2; ++d) largest = std::max(largest, std::abs(fluid.state().u[2*i + d] - speed[d]));
    }
    largest = halo.max(largest);
    MESSAGE("largest deviation from the uniform velocity: ", largest);
    CHECK(largest < 1e-6);
}

namespace
{

constexpr double ductLength = 2;

/// A duct 2 x 1 (3D: x 0.5) with slip walls and fluid of density 1000, nodes moved. velocity: at the start. Patches 0 (x = 0) and 1 (x = 2): given by the caller.
struct Duct
{
    Duct(int dim, double velocity, BoundaryPatch::Velocity at0, BoundaryPatch::Velocity at2, double p0)
    :   mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {16, 8, dim == 3 ? 4 : 1}, {0, 0, 0}, {ductLength, 1, 0.5}, 0.15)), halo(mesh, MPI_COMM_WORLD)
    {
        controls.tolerance = 1e-10;
        const BoundaryPatch::Velocity ends[2] = {at0, at2};
        for (int p = 0; p < 2; ++p)
        {
            patches.push_back(makePatch(mesh, p, ends[p], [=](const double*, double) { return std::array<double, 3>{velocity, 0, 0}; }));
            if (ends[p] != BoundaryPatch::Velocity::Open || p != 0) continue;
            patches[p].pressure = BoundaryPatch::Pressure::Total;
            patches[p].evaluate = [=, base = patches[p].evaluate](const BoundaryState& state, PatchValues& values)
            {
                base(state, values);
                values.pressure.assign(values.pressure.size(), p0);
            };
        }
        for (int p = 2; p < 2*dim; ++p) patches.push_back(makePatch(mesh, p, BoundaryPatch::Velocity::Slip));
        fluid = std::make_unique<Fluid>(mesh, halo, properties, controls, patches);
        FlowState start = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i) start.u[std::size_t(i)*dim] = velocity;
        start.uOld = start.u;
        fluid->start(start, false);
    }

    void advance(double dt)
    {
        fluid->beginStep(dt);
        fluid->assemble();
        REQUIRE(fluid->solve({}).hasConverged);
        fluid->endStep();
    }

    /// Largest deviations of the velocity from (u, 0, 0) and of the pressure from `pressure` at the place x.
    template<class Pressure> std::array<double, 2> deviations(double u, const Pressure& pressure) const
    {
        std::array<double, 2> largest{};
        const int dim = mesh.dim;
        const FlowState& s = fluid->state();
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double* v = &s.u[std::size_t(i)*dim];
            largest[0] = std::max(largest[0], std::hypot(v[0] - u, v[1], dim == 3 ? v[2] : 0));
            largest[1] = std::max(largest[1], std::abs(s.p[i] - pressure(mesh.x[std::size_t(i)*dim])));
        }
        return {halo.max(largest[0]), halo.max(largest[1])};
    }

    SimplexMesh mesh;
    Halo halo;
    FluidProperties properties = oneFluid(1000, 1e-3);
    NumericsControls controls;
    std::vector<BoundaryPatch> patches;
    std::unique_ptr<Fluid> fluid;
};

} // namespace

TEST_CASE("a uniform flow leaves through an open boundary as it is")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        Duct duct(dim, 1, BoundaryPatch::Velocity::Fixed, BoundaryPatch::Velocity::Open, 0);
        for (int step = 0; step < 5; ++step) duct.advance(0.05);
        const auto [velocity, pressure] = duct.deviations(1, [](double) { return 0; });
        CHECK(velocity < 1e-6);
        CHECK(pressure < 1e-3);
    }
}

TEST_CASE("a uniform flow enters through an open boundary of given total pressure as it is")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        Duct duct(dim, 1, BoundaryPatch::Velocity::Open, BoundaryPatch::Velocity::Fixed, 0);
        for (int step = 0; step < 5; ++step) duct.advance(0.05);
        const auto [velocity, pressure] = duct.deviations(1, [](double) { return -500; });
        CHECK(velocity < 1e-6);
        CHECK(pressure < 1e-3);
    }
}

// rho L du/dt = p0 - rho u^2/2: u = U tanh(U t/(2 L)), U^2 = 2 p0/rho (Bernoulli's equation of the unsteady flow in a duct); p falls linearly to 0 along it.
TEST_CASE("a given total pressure drives the water of a duct")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        double last = 0;
        for (int n : {20, 40, 80})
        {
            Duct duct(dim, 0, BoundaryPatch::Velocity::Open, BoundaryPatch::Velocity::Open, 500);
            const double end = 4;
            for (int step = 0; step < n; ++step) duct.advance(end/n);
            const double u = std::tanh(end/(2*ductLength));
            const auto [velocity, pressure] = duct.deviations(u, [&](double x) { return 500*(1 - u*u)*(1 - x/ductLength); });
            MESSAGE(dim, "D, ", n, " steps: velocity off by ", velocity, " m/s, pressure by ", pressure, " Pa");
            CHECK(velocity < 2e-3*20./n);
            if (n > 20) CHECK(velocity < last/3); // second order
            last = velocity;
        }
    }
}
