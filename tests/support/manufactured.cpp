// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/manufactured.hpp"

#include "support/flowCases.hpp"

#include <cmath>

namespace flotsam
{

namespace
{

std::function<double(const double*, double)> wavePressure(int dim)
{
    return [dim](const double* x, double)
    {
        return std::sin(2*x[0])*std::cos(2.5*x[1]) + (dim == 3 ? std::sin(2*x[2] + 0.5) : 0);
    };
}

constexpr double longTimeStep = 1e3; // [s]: each step is an iteration towards the steady state
constexpr int maxIterations = 30;

} // namespace

ExactFlow waves(int dim)
{
    ExactFlow exact;
    exact.pressure = wavePressure(dim);
    if (dim == 2) // stream function sin(2x + 0.3) cos(1.7 y + 0.2) + 0.3 x y
        exact.velocity = [](const double* x, double, double* u)
        {
            u[0] = -1.7*std::sin(2*x[0] + 0.3)*std::sin(1.7*x[1] + 0.2) + 0.3*x[0];
            u[1] = -2*std::cos(2*x[0] + 0.3)*std::cos(1.7*x[1] + 0.2) - 0.3*x[1];
        };
    else
        exact.velocity = [](const double* x, double, double* u)
        {
            u[0] = std::sin(2*x[2]) + std::cos(1.6*x[1] + 0.1);
            u[1] = std::sin(1.8*x[0] + 0.2) + std::cos(2*x[2] - 0.3);
            u[2] = std::sin(1.6*x[1]) + std::cos(1.8*x[0]);
        };
    return exact;
}

ExactFlow potentialFlow(int dim)
{
    ExactFlow exact;
    exact.pressure = wavePressure(dim);
    if (dim == 2) // 0.3 grad(sin 2x sinh 2y)
        exact.velocity = [](const double* x, double, double* u)
        {
            u[0] = 0.6*std::cos(2*x[0])*std::sinh(2*x[1]);
            u[1] = 0.6*std::sin(2*x[0])*std::cosh(2*x[1]);
        };
    else // 0.4 grad(sin ax sin by sinh cz), c^2 = a^2 + b^2
        exact.velocity = [](const double* x, double, double* u)
        {
            const double a = 1.6, b = 1.2, c = 2;
            u[0] = 0.4*a*std::cos(a*x[0])*std::sin(b*x[1])*std::sinh(c*x[2]);
            u[1] = 0.4*b*std::sin(a*x[0])*std::cos(b*x[1])*std::sinh(c*x[2]);
            u[2] = 0.4*c*std::sin(a*x[0])*std::sin(b*x[1])*std::cosh(c*x[2]);
        };
    return exact;
}

ErrorTable steadyErrors(int dim, const char* title, const ExactFlow& exact, double rho, double mu, const std::vector<int>& sizes,
    double moved)
{
    usePetsc();
    ErrorTable table(title);
    for (int n : sizes)
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, moved);
        const Halo halo(mesh, MPI_COMM_WORLD);
        FluidProperties fluid;
        fluid.rhoLiquid = rho;
        fluid.muLiquid = mu;
        NumericsControls controls;
        controls.timeOrder = 1;
        controls.tolerance = 1e-8;
        controls.restart = 200;
        controls.maxIterations = 2000;
        ForcedFlow flow(mesh, halo, fluid, controls, exact);
        if (flow.toSteadyState(longTimeStep, 1e-6, maxIterations) == maxIterations) throw std::runtime_error("steadyErrors: not steady");
        const FlowErrors e = flow.errors();
        table.add(1.0/n, {{"u L2", e.velocity}, {"u H1", e.gradient}, {"p L2", e.pressure}});
    }
    table.print();
    return table;
}

} // namespace flotsam
