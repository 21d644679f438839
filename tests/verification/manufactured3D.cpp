// SPDX-License-Identifier: GPL-3.0-or-later
/// Steady manufactured solutions on tetrahedra, uncut: velocity of order 2 in L2 and 1 in H1, pressure of order 1.5 or better in L2.
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

TEST_CASE("Stokes") { checkOrders(steadyErrors(3, "Stokes 3D", waves(3), 1e-3, 1, {4, 8, 16}, moved)); }
TEST_CASE("Navier-Stokes, mu 0.01, velocity without viscous force")
{
    checkOrders(steadyErrors(3, "Navier-Stokes 3D, mu 0.01, laplace u = 0", potentialFlow(3), 1, 1e-2, {5, 10, 20}, moved));
}

/// Without the viscous force in the residual 1.89 from 16 to 28 cells: an error of first order times the viscosity.
TEST_CASE("Navier-Stokes, mu 0.01") { checkOrders(steadyErrors(3, "Navier-Stokes 3D, mu 0.01", waves(3), 1, 1e-2, {8, 16, 28}, moved)); }
