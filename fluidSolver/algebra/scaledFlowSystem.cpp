// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/scaledFlowSystem.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flotsam
{

ScaledFlowSystem::ScaledFlowSystem(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, int patience)
:   mesh_(mesh), graph_(graph), halo_(halo), B_(mesh.dim + 1), velocity_(graph, mesh.nOwned, mesh.dim), choice_(patience),
    pressure_(mesh, graph, halo), heldPressure_(graph, mesh.nOwned), solids_(halo),
    bodyCompliance_(halo, mesh.nOwned)
{
    const std::size_t n = mesh.nOwned;
    scale_.resize(n*B_);
    pointwisePressure_.resize(n);
    local_.resize(std::size_t(mesh.nNodes)*B_);
    pressureLocal_.resize(mesh.nNodes);
    pressureRows_.resize(n);
    gradient_.resize(n*mesh.dim);
}

void ScaledFlowSystem::chooseVelocities(const FlowSystem& system)
{
    choice_.beginStep(system.viscousNumber);
    if (choice_.usesCycles() != bool(viscous_)) pressure_.forget(); // iterations with other velocities say nothing about its age
}

void ScaledFlowSystem::set(const FlowSystem& system)
{
    system_ = &system;
    solids_.set(system);
    if (system.isNewMatrix)
    {
        if (mesh_.dim == 2) setDiagonals<2>(); else setDiagonals<3>();
        setBodyCompliance();
    }
    q_.assign(system.solids.size()*system.nDof, 0.0);
    qRows_ = qWork_ = q_;
    if (system.isNewMatrix) updateHierarchies();
}

void ScaledFlowSystem::updateHierarchies()
{
    for (int i = 0; i < mesh_.nOwned; ++i) pressureRows_[i] = scale_[std::size_t(i)*B_ + B_ - 1];
    if (!choice_.usesCycles()) viscous_.reset();    // before the pressure's needs memory
    pressure_.update(*system_, pressureRows_);
    if (choice_.usesCycles()) updateViscousBlock();
}

/// As old as the pressure's hierarchy.
void ScaledFlowSystem::updateViscousBlock()
{
    const bool isNew = !viscous_;
    if (isNew) viscous_ = std::make_unique<ViscousBlock>(mesh_, graph_, halo_);
    if (isNew || pressure_.isNew()) viscous_->build(*system_, scale_);
    else viscous_->rescale(scale_);
}

/// local_ = approximate inverse of the velocity block times the momentum rows of r.
void ScaledFlowSystem::solveVelocity(const double* r)
{
    if (viscous_) viscous_->solve(r, scale_.data(), local_.data());
    else velocity_.solve(r, scale_.data(), local_.data());
    product().project(local_.data());
    if (!viscous_) velocity_.relaxLightNodes(r, scale_.data(), local_.data());
}

void ScaledFlowSystem::subtractFromVelocity(const double* gradient)
{
    if (viscous_) viscous_->subtract(gradient, local_.data());
    else velocity_.subtractDiagonal(gradient, local_.data());
}

void ScaledFlowSystem::renewHierarchies()
{
    pressure_.forget();
    updateHierarchies();
}

namespace
{

constexpr double carriedVolume = 0.5;   // numerics, 5.10

/// Inverse of the viscous part of the Schur complement. PSPG and ghost terms act beside it and bound the inverse where the fluid part is a sliver.
double viscousPart(double mass, double pspg) { return 1/(mass + pspg); }

/// The V-cycle takes the compact Laplacian for the inertial part of the Schur complement, the divergence of the gradient. This one hardly sees pressures that change sign from node
/// to node: PSPG is all there is of the Schur complement then, a sixth of its diagonal, and the V-cycle's answer is too small by as much.
double roughPart(double pspg, double schur)
{
    constexpr double share = 0.2;   // numerics, 5.1
    return pspg > 0 ? share*(1/pspg - 1/schur) : 0;
}

} // namespace

template<int D>
void ScaledFlowSystem::setDiagonals()
{
    // work vectors of the solve, void before it
    std::vector<double> &ghost = local_, &ghostPressure = pressureLocal_;
    ghost.assign(ghost.size(), 0.0);
    ghostPressure.assign(ghostPressure.size(), 0.0);
    for (const GhostTerm& g : system_->ghosts)
        for (int j = 0; j < D + 2; ++j)
        {
            ghost[g.node[j]] += g.velocityFactor*g.jumpVelocity[j]*g.jumpVelocity[j];
            ghostPressure[g.node[j]] += g.pressureFactor*g.jumpPressure[j]*g.jumpPressure[j];
        }
    if (!choice_.usesCycles()) velocity_.set(*system_, ghost);
    heldPressure_.set(*system_, ghostPressure);
    constexpr double ofDiagonal = 2.0/(D + 2);  // diagonal of a consistent mass matrix over its row's sum: only smooth pressures see the sum
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        double* s = &scale_[std::size_t(i)*B_];
        if (!system_->isActive[i])
        {
            std::fill(s, s + B_, 1.0);
            pointwisePressure_[i] = 0;
            continue;
        }
        const double* a = &system_->matrix.velocity[std::size_t(graph_.diagonal[i])*D*D];
        double trace = 0;
        for (int r = 0; r < D; ++r) trace += a[r*D + r] + ghost[i];
        std::fill(s, s + D, 1/std::sqrt(trace/D));
        const double pspg = system_->matrix.pressure[graph_.diagonal[i]] + ghostPressure[i], schur = schurDiagonal(*system_, graph_, i) + ghostPressure[i];
        pointwisePressure_[i] = float(viscousPart(ofDiagonal*system_->pressureMass[i], pspg) + roughPart(pspg, schur));
        s[D] = 1/std::sqrt(schur);
    }
}

void ScaledFlowSystem::setBodyCompliance()
{
    if (solids_.isEmpty()) return;
    std::vector<double>& pointwise = pressureRows_;     // free here
    for (int i = 0; i < mesh_.nOwned; ++i)
        pointwise[i] = isFreePressure(*system_, i) ? pointwisePressure_[i] + std::pow(scale_[std::size_t(i)*B_ + B_ - 1], 2) : 0;
    bodyCompliance_.set(*system_, solids_, pointwise);
}

/// Takes from the continuity rows of basins without a prescribed pressure what no velocity can balance: volume that surfaces sweep there, spread as the level is weighed,
/// so that gas makes room for it. Returns that volume [m^dim/s], all basins.
double ScaledFlowSystem::balanceContinuity(double* y)
{
    const FlowSystem& s = *system_;
    if (s.nLevels == 0) return 0;
    std::vector<double>& sum = levelSums_;
    sum.assign(s.nLevels, 0.0);
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (s.level[i] >= 0) sum[s.level[i]] += y[std::size_t(i)*B_ + B_ - 1];
    halo_.sum(sum.data(), s.nLevels);
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (s.level[i] >= 0) y[std::size_t(i)*B_ + B_ - 1] -= s.levelWeight[i]*sum[s.level[i]];
    return std::accumulate(sum.begin(), sum.end(), 0.0, [](double all, double v) { return all + std::abs(v); });
}

/// A solve does not change the level of such basins: solids that are partly outside of the mesh or between two of them feel it.
void ScaledFlowSystem::removeMeans(std::vector<double>& p)
{
    const FlowSystem& s = *system_;
    if (s.nLevels == 0) return;
    std::vector<double>& mean = levelSums_;
    mean.assign(s.nLevels, 0.0);
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (s.level[i] >= 0) mean[s.level[i]] += s.levelWeight[i]*p[i];
    halo_.sum(mean.data(), s.nLevels);
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (s.level[i] >= 0) p[i] -= mean[s.level[i]];
}

/// y = scaled rows of (local_, q_); ofPressure: see FlowOperator::fluidRows. The halo of local_ is updated here.
void ScaledFlowSystem::finishProduct(const FlowOperator& op, double* y, const double* ofPressure)
{
    const std::size_t n = std::size_t(mesh_.nOwned)*B_;
    halo_.update(local_.data(), B_);
    op.fluidRows(local_.data(), solids_.isEmpty() ? nullptr : q_.data(), y, ofPressure);
    op.project(y);
    balanceContinuity(y);
    for (std::size_t i = 0; i < n; ++i) y[i] *= scale_[i];
    if (solids_.isEmpty()) return;
    op.solidRows(local_.data(), q_.data(), qRows_.data());
    solids_.addInertia(q_.data(), qRows_.data());
    solids_.writeRows(qRows_, y + n);
}

void ScaledFlowSystem::multiply(const double* x, double* y)
{
    const std::size_t n = std::size_t(mesh_.nOwned)*B_;
    for (std::size_t i = 0; i < n; ++i) local_[i] = x[i]*scale_[i];
    solids_.readVelocity(x + n, q_);
    finishProduct(product(), y, nullptr);
}

/// pressureLocal_ = S^-1 (r_p - D z_u), z_u in local_ and q_.
void ScaledFlowSystem::solvePressure(const double* r)
{
    const FlowSystem& s = *system_;
    product().divergence(local_.data(), solids_.isEmpty() ? nullptr : q_.data(), pressureRows_.data());
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const std::size_t k = std::size_t(i)*B_ + B_ - 1;
        pressureRows_[i] = isFreePressure(s, i) ? r[k]/scale_[k] - pressureRows_[i] : 0;
    }
    pressure_.apply(pressureRows_.data(), pressureLocal_.data());
    heldPressure_.correct(pressureRows_.data(), pressureLocal_.data());
    for (int i = 0; i < mesh_.nOwned; ++i)
        pressureLocal_[i] = isFreePressure(s, i) ? pressureLocal_[i] + pressureRows_[i]*pointwisePressure_[i] : 0;
    if (!solids_.isEmpty()) bodyCompliance_.correct(pressureLocal_.data());
    removeMeans(pressureLocal_);
    halo_.update(pressureLocal_.data(), 1);
}

/// local_ (owned nodes), q_ = preconditioner times r, without the scaling of the columns; gradient_ is that of its pressure.
void ScaledFlowSystem::preconditionUnscaled(const double* r)
{
    const FlowOperator op = product();
    solveVelocity(r);
    halo_.update(local_.data(), B_);
    if (!solids_.isEmpty())
    {
        solids_.readRows(r + std::size_t(mesh_.nOwned)*B_, qRows_);
        solids_.solve(qRows_, q_);
    }
    solvePressure(r);
    op.gradient(pressureLocal_.data(), gradient_.data());
    subtractFromVelocity(gradient_.data());
    for (int i = 0; i < mesh_.nOwned; ++i) local_[std::size_t(i)*B_ + B_ - 1] = pressureLocal_[i];
    op.project(local_.data());
    if (solids_.isEmpty()) return;
    op.solidRowsOfPressure(pressureLocal_.data(), qRows_.data());
    solids_.solve(qRows_, qWork_);
    for (std::size_t k = 0; k < q_.size(); ++k) q_[k] -= qWork_[k];
}

void ScaledFlowSystem::precondition(const double* r, double* z)
{
    const std::size_t n = std::size_t(mesh_.nOwned)*B_;
    preconditionUnscaled(r);
    for (std::size_t i = 0; i < n; ++i) z[i] = local_[i]/scale_[i];
    solids_.writeVelocity(q_, z + n);
}

void ScaledFlowSystem::multiplyPreconditioned(const double* r, double* y)
{
    preconditionUnscaled(r);
    finishProduct(product(), y, gradient_.data());
}

/// Source of the pressure jumps.
void ScaledFlowSystem::addPressureSources(double* r) const
{
    for (const GhostTerm& g : system_->ghosts)
        for (int j = 0; j < mesh_.dim + 2; ++j)
            if (g.node[j] < mesh_.nOwned)
                r[std::size_t(g.node[j])*B_ + B_ - 1] += g.pressureFactor*g.jumpPressure[j]*g.pressureSource;
}

/// Mean; 0 where none is prescribed.
double ScaledFlowSystem::prescribedLevel(const std::vector<double>& x) const
{
    double sums[2] = {0, 0};
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        if (!system_->isActive[i] || !system_->isPressureFixed[i]) continue;
        sums[0] += x[std::size_t(i)*B_ + B_ - 1];
        sums[1] += 1;
    }
    halo_.sum(sums, 2);
    return sums[1] > 0 ? sums[0]/sums[1] : 0;
}

/// From a right-hand side what the level balances in it: tractions of open boundaries. No other rows know constant pressures.
void ScaledFlowSystem::subtractLevel(double* r)
{
    constexpr double relative = 1e-13;  // of sums of products with the level over the tractions
    roundOff_ = 0;
    if (level_ == 0) return;
    std::fill(pressureLocal_.begin(), pressureLocal_.end(), level_);
    product().gradient(pressureLocal_.data(), gradient_.data());
    const int D = B_ - 1;
    double square = 0;
    for (int i = 0; i < mesh_.nOwned; ++i)
        for (int d = 0; d < D; ++d)
        {
            const double traction = gradient_[std::size_t(i)*D + d];
            r[std::size_t(i)*B_ + d] -= traction;
            square += std::pow(traction*scale_[std::size_t(i)*B_ + d], 2);
        }
    roundOff_ = relative*std::sqrt(halo_.sum(square));
}

/// rows = right-hand side minus product, unscaled and projected.
void ScaledFlowSystem::residualRows(const std::vector<double>& x, const std::vector<double>& q, double* rows)
{
    const std::size_t n = std::size_t(mesh_.nOwned)*B_;
    const FlowOperator op = product();
    op.fluidRows(x.data(), system_->solids.empty() ? nullptr : q.data(), rows);
    for (std::size_t i = 0; i < n; ++i) rows[i] = system_->rhs[i] - rows[i];
    addPressureSources(rows);
    op.project(rows);
    unbalancedVolume_ = balanceContinuity(rows);
}

/// Inertia alone outlasts the step: what a solve leaves of stiff rows (slivers held by ghost penalty, viscous layers, walls) is an error of that step only, and carried it would be
/// another one of the next. The share is that of inertia in the row's diagonal. Of continuity half: all of it at once makes the pressure jump.
void ScaledFlowSystem::remainder(const std::vector<double>& x, const std::vector<double>& q, std::vector<double>& rows)
{
    rows.resize(std::size_t(mesh_.nOwned)*B_);
    residualRows(x, q, rows.data());
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const std::size_t k = std::size_t(i)*B_;
        const double share = std::min(1.0, system_->inertia[i]*scale_[k]*scale_[k]);
        for (int d = 0; d < B_ - 1; ++d) rows[k + d] *= share;
        rows[k + B_ - 1] *= carriedVolume;
    }
}

double ScaledFlowSystem::residual(const std::vector<double>& x, const std::vector<double>& velocity, double* r)
{
    const std::size_t n = std::size_t(mesh_.nOwned)*B_;
    const int nd = system_->nDof;
    const FlowOperator op = product();
    std::copy(system_->rhs.begin(), system_->rhs.end(), r);
    addPressureSources(r);
    level_ = prescribedLevel(x);
    subtractLevel(r);
    op.project(r);
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) square += r[i]*scale_[i]*r[i]*scale_[i];
    double* rows = local_.data(); // free here
    residualRows(x, velocity, rows);
    for (std::size_t i = 0; i < n; ++i) r[i] = rows[i]*scale_[i];
    if (!solids_.isEmpty())
    {
        op.solidRows(x.data(), velocity.data(), qRows_.data());
        solids_.addInertia(velocity.data(), qRows_.data());
        for (std::size_t f = 0; f < solids_.free().size(); ++f)
            for (int d = 0; d < nd; ++d)
            {
                const int s = solids_.free()[f];
                const double b = system_->solids[s].rhs[d];
                qRows_[s*nd + d] = b - qRows_[s*nd + d];
                if (halo_.rank() == 0) square += std::pow(b*solids_.scale(int(f), d), 2);
            }
        solids_.writeRows(qRows_, r + n);
    }
    return std::sqrt(halo_.sum(square));
}

double ScaledFlowSystem::forceNorm(const std::vector<double>& x, const double* r)
{
    const FlowOperator op = product();
    const int D = B_ - 1;
    for (int i = 0; i < mesh_.nNodes; ++i) pressureLocal_[i] = x[std::size_t(i)*B_ + D] - level_;
    op.gradient(pressureLocal_.data(), gradient_.data());
    double* force = local_.data(); // free here
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        for (int d = 0; d < D; ++d) force[std::size_t(i)*B_ + d] = gradient_[std::size_t(i)*D + d];
        force[std::size_t(i)*B_ + D] = 0;
    }
    op.project(force);
    double square = 0;
    for (int i = 0; i < mesh_.nOwned; ++i)
        for (std::size_t k = std::size_t(i)*B_; k < std::size_t(i)*B_ + D; ++k) square += std::pow(r[k] + scale_[k]*force[k], 2);
    if (!solids_.isEmpty())
    {
        op.solidRowsOfPressure(pressureLocal_.data(), qRows_.data());
        std::vector<double> rows(solids_.nLocalEntries());
        solids_.writeRows(qRows_, rows.data());
        const double* own = r + std::size_t(mesh_.nOwned)*B_;
        for (std::size_t k = 0; k < rows.size(); ++k) square += std::pow(own[k] + rows[k], 2);
    }
    return std::sqrt(halo_.sum(square));
}

void ScaledFlowSystem::addTo(std::vector<double>& x, std::vector<double>& q, const double* solution)
{
    const std::size_t n = std::size_t(mesh_.nOwned)*B_;
    const int nd = system_->nDof;
    for (std::size_t i = 0; i < n; ++i) x[i] += solution[i]*scale_[i];
    solids_.readVelocity(solution + n, q_);
    for (int s : solids_.free())
        for (int d = 0; d < nd; ++d) q[s*nd + d] += q_[s*nd + d];
    halo_.update(x.data(), B_);
}

} // namespace flotsam
