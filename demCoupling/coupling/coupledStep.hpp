// SPDX-License-Identifier: GPL-3.0-or-later
/// One time step of everything: flow, free surface, cut geometry, bodies, contact. No OpenFOAM, no files: the application and the
/// tests drive the same object.
#pragma once

#include "demCoupling/coupling/entryCheck.hpp"
#include "demCoupling/coupling/meshExit.hpp"
#include "demCoupling/coupling/scene.hpp"
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "io/bodyHistory.hpp"
#include "io/runLog.hpp"

#include <map>
#include <memory>

namespace flotsam
{

struct StepResult
{
    bool isAccepted = false;
    std::string failure;        ///< why not
    TransportReport transport;
    int linearIterations = 0;   ///< of all solves of the step
    int solves = 0;             ///< 1 + contact repeats
    bool hasConverged = true;   ///< linear solver, all solves
    double contactMismatch = 0;
    std::vector<std::string> waiting; ///< bodies that begin to wait for their place, and what is in the way
    double unbalancedVolume = 0; ///< that gas of basins without a prescribed pressure gave way to or filled [m^dim]
};

class CoupledStep
{
public:
    /// dem: null when there are no bodies (LIGGGHTS is then never opened). References must outlive this.
    CoupledStep(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const NumericsControls& controls,
        const std::vector<BoundaryPatch>& patches, Scene scene, const DemSetup* dem, PhaseTimers& timers);

    /// Start fields; cuts the mesh. isSharp: the phase field is turned into its equilibrium profile.
    void start(FlowState state, bool isSharp);

    /// Advances by dt, or leaves everything as it was (isAccepted false).
    StepResult step(double dt);
    /// Whether BodyCoupling::meanContacts() of the coming steps will be asked for.
    void tallyContacts(bool isOn) { if (coupling_) coupling_->tallyContacts(isOn); }

    Fluid& fluid() { return fluid_; }
    const Fluid& fluid() const { return fluid_; }
    const Scene& scene() const { return scene_; }
    const BodyCoupling* coupling() const { return coupling_.get(); }
    const Cover* cover() const { return scene_.isEmpty() ? nullptr : &builder_->cover(); }

    /// As Scene::fastest(); ahead: of the present time, for what moves as prescribed [s].
    std::pair<std::string, double> fastestSolid(double ahead) const { return scene_.fastest(fluid_.state().time + ahead, ahead); }
    /// That speed over the smallest cut element [1/s]; 0 without moving solids. Collective.
    double bodyCourantRate(double ahead) const;
    int bodiesInContact() const;

    /// State and loads of the solids at the present time, structures first.
    std::vector<BodyRecord> records() const;

    /// What no checkpoint holds: after one is written the run goes on as a restart from it would.
    void forgetUnwritten();
    using Arrays = std::map<std::string, std::vector<double>>;
    /// Arrays for a checkpoint beside the FlowState, the same on every process. Collective.
    Arrays save() const;
    Arrays saveOfProcess() const;       ///< the others
    /// What the state given to restore() is.
    enum class Fields
    {
        Exact,  ///< all of what was stored; arrays: of save() and saveOfProcess()
        Nodal,  ///< the last time level at the nodes; arrays: of save()
        Cells   ///< that as read from cells, as for start()
    };
    void restore(FlowState state, const Arrays& arrays, Fields fields);
    /// Of a run without some of the solids, bodies and restraints: these begin, where the definitions have them at this time, in an object that has not made a step.
    void restore(FlowState state, const Arrays& arrays, Fields fields, const StoredMembers& stored);
    /// Liquid (of one fluid: the volume of it) that gave way to them there [m^3].
    double displaced() const { return displaced_; }

private:
    /// The volume correction takes a few passes from nothing.
    static constexpr int cutsFromNothing = 3;

    void cut(bool hasChanged);
    void restoreFluid(FlowState state, const Arrays& arrays, Fields fields);
    void putIn(const std::vector<char>& isNew);
    const Cover& cutNew(const std::vector<char>& isNew);
    void restoreGeometry(bool hasChanged = false);
    double smallestCutElement() const;  ///< [m]; huge where nothing is cut
    SolveReport solveFlow(StepResult& result, double enough);
    void solveWithContact(StepResult& result);
    bool correctContact(StepResult& result);
    void forgetContact();
    void letIn(double time);
    void takeOutLeavers();

    const SimplexMesh& mesh_;
    const Halo& halo_;
    NumericsControls controls_;
    PhaseTimers& timers_;
    Fluid fluid_;
    Scene scene_;
    std::unique_ptr<CoverBuilder> builder_; // null without solids
    std::unique_ptr<BodyCoupling> coupling_;
    std::unique_ptr<EntryCheck> entry_;
    std::unique_ptr<MeshExit> exit_;
    std::vector<char> isWaiting_;           // per body
    std::vector<std::string> waiting_;      // of the step to come
    std::vector<Fluid::SolidLoad> loads_;   // fluid loads of the last solve
    std::vector<double> wet_;
    std::vector<double> sceneBefore_;       // of the step's start, as the next
    std::vector<Fluid::SolidLoad> loadsBefore_;
    std::vector<Motion> motions_;           // work of a step, as the following: of the bodies
    std::vector<FreeBody> freeBodies_;
    std::vector<Load> bodyLoads_, probeLoads_;
    std::vector<char> mayBeOutside_;
    double displaced_ = 0;
    double contactChange_ = 0;  // residual over the right-hand side that the first new contact load of the last step left; 0: there was none
    int contactRepeats_ = 0;    // new contact loads in the last step
    const bool cutsNeedlessly_, assemblesNeedlessly_;   // see algebra/needlessWork.hpp
};

} // namespace flotsam
