// SPDX-License-Identifier: GPL-3.0-or-later
/// The orders of `manufactured3D` with a sphere that cuts the mesh.
#include "support/cutFlows.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

void checkOrders(const ErrorTable& table)
{
    CHECK(table.fittedOrder("u L2") > 1.9);
    CHECK(table.leastOrder("u L2") > 1.9);
    CHECK(table.leastOrder("u H1") > 0.95);
    CHECK(table.leastOrder("p L2") > 1.5);
}

} // namespace

TEST_CASE("Stokes") { checkOrders(errorsAroundBody(3, "Stokes, sphere", 1e-3, 1, {8, 16, 24})); }
/// Without the viscous force in the residual the velocity's orders are 1.90, 1.89 and 1.88 with mu 0.02, 0.03 and 0.1.
TEST_CASE("Navier-Stokes, mu 0.02") { checkOrders(errorsAroundBody(3, "Navier-Stokes, sphere, mu 0.02", 1, 0.02, {8, 12, 18})); }
TEST_CASE("Navier-Stokes, mu 0.1") { checkOrders(errorsAroundBody(3, "Navier-Stokes, sphere, mu 0.1", 1, 0.1, {6, 12, 24})); }
