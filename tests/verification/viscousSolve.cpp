// SPDX-License-Identifier: GPL-3.0-or-later
/// Iterations of a solve over the viscous number mu dt/(rho h^2), uniform meshes and cut ones.
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

using namespace flotsam;

namespace
{

constexpr int unsolved = 1000;

/// Largest number of iterations of a step in a cavity whose lid starts to move, n cells over its sides.
int iterations(int dim, int n, bool isCut, double viscousNumber)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    FluidProperties properties;
    const double dt = 0.5/n;
    properties.isTwoPhase = false;
    properties.muLiquid = viscousNumber*properties.rhoLiquid/(double(n)*n*dt);
    std::vector<BoundaryPatch> patches = allPatches(mesh, BoundaryPatch::Velocity::Fixed, [dim](const double* x, double)
    {
        return std::array<double, 3>{x[dim - 1] > 1 - 1e-9 ? 1. : 0., 0, 0};
    });
    Fluid fluid(mesh, halo, properties, controls, patches);
    fluid.start(restState(mesh), false);
    std::vector<Solid> solids(1);
    solids[0].shape = makeCylinder(Vec3(0.513, 0.4, -1), Vec3(0.513, 0.4, 2), 0.213);
    if (dim == 3) solids[0].shape = makeSphere(Vec3(0.513, 0.4, 0.487), 0.213);
    CoverBuilder builder(mesh, fluid.graph(), halo);
    if (isCut) fluid.setGeometry(&builder.build(solids), &solids, true);
    int most = 0;
    double seconds = 0;
    for (int k = 0; k < 4; ++k)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        const auto start = std::clock();
        const SolveReport report = fluid.solve({});
        seconds += double(std::clock() - start)/CLOCKS_PER_SEC/4;
        most = std::max(most, report.hasConverged ? report.iterations : unsolved);
        fluid.endStep();
    }
    std::printf("%dD n=%d %-7s viscous number %-5g: %4d iterations, %.3f s a solve\n", dim, n, isCut ? "cut" : "uniform", viscousNumber, most, seconds);
    return most;
}

} // namespace

TEST_CASE("iterations are bounded, however viscous the fluid")
{
    for (const int dim : {2, 3})
        for (const bool isCut : {false, true})
            for (const double number : {0.1, 1., 10., 100., 1e3, 1e4}) CHECK(iterations(dim, dim == 2 ? 40 : 12, isCut, number) < (isCut ? 130 : 65));
}

TEST_CASE("and on fine meshes" * doctest::skip())
{
    for (const int dim : {2, 3})
        for (const bool isCut : {false, true})
            for (const double number : {0.01, 0.03, 0.1, 0.3, 1., 10., 100., 1e4}) CHECK(iterations(dim, dim == 2 ? 120 : 24, isCut, number) < unsolved);
}
