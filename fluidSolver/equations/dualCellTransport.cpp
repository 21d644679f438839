// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/dualCellTransport.hpp"

#include "algebra/needlessWork.hpp"
#include "equations/interfaceWidth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

/// Dual cells that a solid fills to more than 1 - this are moved as if they were this large (time step).
constexpr double smallestCell = 0.3;

} // namespace

DualCellTransport::DualCellTransport(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo,
    const NumericsControls& controls,
    const std::array<double, 3>& gravity)
    : mesh_(mesh), graph_(graph), halo_(halo), controls_(controls),
      width_(interfaceWidth(mesh, graph, halo, controls.interfaceWidth, gravity)), dualVolume_(dualVolumes(mesh, nullptr)),
      wholeVolume_(dualVolume_), cells_(mesh), reconstruction_(mesh, graph, cells_, width_), volumeFlux_(mesh, graph),
      boundary_(mesh, graph, volumeFlux_), liquidVolume_(std::numeric_limits<double>::quiet_NaN()), phase_(mesh.nNodes),
      inflow_(mesh.nNodes), outflow_(mesh.nNodes), rest_(mesh.nNodes), level_(mesh.nNodes), storedAt_(mesh.nElements, -1), liquid_(mesh.nNodes),
      volume_(mesh.nNodes), upwind_(mesh.nNodes), isMeeting_(mesh.nNodes, 0), firstLiquid_(mesh.nNodes),
      firstVolume_(mesh.nNodes), isActiveNode_(mesh.nNodes, 0), isListed_(mesh.nElements, 0), limiter_(2*std::size_t(mesh.nNodes)),
      isOpen_(mesh.nNodes, 0), isEverywhere_(doesNeedless("transport"))
{
    cells_.complete(halo);
}

double DualCellTransport::effectiveVolume(int i) const
{
    return std::max(dualVolume_[i], smallestCell*wholeVolume_[i]);
}

void DualCellTransport::useCover(const Cover* cover)
{
    if (cover)
    {
        findDualVolumes(mesh_, cover, dualVolume_);
    }
    else if (hasSolids_)
    {
        dualVolume_ = wholeVolume_;
    }
    hasSolids_ = cover != nullptr;
}

/// The cells whose own time step begins hold what alpha says. They end it with their volume of now: what the flux balance
/// is short of, a solid's surface has swept.
void DualCellTransport::openCells(const Arguments& in, const Part& part)
{
    const auto begin = [&](int i) {
        volume_[i] = effectiveVolume(i) - timeStep(in, level_[i])*(inflow_[i] - outflow_[i]);
        liquid_[i] = in.alpha[i]*volume_[i];
        upwind_[i] = in.alpha[i];
    };
    if (part.level == 0)
    {
        for (int i = 0; i < mesh_.nNodes; ++i)
        {
            begin(i);
        }
    }
    for (int i : steppedNodes_)
    {
        if (level_[i] < part.level)
        {
            break;
        }
        begin(i);
    }
    for (int l = part.level; l <= largestLevel_; ++l)
    {
        for (int i : meeting_[l])
        {
            firstLiquid_[i] = liquid_[i];
            firstVolume_[i] = volume_[i];
        }
    }
    for (int i = 0; i < mesh_.nOwned && part.level == 0; ++i)
    {
        fill(i, in.dt*rest_[i], in.alpha[i]);   // through elements in which alpha does not vary
    }
}

/// Upwind exchange, lower levels first: what a node of a level holds after it, its own level has exchanged.
template<int dim>
void DualCellTransport::addUpwind(const Arguments& in, const Part& part)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    for (int l = part.level; l <= largestLevel_; ++l)
    {
        const double dt = timeStep(in, l), share = dt/in.dt;
        for (std::size_t k = levelStart_[l]; k < levelStart_[l + 1]; ++k)
        {
            const std::size_t at = std::size_t(byLevel_[k]);
            const int* nodes = &mesh_.elements[std::size_t(stored_[at])*n];
            const double* flux = &flux_[at*Pairs::count];
            double* liquidFlux = &liquidFlux_[at*Pairs::count];
            double upwind[n], volume[n] = {}, liquid[n] = {};
            for (int a = 0; a < n; ++a)
            {
                upwind[a] = upwind_[nodes[a]];
            }
            for (int p = 0; p < Pairs::count; ++p)
            {
                const int a = Pairs::first[p], b = Pairs::second[p];
                const double carried = flux[p]*upwind[flux[p] > 0 ? a : b];
                volume[a] -= flux[p];
                volume[b] += flux[p];
                liquid[a] -= carried;
                liquid[b] += carried;
                liquidFlux[p] = (part.index == 0 ? 0 : liquidFlux[p]) + share*carried;
            }
            for (int a = 0; a < n; ++a)
            {
                volume_[nodes[a]] += dt*volume[a];
                liquid_[nodes[a]] += dt*liquid[a];
            }
        }
        for (int i : meeting_[l])
        {
            firstLiquid_[i] = liquid_[i] - firstLiquid_[i];
            firstVolume_[i] = volume_[i] - firstVolume_[i];
        }
    }
}

void DualCellTransport::addBoundary(const Arguments& in, const Part& part, TransportReport& report)
{
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        if (level_[b.node] < part.level)
        {
            continue;
        }
        const double volume = timeStep(in, level_[b.node])*b.flux;
        const double alpha = b.flux < 0 && b.alphaIn >= 0 ? b.alphaIn : upwind_[b.node];
        (b.flux > 0 ? report.outflow : report.inflow) += std::abs(volume)*alpha;
        fill(b.node, -volume, alpha);
        if (alpha != upwind_[b.node])
        {
            open(b.node);
        }
    }
}

void DualCellTransport::addPairs(const Arguments& in, const Part& part)
{
    const auto levelOf = [this](const PairFlux& pair) { return std::max(level_[pair.a], level_[pair.b]); };
    const auto add = [&](const PairFlux& pair) {
        const int level = levelOf(pair);
        const double volume = timeStep(in, level)*pair.flux, alpha = upwind_[volume > 0 ? pair.a : pair.b];
        fill(pair.a, -volume, alpha);
        fill(pair.b, volume, alpha);
        if (upwind_[pair.a] != upwind_[pair.b])
        {
            open(pair.a);
            open(pair.b);
        }
    };
    if (part.level == 0)
    {
        std::for_each(in.pairFlux.begin(), in.pairFlux.end(), add);
        return;
    }
    for (int k : steppedPairs_)
    {
        if (levelOf(in.pairFlux[k]) < part.level)
        {
            break;
        }
        add(in.pairFlux[k]);
    }
}

void DualCellTransport::closeCells(const Arguments& in, const Part& part, TransportReport& report)
{
    for (int i : openNodes_)
    {
        isOpen_[i] = 0;
        if (i >= mesh_.nOwned)
        {
            continue;
        }
        const double value = liquid_[i]/volume_[i];
        report.minAlpha = std::min(report.minAlpha, value);
        report.maxAlpha = std::max(report.maxAlpha, value);
        in.alpha[i] = upwind_[i] = std::clamp(value, 0., 1.);
    }
    for (int l = 0; l < largestLevel_; ++l)
    {
        const int length = 1 << (largestLevel_ - l), elapsed = (part.index + 1) % length;
        for (int i : meeting_[l])
        {
            if (i >= mesh_.nOwned)
            {
                continue;
            }
            const double ahead = elapsed == 0 ? 0 : 1 - double(elapsed)/length;
            const double volume = volume_[i] - ahead*firstVolume_[i];
            const double value = volume > 0 ? (liquid_[i] - ahead*firstLiquid_[i])/volume : upwind_[i];
            in.alpha[i] = std::clamp(value, 0., 1.);
        }
    }
    halo_.update(in.alpha, 1);
    if (halo_.size() > 1)
    {
        halo_.update(upwind_, 1);
    }
    for (int i : openNodes_)
    {
        findPhases(in.alpha, i, i + 1);
    }
    for (const std::vector<int>& nodes : meeting_)
    {
        for (int i : nodes)
        {
            findPhases(in.alpha, i, i + 1);
        }
    }
    findPhases(in.alpha, mesh_.nOwned, mesh_.nNodes);
    openNodes_.clear();
}

template<int dim>
void DualCellTransport::advancePart(const Arguments& in, const Part& part, TransportReport& report)
{
    openCells(in, part);
    findActive<dim>(part);
    addBoundary(in, part, report);
    addUpwind<dim>(in, part);
    addPairs(in, part);
    reconstruction_.build(in.alpha, aroundActive_, activeNodes_, in.cover, in.surface ? &in.surface->distance : nullptr);
    if (part.level == 0)
    {
        report.nRoof = reconstruction_.nRoofs();
        report.nBand = reconstruction_.nFronts() + reconstruction_.nRoofs() + reconstruction_.nFilms();
    }
    addFaceValues<dim>(in);
    if (in.mobility > 0)
    {
        addModelFlux<dim>(in);
    }
    if (in.surface)
    {
        keepProfile<dim>(in);
    }
    limit<dim>(in, report);
    closeCells(in, part, report);
}

template<int dim>
void DualCellTransport::advanceAll(const Arguments& in, TransportReport& report)
{
    findLevels<dim>(in);
    report.subSteps = 1 << largestLevel_;
    for (int k = 0; k < report.subSteps; ++k)
    {
        advancePart<dim>(in, partAt(k), report);
    }
}

DualCellTransport::ElementFluxes DualCellTransport::fluxes(int e) const
{
    if (storedAt_[e] < 0)
    {
        return {nullptr, nullptr};
    }
    const std::size_t at = std::size_t(storedAt_[e])*(mesh_.dim == 2 ? CornerPairs<2>::count : CornerPairs<3>::count);
    return {&flux_[at], &liquidFlux_[at]};
}

TransportReport DualCellTransport::advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
    const std::vector<double>& fineScale, const Cover* cover, const std::vector<BoundaryPatch>& patches,
    const std::vector<PatchValues>& values, const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux, const Cover* atEnd,
    const SurfaceReading* surface)
{
    TransportReport report;
    useCover(atEnd ? atEnd : cover);
    const double measured = halo_.sum(liquidOf(mesh_, dualVolume_, alpha));
    report.liquidBefore = cover && std::isfinite(liquidVolume_) ? liquidVolume_ : measured;

    boundary_.evaluate(u, fineScale, cover, patches, values, isPressureFixed, pairFlux);
    const double mobility = controls_.mobility > 0 ? controls_.mobility*largestSpeed(mesh_, halo_, u) : 0;
    const Arguments arguments{alpha, dt, u, fineScale, cover, pairFlux, mobility, surface};
    if (mesh_.dim == 2)
    {
        advanceAll<2>(arguments, report);
    }
    else
    {
        advanceAll<3>(arguments, report);
    }

    double sums[5] = {report.inflow, report.outflow, double(report.nLimited), double(report.nRoof),
        double(report.nBand)};
    halo_.sum(sums, 5);
    report.inflow = sums[0];
    report.outflow = sums[1];
    report.nLimited = std::lround(sums[2]);
    report.nRoof = std::lround(sums[3]);
    report.nBand = std::lround(sums[4]);
    report.minAlpha = halo_.min(report.minAlpha);
    report.maxAlpha = halo_.max(report.maxAlpha);
    restoreLiquid(mesh_, halo_, dualVolume_, alpha, report);
    if (cover)
    {
        liquidVolume_ = report.liquidAfter;
    }
    return report;
}

} // namespace flotsam
