// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/dualCellTransport.hpp"

#include "equations/initialProfile.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace flotsam
{

namespace
{

/// alpha closer than this to 0 or 1 is bulk: a divergence-free flux changes nothing there.
constexpr double bulkTolerance = 1e-12;
/// Dual cells that a solid fills to more than 1 - this are moved as if they were this large (time step).
constexpr double smallestCell = 0.3;
/// Limited volumes below this share of an element are not counted.
constexpr double reportedLimit = 1e-3;
constexpr int maxSubSteps = 1000;

} // namespace

DualCellTransport::DualCellTransport(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo,
    const NumericsControls& controls)
    : mesh_(mesh), graph_(graph), halo_(halo), controls_(controls),
      width_(interfaceWidth(mesh, graph, halo, controls.interfaceWidth)), dualVolume_(dualVolumes(mesh, nullptr)),
      wholeVolume_(dualVolume_), cells_(mesh), reconstruction_(mesh, graph, cells_, width_), volumeFlux_(mesh, graph),
      boundary_(mesh, graph, volumeFlux_), liquidVolume_(std::numeric_limits<double>::quiet_NaN()), phase_(mesh.nNodes),
      isActiveNode_(mesh.nNodes, 0), inflowSum_(mesh.nNodes), gain_(mesh.nNodes), limiter_(2*std::size_t(mesh.nNodes))
{
}

double DualCellTransport::effectiveVolume(int i) const
{
    return std::max(dualVolume_[i], smallestCell*wholeVolume_[i]);
}

void DualCellTransport::useCover(const Cover* cover)
{
    if (cover)
    {
        dualVolume_ = dualVolumes(mesh_, cover);
    }
    else if (hasSolids_)
    {
        dualVolume_ = wholeVolume_;
    }
    hasSolids_ = cover != nullptr;
}

/// Elements in which alpha varies, and the nodes that may change in this sub-step.
void DualCellTransport::findActive(const std::vector<double>& alpha, const std::vector<PairFlux>& pairFlux)
{
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        phase_[i] = alpha[i] <= bulkTolerance ? 0 : alpha[i] >= 1 - bulkTolerance ? 1 : 2;
    }
    for (int i : activeNodes_)
    {
        isActiveNode_[i] = 0;
    }
    activeNodes_.clear();
    activeElements_.clear();
    const auto activate = [this](int i) {
        if (!isActiveNode_[i])
        {
            isActiveNode_[i] = 1;
            activeNodes_.push_back(i);
        }
    };

    const int n = mesh_.dim + 1;
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        if (e == mesh_.nInnerElements)
        {
            nInnerActive_ = activeElements_.size();
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const char first = phase_[nodes[0]];
        bool isActive = first == 2;
        for (int a = 1; a < n; ++a)
        {
            isActive = isActive || phase_[nodes[a]] != first;
        }
        if (!isActive)
        {
            continue;
        }
        activeElements_.push_back(e);
        for (int a = 0; a < n && e < mesh_.nInnerElements; ++a)
        {
            activate(nodes[a]);
        }
    }
    if (mesh_.nInnerElements == mesh_.nElements)
    {
        nInnerActive_ = activeElements_.size();
    }
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        if (b.flux < 0 && b.alphaIn >= 0 && b.alphaIn != alpha[b.node])
        {
            activate(b.node);
        }
    }
    for (const PairFlux& pair : pairFlux)
    {
        if (alpha[pair.a] != alpha[pair.b])
        {
            activate(pair.a);
            activate(pair.b);
        }
    }
}

void DualCellTransport::clearSums()
{
    for (int i : activeNodes_)
    {
        inflowSum_[i] = gain_[i] = limiter_[2*std::size_t(i)] = limiter_[2*std::size_t(i) + 1] = 0;
    }
}

void DualCellTransport::addBoundaryInflow(const std::vector<double>& alpha)
{
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        if (b.flux < 0 && b.alphaIn >= 0 && isActiveNode_[b.node])
        {
            inflowSum_[b.node] -= b.flux;
            gain_[b.node] -= b.flux*(b.alphaIn - alpha[b.node]);
        }
    }
}

/// max over all ranks of sum(inflow)/volume [1/s].
double DualCellTransport::largestRate(const Arguments& in)
{
    double rate = 0;
    bool isFinite = true;
    for (int i : activeNodes_)
    {
        if (i < mesh_.nOwned)
        {
            const double r = inflowSum_[i]/effectiveVolume(i);
            isFinite = isFinite && std::isfinite(r);
            rate = std::max(rate, r);
        }
    }
    rate = halo_.max(isFinite ? rate : std::numeric_limits<double>::max());
    if (rate*in.dt > maxSubSteps*controls_.transportCourant)
    {
        throw std::runtime_error("phase transport: a dual cell takes in " + std::to_string(rate*in.dt)
            + " times its volume in one step of " + std::to_string(in.dt) + " s (at most "
            + std::to_string(maxSubSteps*controls_.transportCourant) + "): the velocity is wrong or the step too long");
    }
    return rate;
}

/// Zalesak's limiter with the global bounds 0 and 1: how much of the sums of a node may act. One exchange.
void DualCellTransport::limit(const Arguments& in, double dt)
{
    for (int i : activeNodes_)
    {
        const double room = effectiveVolume(i)/dt;
        const double low = in.alpha[i] + gain_[i]/room;
        double* l = &limiter_[2*std::size_t(i)];
        l[0] = l[0] > 0 ? std::min(1., std::max(0., 1 - low)*room/l[0]) : 1;
        l[1] = l[1] > 0 ? std::min(1., std::max(0., low)*room/l[1]) : 1;
    }
    if (halo_.size() > 1)
    {
        halo_.update(limiter_, 2);
    }
}

template<int dim>
void DualCellTransport::update(const Arguments& in, double dt, TransportReport& report)
{
    using Pairs = CornerPairs<dim>;
    const auto forAllPairs = [&](auto&& act) {
        for (std::size_t k = 0; k < nInnerActive_; ++k)
        {
            const int* nodes = &mesh_.elements[std::size_t(activeElements_[k])*(dim + 1)];
            for (int p = 0; p < Pairs::count; ++p)
            {
                const double flux = antiFlux_[k*Pairs::count + p];
                if (flux != 0)
                {
                    act(flux > 0 ? nodes[Pairs::first[p]] : nodes[Pairs::second[p]],
                        flux > 0 ? nodes[Pairs::second[p]] : nodes[Pairs::first[p]], std::abs(flux), activeElements_[k]);
                }
            }
        }
    };
    forAllPairs([&](int from, int to, double flux, int) {
        limiter_[2*std::size_t(to)] += flux;
        limiter_[2*std::size_t(from) + 1] += flux;
    });
    limit(in, dt);
    forAllPairs([&](int from, int to, double flux, int e) {
        const double factor = std::min(limiter_[2*std::size_t(to)], limiter_[2*std::size_t(from) + 1]);
        gain_[to] += factor*flux;
        gain_[from] -= factor*flux;
        report.nLimited += factor < 1 && (1 - factor)*flux*dt > reportedLimit*mesh_.volume[e] && mesh_.isOwnedElement[e];
    });
    for (int i : activeNodes_)
    {
        if (i < mesh_.nOwned)
        {
            const double value = in.alpha[i] + gain_[i]*dt/effectiveVolume(i);
            report.minAlpha = std::min(report.minAlpha, value);
            report.maxAlpha = std::max(report.maxAlpha, value);
            in.alpha[i] = std::clamp(value, 0., 1.);
        }
    }
    halo_.update(in.alpha, 1);
}

void DualCellTransport::countBoundary(const std::vector<double>& alpha, double dt, TransportReport& report) const
{
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        const double own = alpha[b.node];
        if (b.flux > 0)
        {
            report.outflow += dt*b.flux*own;
        }
        else
        {
            report.inflow -= dt*b.flux*(b.alphaIn >= 0 ? b.alphaIn : own);
        }
    }
}

template<int dim>
void DualCellTransport::advanceAll(const Arguments& in, TransportReport& report)
{
    double mobility = 0;
    if (controls_.mobility > 0)
    {
        mobility = controls_.mobility*largestSpeed(mesh_, halo_, in.u);
    }
    double remaining = in.dt;
    while (remaining > 0)
    {
        findActive(in.alpha, in.pairFlux);
        clearSums();
        storeVolumeFluxes<dim>(in);
        addBoundaryInflow(in.alpha);
        const double rate = largestRate(in);
        const int nLeft = std::max(1, static_cast<int>(std::ceil(remaining*rate/controls_.transportCourant - 1e-9)));
        const double dt = remaining/nLeft;

        reconstruction_.build(in.alpha, activeElements_, activeNodes_, in.cover);
        addFaceValues<dim>(in, dt);
        if (mobility > 0)
        {
            addModelFlux<dim>(in, mobility);
        }
        countBoundary(in.alpha, dt, report);
        update<dim>(in, dt, report);
        remaining = nLeft == 1 ? 0 : remaining - dt;
        ++report.subSteps;
    }
}

TransportReport DualCellTransport::advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
    const std::vector<double>& fineScale, const Cover* cover, const std::vector<BoundaryPatch>& patches,
    const std::vector<PatchValues>& values, const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux)
{
    TransportReport report;
    useCover(cover);
    const double measured = halo_.sum(liquidOf(mesh_, dualVolume_, alpha));
    report.liquidBefore = cover && std::isfinite(liquidVolume_) ? liquidVolume_ : measured;

    boundary_.evaluate(u, fineScale, cover, patches, values, isPressureFixed, pairFlux);
    const Arguments arguments{alpha, dt, u, fineScale, cover, pairFlux};
    if (mesh_.dim == 2)
    {
        advanceAll<2>(arguments, report);
    }
    else
    {
        advanceAll<3>(arguments, report);
    }

    double sums[5] = {report.inflow, report.outflow, double(report.nLimited), double(reconstruction_.nRoofs()),
        double(reconstruction_.nFronts() + reconstruction_.nRoofs())};
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
