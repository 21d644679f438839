// SPDX-License-Identifier: GPL-3.0-or-later
/// What GMRES sees: the product with a FlowSystem whose rows and columns are scaled by the diagonals, its block preconditioner (see
/// flowLinearSolver.hpp) and both one after the other. Vectors: nOwned*(dim+1) fluid values, then (rank 0) the free solids' velocities.
#pragma once

#include "algebra/bodyCompliance.hpp"
#include "algebra/flowOperator.hpp"
#include "algebra/heldPressure.hpp"
#include "algebra/pressureHierarchy.hpp"
#include "algebra/solidUnknowns.hpp"
#include "algebra/velocityBlock.hpp"
#include "algebra/velocityChoice.hpp"
#include "algebra/viscousBlock.hpp"

namespace flotsam
{

class ScaledFlowSystem
{
public:
    /// patience: iterations of diagonal blocks that are too many while nothing is known of cycles (VelocityChoice).
    ScaledFlowSystem(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, int patience);

    /// Before set(): what the velocities of the new step's system are preconditioned by.
    void chooseVelocities(const FlowSystem& system);
    /// Collective. Diagonal blocks of the system (kept by reference) and, when it pays, new hierarchies.
    void set(const FlowSystem& system);

    bool areForcesAsked() const { return system_->areForcesAsked || !system_->solids.empty(); }
    int nEntries() const { return mesh_.nOwned*B_ + solids_.nLocalEntries(); }
    void multiply(const double* x, double* y);
    void precondition(const double* r, double* z);
    /// y = matrix times preconditioner times r.
    void multiplyPreconditioned(const double* r, double* y);

    /// Scaled residual r of (x: nNodes*(dim+1) with its halo up to date, q: nDof per solid); returns the norm of the scaled right-hand side, of pressures over the mean of
    /// the prescribed ones: a constant that is added to all of them changes nothing.
    double residual(const std::vector<double>& x, const std::vector<double>& q, double* r);
    /// See FlowLinearSolver.
    void remainder(const std::vector<double>& x, const std::vector<double>& q, std::vector<double>& rows);
    /// Of the last residual(): volume that surfaces sweep in basins without a prescribed pressure beyond what these can give [m^dim/s].
    double unbalancedVolume() const { return unbalancedVolume_; }
    /// Of the last residual(): what round-off of the pressures' level leaves in it.
    double roundOff() const { return roundOff_; }
    /// Norm of the scaled forces that change the motion of x, which the last residual() was of: its residual r and the pressure's rows. The right-hand side is mostly
    /// inertia over the time step.
    double forceNorm(const std::vector<double>& x, const double* r);
    /// Adds a scaled solution to x and q; the halo of x is updated.
    void addTo(std::vector<double>& x, std::vector<double>& q, const double* solution);

    PressureHierarchy& pressure() { return pressure_; }
    VelocityChoice& choice() { return choice_; }
    /// New hierarchies at once. Collective.
    void renewHierarchies();

private:
    template<int D> void setDiagonals();
    void setBodyCompliance();
    void updateHierarchies();
    void updateViscousBlock();
    void solveVelocity(const double* r);
    void subtractFromVelocity(const double* gradient);
    void solvePressure(const double* r);
    void addPressureSources(double* r) const;
    double prescribedLevel(const std::vector<double>& x) const;
    void subtractLevel(double* r);
    void residualRows(const std::vector<double>& x, const std::vector<double>& q, double* rows);
    void preconditionUnscaled(const double* r);
    void finishProduct(const FlowOperator& op, double* y, const double* ofPressure);
    double balanceContinuity(double* y);
    void removeMeans(std::vector<double>& p);
    FlowOperator product() const { return {graph_, halo_, *system_, mesh_.nOwned}; }

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    const int B_;
    const FlowSystem* system_ = nullptr;
    VelocityBlock velocity_;
    VelocityChoice choice_;
    std::unique_ptr<ViscousBlock> viscous_; // instead of velocity_ when it is the choice
    PressureHierarchy pressure_;
    HeldPressure heldPressure_;
    SolidUnknowns solids_;
    BodyCompliance bodyCompliance_;

    double unbalancedVolume_ = 0;
    double level_ = 0;                      // mean of the prescribed pressures [Pa]
    double roundOff_ = 0;
    std::vector<double> scale_;             // nOwned*B: 1/sqrt(diagonal)
    std::vector<float> pointwisePressure_;  // nOwned: what the inverse of the Schur complement has besides the V-cycle; only preconditions
    std::vector<double> local_;             // work: nNodes*B, unscaled
    std::vector<double> pressureRows_, gradient_; // work: nOwned, nOwned*dim
    std::vector<double> pressureLocal_;     // work: nNodes
    std::vector<double> q_, qRows_, qWork_; // nDof per solid
    std::vector<double> levelSums_;         // work: FlowSystem::nLevels
};

} // namespace flotsam
