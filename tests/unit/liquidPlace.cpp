// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the liquid of a start is, and which starts look as if gravity had the wrong sign. On 1 and 2 ranks.
#include "equations/liquidPlace.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace flotsam;

namespace
{

constexpr double g = 9.81;
using Region = std::function<bool(double x, double y)>;

/// 2 m x 1 m, 0.5 m thick, elements of 0.1 m, alpha 1 at the nodes of the region.
struct Basin
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {20, 10, 1}, {0, 0, 0}, {2, 1, 0.5});
    Halo halo{mesh, MPI_COMM_WORLD};
    FlowState state;

    explicit Basin(const Region& isLiquid, double speed = 0)
    {
        state.u.assign(2*std::size_t(mesh.nNodes), 0.0);
        state.alpha.assign(mesh.nNodes, 0.0);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            state.alpha[i] = isLiquid(mesh.x[2*i], mesh.x[2*i + 1]);
            state.u[2*i + 1] = state.alpha[i]*speed;
        }
    }
    LiquidPlace place(const std::array<double, 3>& gravity) const { return liquidPlace(mesh, halo, state, gravity); }
    bool hangs(const std::array<double, 3>& gravity) const { return hangsFromTop(place(gravity), g); }
};

const std::array<double, 3> down{0, -g, 0}, up{0, g, 0};
const double e = 1e-9;

bool inPool(double, double y) { return y < 0.4 + e; }
bool inColumn(double x, double y) { return x < 0.5 + e && y < 0.6 + e; }

} // namespace

TEST_CASE("volumes and heights of a pool, along whatever direction gravity has")
{
    const Basin pool(inPool);
    const LiquidPlace place = pool.place(down);     // alpha is linear from 1 at 0.4 to 0 at 0.5 m
    CHECK(place.liquid == near(2*0.45*0.5, 1e-13));
    CHECK(place.gas == near(2*0.55*0.5, 1e-13));
    CHECK(place.lowest == within(0, 1e-15));
    CHECK(place.highest == near(0.45, 1e-13));      // where alpha is 1/2
    CHECK(place.bottom == within(0, 1e-15));
    CHECK(place.top == near(1, 1e-13));
    CHECK(place.meanLiquid < 0.25);
    CHECK(place.fastest == 0);
    const LiquidPlace turned = pool.place({-3*g, 0, 0});
    CHECK(turned.top == near(2, 1e-13));
    CHECK(turned.highest == near(2, 1e-13));
    CHECK(turned.meanLiquid == near(1, 0.01));   // the last half element of liquid depends on the diagonals
    const LiquidPlace reversed = pool.place(up);
    CHECK(reversed.lowest == near(-0.45, 1e-13));
    CHECK(reversed.highest == within(0, 1e-15));
    const LiquidPlace nearlyUpright = pool.place({1e-15*g, -g, 0});
    CHECK(nearlyUpright.lowest == 0);   // not -2e-15
    CHECK(nearlyUpright.bottom == 0);
    CHECK(Basin([](double, double) { return false; }).place(down).liquid == 0);
}

TEST_CASE("a start field's volume is that of its cells, not that of the alpha which its surface gives the nodes")
{
    Basin pool(inPool);
    pool.state.startLiquid.volume.assign(pool.mesh.nNodes, 0.0);
    double wet = 0;
    for (int i = 0; i < pool.mesh.nOwned; ++i) wet += pool.state.alpha[i];
    const double share = 0.8/pool.halo.sum(wet);
    for (int i = 0; i < pool.mesh.nOwned; ++i) pool.state.startLiquid.volume[i] = share*pool.state.alpha[i];
    const LiquidPlace place = pool.place(down);
    CHECK(place.liquid == near(0.8*0.5, 1e-13));
    CHECK(place.gas == near(1.2*0.5, 1e-13));
    CHECK(place.highest == near(0.45, 1e-13));
}

TEST_CASE("basins and columns hang from the top when gravity is reversed, not when it is right or turned")
{
    for (const Region& region : {Region(inPool), Region(inColumn)})
    {
        const Basin basin(region);
        CHECK(basin.hangs(up));
        CHECK_FALSE(basin.hangs(down));
        CHECK_FALSE(basin.hangs({-g, 0, 0}));
        CHECK_FALSE(basin.hangs({0.17*g, -0.98*g, 0}));
    }
    CHECK(Basin(inPool).hangs({0.17*g, 0.98*g, 0}));    // a steep flume
    CHECK(Basin(inColumn).hangs({g, 0, 0}));            // from the wall that it stands at
    CHECK_FALSE(Basin(inPool).hangs({g, 0, 0}));
}

TEST_CASE("what is there to fall does not look like reversed gravity")
{
    const auto drop = [](double x, double y) { return std::hypot(x - 1, y - 0.8) < 0.15; };
    CHECK_FALSE(Basin(drop).hangs(down));
    CHECK_FALSE(Basin([&](double x, double y) { return drop(x, y) || y < 0.2 + e; }).hangs(down));          // on a pool
    CHECK_FALSE(Basin([](double x, double y) { return x < 0.3 && y > 0.5 - e; }, -2).hangs(down));          // a jet that comes in from above
    CHECK_FALSE(Basin([](double x, double) { return x < 0.3; }).hangs(down));                               // a column up to the top
    CHECK_FALSE(Basin([](double, double) { return true; }).hangs(down));                                    // no gas
}
