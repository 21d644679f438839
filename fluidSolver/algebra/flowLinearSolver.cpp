// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/flowLinearSolver.hpp"

#include "algebra/petscCalls.hpp"
#include "algebra/scaledFlowSystem.hpp"

#include <petscksp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

constexpr double startReduction = 0.02; // of the residual by a solve that starts from values extrapolated in time
constexpr double repeatReduction = 0.1; // by one that follows a change of the contact load
constexpr int patience = 30;            // iterations: more say that an old hierarchy, or diagonal blocks of a viscous fluid, are not good enough
constexpr double negligible = 3e-4; // of the tolerance: a residual that needs no solve

/// Iterations of a trial, which led from `first` to `last`, had it gone on down to `wanted` at this rate; at most `most`.
int iterationsTo(double wanted, int iterations, double first, double last, int most)
{
    if (last <= wanted || last >= first) return iterations;
    return int(std::clamp(iterations*std::log(first/wanted)/std::log(first/last), double(iterations), double(std::max(iterations, most))));
}

/// Arrays of two vectors for the time of a product.
class Arrays
{
public:
    Arrays(Vec in, Vec out) : in_(in), out_(out)
    {
        VecGetArrayRead(in_, &x);
        VecGetArray(out_, &y);
    }
    ~Arrays()
    {
        VecRestoreArrayRead(in_, &x);
        VecRestoreArray(out_, &y);
    }
    const PetscScalar* x;
    PetscScalar* y;
private:
    Vec in_, out_;
};

PetscErrorCode applyMatrix(Mat m, Vec in, Vec out)
{
    void* system;
    MatShellGetContext(m, &system);
    const Arrays a(in, out);
    static_cast<ScaledFlowSystem*>(system)->multiply(a.x, a.y);
    return 0;
}

PetscErrorCode applyPreconditioner(PC pc, Vec in, Vec out)
{
    void* system;
    PCShellGetContext(pc, &system);
    const Arrays a(in, out);
    static_cast<ScaledFlowSystem*>(system)->precondition(a.x, a.y);
    return 0;
}

/// Both at once: the preconditioner's last product is a part of the matrix's.
PetscErrorCode applyPreconditionedMatrix(PC pc, PCSide, Vec in, Vec out, Vec)
{
    void* system;
    PCShellGetContext(pc, &system);
    const Arrays a(in, out);
    static_cast<ScaledFlowSystem*>(system)->multiplyPreconditioned(a.x, a.y);
    return 0;
}

} // namespace

struct FlowLinearSolver::Implementation
{
    const Halo& halo;
    const NumericsControls& controls;
    ScaledFlowSystem system;
    Mat matrix = nullptr;
    KSP krylov = nullptr;
    Vec rhs = nullptr, solution = nullptr;
    int nVector = -1;
    bool isNewMatrix = true, isFirst = false;   // of the system: FlowSystem::isNewMatrix, isFirst
    double unfinished = std::numeric_limits<double>::infinity();    // residual that a trial with this matrix should have reached: what the solves after it must

    Implementation(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& h, const NumericsControls& c)
    :   halo(h), controls(c), system(mesh, graph, h, patience)
    {}

    ~Implementation() { destroyKrylov(); }

    void destroyKrylov()
    {
        KSPDestroy(&krylov);
        MatDestroy(&matrix);
        VecDestroy(&rhs);
        VecDestroy(&solution);
    }

    void createKrylov()
    {
        const int n = system.nEntries();
        if (!halo.any(!krylov || n != nVector)) return;
        destroyKrylov();
        nVector = n;
        check(MatCreateShell(halo.comm(), n, n, PETSC_DETERMINE, PETSC_DETERMINE, &system, &matrix));
        check(MatShellSetOperation(matrix, MATOP_MULT, (void (*)(void)) applyMatrix));
        check(MatCreateVecs(matrix, &solution, &rhs));
        check(KSPCreate(halo.comm(), &krylov));
        check(KSPSetOptionsPrefix(krylov, "flow_"));
        check(KSPSetOperators(krylov, matrix, matrix));
        check(KSPSetType(krylov, KSPGMRES));
        check(KSPGMRESSetRestart(krylov, controls.restart));
        check(KSPGMRESSetCGSRefinementType(krylov, KSP_GMRES_CGS_REFINE_IFNEEDED));
        PC pc;
        check(KSPGetPC(krylov, &pc));
        check(PCSetType(pc, PCSHELL));
        check(PCShellSetContext(pc, &system));
        check(PCShellSetApply(pc, applyPreconditioner));
        check(PCShellSetApplyBA(pc, applyPreconditionedMatrix));
        check(KSPSetFromOptions(krylov));
        check(KSPSetPCSide(krylov, PC_RIGHT)); // after the options: applyPreconditionedMatrix() knows no other
    }

    /// Residual into rhs; its norm and that of the right-hand side.
    void setResidual(const std::vector<double>& x, const std::vector<double>& q, double& first, double& norm)
    {
        PetscScalar* r;
        check(VecGetArray(rhs, &r));
        norm = system.residual(x, q, r);
        check(VecRestoreArray(rhs, &r));
        check(VecNorm(rhs, NORM_2, &first));
    }

    /// The residual to stop at, given that of the start (in rhs, norm `first`) and the norm of the right-hand side.
    double target(const std::vector<double>& x, double first, double norm)
    {
        double wanted = controls.tolerance*norm;
        const double smallest = std::max(negligible*wanted, system.roundOff());
        // The first solve makes the whole pressure. What it leaves of that goes into vortices, which are solutions of the later steps: these do not take them back
        if (isFirst) return smallest;
        // The right-hand side is mostly inertia over the time step, 150 times the forces in a vortex street: whoever looks at a solid or at forces on patches wants these
        if (system.areForcesAsked())
        {
            const PetscScalar* r;
            check(VecGetArrayRead(rhs, &r));
            wanted = std::min(wanted, controls.forceTolerance*system.forceNorm(x, r));
            check(VecRestoreArrayRead(rhs, &r));
        }
        // An extrapolated start may meet the tolerance by itself (the gas hardly counts in the norm), and taken as the solution step after step it
        // grows: a gas jet of 12 m/s over a flume, without an iteration. What is left of smooth pressures is small in the continuity rows and, a step later, large in the
        // momentum rows, by up to the elements in a wave: a solve must gain more than that loses
        return std::max(std::min(wanted, (isNewMatrix ? startReduction : repeatReduction)*first), smallest);
    }

    /// Iterations that the present preconditioner gets after those of earlier attempts. Bodies that shift in a jam can make an old hierarchy fail all at once.
    int iterationsOfAttempt(int before)
    {
        int most = controls.maxIterations;
        if (!system.pressure().isNew()) most = std::min(most, patience);
        const int limit = system.choice().limit();
        return limit > 0 ? std::min(most, std::max(limit - before, 1)) : most;
    }

    /// What a solve has not converged with after `iterations` gives way to what is better; false: there is nothing better. Collective.
    bool improvePreconditioner(int iterations)
    {
        const int limit = system.choice().limit();
        const bool isTooSlow = limit > 0 && iterations >= limit;
        if (system.pressure().isNew() && !isTooSlow) return false;
        if (isTooSlow) system.choice().giveUpDiagonal();
        system.renewHierarchies();
        return true;
    }

    /// Iterations of a solve: earlier attempts, last one.
    void count(int before, int last)
    {
        // a solve that only follows a new contact impulse starts near its end: it says nothing about preconditioners
        if (isNewMatrix || before > 0) system.pressure().countIterations(last);
        if (isNewMatrix && before == 0) system.choice().count(last);
    }

    /// GMRES on the residual in rhs, down to `target`; adds what it finds to x and q. norm: of the right-hand side.
    SolveReport iterate(std::vector<double>& x, std::vector<double>& q, double target, double norm, int maxIterations)
    {
        check(KSPSetTolerances(krylov, 1e-14, target, 1e10, maxIterations));
        check(VecSet(solution, 0));
        check(KSPSolve(krylov, rhs, solution));
        PetscInt iterations;
        PetscReal final;
        KSPConvergedReason reason;
        check(KSPGetIterationNumber(krylov, &iterations));
        check(KSPGetResidualNorm(krylov, &final));
        check(KSPGetConvergedReason(krylov, &reason));
        const PetscScalar* d;
        check(VecGetArrayRead(solution, &d));
        system.addTo(x, q, d);
        check(VecRestoreArrayRead(solution, &d));
        SolveReport report;
        report.iterations = int(iterations);
        report.final = norm > 0 ? final/norm : 0;
        report.hasConverged = reason > 0;
        return report;
    }
};

FlowLinearSolver::FlowLinearSolver(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls)
:   impl_(std::make_unique<Implementation>(mesh, graph, halo, controls))
{}

FlowLinearSolver::~FlowLinearSolver() = default;

void FlowLinearSolver::forgetPreconditioner()
{
    impl_->system.pressure().forget();
    impl_->system.choice().forget();
}

void FlowLinearSolver::remainder(const std::vector<double>& x, const std::vector<double>& q, std::vector<double>& rows)
{
    impl_->system.remainder(x, q, rows);
}

void FlowLinearSolver::setSystem(const FlowSystem& system)
{
    NoFloatingPointTraps guard;
    impl_->isNewMatrix = system.isNewMatrix;
    impl_->isFirst = system.isFirst;
    if (system.isNewMatrix) impl_->system.chooseVelocities(system);
    // the set-up of a hierarchy and the vectors of a solve, which hard solves have made many, need not be there at once
    if (system.isNewMatrix && impl_->system.pressure().isWorn()) impl_->destroyKrylov();
    impl_->system.set(system);
    impl_->createKrylov();
}

SolveReport FlowLinearSolver::solve(std::vector<double>& x, std::vector<double>& q, double enough)
{
    NoFloatingPointTraps guard;
    Implementation& me = *impl_;
    SolveReport report;
    report.rebuiltPreconditioner = me.isNewMatrix && me.system.pressure().isNew();
    double first = 0, norm = 0;
    me.setResidual(x, q, first, norm);
    const double unbalanced = report.unbalancedVolume = me.system.unbalancedVolume();
    const bool isNumber = norm < 1e300 && first < 1e300; // otherwise the caller repeats the step
    report.initial = report.final = !isNumber ? std::numeric_limits<double>::infinity() : norm > 0 ? first/norm : 0;
    if (!isNumber) return report;
    if (me.isNewMatrix) me.unfinished = std::numeric_limits<double>::infinity();
    const double wanted = std::min(me.target(x, first, norm), me.unfinished), target = std::max(wanted, enough*norm);
    if (target > wanted) me.unfinished = wanted;
    if (first <= target || first == 0)
    {
        report.hasConverged = true;
        return report;
    }
    report = me.iterate(x, q, target, norm, me.iterationsOfAttempt(0));
    report.initial = norm > 0 ? first/norm : 0;
    int before = 0;     // iterations of earlier attempts
    while (!report.hasConverged && me.improvePreconditioner(before + report.iterations))
    {
        me.setResidual(x, q, first, norm);
        before += report.iterations;
        const double initial = report.initial;
        report = me.iterate(x, q, target, norm, me.iterationsOfAttempt(before));
        report.initial = initial;
    }
    const bool isTrial = target > wanted && report.hasConverged;
    me.count(before, isTrial ? iterationsTo(wanted, report.iterations, first, report.final*norm, me.controls.maxIterations) : report.iterations);
    report.iterations += before;
    report.rebuiltPreconditioner = me.isNewMatrix && me.system.pressure().isNew();
    report.unbalancedVolume = unbalanced;
    return report;
}

} // namespace flotsam
