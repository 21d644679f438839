// SPDX-License-Identifier: GPL-3.0-or-later
/// Slip patches that are bent, as beds and round walls of fitted meshes are: the nodes' normals are those of no face. Fluid at rest on them, potential flow along them.
#include "support/errorTable.hpp"
#include "support/potentialFlow.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double dt = 1e-3;

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
    return largestComponent(mesh, halo, afterOneStep(mesh, halo, properties, allPatches(mesh, BoundaryPatch::Velocity::Slip), dt));
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
    for (int p : {0, 1}) patches[p] = drivenPatch(mesh, p, dt, [](const double* x) { return std::atan2(x[1], -x[0]); });
    const auto vortex = [](const double* x)
    {
        const double r2 = x[0]*x[0] + x[1]*x[1];
        return std::array<double, 2>{x[1]/r2, -x[0]/r2};
    };
    return planeFlowError(mesh, halo, afterOneStep(mesh, halo, oneFluid(1, 1e-8), patches, dt), vortex, [](const double*) { return false; });
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
