// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

TransportResult run(int n, double width, double period)
{
    TransportScene scene(MPI_COMM_WORLD, 2, n, width, vortexField());
    scene.fill(disc({0.5, 0.75, 0}, 0.15, 2));
    const TransportResult r = runPeriod(scene, period, 0.5, [period](double t) { return std::cos(M_PI*t/period); });
    CHECK(std::abs(r.massError) < 1e-12);
    CHECK(r.redistributed < 1e-12);
    CHECK(r.lowest > -1e-12);
    CHECK(r.highest < 1 + 1e-12);
    return r;
}

} // namespace

TEST_CASE("reversed vortex, period 2: the error falls with order above 1.8")
{
    const double coarse = run(32, 0.35, 2).error, medium = run(64, 0.35, 2).error, fine = run(128, 0.35, 2).error;
    CHECK(coarse < 0.044);
    CHECK(medium < 0.012);
    CHECK(fine < 0.0033);
    CHECK(std::log2(coarse/fine)/2 > 1.8);
}

TEST_CASE("reversed vortex, period 8: the filament survives")
{
    CHECK(run(64, 0.25, 8).error < 0.15);
}

namespace
{

/// Mean distance of the liquid from the centre of the square.
double meanRadius(const TransportScene& scene)
{
    double liquid = 0, moment = 0;
    for (int i = 0; i < scene.mesh.nOwned; ++i)
    {
        const Point x = scene.point(i);
        liquid += scene.volume[i]*scene.alpha[i];
        moment += scene.volume[i]*scene.alpha[i]*std::hypot(x[0] - 0.5, x[1] - 0.5);
    }
    return moment/liquid;
}

} // namespace

TEST_CASE("a thin ring turned once keeps its place and thickness")
{
    const double h = 1./64, radius = 0.3, thickness = 1.4*h;
    TransportScene scene(MPI_COMM_WORLD, 2, 64, 0.2, rotationField());
    scene.fastest = 1;
    scene.fill([=](const Point& x) { return std::abs(std::hypot(x[0] - 0.5, x[1] - 0.5) - radius) - 0.5*thickness; });
    const double before = meanRadius(scene);
    const TransportResult r = runPeriod(scene, 2*M_PI, 0.5, [](double) { return 1; });
    CHECK(std::abs(meanRadius(scene) - before) < 0.1*h);
    CHECK(r.error < 0.085);
}
