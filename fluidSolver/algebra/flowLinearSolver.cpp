// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/flowLinearSolver.hpp"

#include "algebra/gmres.hpp"
#include "algebra/petscCalls.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double startReduction = 0.1; // of the residual by the first solve of a step
constexpr double negligible = 1e-3; // of the tolerance: a residual that needs no solve

} // namespace

struct FlowLinearSolver::Implementation
{
    const NumericsControls& controls;
    ScaledFlowSystem system;
    Gmres gmres;
    std::vector<double> residual;
    bool isFirstSolve = true;           // of the system
    bool isNewMatrix = true;            // of the system: FlowSystem::isNewMatrix

    Implementation(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& c)
    :   controls(c), system(mesh, graph, halo), gmres(system, halo, c.restart)
    {}
};

FlowLinearSolver::FlowLinearSolver(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls)
:   impl_(std::make_unique<Implementation>(mesh, graph, halo, controls))
{}

FlowLinearSolver::~FlowLinearSolver() = default;

void FlowLinearSolver::forgetPreconditioner()
{
    impl_->system.pressure().forget();
}

void FlowLinearSolver::setSystem(const FlowSystem& system)
{
    NoFloatingPointTraps guard;
    impl_->isFirstSolve = true;
    impl_->isNewMatrix = system.isNewMatrix;
    impl_->system.set(system);
    impl_->residual.resize(impl_->system.nEntries());
}

SolveReport FlowLinearSolver::solve(std::vector<double>& x, std::vector<double>& q)
{
    NoFloatingPointTraps guard;
    Implementation& me = *impl_;
    SolveReport report;
    report.rebuiltPreconditioner = me.isNewMatrix && me.system.pressure().isNew();
    const double norm = me.system.residual(x, q, me.residual.data()); // of the right-hand side
    const double first = me.gmres.norm(me.residual);
    if (!(norm < 1e300) || !(first < 1e300)) return report; // not a number: the caller repeats the step
    report.initial = report.final = norm > 0 ? first/norm : 0;
    // The first solve of a step also makes the residual of its start ten times smaller. An extrapolated start may meet the tolerance by itself (the gas
    // hardly counts in the norm), and taken as the solution step after step it grows: a gas jet of 12 m/s over a flume, without an iteration.
    const double wanted = me.controls.tolerance*norm;
    const double target = me.isFirstSolve ? std::max(std::min(wanted, startReduction*first), negligible*wanted) : wanted;
    const bool isFirst = me.isFirstSolve;
    me.isFirstSolve = false;
    if (first <= target || first == 0)
    {
        report.hasConverged = true;
        return report;
    }
    const Gmres::Result result = me.gmres.solve(x, q, me.residual, first, target, me.controls.maxIterations);
    report.iterations = result.iterations;
    report.final = norm > 0 ? result.residual/norm : 0;
    report.hasConverged = result.hasConverged;
    // a solve that only follows a new contact impulse starts near its end: it says nothing about the hierarchy's age
    if (isFirst && me.isNewMatrix) me.system.pressure().countIterations(report.iterations);
    return report;
}

} // namespace flotsam
