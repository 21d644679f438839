// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

TEST_CASE("Zalesak's slotted disc after one turn: shape, volume and bounds")
{
    const struct { int n; double width, error; } cases[] = {{64, 0.25, 0.053}, {64, 0.35, 0.061}, {128, 0.35, 0.018}};
    for (const auto& c : cases)
    {
        TransportScene scene(MPI_COMM_WORLD, 2, c.n, c.width, rotationField());
        scene.fastest = 1;  // Courant number of the fluid, not of the corners of the square
        scene.fill(slottedDisc());
        const TransportResult r = runPeriod(scene, 2*M_PI, 0.5, [](double) { return 1; });
        INFO("n ", c.n, " width ", c.width);
        CHECK(r.error < c.error);
        CHECK(std::abs(r.massError) < 1e-12);
        CHECK(r.redistributed < 1e-12);     // nothing was lost that had to be put back
        CHECK(r.lowest > -1e-12);
        CHECK(r.highest < 1 + 1e-12);
    }
}
