// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/coupledStep.hpp"

#include "algebra/needlessWork.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double strayElements = 2;     // a rebound at maxBodyCo 0.5 takes a body one element from its prediction
constexpr double poorResidual = 30; // times the tolerance: a solve that ends above fails the step

CouplingControls couplingControls(const FluidProperties& fluid, const NumericsControls& n)
{
    CouplingControls c;
    c.tolerance = n.contactTolerance;
    c.maxRepeats = n.maxContactRepeats;
    c.gravity = Vec3(fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]).norm();
    c.liquidDensity = fluid.rhoLiquid;
    return c;
}

} // namespace

CoupledStep::CoupledStep(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const NumericsControls& controls,
    const std::vector<BoundaryPatch>& patches, Scene scene, const DemSetup* dem, PhaseTimers& timers)
:   mesh_(mesh), halo_(halo), controls_(controls), timers_(timers), fluid_(mesh, halo, fluid, controls, patches),
    scene_(std::move(scene)), cutsNeedlessly_(doesNeedless("cut")), assemblesNeedlessly_(doesNeedless("assembly"))
{
    if (!scene_.isEmpty()) builder_ = std::make_unique<CoverBuilder>(mesh, fluid_.graph(), halo);
    else fluid_.forgetFaces();
    // 2D: the last bit of a section depends on the pose it is taken in, which must not be that in which a run goes on
    for (const Solid& solid : scene_.solids())
        if (solid.kind == Solid::Kind::Free) builder_->exactVolume(solid);
    if (!dem) return;
    coupling_ = std::make_unique<BodyCoupling>(*dem, couplingControls(fluid, controls), halo.comm());
    entry_ = std::make_unique<EntryCheck>(mesh, halo, dem->bodies);
    isWaiting_.assign(dem->bodies.size(), 0);
    exit_ = std::make_unique<MeshExit>(mesh, halo, dem->bodies, Vec3(fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]));
}

void CoupledStep::cut(bool hasChanged)
{
    if (scene_.isEmpty()) return;
    PhaseTimer t(timers_, Phase::Cut);
    const Cover& cover = builder_->buildExactVolume(scene_.solids());
    fluid_.setGeometry(&cover, &scene_.solids(), hasChanged);
}

void CoupledStep::start(FlowState state, bool isSharp)
{
    const double time = state.time;
    fluid_.start(std::move(state), isSharp);
    scene_.place(time, coupling_.get());
    for (int k = 1; k <= cutsFromNothing; ++k) cut(k == cutsFromNothing);
    fluid_.findWetFractions(wet_);
    loads_.assign(scene_.solids().size(), {Vec3::Zero(), Vec3::Zero()});
}

StepResult CoupledStep::step(double dt)
{
    StepResult result;
    scene_.save(sceneBefore_);
    loadsBefore_ = loads_;
    const double time = fluid_.state().time;
    if (coupling_)
    {
        PhaseTimer t(timers_, Phase::Dem);
        letIn(time);
        coupling_->begin(time, dt, 0.5*strayElements*smallestCutElement());
    }
    if (scene_.moves()) fluid_.keepGeometry();
    scene_.place(time + dt, coupling_.get());
    if (scene_.moves() || cutsNeedlessly_) cut(false);
    try
    {
        PhaseTimer t(timers_, Phase::PhaseField);
        result.transport = fluid_.beginStep(dt);
    }
    catch (const std::runtime_error& error) { result.failure = error.what(); } // on every rank alike
    if (result.failure.empty())
    {
        {
            PhaseTimer t(timers_, Phase::FlowAssembly);
            fluid_.assemble();
        }
        solveWithContact(result);
    }
    if (!result.failure.empty())
    {
        fluid_.rejectStep();
        if (coupling_) coupling_->reject();
        forgetContact();
        scene_.restore(sceneBefore_);
        loads_ = loadsBefore_;
        restoreGeometry();
        return result;
    }
    PhaseTimer t(timers_, Phase::FlowAssembly);
    fluid_.endStep();
    if (coupling_)
    {
        fluid_.findSolidMotions(motions_);
        motions_.erase(motions_.begin(), motions_.begin() + scene_.nStructures());
        coupling_->accept(motions_);
        takeOutLeavers();
    }
    fluid_.findWetFractions(wet_);
    result.waiting.swap(waiting_);
    result.isAccepted = true;
    return result;
}

/// Bodies to come whose release is due, in their order: what comes in first is in the way of the next.
void CoupledStep::letIn(double time)
{
    for (int b = 0; b < coupling_->nBodies(); ++b)
    {
        if (coupling_->presence(b) != Presence::Awaited || !coupling_->isDue(b, time)) continue;
        const Obstacle obstacle = entry_->obstacle(b, fluid_.state().alpha, coupling_->states(), coupling_->areAway(), scene_.solids());
        if (!obstacle.isThere()) coupling_->letIn(b);
        else if (!isWaiting_[b])
            waiting_.push_back("body " + coupling_->definition(b).name + " is to come in, but there is " + obstacle.name + " at its place: it waits"
                + (obstacle.isLiquid ? " until there is none. Give it a place two elements above the highest level (constant/bodies)" : ""));
        isWaiting_[b] = obstacle.isThere();
    }
}

/// Bodies that have left the mesh: what cuts no element may have.
void CoupledStep::takeOutLeavers()
{
    const Cover& cover = builder_->cover();
    std::vector<char>& mayBe = mayBeOutside_;
    mayBe.assign(coupling_->nBodies(), 0);
    for (int b = 0; b < coupling_->nBodies(); ++b)
    {
        const int s = scene_.nStructures() + b;
        mayBe[b] = !coupling_->isHeld(b) && cover.solidVolume[s] == 0 && cover.solidArea[s] == 0;
    }
    std::vector<char>& leavers = mayBe;
    if (std::find(leavers.begin(), leavers.end(), 1) != leavers.end()) leavers = exit_->findOutside(coupling_->states(), leavers);
    for (int b = 0; b < coupling_->nBodies(); ++b) leavers[b] = leavers[b] || (!coupling_->isHeld(b) && coupling_->isFarOff(b));
    if (std::find(leavers.begin(), leavers.end(), 1) != leavers.end()) coupling_->takeOut(leavers);
}

/// One solve with the present contact load and what it does to the solids. enough: see FlowLinearSolver::solve().
SolveReport CoupledStep::solveFlow(StepResult& result, double enough)
{
    SolveReport report;
    {
        PhaseTimer t(timers_, Phase::FlowSolve);
        if (coupling_) scene_.findFreeBodies(*coupling_, fluid_.newLoadShare(), freeBodies_);
        report = fluid_.solve(freeBodies_, enough);
    }
    result.unbalancedVolume = report.unbalancedVolume*fluid_.timeStep();
    result.linearIterations += report.iterations;
    result.hasConverged = result.hasConverged && report.hasConverged;
    if (!fluid_.isFinite()) result.failure = "the solution is not a number";
    else if (!report.hasConverged && !(report.final < poorResidual*controls_.tolerance))
        result.failure = "the linear solver did not converge";
    if (scene_.isEmpty() || !result.failure.empty()) return report;
    PhaseTimer t(timers_, Phase::Exchange);
    fluid_.findSolidLoads(loads_);
    return report;
}

/// Bodies in a jam answer most solves with another contact load. As many solves as the last step had such answers are trials, no
/// more exact than what a new load changes; where the contact of one holds, after all, it is finished and the engine asked again. Not with light
/// bodies: what a trial leaves looks like an answer to the contact load.
void CoupledStep::solveWithContact(StepResult& result)
{
    const int trials = coupling_ && !coupling_->hasLightBodies() ? contactRepeats_ : 0;
    const double enoughOfTrial = controls_.contactTrial*contactChange_;
    forgetContact();
    for (bool isNewLoad = true;;)
    {
        const double enough = isNewLoad && result.solves < trials ? enoughOfTrial : 0;
        if (assemblesNeedlessly_ && isNewLoad && result.solves > 0)
        {
            PhaseTimer t(timers_, Phase::FlowAssembly);
            fluid_.assembleAgain();
        }
        const SolveReport report = solveFlow(result, enough);
        result.solves += isNewLoad;
        if (!result.failure.empty() || !coupling_) return;
        if (isNewLoad && result.solves == 2) contactChange_ = report.initial;
        contactRepeats_ = result.solves - 1;
        PhaseTimer t(timers_, Phase::Dem);
        isNewLoad = correctContact(result);
        if (!result.failure.empty()) return;
        if (!isNewLoad && enough == 0) break;
    }
    result.contactMismatch = coupling_->mismatch();
    // the fluid was solved around the predicted places
    const std::string stray = coupling_->strayBody(strayElements*smallestCutElement());
    if (!stray.empty()) result.failure = "body '" + stray + "' ends more than " + std::to_string(int(strayElements)) + " elements from where it was predicted";
    else result.failure = coupling_->brokenContact(largestSpeed(mesh_, halo_, fluid_.state().u));
}

/// Whether the fluid is to be solved again, with another contact load or because it was asked for what it answers to others.
bool CoupledStep::correctContact(StepResult& result)
{
    const auto findLoads = [&](std::vector<Load>& loads) { scene_.findBodyLoads(loads_, *coupling_, fluid_.newLoadShare(), loads); };
    std::vector<Load>& loads = bodyLoads_;
    findLoads(loads);
    ContactAnswer answer = coupling_->correct(loads);
    if (answer != ContactAnswer::AsksFluid) return answer == ContactAnswer::Changes;
    for (; answer == ContactAnswer::AsksFluid; answer = coupling_->correct(loads))
    {
        for (int k = 0; k < coupling_->nProbes(); ++k)
        {
            coupling_->startProbe(k);
            solveFlow(result, 0);
            if (!result.failure.empty()) break;
            findLoads(probeLoads_);
            coupling_->takeProbe(k, probeLoads_);
        }
        coupling_->finishProbes();
        if (!result.failure.empty()) break;
    }
    return true;
}

/// A step begins without trials.
void CoupledStep::forgetContact()
{
    contactChange_ = 0;
    contactRepeats_ = 0;
}

double CoupledStep::smallestCutElement() const
{
    double h = 1e300;
    for (const CutElement& c : builder_->cover().cuts) h = std::min(h, mesh_.h[c.element]);
    return halo_.min(h);
}

double CoupledStep::bodyCourantRate(double ahead) const
{
    const double speed = fastestSolid(ahead).second;
    if (speed == 0) return 0;
    return speed/smallestCutElement();
}

int CoupledStep::bodiesInContact() const
{
    if (!coupling_) return 0;
    return int(std::count_if(coupling_->contactCounts().begin(), coupling_->contactCounts().end(), [](int n) { return n > 0; }));
}

std::vector<BodyRecord> CoupledStep::records() const
{
    std::vector<BodyRecord> records(scene_.solids().size());
    for (std::size_t s = 0; s < records.size(); ++s)
    {
        const Solid& solid = scene_.solids()[s];
        BodyRecord& r = records[s];
        r.pose = solid.pose;
        r.motion = solid.motion;
        r.fluidForce = loads_[s].force;
        r.fluidMoment = loads_[s].moment;
        r.wetFraction = wet_[s];
        const int body = int(s) - scene_.nStructures();
        if (!coupling_) continue;
        if (body < 0)
        {
            const int wall = scene_.wallOf(int(s));
            if (wall < 0) continue;
            r.contactForce = coupling_->wallLoads()[wall].force;
            r.contactMoment = coupling_->wallLoads()[wall].moment - r.pose.position.cross(r.contactForce);
            r.peakContactForce = coupling_->wallPeaks()[wall];
            r.contacts = coupling_->wallContactCounts()[wall];
            continue;
        }
        r.pose = coupling_->states()[body].pose;
        r.motion = coupling_->states()[body].motion;
        r.contactForce = coupling_->contactLoads()[body].force;
        r.contactMoment = coupling_->contactLoads()[body].moment;
        r.peakContactForce = coupling_->contactPeaks()[body];
        r.contacts = coupling_->contactCounts()[body];
        r.hasLeft = coupling_->presence(body) == Presence::Left;
        r.isAwaited = coupling_->presence(body) == Presence::Awaited;
    }
    return records;
}

void CoupledStep::forgetUnwritten()
{
    fluid_.forgetUnwritten();
    forgetContact();
}

} // namespace flotsam
