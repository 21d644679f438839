// SPDX-License-Identifier: GPL-3.0-or-later
/// The orders of `manufactured` with walls that cut the mesh: flow around a disc, annular Couette flow with the torque.
#include "support/cutFlows.hpp"
#include "support/errorTable.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

NumericsControls steadyControls()
{
    NumericsControls controls;
    controls.timeOrder = 1;
    controls.tolerance = 1e-8;
    controls.restart = 200;
    controls.maxIterations = 2000;
    return controls;
}

ErrorTable couette(const char* title, double rho, double mu, const std::vector<int>& sizes)
{
    usePetsc();
    ErrorTable table(title);
    for (int n : sizes)
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {n, n, 1}, {0, 0, 0}, {1, 1, 1}, 0.12);
        const Halo halo(mesh, MPI_COMM_WORLD);
        AnnularCouette annulus;
        annulus.centre = Vec3(0.507, 0.489, 0);
        ForcedFlow flow(mesh, halo, oneFluid(rho, mu), steadyControls(), annulus.flow(rho));
        const std::vector<Solid> solids = annulus.solids();
        CoverBuilder builder(mesh, flow.graph(), halo);
        flow.setGeometry(builder.build(solids), solids);
        CHECK(flow.toSteadyState(1e3, 1e-6, 40) < 40);
        const FlowErrors e = flow.errors();
        const double torque = annulus.torque(mu), outer = flow.load(0)[2], inner = flow.load(1)[2];
        table.add(1.0/n, {{"u L2", e.velocity}, {"u H1", e.gradient}, {"p L2", e.pressure},
            {"torque inner", std::abs(inner/torque + 1)}, {"torque outer", std::abs(outer/torque - 1)}});
    }
    table.print();
    return table;
}

void checkOrders(const ErrorTable& table)
{
    CHECK(table.shownOrder("u L2") > 1.9);
    CHECK(table.shownOrder("u H1") > 0.95);
    CHECK(table.shownOrder("p L2") > 1.5);
}

/// The torque by its size: its errors of both signs (stiff P1 layer, slip at the wall) nearly cancel, so that no order is seen between two meshes.
void checkCouette(const ErrorTable& table, double gradientOrder)
{
    CHECK(table.fittedOrder("u L2") > 1.95);
    CHECK(table.shownOrder("u H1") > gradientOrder);
    CHECK(table.shownOrder("p L2") > 1.5);
    for (const char* torque : {"torque inner", "torque outer"})
    {
        CHECK(table.value(torque, 0) < 0.02);
        CHECK(table.value(torque, 2) < 0.002);
    }
}

} // namespace

TEST_CASE("Stokes around a disc") { checkOrders(errorsAroundBody(2, "Stokes, disc", 1e-3, 1, {16, 32, 64})); }
/// Meshes on which viscosity rules tau more and more: between its branches the velocity's order is 1.88.
TEST_CASE("Navier-Stokes around a disc")
{
    const ErrorTable table = errorsAroundBody(2, "Navier-Stokes, disc, mu 0.01", 1, 1e-2, {24, 48, 96});
    checkOrders(table);
    CHECK(table.value("u L2", 1) < 2.76e-3); // with one branch, of order 1.91 from 24 cells to these 48
}
/// Errors of the velocity three quarters, of the pressure six tenths of those without.
TEST_CASE("Viscous residual around a disc")
{
    const ErrorTable stokes = errorsAroundBody(2, "Stokes, disc, viscous residual", 1e-3, 1, {16, 32, 64}, true);
    checkOrders(stokes);
    CHECK(stokes.value("p L2", 2) < 0.035);
    const ErrorTable inertial = errorsAroundBody(2, "Navier-Stokes, disc, mu 0.01, viscous residual", 1, 1e-2, {24, 48, 96}, true);
    checkOrders(inertial);
    CHECK(inertial.value("u L2", 2) < 5e-4);
}
/// The coarse meshes' gradients, 0.89 from 16 to 32 cells, keep the fit below 0.95.
TEST_CASE("Couette flow between cut cylinders, Stokes")
{
    const ErrorTable table = couette("Annular Couette, Stokes", 1e-3, 1, {16, 32, 64, 96});
    checkCouette(table, 0.92);
    CHECK(table.lastOrder("u H1") > 0.95);
}
TEST_CASE("Couette flow between cut cylinders, Reynolds number 40")
{
    // order 0.949; 0.960 with all of the ghost penalties on every cut, but there the errors are larger on both meshes
    const ErrorTable table = couette("Annular Couette, mu 0.01", 1, 1e-2, {12, 24, 48});
    checkCouette(table, 0.94);
    CHECK(table.value("u H1", 1) < 0.3145); // 0.3168 with them
    CHECK(table.value("u H1", 2) < 0.1628); // 0.1629
}

// Not reached: 1.80. The non-symmetric Nitsche form is not adjoint-consistent; nitscheGamma 100 gives 2.0 with larger errors.
TEST_CASE("Couette flow between cut cylinders, velocity of order 2" * doctest::skip())
{
    CHECK(couette("Annular Couette, Stokes", 1e-3, 1, {16, 32, 64, 96}).lastOrder("u L2") > 1.9);
}
TEST_CASE("Navier-Stokes around a disc, mu 1e-4" * doctest::skip()) // takes minutes
{
    checkOrders(errorsAroundBody(2, "Navier-Stokes, disc, mu 1e-4", 1, 1e-4, {12, 24, 48}));
}
