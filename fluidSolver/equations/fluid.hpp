// SPDX-License-Identifier: GPL-3.0-or-later
/// The fluid: state, phase field, momentum and continuity of one step, behind a few verbs for the main loop.
///
///   keepGeometry() when solids move: before the geometry of t+dt is set
///   beginStep(dt)  phase field to t+dt, boundary values
///   assemble()     linear system on the geometry of t+dt
///   solve()        velocities, pressure, free solids' velocities (repeatable with other contact loads)
///   endStep()      accept; or rejectStep(): back to t
#pragma once

#include "algebra/elementHalo.hpp"
#include "algebra/flowLinearSolver.hpp"
#include "equations/basins.hpp"
#include "equations/dualCellTransport.hpp"
#include "equations/flowEquation.hpp"
#include "equations/flowMeasures.hpp"
#include "equations/gasRegion.hpp"
#include "equations/interfacePlanes.hpp"
#include "equations/massFluxes.hpp"
#include "equations/patchForces.hpp"
#include "equations/phaseFieldSupg.hpp"
#include "equations/shutPockets.hpp"
#include "equations/solidExtension.hpp"
#include "equations/squeezedBasins.hpp"
#include "equations/surfaceLevel.hpp"

#include <memory>
#include <string>

namespace flotsam
{

class Fluid
{
public:
    Fluid(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const NumericsControls& controls,
        const std::vector<BoundaryPatch>& patches);

    /// Takes the start fields (u, p, alpha per node); sharp: alpha is turned into the equilibrium profile.
    void start(FlowState state, bool isSharp);

    /// Geometry of the current state; pass it again after every re-cutting. Null: no solids.
    /// hasChanged: the phase field inside solids follows that of the surroundings anew.
    void setGeometry(const Cover* cover, const std::vector<Solid>* solids, bool hasChanged);

    /// After solids were put in where before was fluid: what the last step left there for the next is void. before: the cover without them.
    void forgetCovered(const Cover& before);

    /// The next step goes from the present geometry to the one that is set until beginStep().
    void keepGeometry();
    TransportReport beginStep(double dt);
    void assemble();
    void assembleAgain();   ///< the same system
    SolveReport solve(const std::vector<FreeBody>& bodies, double enough = 0);  ///< enough: see FlowLinearSolver::solve()
    void endStep();
    void rejectStep();

    /// The mean load of the step on a body is share (new load) + (1 - share) (last step's mean load): m dV/dt by the fluid's own BDF,
    /// written for the change of velocity within the step. Valid from beginStep().
    double newLoadShare() const { return 1/(time_.c0*time_.dt); }

    /// Fluid force and moment (about the pose's position) on every solid from the last solve, space frame, 3D values.
    struct SolidLoad { Vec3 force, moment; };
    std::vector<SolidLoad> solidLoads();
    void findSolidLoads(std::vector<SolidLoad>& loads);     ///< into memory that is kept
    /// From now on endStep() finds the forces on these patches (indices in the constructor's), which let no fluid through.
    void watchPatches(const std::vector<int>& patches);
    /// Of every patch in the last accepted step, before it and where it is not watched zero.
    const std::vector<PatchForce>& patchForces() const { return patchForces_->result(); }

    /// Velocity of every solid in the last solve (free: solved; others: as given).
    std::vector<Motion> solidMotions() const;
    void findSolidMotions(std::vector<Motion>& motions) const;  ///< into memory that is kept
    /// Liquid share of every solid's surface, 0..1. Collective.
    void findWetFractions(std::vector<double>& result) const
    {
        flotsam::findWetFractions(mesh_, halo_, cover_, solids_ ? solids_->size() : 0, state_.alpha, result);
    }

    /// Mean and largest |u|/h over the active elements [1/s]. Collective.
    CourantRates courantRates() const { return flotsam::courantRates(mesh_, halo_, cover_, state_); }

    /// The fastest place, for messages: "|u| = 12 m/s at (0.1 0.2 0), alpha 0.01, 0.002 m from 'gate'". Collective.
    std::string describeFastest() const { return flotsam::describeFastest(mesh_, halo_, state_, cover_, solids_); }

    /// Of the last step, for messages: the structure that changes the volume of fluid that nothing lets in or out, and where; empty: none. Collective.
    std::string describeSqueezed() const { return cover_ && solids_ ? flotsam::describeSqueezed(mesh_, halo_, *cover_, *solids_, equation_.system().level) : ""; }

    /// Liquid volume int alpha over the fluid part [m^3]. Collective.
    double liquidVolume() const { return flotsam::liquidVolume(mesh_, halo_, cover_, state_.alpha); }

    double timeStep() const { return time_.dt; }    ///< of the step that beginStep() began [s]

    const FlowState& state() const { return state_; }
    const std::vector<double>& profileWidth() const { return transport_.width(); }  ///< of the phase field, nNodes [m]
    FlowState& state() { return state_; }
    const SimplexMesh& mesh() const { return mesh_; }
    const NodeGraph& graph() const { return graph_; }
    /// Nothing will ever be cut: the graph forgets the faces of the elements, unless gas is left out along them.
    void forgetFaces();
    const Halo& halo() const { return halo_; }
    const FlowEquation& equation() const { return equation_; }
    /// Liquid volume the transport keeps to (part of the state) [m^dim].
    double keptLiquid() const { return supg_ ? supg_->liquidVolume() : transport_.liquidVolume(); }
    void setKeptLiquid(double volume);
    /// What the written state does not hold (preconditioner, gas left out, level of the surface) starts anew, as in a run that goes on from it: both stay the same.
    void forgetUnwritten();
    /// Ghost-penalty fluxes of the last accepted solve as {a, b, flux} triples (part of the state of a run with solids).
    std::vector<double> ghostFluxes() const;
    void setGhostFluxes(const std::vector<double>& triples);
    /// What the last accepted solve has left for the next step (part of the state): FlowState::remainder. Throws std::runtime_error where that is of another mesh.
    void setRemainder(const std::vector<double>& rows);
    /// Mass fluxes of the last accepted step, with surfaceTimeOrder 2 (part of the state).
    MassFluxes& massFluxes() { return massFluxes_; }
    const MassFluxes& massFluxes() const { return massFluxes_; }
    bool isFinite() const;  ///< the last solution is a number everywhere. Collective.

private:
    void evaluatePatches(double time);
    const std::vector<double>& alphaOfPatches();
    void moveInactiveNodes();
    void keepInlets();
    void extendPhase();
    void findSurface(const Cover* cover);
    void findDensity(std::vector<double>& rho) const;
    void balancePatchPressures();
    bool isGravityBalanced() const { return fluid_.isTwoPhase && controls_.balancedGravity; }
    void setGravity(const Cover* cover);
    void findBasins(const Cover* cover);
    void setPocketPressures();
    void setFirstGuess();
    void carryRemainder();
    void findPatchForces();
    TransportReport advancePhase(double dt);
    TransportReport transportPhase(double dt, const std::vector<double>& u, const std::vector<double>& fine);
    double levelTolerance() const;
    bool isFirstStep() const { return state_.dt <= 0; }    ///< no step of this run, or of the one that it goes on with, is known
    double profileRate() const;
    /// Over which the phase field is a mean; null: its values are the nodes'.
    const DualCells* profileCells() const { return supg_ ? nullptr : &transport_.cells(); }
    const std::vector<double>& halfStep(const std::vector<double>& now, const std::vector<double>& old, double dt,
        std::vector<double>& work) const;

    const SimplexMesh& mesh_;
    const Halo& halo_;
    NodeGraph graph_;
    ElementHalo elementHalo_;
    FluidProperties fluid_;
    NumericsControls controls_;
    std::vector<BoundaryPatch> patches_;
    std::vector<PatchValues> values_;
    PatchValues sharpValues_;           // work of balancePatchPressures()
    std::vector<double> patchAlpha_;    // see alphaOfPatches()

    FlowState state_, before_;      // before_: alpha levels at the start of the step
    FlowEquation equation_;
    FlowLinearSolver solver_;
    DualCellTransport transport_;
    MassFluxes massFluxes_;         // of the last step; surfaceTimeOrder 2
    std::unique_ptr<PhaseFieldSupg> supg_;  // the paper's form, when selected
    InterfacePlanes planes_;
    SurfaceLevel surfaceLevel_;
    std::vector<double> level_;             // of the last search
    bool isLevelKnown_ = false;             // the search was on the present phase field
    const Cover* cover_ = nullptr;
    Cover start_, during_;              // while solids move: geometry of t (as keepForMean() leaves it), mean over the step
    bool isMoved_ = false;              // start_ holds
    std::unique_ptr<GasRegion> gas_;    // when gas far from the water is left out
    Basins basins_;
    bool areBasinsOld_ = true;          // the geometry has changed since they were found
    ShutPockets pockets_;
    const std::vector<Solid>* solids_ = nullptr;
    TimeScheme time_;
    std::vector<double> surfaceDensity_; // nNodes, work of setGravity()
    std::vector<FacetPressure> surfacePressure_;
    std::unique_ptr<PatchForces> patchForces_;  // null: none asked for
    std::vector<double> force_;         // nElements*dim; empty between advancePhase() and setGravity()
    std::vector<double> x_, q_;         // solution: nNodes*(dim+1), nDof per solid; x_ is void between endStep() and setFirstGuess(), and lends its memory
    std::vector<PairFlux> ghostFlux_;   // of the last accepted solve
    double liquidBefore_ = 0;
    RingWork rings_;                    // work, as the following: of extendPhase()
    std::vector<char> isFixed_;         // of findBasins()
    std::vector<double> solidRows_;     // of findSolidLoads()
    std::vector<Motion> motions_;       // of moveInactiveNodes()
};

} // namespace flotsam
