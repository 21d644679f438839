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
constexpr int maxSubSteps = 1000;

template<int dim>
double dot(const double* a, const double* b)
{
    double s = a[0]*b[0] + a[1]*b[1];
    if constexpr (dim == 3)
    {
        s += a[2]*b[2];
    }
    return s;
}

/// What the dual faces of one element share.
template<int dim>
struct FaceGeometry
{
    static constexpr int n = dim + 1;
    static constexpr DualFaceWeights weights = DualFaceWeights::of(dim);
    const double* x[n];
    const double* u[n];
    double xSum[dim] = {}, uSum[dim] = {};

    FaceGeometry(const SimplexMesh& mesh, const std::vector<double>& velocity, const int* nodes)
    {
        for (int a = 0; a < n; ++a)
        {
            x[a] = &mesh.x[std::size_t(nodes[a])*dim];
            u[a] = &velocity[std::size_t(nodes[a])*dim];
            for (int d = 0; d < dim; ++d)
            {
                xSum[d] += x[a][d];
                uSum[d] += u[a][d];
            }
        }
    }

    static double atFace(double sum, double a, double b) { return weights.far*sum + (weights.near - weights.far)*(a + b); }

    /// Centroid of the dual face (a, b) relative to corner `from`, and the velocity there.
    void evaluate(int a, int b, int from, double* offset, double* velocity) const
    {
        for (int d = 0; d < dim; ++d)
        {
            offset[d] = atFace(xSum[d], x[a][d], x[b][d]) - x[from][d];
            velocity[d] = atFace(uSum[d], u[a][d], u[b][d]);
        }
    }
};

} // namespace

struct DualCellTransport::Arguments
{
    std::vector<double>& alpha;
    double dt;
    const std::vector<double>& u;
    const std::vector<double>& fineScale;
    const Cover* cover;
    const std::vector<PairFlux>& pairFlux;
};

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

double DualCellTransport::liquidOf(const std::vector<double>& alpha) const
{
    double sum = 0;
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        sum += dualVolume_[i]*alpha[i];
    }
    return sum;
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

template<int dim>
void DualCellTransport::storeVolumeFluxes(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    flux_.resize(nInnerActive_*Pairs::count);
    for (std::size_t k = 0; k < nInnerActive_; ++k)
    {
        const int e = activeElements_[k];
        const int* nodes = &mesh_.elements[std::size_t(e)*(dim + 1)];
        double* flux = &flux_[k*Pairs::count];
        volumeFlux_.ofElement<dim>(e, in.u, in.fineScale, in.cover, flux);
        for (int p = 0; p < Pairs::count; ++p)
        {
            const int a = nodes[Pairs::first[p]], b = nodes[Pairs::second[p]];
            const int from = flux[p] > 0 ? a : b, to = flux[p] > 0 ? b : a;
            const double size = std::abs(flux[p]);
            inflowSum_[to] += size;
            gain_[to] += size*(in.alpha[from] - in.alpha[to]);
        }
    }
    for (const PairFlux& pair : in.pairFlux)
    {
        const int from = pair.flux > 0 ? pair.a : pair.b, to = pair.flux > 0 ? pair.b : pair.a;
        inflowSum_[to] += std::abs(pair.flux);
        gain_[to] += std::abs(pair.flux)*(in.alpha[from] - in.alpha[to]);
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

/// antiFlux_ = F (alpha of the profile at the face - alpha of the upwind cell), from the first corner to the second.
template<int dim>
void DualCellTransport::addFaceValues(const Arguments& in, double dt)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    antiFlux_.resize(flux_.size());
    for (std::size_t k = 0; k < nInnerActive_; ++k)
    {
        const int e = activeElements_[k];
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* flux = &flux_[k*Pairs::count];
        double* antiFlux = &antiFlux_[k*Pairs::count];
        const FaceGeometry<dim> geometry(mesh_, in.u, nodes);

        bool hasRoof = false;
        for (int a = 0; a < n; ++a)
        {
            hasRoof = hasRoof || reconstruction_.profile(nodes[a]).kind == NodeProfile::Kind::Roof;
        }
        double gradient[dim] = {}, gradientLength = 1e-30;
        if (hasRoof)
        {
            const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
            for (int a = 0; a < n; ++a)
            {
                for (int d = 0; d < dim; ++d)
                {
                    gradient[d] += reconstruction_.level(nodes[a])*g[a*dim + d];
                }
            }
            gradientLength += std::sqrt(dot<dim>(gradient, gradient));
        }

        for (int p = 0; p < Pairs::count; ++p)
        {
            const int a = Pairs::first[p], b = Pairs::second[p], upwind = flux[p] > 0 ? a : b;
            const NodeProfile& profile = reconstruction_.profile(nodes[upwind]);
            if (profile.kind == NodeProfile::Kind::Bulk || flux[p] == 0)
            {
                antiFlux[p] = 0;
                continue;
            }
            double offset[dim], velocity[dim];
            geometry.evaluate(a, b, upwind, offset, velocity);
            double psi, swept;
            if (profile.kind == NodeProfile::Kind::Front)
            {
                psi = profile.value + profile.steepness*dot<dim>(profile.normal, offset);
                swept = profile.steepness*dt*dot<dim>(profile.normal, velocity);
            }
            else
            {
                const double scale = std::min(profile.roofFactor, 1/gradientLength)*profile.steepness;
                psi = profile.value + scale*dot<dim>(gradient, offset);
                swept = scale*dt*dot<dim>(gradient, velocity);
            }
            antiFlux[p] = flux[p]*(sweptMean(psi, swept) - in.alpha[nodes[upwind]]);
        }
    }
}

/// The Allen-Cahn flux gamma delta grad alpha (1 - 1/|grad level|), which vanishes in the equilibrium profile
/// (ratio form). mobility: gamma [m/s].
template<int dim>
void DualCellTransport::addModelFlux(const Arguments& in, double mobility)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    for (std::size_t k = 0; k < nInnerActive_; ++k)
    {
        const int e = activeElements_[k];
        if (in.cover && in.cover->state[e] != ElementState::Fluid)
        {
            continue;
        }
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double* g = &mesh_.gradN[std::size_t(e)*n*dim];
        double slope[dim] = {}, gradient[dim] = {}, width = 0;
        bool inBand = false;
        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            inBand = inBand || reconstruction_.profile(i).kind != NodeProfile::Kind::Bulk;
            width += width_[i]/n;
            for (int d = 0; d < dim; ++d)
            {
                slope[d] += in.alpha[i]*g[a*dim + d];
                gradient[d] += reconstruction_.level(i)*g[a*dim + d];
            }
        }
        const double length = std::sqrt(dot<dim>(gradient, gradient));
        if (!inBand || length <= 0)
        {
            continue;
        }
        const double factor = mobility*width*(1 - std::min(2., 1/length))*mesh_.volume[e]/n;
        for (int p = 0; p < Pairs::count; ++p)
        {
            antiFlux_[k*Pairs::count + p] -= factor*(dot<dim>(slope, g + Pairs::second[p]*dim) - dot<dim>(slope, g + Pairs::first[p]*dim));
        }
    }
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
        report.nLimited += factor < 1 && (1 - factor)*flux*dt > bulkTolerance*mesh_.volume[e] && mesh_.isOwnedElement[e];
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
        double fastest = 0;
        for (int i = 0; i < mesh_.nOwned; ++i)
        {
            fastest = std::max(fastest, dot<dim>(&in.u[std::size_t(i)*dim], &in.u[std::size_t(i)*dim]));
        }
        mobility = controls_.mobility*std::sqrt(halo_.max(fastest));
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

        std::vector<int>& nodes = activeNodes_;
        reconstruction_.build(in.alpha, activeElements_, nodes, in.cover);
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

/// alpha += c alpha (1 - alpha), |c| <= 1 keeps the bounds and makes the volume linear in c.
void DualCellTransport::restoreVolume(std::vector<double>& alpha, TransportReport& report)
{
    const double target = report.liquidAfter;
    for (int iteration = 0; iteration < 5; ++iteration)
    {
        double sums[2] = {0, 0};
        for (int i = 0; i < mesh_.nOwned; ++i)
        {
            sums[0] += dualVolume_[i]*alpha[i];
            sums[1] += dualVolume_[i]*alpha[i]*(1 - alpha[i]);
        }
        halo_.sum(sums, 2);
        if (iteration == 0)
        {
            report.redistributed = target - sums[0];
        }
        report.liquidAfter = sums[0];
        const double missing = target - sums[0];
        if (sums[1] <= 0 || std::abs(missing) <= 1e-15*std::abs(target))
        {
            return;
        }
        const double c = std::clamp(missing/sums[1], -1., 1.);
        for (int i = 0; i < mesh_.nNodes; ++i)
        {
            alpha[i] += c*alpha[i]*(1 - alpha[i]);
        }
        if (std::abs(missing/sums[1]) <= 1)
        {
            report.liquidAfter = target;
            return;
        }
    }
}

TransportReport DualCellTransport::advance(std::vector<double>& alpha, double dt, const std::vector<double>& u,
    const std::vector<double>& fineScale, const Cover* cover, const std::vector<BoundaryPatch>& patches,
    const std::vector<PatchValues>& values, const std::vector<char>& isPressureFixed, const std::vector<PairFlux>& pairFlux)
{
    TransportReport report;
    useCover(cover);
    const double measured = halo_.sum(liquidOf(alpha));
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
    report.liquidAfter = report.liquidBefore + report.inflow - report.outflow;
    restoreVolume(alpha, report);
    if (cover)
    {
        liquidVolume_ = report.liquidAfter;
    }
    return report;
}

} // namespace flotsam
