// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/fluid.hpp"

#include "equations/initialProfile.hpp"
#include "equations/rigidCoupling.hpp"
#include "geometry/meanCover.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace flotsam
{

Fluid::Fluid(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const NumericsControls& controls,
    const std::vector<BoundaryPatch>& patches)
:   mesh_(mesh), halo_(halo), graph_(mesh), elementHalo_(mesh, graph_, halo), fluid_(fluid), controls_(controls), patches_(patches), values_(patches.size()),
    equation_(mesh, graph_, halo, fluid_, controls_, patches_), solver_(mesh, graph_, halo, controls_),
    transport_(mesh, graph_, halo, controls_, fluid_.gravity), massFluxes_(mesh, fluid_, controls_), surfaceLevel_(mesh, halo, fluid_.gravity), basins_(mesh, halo), pockets_(mesh, graph_, halo)
{
    if (controls_.gasDepth > 0 && fluid_.isTwoPhase) gas_ = std::make_unique<GasRegion>(mesh, halo, controls_.gasDepth);
    if (!controls_.dualCellTransport) supg_ = std::make_unique<PhaseFieldSupg>(mesh, graph_, halo, controls_, fluid_.gravity);
}

void Fluid::forgetFaces()
{
    if (gas_) return;
    std::vector<InteriorFace>().swap(graph_.faces);
    transport_.forgetFaces();
}

void Fluid::start(FlowState state, bool isSharp)
{
    state_ = std::move(state);
    isLevelKnown_ = false;
    const std::size_t n = std::size_t(mesh_.nNodes)*mesh_.dim;
    if (state_.uOld.size() != n) state_.uOld = state_.u;
    if (state_.pOld.size() != state_.p.size()) state_.pOld = state_.p;
    if (!fluid_.isTwoPhase) state_.alpha.assign(mesh_.nNodes, 1.0);
    else if (isSharp)
    {
        makeStartProfile(mesh_, graph_, halo_, transport_.width(), state_.alpha, state_.startLiquid, profileCells());
        state_.startLiquid = {};
    }
    if (isSharp || state_.alphaOld.size() != state_.alpha.size()) state_.alphaOld = state_.alphaOlder = state_.alpha;
    const std::size_t fine = std::size_t(mesh_.nElements)*mesh_.dim;
    if (state_.fineScale.size() != fine)
    {
        state_.fineScale.assign(fine, 0.0);
        state_.fineScaleOld.assign(fine, 0.0);
    }
}

void Fluid::setGeometry(const Cover* cover, const std::vector<Solid>* solids, bool hasChanged)
{
    cover_ = cover;
    solids_ = solids;
    areBasinsOld_ = true;
    if (cover && hasChanged && fluid_.isTwoPhase) extendPhase();
}

void Fluid::evaluatePatches(double time)
{
    const BoundaryState state{time, state_.u.data(), alphaOfPatches().data(), cover_};
    for (std::size_t p = 0; p < patches_.size(); ++p) patches_[p].evaluate(state, values_[p]);
}

std::vector<double> Fluid::ghostFluxes() const
{
    std::vector<double> triples;
    triples.reserve(3*ghostFlux_.size());
    for (const PairFlux& f : ghostFlux_) triples.insert(triples.end(), {double(f.a), double(f.b), f.flux});
    return triples;
}

void Fluid::setGhostFluxes(const std::vector<double>& triples)
{
    ghostFlux_.clear();
    for (std::size_t k = 0; k + 2 < triples.size(); k += 3)
        ghostFlux_.push_back({int(triples[k]), int(triples[k + 1]), triples[k + 2]});
}

void Fluid::setRemainder(const std::vector<double>& rows)
{
    const std::size_t expected = equation_.system().rhs.size();
    if (!rows.empty() && rows.size() != expected)
        throw std::runtime_error("restart: the stored 'remainder' holds " + std::to_string(rows.size()) + " values, the mesh has " + std::to_string(expected));
    state_.remainder = rows;
}

void Fluid::forgetCovered(const Cover& before)
{
    massFluxes_.drop([&](int e) { return cover_->state[e] != before.state[e]; });
    const auto isCovered = [&](int i) { return before.isActiveNode[i] && !cover_->isActiveNode[i]; };
    const std::size_t B = mesh_.dim + 1;
    for (std::size_t i = 0; (i + 1)*B <= state_.remainder.size(); ++i)
        if (isCovered(int(i))) std::fill_n(state_.remainder.begin() + std::ptrdiff_t(i*B), B, 0.0);
    const auto isVoid = [&](const PairFlux& f) { return isCovered(f.a) || isCovered(f.b); };
    ghostFlux_.erase(std::remove_if(ghostFlux_.begin(), ghostFlux_.end(), isVoid), ghostFlux_.end());
}

void Fluid::keepGeometry()
{
    if (!fluid_.isTwoPhase) return;
    if (!std::isfinite(keptLiquid())) setKeptLiquid(liquidVolume()/mesh_.thickness);
    keepForMean(*cover_, start_);
    isMoved_ = true;
}

TransportReport Fluid::beginStep(double dt)
{
    before_.alpha = state_.alpha;
    before_.alphaOld = state_.alphaOld;
    before_.alphaOlder = state_.alphaOlder;
    liquidBefore_ = keptLiquid();
    time_ = TimeScheme::bdf(controls_.timeOrder, dt, state_.dt);
    TransportReport report;
    if (fluid_.isTwoPhase)
    {
        evaluatePatches(state_.time + 0.5*dt);
        if (profileRate() > 0 && !isLevelKnown_) findSurface(isMoved_ ? &start_ : cover_);
        isLevelKnown_ = false;
        state_.alphaOlder = state_.alphaOld;
        state_.alphaOld = state_.alpha;
        report = advancePhase(dt);
        if (isMoved_) extendPhase();
    }
    isMoved_ = false;
    evaluatePatches(state_.time + dt);
    return report;
}

/// cover: of what is computed.
void Fluid::findBasins(const Cover* cover)
{
    if (!areBasinsOld_ && !gas_) return;
    areBasinsOld_ = false;
    basins_.find(cover);
    if (!cover_) return;
    isFixed_ = equation_.isPatchPressureFixed();
    for (int i = 0; gas_ && i < mesh_.nNodes; ++i) isFixed_[i] |= gas_->isEdge()[i];
    pockets_.find(*cover, isFixed_);
}

void Fluid::setPocketPressures()
{
    if (!pockets_.areAny()) return;
    std::array<double, 3> gravity{};
    for (int d = 0; d < mesh_.dim; ++d) gravity[d] = fluid_.gravity[mesh_.axes[d]];
    findDensity(x_);
    pockets_.setPressures(state_.p, x_, gravity);
    x_.clear();
}

void Fluid::assemble()
{
    const Cover* cover = cover_;
    if (gas_)
    {
        gas_->choose(state_.alpha, cover_);
        cover = &gas_->cover(cover_);
    }
    setGravity(cover);
    if (isGravityBalanced()) balancePatchPressures();
    findBasins(cover);
    if (cover_) setPocketPressures();
    FlowStepData step;
    step.time = time_;
    step.gravity = std::hypot(fluid_.gravity[0], fluid_.gravity[1], fluid_.gravity[2]);
    if (step.gravity == 0) step.speed = largestSpeed(mesh_, halo_, state_.u);
    step.state = &state_;
    step.cover = cover;
    step.gas = gas_.get();
    step.basins = &basins_;
    step.pockets = cover_ ? &pockets_ : nullptr;
    step.solids = solids_;
    step.patchValues = &values_;
    step.elementForce = &force_;
    step.level = isGravityBalanced() ? &level_ : nullptr;
    step.surfacePressure = &surfacePressure_;
    step.fineScale = &state_.fineScale;
    step.transport = fluid_.isTwoPhase && !supg_ ? &transport_ : nullptr;
    step.massFluxes = step.transport && controls_.surfaceTimeOrder == 2 ? &massFluxes_ : nullptr;
    equation_.assemble(step);
    carryRemainder();
    equation_.system().isNewMatrix = true;
    equation_.system().isFirst = isFirstStep();
    setFirstGuess();
}

void Fluid::assembleAgain()
{
    equation_.assembleAgain();
    carryRemainder();
}

/// Impulse and volume that the last solve has left go into this one's right-hand side: solves leave the same sign in step after step, and that would add up.
void Fluid::carryRemainder()
{
    if (!controls_.carryRemainder) return;
    std::vector<double>& rhs = equation_.system().rhs;
    const double steps = state_.dt/time_.dt;
    for (std::size_t k = 0; k < state_.remainder.size(); ++k) rhs[k] += steps*state_.remainder[k];
}

/// Velocity and pressure extrapolated in time (10 to 20 % less time than with the last pressure); solids with the velocity they have.
void Fluid::setFirstGuess()
{
    const int dim = mesh_.dim, B = dim + 1, nDof = equation_.system().nDof;
    x_.resize(std::size_t(mesh_.nNodes)*B);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        for (int d = 0; d < dim; ++d)
        {
            const std::size_t k = std::size_t(i)*dim + d;
            x_[std::size_t(i)*B + d] = state_.u[k] + time_.extrapolation*(state_.u[k] - state_.uOld[k]);
        }
        x_[std::size_t(i)*B + dim] = state_.p[i] + time_.extrapolation*(state_.p[i] - state_.pOld[i]);
    }
    equation_.setPressureLevel(x_); // else the extrapolation lets it drift
    equation_.applyConstraints(values_, x_);
    q_.assign(solids_ ? solids_->size()*nDof : 0, 0.0);
    for (std::size_t s = 0; solids_ && s < solids_->size(); ++s) solidVelocity(mesh_, (*solids_)[s], &q_[s*nDof]);
}

SolveReport Fluid::solve(const std::vector<FreeBody>& bodies, double enough)
{
    equation_.setFreeBodies(bodies, time_.dt);
    solver_.setSystem(equation_.system());
    const SolveReport report = solver_.solve(x_, q_, enough);
    equation_.system().isNewMatrix = false;
    return report;
}

std::vector<Fluid::SolidLoad> Fluid::solidLoads()
{
    std::vector<SolidLoad> loads;
    findSolidLoads(loads);
    return loads;
}

void Fluid::findSolidLoads(std::vector<SolidLoad>& loads)
{
    const FlowSystem& system = equation_.system();
    std::vector<double>& rows = solidRows_;
    rows.assign(q_.size(), 0.0);
    FlowOperator(graph_, halo_, system, mesh_.nOwned).solidRows(x_.data(), q_.data(), rows.data());
    for (std::size_t s = 0; s < system.solids.size(); ++s)
        for (int d = 0; d < system.nDof; ++d) rows[s*system.nDof + d] -= system.solids[s].load[d];
    equation_.addBeyondRows(q_, rows);
    loads.assign(system.solids.size(), {Vec3::Zero(), Vec3::Zero()});
    for (std::size_t s = 0; s < loads.size(); ++s)
    {
        const double* r = &rows[s*system.nDof];
        if (mesh_.dim == 2)
        {
            for (int d = 0; d < 2; ++d) loads[s].force[mesh_.axes[d]] = -mesh_.thickness*r[d];
            loads[s].moment[mesh_.axes[2]] = -mesh_.thickness*r[2];
        }
        else for (int d = 0; d < 3; ++d) { loads[s].force[d] = -r[d]; loads[s].moment[d] = -r[3 + d]; }
    }
}

std::vector<Motion> Fluid::solidMotions() const
{
    std::vector<Motion> motions;
    findSolidMotions(motions);
    return motions;
}

void Fluid::findSolidMotions(std::vector<Motion>& motions) const
{
    motions.clear();
    const int nDof = equation_.system().nDof;
    for (std::size_t s = 0; solids_ && s < solids_->size(); ++s)
    {
        Motion m;
        const double* q = &q_[s*nDof];
        if (mesh_.dim == 2)
        {
            for (int d = 0; d < 2; ++d) m.velocity[mesh_.axes[d]] = q[d];
            m.angularVelocity[mesh_.axes[2]] = q[2];
        }
        else for (int d = 0; d < 3; ++d) { m.velocity[d] = q[d]; m.angularVelocity[d] = q[3 + d]; }
        motions.push_back(m);
    }
}

/// Nodes inside solids carry the rigid velocity: it is the history of a node that the solid uncovers later.
void Fluid::moveInactiveNodes()
{
    if (!cover_ || !solids_) return;
    findSolidMotions(motions_);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (cover_->isActiveNode[i] || cover_->nearestSolid[i] < 0) continue;
        const int s = cover_->nearestSolid[i];
        const std::array<double, 3> p = mesh_.spacePoint(i);
        const Vec3 r = Vec3(p[0], p[1], p[2]) - (*solids_)[s].pose.position;
        const Vec3 v = motions_[s].velocity + motions_[s].angularVelocity.cross(r);
        for (int d = 0; d < mesh_.dim; ++d)
        {
            state_.u[std::size_t(i)*mesh_.dim + d] = v[mesh_.axes[d]];
            state_.uOld[std::size_t(i)*mesh_.dim + d] = v[mesh_.axes[d]];
        }
    }
}

/// Inside solids, too, nodes of patches keep the velocity that these prescribe: the transport's next step has it where a solid uncovers an inlet.
void Fluid::keepInlets()
{
    if (!cover_) return;
    const std::size_t dim = mesh_.dim;
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        if (patches_[p].velocity != BoundaryPatch::Velocity::Fixed || patches_[p].isNoSlipWall) continue;
        for (std::size_t k = 0; k < patches_[p].nodes.size(); ++k)
        {
            const std::size_t i = patches_[p].nodes[k];
            if (cover_->isActiveNode[i]) continue;
            for (std::size_t d = 0; d < dim; ++d) state_.u[i*dim + d] = state_.uOld[i*dim + d] = values_[p].velocity[k*dim + d];
        }
    }
}

void Fluid::watchPatches(const std::vector<int>& patches)
{
    equation_.system().areForcesAsked = true;
    patchForces_ = std::make_unique<PatchForces>(mesh_, halo_, patches_, patches);
}

/// Walls feel a sharp surface's pressure, as solids do.
void Fluid::findPatchForces()
{
    patchForces_->start();
    equation_.addPatchForces(x_, q_, *patchForces_);
    for (std::size_t k = 0; k < patches_.size() && isGravityBalanced(); ++k)
    {
        if (!patchForces_->isAsked(int(k))) continue;
        std::vector<FacetPressure> onFaces;
        addSurfacePressure(mesh_, fluid_, planes_, surfaceDensity_, level_, cover_, mesh_.patches[patches_[k].meshPatch], onFaces);
        for (const FacetPressure& p : onFaces) patchForces_->addFacet(int(k), p.element, p.first, p.normal);
    }
    patchForces_->finish();
}

void Fluid::endStep()
{
    const int dim = mesh_.dim, B = dim + 1;
    if (controls_.carryRemainder) solver_.remainder(x_, q_, state_.remainder); else state_.remainder.clear();
    if (patchForces_) findPatchForces();
    equation_.fineScale(x_, state_.fineScaleOld);   // before the time levels move on: of the step's own residual, that of the continuity rows
    elementHalo_.update(state_.fineScaleOld, dim);  // counts in the ghost penalty of faces to the second ring
    std::swap(state_.fineScale, state_.fineScaleOld);
    std::swap(state_.u, state_.uOld);
    state_.pOld = state_.p;
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        for (int d = 0; d < dim; ++d) state_.u[std::size_t(i)*dim + d] = x_[std::size_t(i)*B + d];
        state_.p[i] = x_[std::size_t(i)*B + dim];
    }
    if (isFirstStep()) state_.pOld = state_.p;  // that of the start is no solution: extrapolated with it the next step would start as far off as from zero
    moveInactiveNodes();
    keepInlets();
    equation_.ghostFluxes(x_, ghostFlux_);
    if (fluid_.isTwoPhase && !supg_ && controls_.surfaceTimeOrder == 2) massFluxes_.keep(transport_, state_.alphaOld, state_.alpha);
    state_.dt = time_.dt;
    state_.time += time_.dt;
}

void Fluid::rejectStep()
{
    state_.alpha = before_.alpha;
    state_.alphaOld = before_.alphaOld;
    state_.alphaOlder = before_.alphaOlder;
    setKeptLiquid(liquidBefore_);
    isMoved_ = false;
    isLevelKnown_ = false;
    solver_.forgetPreconditioner(); // what failed may have been its
}

void Fluid::forgetUnwritten()
{
    solver_.forgetPreconditioner();
    if (gas_) gas_->forget();
    isLevelKnown_ = false;
}

bool Fluid::isFinite() const
{
    bool isBad = false;
    for (double v : x_) isBad = isBad || !std::isfinite(v);
    for (double v : q_) isBad = isBad || !std::isfinite(v);
    return !halo_.any(isBad);
}

} // namespace flotsam
