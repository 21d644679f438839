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

TEST_CASE("reversed vortex, period 2: the error falls with order above 1.5")
{
    const double coarse = run(32, 0.35, 2).error, medium = run(64, 0.35, 2).error, fine = run(128, 0.35, 2).error;
    CHECK(coarse < 0.060);
    CHECK(medium < 0.016);
    CHECK(fine < 0.0050);
    CHECK(std::log2(coarse/fine)/2 > 1.5);
}

TEST_CASE("reversed vortex, period 8: the filament survives")
{
    CHECK(run(64, 0.25, 8).error < 0.26);
}
