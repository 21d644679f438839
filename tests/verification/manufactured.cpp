// SPDX-License-Identifier: GPL-3.0-or-later
/// Steady manufactured solutions on triangles, uncut: velocity of order 2 in L2 and 1 in H1, pressure of order 1.5 or better in L2.
#include "support/manufactured.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double moved = 0.18; // largest displacement of a node over the cell

void checkOrders(const ErrorTable& table)
{
    CHECK(table.shownOrder("u L2") > 1.9);
    CHECK(table.shownOrder("u H1") > 0.95);
    CHECK(table.shownOrder("p L2") > 1.5);
}

} // namespace

TEST_CASE("Stokes, regular mesh") { checkOrders(steadyErrors(2, "Stokes 2D, regular", waves(2), 1e-3, 1, {12, 24, 48}, 0)); }
/// Without the viscous force in the residual the pressure's order is 1.39 on the last two meshes and the velocity's error 4.8e-4.
TEST_CASE("Stokes, moved nodes")
{
    const ErrorTable table = steadyErrors(2, "Stokes 2D, moved nodes", waves(2), 1e-3, 1, {12, 24, 48}, moved);
    checkOrders(table);
    CHECK(table.value("u L2", 2) < 3.5e-4);
}
/// Meshes on which viscosity rules tau more and more; without the viscous force in the residual the velocity's order is 1.83, then 1.91.
TEST_CASE("Navier-Stokes, mu 0.01")
{
    const ErrorTable table = steadyErrors(2, "Navier-Stokes 2D, mu 0.01, moved nodes", waves(2), 1, 1e-2, {40, 80, 160}, moved);
    checkOrders(table);
    CHECK(table.leastOrder("u L2") > 1.9);
    CHECK(table.value("u L2", 1) < 1.3e-4); // 1.6e-4 without
}
/// The coarsest mesh does not resolve the flow: 1.69 to the next, then 2.07 and on the next finer one 2.13.
TEST_CASE("Navier-Stokes, mu 1e-4")
{
    const ErrorTable table = steadyErrors(2, "Navier-Stokes 2D, mu 1e-4, moved nodes", waves(2), 1, 1e-4, {14, 28, 56}, moved);
    CHECK(table.shownOrder("p L2") > 1.5);
    CHECK(table.shownOrder("u H1") > 0.95);
    CHECK(table.lastOrder("u L2") > 1.9);
    CHECK(table.fittedOrder("u L2") > 1.85);
}
TEST_CASE("Navier-Stokes, mu 1e-4, resolved" * doctest::skip()) // takes two minutes
{
    checkOrders(steadyErrors(2, "Navier-Stokes 2D, mu 1e-4, moved nodes", waves(2), 1, 1e-4, {28, 56, 112}, moved));
}

// Not reached on meshes so fine: 1.55 from 32 to 64, 1.43 from 64 to 96. P1 pressure follows the O(h) velocity gradient of irregular triangles.
TEST_CASE("Stokes pressure of order 1.5 on moved nodes" * doctest::skip())
{
    CHECK(steadyErrors(2, "Stokes 2D, moved nodes", waves(2), 1e-3, 1, {16, 32, 64, 96}, moved).shownOrder("p L2") > 1.5);
}
