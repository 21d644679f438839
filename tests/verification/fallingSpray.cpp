// SPDX-License-Identifier: GPL-3.0-or-later
/// Water in flight has its weight: spray above a flat surface falls.
#include "equations/fluid.hpp"
#include "equations/initialProfile.hpp"
#include "equations/materials.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace flotsam;

namespace
{

constexpr double gravity = 9.81;    // [m/s^2]
constexpr double height = 1.5;      // of the box, 1 m wide, open at the top [m]

/// Water and gas in the box; alpha of a point, from it and the interface width there.
struct Scene
{
    int dim, n;                     // cells over 1 m
    std::function<double(const double*, double)> alpha;
    double lowest = 0;              // water above this counts [m]
};

/// Mean acceleration of the water above `lowest` over `time` seconds, over that of gravity.
double fall(const Scene& scene, double time, double dt)
{
    usePetsc();
    const int dim = scene.dim, n = scene.n, rows = int(height*n), up = dim - 1;
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
    {
        start.alpha[i] = scene.alpha(&mesh.x[std::size_t(i)*dim], width[i]);
    }
    start.uOld = start.u;
    start.alphaOld = start.alphaOlder = start.alpha;
    fluid.start(start, false);

    const std::vector<double> volume = dualVolumes(mesh, nullptr);
    const auto meanVelocity = [&] {
        double sums[2] = {0, 0};
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (mesh.x[std::size_t(i)*dim + up] < scene.lowest) continue;
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

double ball(int dim, const double* x, double z, double radius)
{
    double square = (x[dim - 1] - z)*(x[dim - 1] - z);
    for (int d = 0; d < dim - 1; ++d) square += (x[d] - 0.5)*(x[d] - 0.5);
    return radius - std::sqrt(square);
}

} // namespace

TEST_CASE("spray above a flat surface falls")
{
    for (int dim : {2, 3})
    {
        const int n = dim == 2 ? 16 : 12;
        const auto alpha = [&](const double* x, double width) {
            const double water = 1/(1 + std::exp((x[dim - 1] - 0.3)/width));
            return std::max(water, ball(dim, x, 0.3 + 5./n, 2./n) > 0 ? 0.05 : 0);
        };
        const double share = fall({dim, n, alpha, 0.3 + 2.5/n}, 0.05, 0.005);
        MESSAGE(dim, "D spray: share of its weight ", share);
        CHECK(share > 0.8);
    }
}
