// SPDX-License-Identifier: GPL-3.0-or-later
/// Spheres carried, turned and deformed, and back, at the default interface width on 16, 24 and 32 cells a side.
#include "support/errorTable.hpp"
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace flotsam;

namespace
{

/// Each error at most its bound.
ErrorTable errors(const char* title, const VelocityField& field, const LiquidShape& sphere, double period,
    const std::function<double(double)>& amplitude, const std::array<double, 3>& bounds)
{
    ErrorTable table(title);
    for (int k = 0; k < 3; ++k)
    {
        const int n = 16 + 8*k;
        TransportScene scene(MPI_COMM_WORLD, 3, n, defaultWidth, field);
        scene.fill(sphere);
        const TransportResult r = runPeriod(scene, period, 0.5, amplitude);
        INFO("n ", n);
        CHECK(r.error < bounds[k]);
        CHECK(std::abs(r.massError) < 1e-12);
        CHECK(r.redistributed < 1e-12);
        CHECK(r.lowest > -1e-12);
        CHECK(r.highest < 1 + 1e-12);
        table.add(1.0/n, {{"shape", r.error}});
    }
    table.print();
    return table;
}

} // namespace

TEST_CASE("sphere carried along a diagonal and back")
{
    const ErrorTable table = errors("Sphere carried along a diagonal and back", [](const Point&) { return Point{1, 0.7, 0.4}; },
        disc({0.35, 0.38, 0.42}, 0.2, 3), 0.5, [](double t) { return t < 0.25 ? 1 : -1; }, {0.0266, 0.0099, 0.0056});
    CHECK(table.leastOrder("shape") > 1.9);
}

TEST_CASE("sphere turned by 60 degrees and back")
{
    const ErrorTable table = errors("Sphere turned by 60 degrees and back", rotationField(), disc({0.5, 0.7, 0.5}, 0.18, 3), 2*M_PI/3,
        [](double t) { return t < M_PI/3 ? 1 : -1; }, {0.0398, 0.0123, 0.0069});
    CHECK(table.leastOrder("shape") > 1.9);
}

TEST_CASE("sphere in a deformation field that is reversed")
{
    const ErrorTable table = errors("Reversed deformation in 3D, T = 1.5", deformationField(), disc({0.35, 0.35, 0.35}, 0.15, 3), 1.5,
        [](double t) { return std::cos(M_PI*t/1.5); }, {0.357, 0.189, 0.110});
    CHECK(table.leastOrder("shape") > 1.5); // half-way the sphere is a sheet of a cell: 1.57, then 1.88
}
