// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/flowLinearSolver.hpp"

#include <Eigen/Dense>
#include <petscksp.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <stdexcept>

namespace flotsam
{

namespace
{

void check(PetscErrorCode error)
{
    if (error) throw std::runtime_error("PETSc error " + std::to_string(int(error)) + " in the flow solver");
}

/// Switches floating point traps off while a library runs that divides 0 by 0 harmlessly.
class NoFloatingPointTraps
{
public:
    NoFloatingPointTraps() : enabled_(fegetexcept()) { fedisableexcept(FE_ALL_EXCEPT); }
    ~NoFloatingPointTraps() { std::feclearexcept(FE_ALL_EXCEPT); feenableexcept(enabled_); }
private:
    int enabled_;
};

constexpr int maxAge = 20;          // steps a pressure hierarchy is kept at most
constexpr double singularShift = 1e-7; // relative diagonal shift of the pressure matrix without a pressure level
constexpr double startReduction = 0.1; // of the residual by the first solve of a step
constexpr double negligible = 1e-3; // of the tolerance: a residual that needs no solve

} // namespace

struct FlowLinearSolver::Implementation
{
    const SimplexMesh& mesh;
    const NodeGraph& graph;
    const Halo& halo;
    const NumericsControls& controls;
    const int B;
    const FlowSystem* system = nullptr;

    std::vector<double> scale;          // nOwned*B: 1/sqrt(diagonal)
    std::vector<double> velocityInverse; // nOwned*dim*dim
    std::vector<double> viscousPressure; // nOwned: inverse of the viscous part of the Schur complement, lumped
    std::vector<int> freeSolid;         // solids whose velocity is unknown
    std::vector<Eigen::MatrixXd> solidInverse;
    std::vector<double> solidScale;     // free*nDof

    std::vector<double> local, localScalar, owned, owned2, ownedScalar, gradient; // work: nNodes*B, nNodes, nOwned*B, nOwned*B, nOwned
    std::vector<double> q, qRows, qWork; // per solid: nDof

    Mat matrix = nullptr, schur = nullptr;
    KSP krylov = nullptr;
    PC amg = nullptr;
    Vec rhs = nullptr, solution = nullptr, pressureIn = nullptr, pressureOut = nullptr;
    int nVector = -1;
    int age = -1, freshIterations = 0, lastIterations = 0;
    bool isFirstSolve = true;           // of the step
    double builtFor = 0; // typical Schur diagonal when the hierarchy was made

    Implementation(const SimplexMesh& m, const NodeGraph& g, const Halo& h, const NumericsControls& c)
    :   mesh(m), graph(g), halo(h), controls(c), B(m.dim + 1)
    {
        const std::size_t n = m.nOwned;
        scale.resize(n*B); owned.resize(n*B); owned2.resize(n*B); gradient.resize(n*B); ownedScalar.resize(n);
        local.resize(std::size_t(m.nNodes)*B); localScalar.resize(m.nNodes);
        velocityInverse.resize(n*m.dim*m.dim);
        viscousPressure.resize(n);
        check(VecCreateMPIWithArray(halo.comm(), 1, mesh.nOwned, PETSC_DETERMINE, nullptr, &pressureIn));
        check(VecCreateMPIWithArray(halo.comm(), 1, mesh.nOwned, PETSC_DETERMINE, nullptr, &pressureOut));
    }

    ~Implementation()
    {
        destroyKrylov();
        PCDestroy(&amg);
        MatDestroy(&schur);
        VecDestroy(&pressureIn);
        VecDestroy(&pressureOut);
    }

    void destroyKrylov()
    {
        KSPDestroy(&krylov);
        MatDestroy(&matrix);
        VecDestroy(&rhs);
        VecDestroy(&solution);
    }

    // ---- pressure matrix
    /// A new matrix each time: the pressure ghost terms reach beyond the graph, and their faces move with the solids.
    void createSchur()
    {
        const int n = mesh.nOwned;
        std::vector<PetscInt> diagonal(n, 0), offDiagonal(n, 0);
        auto count = [&](int row, int column) { ++(column < n ? diagonal : offDiagonal)[row]; };
        for (int i = 0; i < n; ++i)
            for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k) count(i, graph.column[k]);
        for (const GhostTerm& g : system->ghosts)
        {
            const int a = g.node[mesh.dim], b = g.node[mesh.dim + 1];
            if (a < n) count(a, b);
            if (b < n) count(b, a);
        }
        MatDestroy(&schur);
        check(MatCreateAIJ(halo.comm(), n, n, PETSC_DETERMINE, PETSC_DETERMINE, 0, diagonal.data(), 0, offDiagonal.data(), &schur));
    }

    bool isFreePressure(int i) const { return system->isActive[i] && !system->isPressureFixed[i]; }

    void addGhostsToSchur()
    {
        const int n = mesh.dim + 2;
        for (const GhostTerm& g : system->ghosts)
            for (int j = 0; j < n; ++j)
            {
                if (g.node[j] >= mesh.nOwned || !isFreePressure(g.node[j])) continue;
                const PetscInt row = mesh.globalNode[g.node[j]];
                for (int k = 0; k < n; ++k)
                {
                    if (!isFreePressure(g.node[k])) continue;
                    const PetscInt column = mesh.globalNode[g.node[k]];
                    const PetscScalar value = g.pressureFactor*g.jumpPressure[j]*g.jumpPressure[k];
                    check(MatSetValues(schur, 1, &row, 1, &column, &value, ADD_VALUES));
                }
            }
    }

    void fillSchur()
    {
        createSchur();
        const double shift = system->hasPressureLevel ? 1 : 1 + singularShift;
        std::vector<PetscInt> columns;
        std::vector<PetscScalar> values;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const PetscInt row = mesh.globalNode[i];
            columns.clear();
            values.clear();
            for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
            {
                const int j = graph.column[k];
                columns.push_back(mesh.globalNode[j]);
                if (i == j) values.push_back(isFreePressure(i) ? system->schur[k]*shift : schurDiagonal(i));
                else values.push_back(isFreePressure(i) && isFreePressure(j) ? system->schur[k] : 0);
            }
            check(MatSetValues(schur, 1, &row, PetscInt(columns.size()), columns.data(), values.data(), ADD_VALUES));
        }
        addGhostsToSchur();
        check(MatAssemblyBegin(schur, MAT_FINAL_ASSEMBLY));
        check(MatAssemblyEnd(schur, MAT_FINAL_ASSEMBLY));
    }

    double schurDiagonal(int i) const
    {
        const double d = system->schur[graph.diagonal[i]];
        return d > 0 ? d : 1;
    }

    void buildAmg()
    {
        fillSchur();
        if (!amg)
        {
            check(PCCreate(halo.comm(), &amg));
            check(PCSetType(amg, PCHYPRE));
            check(PCHYPRESetType(amg, "boomeramg"));
            check(PCSetOptionsPrefix(amg, "pressure_"));
            const char* options[][2] = {{"coarsen_type", "PMIS"}, {"interp_type", "ext+i"}, {"strong_threshold", "0.25"},
                {"agg_nl", "1"}, {"P_max", "4"}, {"relax_type_coarse", "symmetric-SOR/Jacobi"}};
            for (auto& o : options)
            {
                const std::string key = std::string("-pressure_pc_hypre_boomeramg_") + o[0];
                PetscBool isSet;
                check(PetscOptionsHasName(nullptr, nullptr, key.c_str(), &isSet));
                if (!isSet) check(PetscOptionsSetValue(nullptr, key.c_str(), o[1]));
            }
            check(PCSetFromOptions(amg));
        }
        check(PCSetOperators(amg, schur, schur));
        check(PCSetUp(amg));
        age = 0;
        freshIterations = 0;
    }

    double typicalSchur() const
    {
        double sum = 0;
        long n = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
            if (system->isActive[i]) { sum += std::log(schurDiagonal(i)); ++n; }
        sum = halo.sum(sum);
        n = halo.sum(n);
        return n ? std::exp(sum/n) : 1;
    }

    /// A hierarchy is kept while it serves: until it needs half as many iterations again as it did fresh.
    bool needsNewHierarchy(double typical) const
    {
        if (age < 0 || age >= maxAge) return true;
        if (std::abs(std::log(typical/builtFor)) > 0.3) return true;
        if (system->geometryChanged && age >= 4) return true;
        return freshIterations > 0 && lastIterations > 1.5*freshIterations + 2;
    }

    // ---- diagonal blocks
    void setDiagonals()
    {
        const int dim = mesh.dim;
        std::vector<double> ghost(std::size_t(mesh.nNodes), 0.0), ghostPressure(std::size_t(mesh.nNodes), 0.0);
        for (const GhostTerm& g : system->ghosts)
            for (int j = 0; j < dim + 2; ++j)
            {
                ghost[g.node[j]] += g.velocityFactor*g.jumpVelocity[j]*g.jumpVelocity[j];
                ghostPressure[g.node[j]] += g.pressureFactor*g.jumpPressure[j]*g.jumpPressure[j];
            }
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            double* inverse = &velocityInverse[std::size_t(i)*dim*dim];
            double* s = &scale[std::size_t(i)*B];
            if (!system->isActive[i])
            {
                std::fill(inverse, inverse + dim*dim, 0.0);
                std::fill(s, s + B, 1.0);
                viscousPressure[i] = 0;
                continue;
            }
            const double* a = &system->matrix.velocity[std::size_t(graph.diagonal[i])*dim*dim];
            double trace = 0;
            for (int r = 0; r < dim; ++r) trace += a[r*dim + r] + ghost[i];
            if (dim == 2) invert<2>(a, ghost[i], inverse); else invert<3>(a, ghost[i], inverse);
            std::fill(s, s + dim, 1/std::sqrt(trace/dim));
            // PSPG and ghost terms act beside the viscous part and bound its inverse where the fluid part is a sliver
            viscousPressure[i] = 1/(system->pressureMass[i] + system->matrix.pressure[graph.diagonal[i]] + ghostPressure[i]);
            s[dim] = 1/std::sqrt(schurDiagonal(i) + ghostPressure[i]);
        }
    }

    template<int D> void invert(const double* a, double ghost, double* inverse) const
    {
        Eigen::Matrix<double, D, D, Eigen::RowMajor> m;
        for (int r = 0; r < D; ++r)
            for (int c = 0; c < D; ++c) m(r, c) = a[r*D + c] + (r == c ? ghost : 0);
        Eigen::Map<Eigen::Matrix<double, D, D, Eigen::RowMajor>> result(inverse);
        result = m.inverse();
    }

    void setSolids()
    {
        const int n = system->nDof;
        freeSolid.clear();
        solidInverse.clear();
        solidScale.clear();
        for (std::size_t s = 0; s < system->solids.size(); ++s)
        {
            const SolidCoupling& solid = system->solids[s];
            if (!solid.isFree) continue;
            freeSolid.push_back(int(s));
            std::vector<double> block(solid.block);
            block.resize(std::size_t(n)*n);
            halo.sum(block.data(), n*n);
            for (int k = 0; k < n*n; ++k) block[k] += solid.inertia[k];
            const Eigen::MatrixXd m = Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(block.data(), n, n);
            solidInverse.push_back(m.inverse());
            for (int k = 0; k < n; ++k) solidScale.push_back(1/std::sqrt(std::abs(m(k, k))));
        }
        q.assign(system->solids.size()*n, 0.0);
        qRows = qWork = q;
    }

    // ---- vectors: owned fluid values, then (rank 0) the free solids' velocities
    int nSolidEntries() const { return int(freeSolid.size())*system->nDof; }

    void createKrylov()
    {
        const int n = mesh.nOwned*B + (halo.rank() == 0 ? nSolidEntries() : 0);
        if (krylov && n == nVector) return;
        destroyKrylov();
        nVector = n;
        check(MatCreateShell(halo.comm(), n, n, PETSC_DETERMINE, PETSC_DETERMINE, this, &matrix));
        check(MatShellSetOperation(matrix, MATOP_MULT, (void (*)(void)) applyMatrix));
        check(MatCreateVecs(matrix, &solution, &rhs));
        check(KSPCreate(halo.comm(), &krylov));
        check(KSPSetOptionsPrefix(krylov, "flow_"));
        check(KSPSetOperators(krylov, matrix, matrix));
        check(KSPSetType(krylov, KSPGMRES));
        check(KSPGMRESSetRestart(krylov, controls.restart));
        check(KSPGMRESSetCGSRefinementType(krylov, KSP_GMRES_CGS_REFINE_IFNEEDED));
        check(KSPSetPCSide(krylov, PC_RIGHT));
        PC pc;
        check(KSPGetPC(krylov, &pc));
        check(PCSetType(pc, PCSHELL));
        check(PCShellSetContext(pc, this));
        check(PCShellSetApply(pc, applyPreconditioner));
        check(KSPSetFromOptions(krylov));
    }

    /// Removes from the continuity rows what no velocity can balance when no pressure is prescribed (closed boxes).
    void balanceContinuity(double* y) const
    {
        if (system->hasPressureLevel) return;
        double sums[2] = {0, 0};
        for (int i = 0; i < mesh.nOwned; ++i)
            if (system->isActive[i]) { sums[0] += y[std::size_t(i)*B + B - 1]; sums[1] += system->dualVolume[i]; }
        halo.sum(sums, 2);
        for (int i = 0; i < mesh.nOwned; ++i)
            if (system->isActive[i]) y[std::size_t(i)*B + B - 1] -= sums[0]/sums[1]*system->dualVolume[i];
    }

    void removeMeanPressure(double* y) const
    {
        if (system->hasPressureLevel) return;
        double sums[2] = {0, 0};
        for (int i = 0; i < mesh.nOwned; ++i)
            if (system->isActive[i]) { sums[0] += y[std::size_t(i)*B + B - 1]*system->dualVolume[i]; sums[1] += system->dualVolume[i]; }
        halo.sum(sums, 2);
        for (int i = 0; i < mesh.nOwned; ++i)
            if (system->isActive[i]) y[std::size_t(i)*B + B - 1] -= sums[0]/sums[1];
    }

    /// Entries of the free solids: from rank 0 to every rank, into q (nDof per solid), times solidScale.
    void readSolids(const double* entries)
    {
        const int n = system->nDof, total = nSolidEntries();
        if (!total) return;
        std::vector<double> values(total);
        if (halo.rank() == 0) std::copy(entries, entries + total, values.begin());
        MPI_Bcast(values.data(), total, MPI_DOUBLE, 0, halo.comm());
        for (std::size_t f = 0; f < freeSolid.size(); ++f)
            for (int d = 0; d < n; ++d) q[freeSolid[f]*n + d] = values[f*n + d]*solidScale[f*n + d];
    }

    void inertiaTimes(const double* velocity, double* rows) const
    {
        const int n = system->nDof;
        for (int s : freeSolid)
            for (int d = 0; d < n; ++d)
                for (int c = 0; c < n; ++c) rows[s*n + d] += system->solids[s].inertia[d*n + c]*velocity[s*n + c];
    }

    static PetscErrorCode applyMatrix(Mat m, Vec in, Vec out)
    {
        void* context;
        MatShellGetContext(m, &context);
        auto& me = *static_cast<Implementation*>(context);
        const PetscScalar* x;
        PetscScalar* y;
        VecGetArrayRead(in, &x);
        VecGetArray(out, &y);
        me.multiply(x, y);
        VecRestoreArrayRead(in, &x);
        VecRestoreArray(out, &y);
        return 0;
    }

    void multiply(const double* x, double* y)
    {
        const std::size_t n = std::size_t(mesh.nOwned)*B;
        for (std::size_t i = 0; i < n; ++i) local[i] = x[i]*scale[i];
        halo.update(local.data(), B);
        readSolids(x + n);
        const FlowOperator op(graph, halo, *system, mesh.nOwned);
        op.fluidRows(local.data(), freeSolid.empty() ? nullptr : q.data(), y);
        op.project(y);
        balanceContinuity(y);
        for (std::size_t i = 0; i < n; ++i) y[i] *= scale[i];
        if (freeSolid.empty()) return;
        op.solidRows(local.data(), q.data(), qRows.data());
        inertiaTimes(q.data(), qRows.data());
        if (halo.rank() == 0) writeSolids(qRows, y + n);
    }

    void writeSolids(const std::vector<double>& rows, double* entries) const
    {
        const int n = system->nDof;
        for (std::size_t f = 0; f < freeSolid.size(); ++f)
            for (int d = 0; d < n; ++d) entries[f*n + d] = rows[freeSolid[f]*n + d]*solidScale[f*n + d];
    }

    static PetscErrorCode applyPreconditioner(PC pc, Vec in, Vec out)
    {
        void* context;
        PCShellGetContext(pc, &context);
        auto& me = *static_cast<Implementation*>(context);
        const PetscScalar* r;
        PetscScalar* z;
        VecGetArrayRead(in, &r);
        VecGetArray(out, &z);
        me.precondition(r, z);
        VecRestoreArrayRead(in, &r);
        VecRestoreArray(out, &z);
        return 0;
    }

    void velocityDiagonal(const double* r, double* z) const
    {
        const int dim = mesh.dim;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double* m = &velocityInverse[std::size_t(i)*dim*dim];
            for (int a = 0; a < dim; ++a)
            {
                double sum = 0;
                for (int b = 0; b < dim; ++b) sum += m[a*dim + b]*r[std::size_t(i)*B + b];
                z[std::size_t(i)*B + a] = sum;
            }
        }
    }

    /// w = (solid's own block)^-1 rows, for the free solids.
    void solveSolids(const std::vector<double>& rows, std::vector<double>& w) const
    {
        const int n = system->nDof;
        for (std::size_t f = 0; f < freeSolid.size(); ++f)
        {
            const Eigen::Map<const Eigen::VectorXd> r(rows.data() + freeSolid[f]*n, n);
            Eigen::Map<Eigen::VectorXd>(w.data() + freeSolid[f]*n, n) = solidInverse[f]*r;
        }
    }

    void precondition(const double* r, double* z)
    {
        const std::size_t n = std::size_t(mesh.nOwned)*B;
        const FlowOperator op(graph, halo, *system, mesh.nOwned);
        // velocity and solids by their diagonal blocks
        for (std::size_t i = 0; i < n; ++i) owned[i] = r[i]/scale[i];
        velocityDiagonal(owned.data(), owned2.data());
        for (int i = 0; i < mesh.nOwned; ++i) owned2[std::size_t(i)*B + B - 1] = 0;
        op.project(owned2.data());
        std::copy(owned2.begin(), owned2.end(), local.begin());
        halo.update(local.data(), B);
        double* qSolids = nullptr;
        if (!freeSolid.empty())
        {
            readSolidResidual(r + n);
            solveSolids(qRows, q);
            qSolids = q.data();
        }
        // pressure: S^-1 (r_p - D z_u)
        op.divergence(local.data(), qSolids, ownedScalar.data());
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const bool isFree = system->isActive[i] && !system->isPressureFixed[i];
            ownedScalar[i] = isFree ? owned[std::size_t(i)*B + B - 1] - ownedScalar[i] : 0;
        }
        check(VecPlaceArray(pressureIn, ownedScalar.data()));
        check(VecPlaceArray(pressureOut, localScalar.data()));
        check(PCApply(amg, pressureIn, pressureOut));
        check(VecResetArray(pressureIn));
        check(VecResetArray(pressureOut));
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (!system->isActive[i] || system->isPressureFixed[i]) localScalar[i] = 0;
            else localScalar[i] += ownedScalar[i]*viscousPressure[i];
            owned2[std::size_t(i)*B + B - 1] = localScalar[i];
        }
        removeMeanPressure(owned2.data());
        for (int i = 0; i < mesh.nOwned; ++i) localScalar[i] = owned2[std::size_t(i)*B + B - 1];
        halo.update(localScalar.data(), 1);
        // velocity and solids corrected by the pressure
        op.gradient(localScalar.data(), owned.data());
        velocityDiagonal(owned.data(), gradient.data());

        for (int i = 0; i < mesh.nOwned; ++i)
            for (int c = 0; c < B - 1; ++c) owned2[std::size_t(i)*B + c] -= gradient[std::size_t(i)*B + c];
        op.project(owned2.data());
        for (std::size_t i = 0; i < n; ++i) z[i] = owned2[i]/scale[i];
        if (freeSolid.empty()) return;
        op.solidRowsOfPressure(localScalar.data(), qRows.data());
        solveSolids(qRows, qWork);
        if (halo.rank() != 0) return;
        const int nd = system->nDof;
        for (std::size_t f = 0; f < freeSolid.size(); ++f)
            for (int d = 0; d < nd; ++d)
                z[n + f*nd + d] = (q[freeSolid[f]*nd + d] - qWork[freeSolid[f]*nd + d])/solidScale[f*nd + d];
    }


    void readSolidResidual(const double* entries)
    {
        const int n = system->nDof, total = nSolidEntries();
        std::vector<double> values(total);
        if (halo.rank() == 0) std::copy(entries, entries + total, values.begin());
        MPI_Bcast(values.data(), total, MPI_DOUBLE, 0, halo.comm());
        for (std::size_t f = 0; f < freeSolid.size(); ++f)
            for (int d = 0; d < n; ++d) qRows[freeSolid[f]*n + d] = values[f*n + d]/solidScale[f*n + d];
    }

    /// Scaled right-hand side minus matrix times (x, q) into `rhs`; returns the norm of the right-hand side itself.
    double setResidual(const std::vector<double>& x, const std::vector<double>& velocity)
    {
        const std::size_t n = std::size_t(mesh.nOwned)*B;
        const int nd = system->nDof;
        const FlowOperator op(graph, halo, *system, mesh.nOwned);
        const double* qAll = system->solids.empty() ? nullptr : velocity.data();
        op.fluidRows(x.data(), qAll, owned.data());
        PetscScalar* r;
        check(VecGetArray(rhs, &r));
        for (std::size_t i = 0; i < n; ++i) r[i] = system->rhs[i];
        for (const GhostTerm& g : system->ghosts) // source of the pressure jumps
            for (int j = 0; j < mesh.dim + 2; ++j)
                if (g.node[j] < mesh.nOwned)
                    r[std::size_t(g.node[j])*B + B - 1] += g.pressureFactor*g.jumpPressure[j]*g.pressureSource;
        std::copy(r, r + n, owned2.begin());
        op.project(owned2.data());
        double norm = 0;
        for (std::size_t i = 0; i < n; ++i) norm += owned2[i]*scale[i]*owned2[i]*scale[i];
        for (std::size_t i = 0; i < n; ++i) r[i] -= owned[i];
        op.project(r);
        balanceContinuity(r);
        for (std::size_t i = 0; i < n; ++i) r[i] *= scale[i];
        if (!freeSolid.empty())
        {
            op.solidRows(x.data(), velocity.data(), qRows.data());
            inertiaTimes(velocity.data(), qRows.data());
            for (std::size_t f = 0; f < freeSolid.size(); ++f)
                for (int d = 0; d < nd; ++d)
                {
                    const double b = system->solids[freeSolid[f]].rhs[d];
                    qRows[freeSolid[f]*nd + d] = b - qRows[freeSolid[f]*nd + d];
                    if (halo.rank() == 0) norm += std::pow(b*solidScale[f*nd + d], 2);
                }
            if (halo.rank() == 0) writeSolids(qRows, r + n);
        }
        check(VecRestoreArray(rhs, &r));
        return std::sqrt(halo.sum(norm));
    }
};

FlowLinearSolver::FlowLinearSolver(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls)
:   impl_(std::make_unique<Implementation>(mesh, graph, halo, controls))
{}

FlowLinearSolver::~FlowLinearSolver() = default;

void FlowLinearSolver::setSystem(const FlowSystem& system)
{
    NoFloatingPointTraps guard;
    Implementation& me = *impl_;
    me.system = &system;
    me.isFirstSolve = true;
    me.setDiagonals();
    me.setSolids();
    me.createKrylov();
    const double typical = me.typicalSchur();
    if (me.needsNewHierarchy(typical))
    {
        me.buildAmg();
        me.builtFor = typical;
    }
    else ++me.age;
}

SolveReport FlowLinearSolver::solve(std::vector<double>& x, std::vector<double>& q)
{
    NoFloatingPointTraps guard;
    Implementation& me = *impl_;
    SolveReport report;
    report.rebuiltPreconditioner = me.age == 0;
    const double norm = me.setResidual(x, q);
    double first = 0;
    check(VecNorm(me.rhs, NORM_2, &first));
    if (!(norm < 1e300) || !(first < 1e300)) return report; // not a number: the caller repeats the step
    report.initial = report.final = norm > 0 ? first/norm : 0;
    // The first solve of a step also makes the residual of its start ten times smaller. An extrapolated start may meet the tolerance by itself (the gas
    // hardly counts in the norm), and taken as the solution step after step it grows: a gas jet of 12 m/s over a flume, without an iteration.
    const double wanted = me.controls.tolerance*norm;
    const double target = me.isFirstSolve ? std::max(std::min(wanted, startReduction*first), negligible*wanted) : wanted;
    me.isFirstSolve = false;
    if (first <= target || first == 0)
    {
        report.hasConverged = true;
        return report;
    }
    check(KSPSetTolerances(me.krylov, 1e-14, target, 1e10, me.controls.maxIterations));
    check(VecSet(me.solution, 0));
    check(KSPSolve(me.krylov, me.rhs, me.solution));
    PetscInt iterations;
    PetscReal final;
    KSPConvergedReason reason;
    check(KSPGetIterationNumber(me.krylov, &iterations));
    check(KSPGetResidualNorm(me.krylov, &final));
    check(KSPGetConvergedReason(me.krylov, &reason));
    report.iterations = int(iterations);
    report.final = norm > 0 ? final/norm : 0;
    report.hasConverged = reason > 0;
    me.lastIterations = report.iterations;
    if (me.freshIterations == 0) me.freshIterations = report.iterations;

    const PetscScalar* d;
    check(VecGetArrayRead(me.solution, &d));
    const std::size_t n = std::size_t(me.mesh.nOwned)*me.B;
    for (std::size_t i = 0; i < n; ++i) x[i] += d[i]*me.scale[i];
    me.readSolids(d + n);
    for (int s : me.freeSolid)
        for (int k = 0; k < me.system->nDof; ++k) q[s*me.system->nDof + k] += me.q[s*me.system->nDof + k];
    check(VecRestoreArrayRead(me.solution, &d));
    me.halo.update(x.data(), me.B);
    return report;
}

} // namespace flotsam
