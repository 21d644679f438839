// SPDX-License-Identifier: GPL-3.0-or-later
/// Order in time with an exact solution that oscillates, on a mesh so fine that its error does not hide the order: BDF1 1, BDF2 2, the
/// first step being BDF1 in both. Time step and mesh refined together keep the order although tau contains the time step.
#include "support/cutFlows.hpp"
#include "support/errorTable.hpp"
#include "support/flowCases.hpp"
#include "support/manufactured.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double endTime = 0.8, frequency = 2*M_PI; // [s], [rad/s]

/// A steady flow made to oscillate: u(x) sin(wt + 0.5), p(x) cos(wt).
ExactFlow oscillating(const ExactFlow& steady)
{
    ExactFlow exact;
    exact.velocity = [steady](const double* x, double t, double* u)
    {
        u[2] = 0;
        steady.velocity(x, 0, u);
        for (int d = 0; d < 3; ++d) u[d] *= std::sin(frequency*t + 0.5);
    };
    exact.pressure = [steady](const double* x, double t) { return steady.pressure(x, 0)*std::cos(frequency*t); };
    return exact;
}

/// Velocity and pressure linear in space, which P1 holds exactly: all that is left of the mesh's error is the force, constant in each element.
ExactFlow turning()
{
    ExactFlow exact;
    exact.velocity = [](const double* x, double, double* u)
    {
        u[0] = 1.5*x[2] - 1.2*x[1] + 0.4*x[0];
        u[1] = 1.4*x[0] - 0.9*x[2] + 0.3*x[1];
        u[2] = 1.1*x[1] - 1.3*x[0] - 0.7*x[2];
    };
    exact.pressure = [](const double* x, double) { return 2*x[0] - x[1] + 1.5*x[2]; };
    return exact;
}

/// Adds the L2 errors of velocity and pressure, rms over the second half of the run.
void addErrors(ErrorTable& table, double size, int timeOrder, int dim, int n, double dt, bool isCut)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties fluid;
    fluid.rhoLiquid = 1;
    fluid.muLiquid = 0.01;
    NumericsControls controls;
    controls.timeOrder = timeOrder;
    controls.tolerance = 1e-7;
    controls.restart = 100; // Courant numbers up to 13
    controls.maxIterations = 500;
    FlowAroundBody body;
    body.centre = Vec3(0.51, 0.49, 0);
    ForcedFlow flow(mesh, halo, fluid, controls, oscillating(isCut ? body.flow() : dim == 2 ? waves(2) : turning()));
    const std::vector<Solid> solids = body.solids();
    CoverBuilder builder(mesh, flow.graph(), halo);
    if (isCut) flow.setGeometry(builder.build(solids), solids);
    const int steps = int(std::lround(endTime/dt));
    double velocity = 0, pressure = 0;
    for (int k = 1; k <= steps; ++k)
    {
        REQUIRE(flow.step(dt).hasConverged);
        if (2*k <= steps) continue;
        const FlowErrors e = flow.errors();
        velocity += e.velocity*e.velocity;
        pressure += e.pressure*e.pressure;
    }
    table.add(size, {{"u L2", std::sqrt(velocity/(steps - steps/2))}, {"p L2", std::sqrt(pressure/(steps - steps/2))}});
}

ErrorTable timeSteps(const char* title, int timeOrder, int dim, int n, const std::vector<double>& steps)
{
    ErrorTable table(title, "dt [s]");
    for (double dt : steps) addErrors(table, dt, timeOrder, dim, n, dt, false);
    table.print();
    return table;
}

ErrorTable together(const char* title, int timeOrder)
{
    ErrorTable table(title, "dt [s] = 1.6 h");
    for (int n : {16, 32, 64}) addErrors(table, 1.6/n, timeOrder, 2, n, 1.6/n, true);
    table.print();
    return table;
}

/// Of velocity and pressure, between the last two steps and between any two neighbours: the longest steps are not yet small.
void checkOrders(const ErrorTable& table, double last, double least)
{
    for (const char* error : {"u L2", "p L2"})
    {
        CHECK(table.lastOrder(error) > last);
        CHECK(table.leastOrder(error) > least);
    }
}

} // namespace

TEST_CASE("BDF1, fixed mesh") { checkOrders(timeSteps("BDF1, n = 32", 1, 2, 32, {0.025, 0.0125, 0.00625}), 0.9, 0.88); }
TEST_CASE("BDF2, fixed mesh") { checkOrders(timeSteps("BDF2, n = 64", 2, 2, 64, {0.08, 0.04, 0.02}), 1.85, 1.72); }
TEST_CASE("BDF1, fixed mesh, 3D") { checkOrders(timeSteps("BDF1, 3D, n = 8", 1, 3, 8, {0.05, 0.025, 0.0125}), 0.95, 0.88); }
TEST_CASE("BDF2, fixed mesh, 3D") { checkOrders(timeSteps("BDF2, 3D, n = 14", 2, 3, 14, {0.08, 0.04, 0.02}), 1.85, 1.7); }
TEST_CASE("BDF1, mesh and time step together, cut disc") { checkOrders(together("BDF1, cut disc", 1), 0.9, 0.84); }
TEST_CASE("BDF2, mesh and time step together, cut disc") { checkOrders(together("BDF2, cut disc", 2), 1.85, 1.65); }
