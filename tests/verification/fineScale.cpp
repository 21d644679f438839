// SPDX-License-Identifier: GPL-3.0-or-later
/// u' after a step is that of the step's own continuity rows: u + u' leaves no dual cell, those of cut elements included. With any other
/// acceleration in u' this fails: what convects the momentum is then not free of divergence.
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

/// Outflow of every owned node's dual cell, without the velocity or with it.
std::vector<double> outflows(const Fluid& fluid, const VolumeFlux& flux, const Cover& cover, bool withVelocity)
{
    const SimplexMesh& mesh = fluid.mesh();
    const int n = mesh.dim + 1;
    const std::vector<double> u(fluid.state().u.size(), 0.0);
    std::vector<double> sum(mesh.nNodes, 0.0);
    for (int e = 0; e < mesh.nElements; ++e)
        for (int a = 0; a < n; ++a)
            sum[mesh.elements[std::size_t(e)*n + a]] += flux.row(e, a, withVelocity ? fluid.state().u : u, fluid.state().fineScale, &cover);
    const std::vector<double> ghosts = fluid.ghostFluxes();
    for (std::size_t k = 0; k < ghosts.size() && withVelocity; k += 3)
    {
        sum[int(ghosts[k])] += ghosts[k + 2];
        sum[int(ghosts[k + 1])] -= ghosts[k + 2];
    }
    sum.resize(mesh.nOwned);
    return sum;
}

/// A vortex in the unit box, with a cylinder or sphere at rest in it.
FlowState vortex(const SimplexMesh& mesh)
{
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const double *x = &mesh.x[std::size_t(i)*mesh.dim], a = M_PI*x[0], b = M_PI*x[1];
        state.u[std::size_t(i)*mesh.dim] = std::sin(a)*std::cos(b);
        state.u[std::size_t(i)*mesh.dim + 1] = -std::cos(a)*std::sin(b);
    }
    state.uOld = state.u;
    return state;
}

double largest(const Halo& halo, const std::vector<double>& v)
{
    double result = 0;
    for (double x : v) result = std::max(result, std::abs(x));
    return halo.max(result);
}

} // namespace

TEST_CASE("u + u' of every step leaves no dual cell, around a body at rest and with any time step")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        const int n = dim == 2 ? 16 : 8;
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.15);
        const Halo halo(mesh, MPI_COMM_WORLD);
        FluidProperties properties;
        properties.isTwoPhase = false;
        properties.rhoLiquid = 1;
        properties.muLiquid = 1e-3;
        NumericsControls controls;
        controls.tolerance = 1e-11;
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
        fluid.start(vortex(mesh), false);
        std::vector<Solid> solids(1);
        solids[0].kind = Solid::Kind::Fixed;
        solids[0].shape = makeSphere(Vec3::Zero(), 0.17);
        solids[0].pose.position = Vec3(0.41, 0.62, 0.5);
        CoverBuilder builder(mesh, fluid.graph(), halo);
        const Cover& cover = builder.build(solids);
        fluid.setGeometry(&cover, &solids, true);
        const VolumeFlux flux(mesh, fluid.graph());
        double defect = 0, size = 0;
        for (double dt : {0.02, 0.02, 0.012, 0.015, 0.02})
        {
            fluid.beginStep(dt);
            fluid.assemble();
            REQUIRE(fluid.solve({}).hasConverged);
            fluid.endStep();
            defect = std::max(defect, largest(halo, outflows(fluid, flux, cover, true)));
            size = std::max(size, largest(halo, outflows(fluid, flux, cover, false)));
        }
        MESSAGE(dim, "D: u + u' ", defect, ", u' alone ", size);
        CHECK(size > 0);
        CHECK(defect < 1e-6*size);
    }
}
