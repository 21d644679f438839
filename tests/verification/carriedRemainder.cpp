// SPDX-License-Identifier: GPL-3.0-or-later
/// What linear solves leave: with `carryRemainder` the next step makes up for it, so that it does not add up over a run, and a wave that is solved loosely moves as one
/// that is solved exactly.
#include "equations/fluid.hpp"
#include "algebra/flowOperator.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr double dt = 0.01; // [s]; the wave's period is 1.2 s
constexpr int nSteps = 120;

/// Of all rows, momentum or continuity.
struct Norms { double momentum = 0, volume = 0; };

struct Run
{
    FlowState state;
    std::vector<double> leftSum;        ///< per row: impulse and volume that the steps' equations lack, without what was carried into them, summed over the steps
    Norms sum, largestStep;             ///< norms: of leftSum, of the most that a single step left
};

Norms norms(const std::vector<double>& rows, int dim, const Halo& halo)
{
    double squares[2] = {};
    for (std::size_t k = 0; k < rows.size(); ++k) squares[int(k % (dim + 1)) == dim] += rows[k]*rows[k];
    halo.sum(squares, 2);
    return {std::sqrt(squares[0]), std::sqrt(squares[1])};
}

struct Tank
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {20, 20, 1}, {0, 0, 0}, {1, 1, 1}, 0.1);
    Halo halo{mesh, MPI_COMM_WORLD};
    FluidProperties properties;

    Tank() { properties.gravity[1] = -9.81; }

    FlowState start() const
    {
        FlowState state = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i) state.alpha[i] = mesh.x[2*std::size_t(i) + 1] < 0.5 + 0.06*std::cos(M_PI*mesh.x[2*std::size_t(i)]);
        return state;
    }

    /// What the last solve lacks of its rows, as FlowLinearSolver has them: with what was carried into it.
    std::vector<double> residual(const Fluid& fluid) const
    {
        const FlowSystem& system = fluid.equation().system();
        const FlowState& s = fluid.state();
        std::vector<double> x(std::size_t(mesh.nNodes)*3), rows(std::size_t(mesh.nOwned)*3);
        for (std::size_t i = 0; i < std::size_t(mesh.nNodes); ++i)
        {
            x[3*i] = s.u[2*i];
            x[3*i + 1] = s.u[2*i + 1];
            x[3*i + 2] = s.p[i];
        }
        const FlowOperator op(fluid.graph(), halo, system, mesh.nOwned);
        op.fluidRows(x.data(), nullptr, rows.data());
        for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = system.rhs[k] - rows[k];
        op.project(rows.data());
        return rows;
    }

    Run run(const NumericsControls& controls) const
    {
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
        fluid.start(start(), true);
        Run result;
        result.leftSum.assign(std::size_t(mesh.nOwned)*3, 0.0);
        for (int n = 0; n < nSteps; ++n)
        {
            const std::vector<double> before = fluid.state().remainder;
            fluid.beginStep(dt);
            fluid.assemble();
            REQUIRE(fluid.solve({}).hasConverged);
            fluid.endStep();
            std::vector<double> left = residual(fluid);
            const Norms ofStep = norms(left, 2, halo);
            for (std::size_t k = 0; k < left.size(); ++k) result.leftSum[k] += dt*(left[k] - (before.empty() ? 0 : before[k]));
            result.largestStep.momentum = std::max(result.largestStep.momentum, ofStep.momentum*dt);
            result.largestStep.volume = std::max(result.largestStep.volume, ofStep.volume*dt);
        }
        result.sum = norms(result.leftSum, 2, halo);
        result.state = fluid.state();
        return result;
    }

    /// rms over the water of the difference of two runs' velocities.
    double difference(const Run& a, const Run& b) const
    {
        double sums[2] = {};
        for (std::size_t i = 0; i < std::size_t(mesh.nOwned); ++i)
        {
            if (b.state.alpha[i] < 0.99) continue;
            sums[0] += 1;
            sums[1] += std::pow(a.state.u[2*i] - b.state.u[2*i], 2) + std::pow(a.state.u[2*i + 1] - b.state.u[2*i + 1], 2);
        }
        halo.sum(sums, 2);
        return std::sqrt(sums[1]/sums[0]);
    }
};

} // namespace

TEST_CASE("what solves leave does not add up, and a wave that is solved loosely moves as one that is solved exactly")
{
    usePetsc();
    const Tank tank;
    NumericsControls controls;
    controls.tolerance = 1e-3;
    const Run carried = tank.run(controls);
    controls.carryRemainder = false;
    const Run forgotten = tank.run(controls);
    controls.tolerance = 1e-8;
    const Run exact = tank.run(controls);
    for (const Run* r : {&carried, &forgotten, &exact})
        std::printf("left: impulse %.1e of at most %.1e a step, volume %.1e of %.1e; velocity off by %.1e m/s\n", r->sum.momentum, r->largestStep.momentum,
            r->sum.volume, r->largestStep.volume, tank.difference(*r, exact));

    CHECK(forgotten.state.remainder.empty());
    CHECK(forgotten.sum.momentum > 5*forgotten.largestStep.momentum);
    CHECK(carried.sum.momentum < 2*carried.largestStep.momentum);
    CHECK(carried.sum.volume < 0.5*forgotten.sum.volume);
    CHECK(tank.difference(carried, exact) < 0.4*tank.difference(forgotten, exact));
}
