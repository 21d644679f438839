// SPDX-License-Identifier: GPL-3.0-or-later
/// Cells many times as tall as wide: the surface's level is found in them, and water at rest stays there.
#include "equations/fluid.hpp"
#include "equations/interfaceWidth.hpp"
#include "equations/surfaceLevel.hpp"
#include "support/boxMesh.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"
#include "support/waterAtRest.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr double wide = 0.2;    // of the tank [m]
constexpr int nRows = 7;
const std::array<double, 3> gravity2D{0, -9.81, 0}, gravity3D{0, 0, -9.81};

int nColumns(int dim) { return dim == 2 ? 20 : 6; }
double cellHeight(int dim, double aspect) { return aspect*wide/nColumns(dim); }

SimplexMesh tallMesh(int dim, double aspect)
{
    const int n = nColumns(dim);
    const double high = nRows*cellHeight(dim, aspect);
    return makeBoxMesh(MPI_COMM_WORLD, dim, {n, dim == 2 ? nRows : n, nRows}, {0, 0, 0}, {wide, dim == 2 ? high : wide, dim == 2 ? 0 : high}, 0, true);
}

/// Largest speed after 0.3 s, in the water and the gas; water up to `level` [cell heights].
double speedAtRest(int dim, double aspect, double level, double tolerance)
{
    usePetsc();
    const SimplexMesh mesh = tallMesh(dim, aspect);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = tolerance;
    FluidProperties properties;
    properties.gravity = dim == 2 ? gravity2D : gravity3D;
    Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    fluid.start(waterAtRest(fluid, level*cellHeight(dim, aspect)), false);
    while (fluid.state().time < 0.3)
    {
        fluid.beginStep(0.01);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
    double largest = 0;
    for (int i = 0; i < mesh.nOwned*dim; ++i) largest = std::max(largest, std::abs(fluid.state().u[i]));
    largest = halo.max(largest);
    std::printf("%dD, %g times as tall as wide, level %g: %.1e m/s\n", dim, aspect, level, largest);
    return largest;
}

/// Largest error of the level of a plane, `degrees` from level, at nodes within four interface widths of it, in widths. knowsGravity: as the program calls it.
double levelError(int dim, double aspect, double degrees, bool knowsGravity)
{
    const SimplexMesh mesh = tallMesh(dim, aspect);
    const NodeGraph graph(mesh);
    const Halo halo(mesh, MPI_COMM_WORLD);
    DualCells cells(mesh);
    cells.complete(halo);
    const std::array<double, 3> gravity = dim == 2 ? gravity2D : gravity3D;
    const std::vector<double> width = interfaceWidth(mesh, graph, halo, NumericsControls().interfaceWidth, gravity);
    const double middle = 0.5*nRows*cellHeight(dim, aspect), c = std::cos(degrees*M_PI/180), s = std::sin(degrees*M_PI/180);
    double normal[3] = {-s};
    normal[dim - 1] = -c;
    std::vector<double> alpha(mesh.nNodes), exact(mesh.nNodes), work, found;
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const double* x = &mesh.x[std::size_t(i)*dim];
        exact[i] = c*(1.03*middle - x[dim - 1]) + s*(0.5*wide - x[0]);
        alpha[i] = profileSlab(&cells, i, normal, exact[i], width[i]).mean();
    }
    SurfaceLevel(mesh, halo, knowsGravity ? gravity : std::array<double, 3>{}).find(alpha, width, &cells, nullptr, 1e-10, work, found);
    double worst = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
        if (std::abs(exact[i]) < 4*width[i]) worst = std::max(worst, std::abs(found[i] - exact[i])/width[i]);
    worst = halo.max(worst);
    std::printf("%dD, %g times as tall as wide, plane %g degrees from level: off by %.1e widths%s\n", dim, aspect, degrees, worst,
        knowsGravity ? "" : ", begun with the values at the nodes");
    return worst;
}

} // namespace

TEST_CASE("water at rest in tall cells stays at rest, wherever its level is between the rows")
{
    for (const double aspect : {8., 16., 40.})
        for (const double level : {3.02, 3.3, 3.5}) CHECK(speedAtRest(2, aspect, level, 1e-8) < 1e-6);
    for (const double aspect : {8., 20.}) CHECK(speedAtRest(3, aspect, 3.3, 1e-8) < 1e-6);
}

// what a first solve leaves of the pressure would be vortices that stay
TEST_CASE("it does so, in the gas too, solved as runs are")
{
    for (const double aspect : {1., 8., 20.})
        for (const int dim : {2, 3}) CHECK(speedAtRest(dim, aspect, 3.3, NumericsControls().tolerance) < 1e-5);
}

TEST_CASE("level and upright planes are found in them, and slight slopes; begun with the values at the nodes level ones are not")
{
    for (const int dim : {2, 3})
    {
        for (const double aspect : {8., 16., 40.})
        {
            CHECK(levelError(dim, aspect, 0, true) < 1e-9);
            CHECK(levelError(dim, aspect, 1, true) < 1e-7);
            CHECK(levelError(dim, aspect, 90, true) < 0.01);
        }
        for (const double aspect : {8., 16.}) CHECK(levelError(dim, aspect, 5, true) < 1e-5);
        for (const double aspect : {16., 40.}) CHECK(levelError(dim, aspect, 0, false) > 1);
    }
}

TEST_CASE("the profile is as thick as elements long, in tall ones as high less their length")
{
    for (const int dim : {2, 3})
        for (const double aspect : {0.1, 1., 2., 16.})
        {
            const SimplexMesh mesh = tallMesh(dim, aspect);
            const std::vector<double> width = interfaceWidth(mesh, NodeGraph(mesh), Halo(mesh, MPI_COMM_WORLD), 0.2, dim == 2 ? gravity2D : gravity3D);
            const double h = mesh.h[0], high = cellHeight(dim, aspect);
            for (int i = 0; i < mesh.nOwned; ++i) CHECK(width[i] == near(0.2*std::max(h, high - h), 1e-12));
        }
}
