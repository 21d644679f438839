// SPDX-License-Identifier: GPL-3.0-or-later
/// The phase field's part of a step: its transport, how it goes on in solids, the surface in it and the gravity that follows from that.
#include "equations/fluid.hpp"

#include "equations/gravity.hpp"
#include "equations/materials.hpp"
#include "equations/solidExtension.hpp"
#include "geometry/meanCover.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// As pressure boundaries read it, which make p of p_rgh: what is left in a solid may be the water on its other side.
const std::vector<double>& Fluid::alphaOfPatches()
{
    if (!cover_ || !fluid_.isTwoPhase) return state_.alpha;
    patchAlpha_ = state_.alpha;
    takeFromFluidBeside(mesh_, halo_, *cover_, equation_.isPatchPressureFixed(), patchAlpha_);
    return patchAlpha_;
}

const std::vector<double>& Fluid::halfStep(const std::vector<double>& now, const std::vector<double>& old, double dt,
    std::vector<double>& work) const
{
    if (state_.dt <= 0 || old.size() != now.size()) return now;
    const double e = 0.5*dt/state_.dt;
    work.resize(now.size());
    for (std::size_t k = 0; k < now.size(); ++k) work[k] = now[k] + e*(now[k] - old[k]);
    return work;
}

/// The last solution and gravity are void from here until they are computed anew: they lend their memory, and are left empty.
TransportReport Fluid::advancePhase(double dt)
{
    const std::vector<double>& u = halfStep(state_.u, state_.uOld, dt, x_);
    const std::vector<double>& fine = halfStep(state_.fineScale, state_.fineScaleOld, dt, force_);
    const TransportReport report = transportPhase(dt, u, fine);
    x_.clear();
    force_.clear();
    return report;
}

TransportReport Fluid::transportPhase(double dt, const std::vector<double>& u, const std::vector<double>& fine)
{
    const std::vector<char>& isFixed = equation_.isPatchPressureFixed();
    if (isMoved_) setMeanCover(mesh_, start_, *cover_, during_);
    const Cover* during = isMoved_ ? &during_ : cover_;
    if (!supg_)
    {
        const SurfaceReading surface{level_, planes_, profileRate()};
        return transport_.advance(state_.alpha, dt, u, fine, during, patches_, values_, isFixed, ghostFlux_, cover_, surface.rate > 0 ? &surface : nullptr);
    }
    supg_->setHistory(state_.alphaOlder, state_.dt);
    return supg_->advance(state_.alpha, dt, u, fine, during, patches_, values_, isFixed, ghostFlux_, cover_);
}

void Fluid::setKeptLiquid(double volume)
{
    if (supg_) supg_->setLiquidVolume(volume); else transport_.setLiquidVolume(volume);
}

/// Of the surface's level, in widths: a hundredth of the way that it went in the last time step. Exact at rest, where any other would be a current.
double Fluid::levelTolerance() const
{
    constexpr double share = 1e-2, least = 1e-10, most = 1e-2;
    const double way = longestWay(mesh_, halo_, transport_.width(), state_);
    return std::clamp(share*way, least, most);
}

/// SurfaceReading::rate; 0 where nothing reads the surface.
double Fluid::profileRate() const
{
    const std::array<double, 3>& g = fluid_.gravity;
    return controls_.balancedGravity && !supg_ ? controls_.profileKeeping*std::sqrt(std::hypot(g[0], g[1], g[2])) : 0;
}

/// Planes of the free surface. The level is found once a step. The last solution is void and lends its memory.
void Fluid::findSurface(const Cover* cover)
{
    if (!isLevelKnown_) surfaceLevel_.find(state_.alpha, transport_.width(), profileCells(), cover, levelTolerance(), x_, level_);
    x_.clear();
    isLevelKnown_ = true;
    InterfacePlanes::Extent extent = planesExtent(controls_, transport_.width());
    extent.throughSolids = cover && halo_.any(cover->areSolidsClose);
    planes_.propagate(mesh_, graph_, halo_, level_, extent, cover, true);
}

/// Inside solids the phase field continues the free surface outside: the nearest plane's profile, so that a plane
/// reaching into a solid stays a plane; away from the surface the mean of the neighbours nearer to the fluid. So it is where that differs and the plane comes from farther
/// away than the fluid on this side does: planes are handed on through solids, and what lies dry behind one would turn wet as it moves on.
void Fluid::extendPhase()
{
    constexpr double unlike = 0.01;  // difference of alpha
    constexpr double beside = 10;   // from the surface, in widths: there the profile ends
    extendIntoSolids(mesh_, graph_, halo_, *cover_, state_.alpha, rings_);
    isLevelKnown_ = false;
    findSurface(cover_);
    for (int i : planes_.nodes())
    {
        if (cover_->isActiveNode[i]) continue;
        const double width = transport_.width()[i], mean = profileSlab(profileCells(), i, planes_.normal(i), planes_.distance(i), width).mean();
        double away2 = 0;   // from the plane's own point
        for (int d = 0; d < mesh_.dim; ++d) away2 += std::pow(mesh_.x[std::size_t(i)*mesh_.dim + d] - planes_.point(i)[d], 2);
        const double depth = cover_->distance[i], reach = beside*width;
        level_[i] = planes_.distance(i);    // for the surface's pressure on what solids cover of each other, however far away
        if (std::abs(mean - state_.alpha[i]) > unlike && away2 > depth*depth + reach*reach) continue;
        state_.alpha[i] = mean;
    }
    halo_.update(state_.alpha, 1);
    halo_.update(level_, 1);
}

void Fluid::findDensity(std::vector<double>& rho) const
{
    rho.resize(mesh_.nNodes);
    for (int i = 0; i < mesh_.nNodes; ++i) rho[i] = density(fluid_, controls_, fluid_.isTwoPhase ? state_.alpha[i] : 1);
}

/// Gravity per element, into force_, and what it leaves out of the load on solids, into surfacePressure_; cover: of what is computed. The last solution is void and lends
/// its memory.
void Fluid::setGravity(const Cover* cover)
{
    const bool isBalanced = isGravityBalanced();
    if (isBalanced)
    {
        findSurface(cover_);
        surfaceDensity(mesh_, fluid_, controls_, planes_, cover_, transport_.width(), state_.alpha, surfaceDensity_);
    }
    findDensity(x_);
    gravityForce(mesh_, fluid_.gravity, x_, isBalanced ? &planes_ : nullptr, surfaceDensity_, cover, force_);
    x_.clear();
    surfacePressure_.clear();
    if (isBalanced && cover) addSurfacePressure(mesh_, fluid_, planes_, surfaceDensity_, level_, *cover, surfacePressure_);
}

/// Prescribed pressures as of a sharp surface, and what the profile has besides: by the densities of the profile itself liquid would be drawn through an open top one
/// element above the surface, whose nodes have traces of it. A node's fluid is the one it has more of: in thin sheets planes may be those of their other side. Inside solids
/// as they are.
void Fluid::balancePatchPressures()
{
    const auto isOfProfile = [this](int i) { return planes_.has(i) && !(cover_ && cover_->distance[i] < 0); };
    std::vector<double>& sharp = x_;    // void until the first guess
    sharp = alphaOfPatches();
    for (int i : planes_.nodes())
        if (isOfProfile(i)) sharp[i] = sharp[i] > 0.5;
    const BoundaryState state{state_.time + time_.dt, state_.u.data(), sharp.data(), cover_};
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        if (patches_[p].pressure == BoundaryPatch::Pressure::Natural) continue;
        patches_[p].evaluate(state, sharpValues_);
        values_[p].pressure.swap(sharpValues_.pressure);
        for (std::size_t k = 0; k < patches_[p].nodes.size(); ++k)
        {
            const int i = patches_[p].nodes[k];
            if (isOfProfile(i)) values_[p].pressure[k] += profilePressure(mesh_, fluid_, planes_, surfaceDensity_, i, sharp[i]);
        }
    }
    x_.clear();
}

} // namespace flotsam
