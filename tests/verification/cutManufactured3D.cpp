// SPDX-License-Identifier: GPL-3.0-or-later
/// The orders of `manufactured3D` with a sphere that cuts the mesh.
#include "support/cutFlows.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

void checkOrders(const ErrorTable& table, double velocityOrder)
{
    CHECK(table.fittedOrder("u L2") > 1.9);
    CHECK(table.leastOrder("u L2") > velocityOrder);
    CHECK(table.leastOrder("u H1") > 0.95);
    CHECK(table.leastOrder("p L2") > 1.5);
}

} // namespace

TEST_CASE("Stokes") { checkOrders(errorsAroundBody(3, "Stokes, sphere", 1e-3, 1, {8, 16, 24}), 1.88); }
TEST_CASE("Navier-Stokes, mu 0.02") { checkOrders(errorsAroundBody(3, "Navier-Stokes, sphere, mu 0.02", 1, 0.02, {8, 12, 18}), 1.88); }
TEST_CASE("Navier-Stokes, mu 0.02, viscous residual")
{
    checkOrders(errorsAroundBody(3, "Navier-Stokes, sphere, mu 0.02, viscous residual", 1, 0.02, {6, 12, 18}, true), 1.9);
}
