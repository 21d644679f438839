// SPDX-License-Identifier: GPL-3.0-or-later
/// Water in flight has its weight: spray above a flat surface falls.
#include "equations/fluid.hpp"
#include "equations/interfaceWidth.hpp"
#include "equations/materials.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double gravity = 9.81;    // [m/s^2]
constexpr double height = 1.5;      // of the box, 1 m wide, open at the top [m]
constexpr double level = 0.3;       // of the water [m]

/// Phase field 0.05 in a ball five elements above the water, two elements in radius.
double waterAndSpray(int dim, const double* x, double width, double h)
{
    const double z = x[dim - 1] - level;
    double square = (z - 5*h)*(z - 5*h);
    for (int d = 0; d < dim - 1; ++d) square += (x[d] - 0.5)*(x[d] - 0.5);
    return std::max(1/(1 + std::exp(z/width)), square < 4*h*h ? 0.05 : 0);
}

/// Mean acceleration of the spray over that of gravity, n cells over 1 m.
double fallOfSpray(int dim, int n)
{
    constexpr double time = 0.05, dt = 0.005;   // [s]
    usePetsc();
    const int rows = int(height*n), up = dim - 1;
    const double h = 1./n, lowest = level + 2.5*h;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, dim == 2 ? rows : n, rows}, {0, 0, 0}, {1, dim == 2 ? height : 1, dim == 2 ? 1 : height}, 0, true);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.gravity[up] = -gravity;
    const NumericsControls controls;
    std::vector<BoundaryPatch> patches = allPatches(mesh, BoundaryPatch::Velocity::Slip);
    const int top = 2*dim - 1;
    patches[top] = makePatch(mesh, top, BoundaryPatch::Velocity::Open);
    Fluid fluid(mesh, halo, properties, controls, patches);
    FlowState start = restState(mesh);
    const std::vector<double> width = interfaceWidth(mesh, fluid.graph(), halo, controls.interfaceWidth);
    for (int i = 0; i < mesh.nNodes; ++i)
        start.alpha[i] = waterAndSpray(dim, &mesh.x[std::size_t(i)*dim], width[i], h);
    start.uOld = start.u;
    start.alphaOld = start.alphaOlder = start.alpha;
    fluid.start(start, false);

    const std::vector<double> volume = dualVolumes(mesh, nullptr);
    const auto meanVelocity = [&] {
        double sums[2] = {0, 0};
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (mesh.x[std::size_t(i)*dim + up] < lowest) continue;
            const double mass = (density(properties, controls, fluid.state().alpha[i]) - properties.rhoGas)*volume[i];
            sums[0] += mass*fluid.state().u[std::size_t(i)*dim + up];
            sums[1] += mass;
        }
        halo.sum(sums, 2);
        return sums[0]/sums[1];
    };
    const auto advance = [&](double step) {
        fluid.beginStep(step);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    };
    advance(0.1*dt);
    const double before = meanVelocity(), first = fluid.state().time;
    while (fluid.state().time < time - 0.5*dt) advance(dt);
    return (before - meanVelocity())/(gravity*(fluid.state().time - first));
}

} // namespace

TEST_CASE("spray above a flat surface falls")
{
    for (int dim : {2, 3})
    {
        const double share = fallOfSpray(dim, dim == 2 ? 16 : 12);
        MESSAGE(dim, "D spray: share of its weight ", share);
        CHECK(share == near(1, 0.1)); // all density taken for the surface's: 1.28 and 1.48
    }
}
