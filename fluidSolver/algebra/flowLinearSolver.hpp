// SPDX-License-Identifier: GPL-3.0-or-later
/// Krylov solution of a FlowSystem: GMRES (PETSc) outside, block preconditioner inside.
///
/// Preconditioner (lower-upper block factorisation, SIMPLE type): velocity by its diagonal blocks, or one block where
/// ghost penalty holds the nodes, solids by their own mass and wall blocks, pressure by one BoomerAMG V-cycle on the assembled Schur approximation,
/// corrected at such nodes, plus its viscous part (Cahouet & Chabat 1988, doi 10.1002/fld.1650080802), less what free bodies give way
/// (bodyCompliance.hpp). Rows and columns are scaled by the diagonals: the plain residual norm is meaningless at a density ratio of 1000.
#pragma once

#include "algebra/flowOperator.hpp"
#include "core/controls.hpp"

#include <memory>

namespace flotsam
{

struct SolveReport
{
    int iterations = 0;
    double initial = 0, final = 0;  ///< scaled residual over scaled right-hand side
    bool hasConverged = false;
    bool rebuiltPreconditioner = false;
    double unbalancedVolume = 0;    ///< swept in basins without a prescribed pressure beyond what these can give, at the start [m^dim/s]
};

class FlowLinearSolver
{
public:
    FlowLinearSolver(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const NumericsControls& controls);
    ~FlowLinearSolver();
    FlowLinearSolver(const FlowLinearSolver&) = delete;
    FlowLinearSolver& operator=(const FlowLinearSolver&) = delete;

    /// Takes a newly assembled system (kept by reference until the next call) and, when it pays, a new preconditioner.
    void setSystem(const FlowSystem& system);

    /// Improves x (nNodes*(dim+1), constraints already satisfied, halo up to date) and q (nDof per solid; entries of solids
    /// that are not free are data). Repeated calls after a change of a solid's rhs need no new setSystem().
    /// enough: residual over the right-hand side to stop at when that is more than the tolerances ask for (a trial, which another solve follows).
    SolveReport solve(std::vector<double>& x, std::vector<double>& q, double enough = 0);

    /// rows (nOwned*(dim+1)): of what (x, q) leaves of momentum [N; 2D: N/m] and continuity [m^dim/s] that which a next step has to make up for (numerics, 5.10);
    /// nothing where velocity or pressure are prescribed.
    void remainder(const std::vector<double>& x, const std::vector<double>& q, std::vector<double>& rows);

    /// The next system gets a new preconditioner, whatever pays: what comes then depends on the state alone.
    void forgetPreconditioner();

private:
    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

/// Starts PETSc inside an MPI program (or alone) without its signal handlers, and ends it. One per process.
struct PetscSession
{
    explicit PetscSession(MPI_Comm comm);
    ~PetscSession();
};

} // namespace flotsam
