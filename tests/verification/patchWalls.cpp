// SPDX-License-Identifier: GPL-3.0-or-later
/// No-slip patches: exact where the flow is linear, of second order where their layer is resolved, without a layer of the elements' own where it is not.
#include "equations/fluid.hpp"
#include "equations/wallLaw.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <memory>

using namespace flotsam;

namespace
{

using Profile = std::function<double(double y, double t)>;

/// A channel 1 x 1 (3D: x 0.5) along x with a no-slip patch at y = 0, density 1. u(y, t) at the inlet (unless the flow is free to develop: patches 0 and 1 are set by
/// the caller), at y = 1 and as start; nodes moved.
struct Channel
{
    Channel(int dim, int n, double mu, Profile u, double gamma, BoundaryPatch::Velocity outlet = BoundaryPatch::Velocity::Fixed)
    :   mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n/2}, {0, 0, 0}, {1, 1, dim == 3 ? 0.5 : 1}, 0.15)), halo(mesh, MPI_COMM_WORLD), properties(oneFluid(1, mu)), u_(u)
    {
        controls.tolerance = 1e-10;
        controls.wallGamma = gamma;
        const auto along = [u](const double* x, double t) { return std::array<double, 3>{u(x[1], t), 0, 0}; };
        patches.push_back(makePatch(mesh, 0, BoundaryPatch::Velocity::Fixed, along));
        patches.push_back(makePatch(mesh, 1, outlet, along));
        patches.push_back(makePatch(mesh, 2, gamma > 0 ? BoundaryPatch::Velocity::NoSlip : BoundaryPatch::Velocity::Fixed));
        patches.back().isNoSlipWall = true;
        patches.push_back(makePatch(mesh, 3, BoundaryPatch::Velocity::Fixed, along));
        for (int p = 4; p < 2*dim; ++p) patches.push_back(makePatch(mesh, p, BoundaryPatch::Velocity::Slip));
    }

    void start()
    {
        fluid = std::make_unique<Fluid>(mesh, halo, properties, controls, patches);
        FlowState s = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i) s.u[std::size_t(i)*mesh.dim] = u_(mesh.x[std::size_t(i)*mesh.dim + 1], 0);
        s.uOld = s.u;
        fluid->start(s, false);
    }

    void advance(double dt)
    {
        fluid->beginStep(dt);
        fluid->assemble();
        REQUIRE(fluid->solve({}).hasConverged);
        fluid->endStep();
    }

    /// Of the velocities of nodes beyond `from` against u: largest and root of the mean square.
    std::array<double, 2> errors(double from = 0) const
    {
        double largest = 0, sum = 0, n = 0;
        const int dim = mesh.dim;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (mesh.x[std::size_t(i)*dim] < from) continue;
            const double* v = &fluid->state().u[std::size_t(i)*dim];
            const double error = std::hypot(v[0] - u_(mesh.x[std::size_t(i)*dim + 1], fluid->state().time), v[1], dim == 3 ? v[2] : 0);
            largest = std::max(largest, error);
            sum += error*error;
            ++n;
        }
        return {halo.max(largest), std::sqrt(halo.sum(sum)/halo.sum(n))};
    }

    /// of 1 - u over the channel
    double meanLoss() const
    {
        double sum = 0, volume = 0;
        for (std::size_t e = 0; e < mesh.volume.size(); ++e)
        {
            if (!mesh.isOwnedElement[e]) continue;
            volume += mesh.volume[e];
            const int n = mesh.dim + 1;
            for (int k = 0; k < n; ++k) sum += mesh.volume[e]/n*(1 - fluid->state().u[std::size_t(mesh.elements[e*n + k])*mesh.dim]);
        }
        return halo.sum(sum)/halo.sum(volume);
    }

    SimplexMesh mesh;
    Halo halo;
    FluidProperties properties;
    NumericsControls controls;
    std::vector<BoundaryPatch> patches;
    std::unique_ptr<Fluid> fluid;

private:
    Profile u_;
};

} // namespace

// in Stokes' regime: convection keeps a shear flow on nodes that were moved to the second order alone
TEST_CASE("a linear profile over a no-slip patch is kept")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        Channel channel(dim, 8, 1e4, [](double y, double) { return y; }, 16);
        channel.start();
        for (int k = 0; k < 5; ++k) channel.advance(0.1);
        CHECK(channel.errors()[0] < 1e-8);
    }
}

// u = y (2 - y), whose dp/dx is -2 mu
TEST_CASE("Poiseuille's profile over a no-slip patch with order 2")
{
    usePetsc();
    for (double gamma : {16., 0.})
    {
        std::vector<double> error;
        for (int n : {8, 16, 32})
        {
            Channel channel(2, n, 0.1, [](double y, double) { return y*(2 - y); }, gamma);
            channel.start();
            for (int k = 0; k < 60; ++k) channel.advance(0.2);
            error.push_back(channel.errors()[1]);
        }
        MESSAGE("wallGamma ", gamma, ": ", error[0], ' ', error[1], ' ', error[2]);
        CHECK(std::log2(error[0]/error[2]) > 3.4);
    }
}

// After a start at once the layer on the wall (Stokes' first problem) takes u sqrt(4 nu t/pi) = 0.0020 of the flow: of the node there, which stands for half an
// element, 3 %. Held at the nodes the wall takes all of it. The water enters by its total pressure, at rest nowhere
TEST_CASE("an unresolved layer takes of the flow what it is thick, not what the elements are")
{
    usePetsc();
    const auto slowed = [](double gamma, bool wallLaw = false, double roughness = 0)
    {
        Channel channel(2, 8, 1e-5, [](double, double) { return 1.; }, gamma, BoundaryPatch::Velocity::Open);
        channel.patches[0] = makePatch(channel.mesh, 0, BoundaryPatch::Velocity::Open);
        channel.patches[0].pressure = BoundaryPatch::Pressure::Total;
        channel.patches[0].evaluate = [base = channel.patches[0].evaluate](const BoundaryState& state, PatchValues& values)
        {
            base(state, values);
            values.pressure.assign(values.pressure.size(), 0.5);
        };
        channel.controls.wallLaw = wallLaw;
        channel.controls.wallRoughness = roughness;
        channel.start();
        for (int k = 0; k < 6; ++k) channel.advance(0.05);
        return std::array<double, 2>{channel.errors()[0], channel.meanLoss()};
    };
    CHECK(slowed(0)[0] == near(1, 1e-12));
    CHECK(slowed(16)[0] < 0.03);
    // by the wall law's traction (u/u+)^2; what has entered since has run along the wall for half of the time
    for (double roughness : {0., 0.01})
    {
        const double uPlus = velocityOverFriction(0.125/2/1e-5, roughness/1e-5);
        const double lost = slowed(16, true, roughness)[1];
        MESSAGE("roughness ", roughness, ": momentum lost ", lost);
        CHECK(lost == near(0.3*(1 - 0.3/2)/(uPlus*uPlus), 0.1));
    }
}
