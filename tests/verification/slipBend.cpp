// SPDX-License-Identifier: GPL-3.0-or-later
/// Slip patches that are bent, as beds and round walls of fitted meshes are: the nodes' normals are those of no face. Fluid at rest on them, potential flow along them.
#include "equations/fluid.hpp"
#include "support/errorTable.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double dt = 1e-3;

/// Fluid after one step from rest.
FlowState afterOneStep(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& properties, std::vector<BoundaryPatch> patches)
{
    usePetsc();
    NumericsControls controls;
    controls.tolerance = 1e-10;
    Fluid fluid(mesh, halo, properties, controls, std::move(patches));
    fluid.start(restState(mesh), true);
    fluid.beginStep(dt);
    fluid.assemble();
    REQUIRE(fluid.solve({}).hasConverged);
    fluid.endStep();
    return fluid.state();
}

/// Closed box of unit sides whose bottom is a hill: slopes up to 25 degrees, bends from element to element of 1 to 6.
double largestSpeedOnHill(int dim, int n)
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.1);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        double* x = &mesh.x[std::size_t(i)*dim];
        const double hill = 0.15*std::sin(M_PI*x[0])*(dim == 3 ? std::sin(M_PI*x[1]) : 1);
        x[dim - 1] += hill*(1 - x[dim - 1]);
    }
    mesh.computeGeometry();
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties = oneFluid(1, 1e-8);
    properties.gravity = {3, -8, dim == 3 ? 4. : 0.};
    const FlowState state = afterOneStep(mesh, halo, properties, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    double largest = 0;
    for (int i = 0; i < mesh.nOwned*dim; ++i) largest = std::max(largest, std::abs(state.u[i]));
    return halo.max(largest);
}

/// Nodal L2 error, relative, of the potential vortex u = 1/r between circles of radius 1 and 2, driven through a quarter of the ring (in 3D a slab of it) by
/// the pressures on its ends, with the angle as potential.
double vortexError(int dim, int n)
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {2*n, n, 2}, {0, 1, 0}, {M_PI/2, 2, 2./n}, 0);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        double* x = &mesh.x[std::size_t(i)*dim];
        const double angle = x[0], r = x[1];
        x[0] = -r*std::cos(angle);
        x[1] = r*std::sin(angle);
    }
    mesh.computeGeometry();
    const Halo halo(mesh, MPI_COMM_WORLD);
    std::vector<BoundaryPatch> patches = allPatches(mesh, BoundaryPatch::Velocity::Slip);
    for (int p : {0, 1})
    {
        patches[p] = makePatch(mesh, p, BoundaryPatch::Velocity::Open);
        const std::vector<int> nodes = patches[p].nodes;
        patches[p].evaluate = [&mesh, nodes](const BoundaryState&, PatchValues& values)
        {
            values.pressure.clear();
            for (int i : nodes) values.pressure.push_back(-std::atan2(mesh.x[std::size_t(i)*mesh.dim + 1], -mesh.x[std::size_t(i)*mesh.dim])/dt);
            values.alpha.assign(nodes.size(), 1);
        };
    }
    const FlowState state = afterOneStep(mesh, halo, oneFluid(1, 1e-8), patches);
    double error = 0, norm = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const double *x = &mesh.x[std::size_t(i)*dim], r2 = x[0]*x[0] + x[1]*x[1];
        const double exact[3] = {x[1]/r2, -x[0]/r2, 0};
        for (int d = 0; d < dim; ++d)
        {
            error += std::pow(state.u[std::size_t(i)*dim + d] - exact[d], 2);
            norm += exact[d]*exact[d];
        }
    }
    return std::sqrt(halo.sum(error)/halo.sum(norm));
}

ErrorTable study(const char* title, int dim, const std::vector<int>& sizes)
{
    ErrorTable table(title, "h");
    for (int n : sizes) table.add(1./n, {{"u L2", vortexError(dim, n)}});
    table.print();
    return table;
}

} // namespace

TEST_CASE("fluid at rest stays at rest on a bent bed")
{
    CHECK(largestSpeedOnHill(2, 10) < 1e-10);
    CHECK(largestSpeedOnHill(3, 6) < 1e-10);
}

TEST_CASE("fluid flows along round walls")
{
    // without the terms of the faces at bends: 0.0040, order 1.46; 0.0174, 1.41
    const ErrorTable flat = study("Vortex between round slip patches", 2, {8, 16, 32}), slab = study("The same in 3D", 3, {6, 12});
    CHECK(flat.lastOrder("u L2") > 1.75);
    CHECK(flat.value("u L2", 2) < 0.001);
    CHECK(slab.lastOrder("u L2") > 1.7);
    CHECK(slab.value("u L2", 1) < 0.006);
}
