// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/errorTable.hpp"
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

TEST_CASE("Zalesak's slotted disc after one turn: shape, volume and bounds")
{
    const double bounds[] = {0.257, 0.0485, 0.0165};
    ErrorTable table("Zalesak's disc, one turn");
    for (int k = 0; k < 3; ++k)
    {
        const int n = 32 << k;
        TransportScene scene(MPI_COMM_WORLD, 2, n, defaultWidth, rotationField());
        scene.fastest = 1;  // Courant number of the fluid, not of the corners of the square
        scene.fill(slottedDisc());
        const TransportResult r = runPeriod(scene, 2*M_PI, 0.5, [](double) { return 1; });
        INFO("n ", n);
        CHECK(r.error < bounds[k]);
        CHECK(std::abs(r.massError) < 1e-12);
        CHECK(r.redistributed < 1e-12);     // nothing was lost that had to be put back
        CHECK(r.lowest > -1e-12);
        CHECK(r.highest < 1 + 1e-12);
        table.add(1.0/n, {{"shape", r.error}});
    }
    table.print();
    CHECK(table.leastOrder("shape") > 1.5);
}
