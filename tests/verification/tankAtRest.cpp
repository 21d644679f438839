// SPDX-License-Identifier: GPL-3.0-or-later
/// Water under air at rest on irregular meshes stays at rest, with and without a solid that pierces the surface.
#include "equations/fluid.hpp"
#include "equations/interfaceWidth.hpp"
#include "equations/surfaceLevel.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

/// Largest speed in the water (alpha > 0.5) and anywhere after `time` seconds. degrees: gravity off the mesh's axis.
std::array<double, 2> speedsAfter(int dim, int n, bool hasSolid, double time, double degrees = 0, double tolerance = 1e-9,
    double interfaceWidthOverLength = NumericsControls().interfaceWidth, double profileKeeping = NumericsControls().profileKeeping)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, dim == 2 ? n : n/2, n}, {0, 0, 0},
        {0.2, dim == 2 ? 0.2 : 0.1, dim == 2 ? 1.0 : 0.2}, 0.19);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = tolerance;
    controls.interfaceWidth = interfaceWidthOverLength;
    controls.profileKeeping = profileKeeping;
    FluidProperties properties;
    const double c = std::cos(degrees*M_PI/180), s = std::sin(degrees*M_PI/180);
    properties.gravity[dim - 1] = -9.81*c;
    properties.gravity[0] = -9.81*s;
    Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
    FlowState state = restState(mesh);
    const double level = 0.1 + 0.37*0.2/n;
    const DualCells cells(mesh);
    double normal[3] = {-s};
    normal[dim - 1] = -c;
    const std::vector<double> width = interfaceWidth(mesh, fluid.graph(), halo, controls.interfaceWidth);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const double* x = &mesh.x[std::size_t(i)*dim];
        const double d = c*(level - x[dim - 1]) + s*(0.1 - x[0]);
        state.alpha[i] = profileSlab(&cells, i, normal, d, width[i]).mean();
    }
    halo.update(state.alpha, 1);    // cells of second-ring copies are not whole
    state.alphaOld = state.alphaOlder = state.alpha;
    fluid.start(state, false);
    std::vector<Solid> solids(1);
    solids[0].shape = makeCylinder(Vec3(0.103, 0.103, -1), Vec3(0.103, 0.103, 2), 0.03);
    if (dim == 3) solids[0].shape = makeCylinder(Vec3(0.103, 0.053, -1), Vec3(0.103, 0.053, 2), 0.023);
    CoverBuilder builder(mesh, fluid.graph(), halo);
    if (hasSolid)
    {
        const Cover& cover = builder.build(solids);
        fluid.setGeometry(&cover, &solids, true);
    }
    const double dt = 2e-3;
    while (fluid.state().time < time)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
    std::array<double, 2> largest{0, 0};
    for (int i = 0; i < mesh.nOwned; ++i)
        for (int d = 0; d < dim; ++d)
        {
            const double u = std::abs(fluid.state().u[std::size_t(i)*dim + d]);
            largest[1] = std::max(largest[1], u);
            if (fluid.state().alpha[i] > 0.5) largest[0] = std::max(largest[0], u);
        }
    for (double& v : largest) v = halo.max(v);
    std::printf("%dD n=%d, %g degrees, %s: water %.2e m/s, all %.2e m/s after %g s\n", dim, n, degrees,
        hasSolid ? "with a cylinder" : "open", largest[0], largest[1], time);
    return largest;
}

} // namespace

TEST_CASE("a two-fluid tank on an irregular mesh stays at rest") { CHECK(speedsAfter(2, 20, false, 0.1)[0] < 1e-6); }
TEST_CASE("so it does around a cylinder at the surface") { CHECK(speedsAfter(2, 20, true, 0.1)[0] < 1e-6); }
TEST_CASE("and in 3D") { CHECK(speedsAfter(3, 10, false, 0.1)[0] < 1e-6); }
TEST_CASE("and in 3D around a cylinder that pierces the surface") { CHECK(speedsAfter(3, 10, true, 0.1)[0] < 1e-6); }
// Smooth pressures that a solve leaves must not grow from step to step, in the gas neither: speeds in proportion to the tolerance, a second later the same.
TEST_CASE("and on a fine mesh, solved as runs are")
{
    const double tolerance = NumericsControls().tolerance;
    CHECK(speedsAfter(2, 80, false, 0.4, 0, tolerance)[1] < 1e-5);
    CHECK(speedsAfter(2, 80, false, 1.2, 0, tolerance)[1] < 1e-5);
    CHECK(speedsAfter(2, 80, true, 0.4, 0, tolerance)[1] < 1e-5);
    CHECK(speedsAfter(2, 80, false, 0.4, 0, 0.1*tolerance)[1] < 1e-6);
    CHECK(speedsAfter(2, 80, true, 0.4, 0, 0.1*tolerance)[1] < 1e-6);
}
// Circulations that widen the profile here and thin it there meet no resistance but profileKeeping: without it 6e-4, 5e-4 and 6e-5 m/s, growing by e in 0.6 s (width 0.4: 0.4 s).
TEST_CASE("and for long, whatever the profile's width")
{
    const double tolerance = NumericsControls().tolerance;
    CHECK(speedsAfter(2, 40, false, 4.8, 0, tolerance)[1] < 1e-5);
    CHECK(speedsAfter(2, 40, true, 4.8, 0, tolerance)[1] < 1e-5);
    CHECK(speedsAfter(2, 40, false, 2.4, 0, tolerance, 0.4)[1] < 1e-5);
}
// nodes of cut elements lie more than h from the surface
TEST_CASE("and where the surface crosses the mesh's lines at an angle")
{
    CHECK(speedsAfter(2, 20, false, 0.1, 40)[0] < 1e-6);
    CHECK(speedsAfter(3, 10, false, 0.1, 40)[0] < 1e-6);
}
// For the table in docs/numerics.md, section 4: speeds for rates of profileKeeping and widths.
TEST_CASE("table of profileKeeping" * doctest::skip())
{
    for (const double rate : {0.0, 0.03, 0.1, 0.3, 1.0, 3.0})
    {
        std::printf("profileKeeping %g: ", rate);
        speedsAfter(2, 40, false, 6.8, 0, 1e-6, NumericsControls().interfaceWidth, rate);
    }
    for (const double width : {0.1, 0.2, 0.4})
    {
        std::printf("profileKeeping 0, width %g: ", width);
        speedsAfter(2, 40, false, 4.8, 0, 1e-6, width, 0);
    }
}
