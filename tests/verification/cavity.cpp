// SPDX-License-Identifier: GPL-3.0-or-later
/// Lid-driven cavity against Ghia, Ghia and Shin (1982).
#include "equations/fluid.hpp"
#include "support/flowCases.hpp"
#include "support/ghiaCavity.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

/// P1 velocity component at a point, on every rank.
double velocityAt(const Fluid& fluid, double x, double y, int component)
{
    const SimplexMesh& mesh = fluid.mesh();
    double result[2] = {0, 0}; // value, number of elements that hold the point
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e]) continue;
        double value = 0, lowest = 1;
        for (int a = 0; a < 3; ++a)
        {
            const int i = mesh.elements[3*e + a];
            const double* g = &mesh.gradN[(std::size_t(e)*3 + a)*2];
            const double lambda = 1 + g[0]*(x - mesh.x[2*i]) + g[1]*(y - mesh.x[2*i + 1]);
            lowest = std::min(lowest, lambda);
            value += lambda*fluid.state().u[2*i + component];
        }
        if (lowest < -1e-10) continue;
        result[0] += value;
        result[1] += 1;
    }
    fluid.halo().sum(result, 2);
    return result[0]/result[1];
}

/// Root mean square difference to Ghia's values over both centre lines.
double difference(const Fluid& fluid, double GhiaRow::*column)
{
    double sum = 0;
    int n = 0;
    for (const GhiaRow& row : ghiaU) { sum += std::pow(velocityAt(fluid, 0.5, row.coordinate, 0) - row.*column, 2); ++n; }
    for (const GhiaRow& row : ghiaV) { sum += std::pow(velocityAt(fluid, row.coordinate, 0.5, 1) - row.*column, 2); ++n; }
    return std::sqrt(sum/n);
}

double cavity(int n, double reynolds, double GhiaRow::*column)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.isTwoPhase = false;
    properties.rhoLiquid = 1;
    properties.muLiquid = 1/reynolds;
    NumericsControls controls;
    controls.timeOrder = 1;
    controls.tolerance = 1e-5;
    controls.restart = 100; // viscous numbers up to 2.6
    controls.maxIterations = 500;
    auto patches = allPatches(mesh, BoundaryPatch::Velocity::NoSlip);
    for (BoundaryPatch& p : patches) p.isNoSlipWall = true;
    patches[3] = makePatch(mesh, 3, BoundaryPatch::Velocity::Fixed, [](const double*, double) { return std::array<double, 3>{1, 0, 0}; });
    Fluid fluid(mesh, halo, properties, controls, patches);
    fluid.start(restState(mesh), false);
    double change = 1;
    for (int k = 0; change > 1e-5 && k < 6000; ++k) // d(u)/dt against U^2/L
    {
        const double dt = 2.0/n;
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
        change = 0;
        for (std::size_t i = 0; i < fluid.state().u.size(); ++i)
            change = std::max(change, std::abs(fluid.state().u[i] - fluid.state().uOld[i])/dt);
        change = halo.max(change);
    }
    CHECK(change <= 1e-5);
    const double error = difference(fluid, column);
    if (halo.rank() == 0) std::printf("| %g | %d | %.4f | %.1f |\n", reynolds, n, error, fluid.state().time);
    return error;
}

void printHeader()
{
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0) std::printf("\n| Re | n | rms difference to Ghia et al. | steady after [s] |\n|---|---|---|---|\n");
}

} // namespace

TEST_CASE("cavity")
{
    printHeader();
    CHECK(cavity(32, 100, &GhiaRow::re100) < 0.003);
    CHECK(cavity(32, 400, &GhiaRow::re400) < 0.01);
}

// Reynolds number 100: the difference no longer depends on the mesh, it is the table's own
TEST_CASE("cavity fine" * doctest::skip())
{
    printHeader();
    const double re100 = cavity(64, 100, &GhiaRow::re100);
    CHECK(cavity(128, 100, &GhiaRow::re100) == near(re100, 0.2));
    CHECK(cavity(64, 400, &GhiaRow::re400) < 0.005);
    CHECK(cavity(128, 1000, &GhiaRow::re1000) < 0.01);
}
