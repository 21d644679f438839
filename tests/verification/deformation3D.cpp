// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

void checkConservation(const TransportResult& r)
{
    CHECK(std::abs(r.massError) < 1e-12);
    CHECK(r.redistributed < 1e-12);
    CHECK(r.lowest > -1e-12);
    CHECK(r.highest < 1 + 1e-12);
}

} // namespace

TEST_CASE("sphere carried along a diagonal and back")
{
    TransportScene scene(MPI_COMM_WORLD, 3, 24, 0.35, [](const Point&) { return Point{1, 0.7, 0.4}; });
    scene.fill(disc({0.35, 0.38, 0.42}, 0.2, 3));
    const TransportResult r = runPeriod(scene, 0.5, 0.5, [](double t) { return t < 0.25 ? 1 : -1; });
    checkConservation(r);
    CHECK(r.error < 0.011);
}

TEST_CASE("sphere turned by 60 degrees and back")
{
    TransportScene scene(MPI_COMM_WORLD, 3, 24, 0.35, rotationField());
    scene.fill(disc({0.5, 0.7, 0.5}, 0.18, 3));
    const TransportResult r = runPeriod(scene, 2*M_PI/3, 0.5, [](double t) { return t < M_PI/3 ? 1 : -1; });
    checkConservation(r);
    CHECK(r.error < 0.014);
}

TEST_CASE("sphere in a deformation field that is reversed")
{
    TransportScene scene(MPI_COMM_WORLD, 3, 32, 0.35, deformationField());
    scene.fill(disc({0.35, 0.35, 0.35}, 0.15, 3));
    const TransportResult r = runPeriod(scene, 1.5, 0.5, [](double t) { return std::cos(M_PI*t/1.5); });
    checkConservation(r);
    CHECK(r.error < 0.115);
    MESSAGE("error ", r.error, ", us per node and step ", 1e6*r.secondsPerNodeStep, ", band ", r.bandShare);
}
