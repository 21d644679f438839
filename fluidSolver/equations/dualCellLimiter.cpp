// SPDX-License-Identifier: GPL-3.0-or-later
/// The antidiffusive part of the dual-cell transport: where it acts, and how much of it the bounds 0 and 1 leave.
#include "equations/dualCellTransport.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// Limited volumes below this share of an element are not counted.
constexpr double reportedLimit = 1e-3;

} // namespace

/// Acting elements in which alpha varies, and their nodes.
template<int dim>
void DualCellTransport::findActive(const Part& part)
{
    for (int i : activeNodes_)
    {
        isActiveNode_[i] = 0;
    }
    activeNodes_.clear();
    active_.clear();
    activeLevel_.clear();
    for (int l = part.level; l <= largestLevel_; ++l)
    {
        for (std::size_t k = levelStart_[l]; k < levelStart_[l + 1]; ++k)
        {
            const int e = stored_[byLevel_[k]];
            if (std::size_t(byLevel_[k]) < nNeeded_ && isBulk<dim>(e))
            {
                continue;
            }
            active_.push_back(byLevel_[k]);
            activeLevel_.push_back(l);
            const int* nodes = &mesh_.elements[std::size_t(e)*(dim + 1)];
            for (int a = 0; a <= dim; ++a)
            {
                if (!isActiveNode_[nodes[a]])
                {
                    isActiveNode_[nodes[a]] = 1;
                    activeNodes_.push_back(nodes[a]);
                }
            }
        }
    }
    for (int i : activeNodes_)
    {
        open(i);
        limiter_[2*std::size_t(i)] = limiter_[2*std::size_t(i) + 1] = 0;
    }
    findAround<dim>(part);
}

/// All elements around the active nodes in which alpha varies.
template<int dim>
void DualCellTransport::findAround(const Part& part)
{
    aroundActive_.clear();
    if (part.level == 0)    // all act
    {
        for (int e = 0; e < mesh_.nElements; ++e)
        {
            if (isEverywhere_ || !isBulk<dim>(e))
            {
                aroundActive_.push_back(e);
            }
        }
        return;
    }
    for (int i : activeNodes_)
    {
        for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1]; ++k)
        {
            const int e = graph_.nodeElement[k];
            if (!isListed_[e] && !isBulk<dim>(e))
            {
                isListed_[e] = 1;
                aroundActive_.push_back(e);
            }
        }
    }
    for (int e : aroundActive_)
    {
        isListed_[e] = 0;
    }
}

/// Zalesak's limiter with the global bounds 0 and 1: how much of the sums of a node may act, then what acts. One exchange.
template<int dim>
void DualCellTransport::limit(const Arguments& in, TransportReport& report)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const CornerSums<dim> sums(&antiFlux_[k*Pairs::count]);
        const int* nodes = &mesh_.elements[std::size_t(stored_[active_[k]])*n];
        for (int a = 0; a < n; ++a)
        {
            limiter_[2*std::size_t(nodes[a])] += sums.in[a];
            limiter_[2*std::size_t(nodes[a]) + 1] += sums.out[a];
        }
    }
    for (int i : activeNodes_)
    {
        // the smaller over the larger: sums as small as 1e-310 would overflow the other way round
        double* l = &limiter_[2*std::size_t(i)];
        const double room = std::max(0., volume_[i] - liquid_[i]), stock = std::max(0., liquid_[i]);
        l[0] = l[0] > room ? room/l[0] : 1;
        l[1] = l[1] > stock ? stock/l[1] : 1;
    }
    if (halo_.size() > 1)
    {
        halo_.update(limiter_, 2);
    }
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        addLimited<dim>(in, k, report);
    }
}

/// What the limiter leaves of an active element's fluxes.
template<int dim>
void DualCellTransport::addLimited(const Arguments& in, std::size_t k, TransportReport& report)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    const std::size_t at = std::size_t(active_[k]);
    const int e = stored_[at], level = activeLevel_[k];
    const int* nodes = &mesh_.elements[std::size_t(e)*n];
    double* liquidFlux = &liquidFlux_[at*Pairs::count];
    double change[n] = {}, increase[n], decrease[n];
    for (int a = 0; a < n; ++a)
    {
        increase[a] = limiter_[2*std::size_t(nodes[a])];
        decrease[a] = limiter_[2*std::size_t(nodes[a]) + 1];
    }
    for (int p = 0; p < Pairs::count; ++p)
    {
        const int a = Pairs::first[p], b = Pairs::second[p];
        const double flux = antiFlux_[k*Pairs::count + p];
        const double forward = std::min(increase[b], decrease[a]), backward = std::min(increase[a], decrease[b]);
        const double factor = flux > 0 ? forward : backward;
        change[a] -= factor*flux;
        change[b] += factor*flux;
        liquidFlux[p] += factor*flux/in.dt;
        report.nLimited += factor < 1 && (1 - factor)*std::abs(flux) > reportedLimit*mesh_.volume[e] && mesh_.isOwnedElement[e];
    }
    for (int a = 0; a < n; ++a)
    {
        liquid_[nodes[a]] += change[a];
        if (isMeeting_[nodes[a]] && level_[nodes[a]] == level)
        {
            firstLiquid_[nodes[a]] += change[a];
        }
    }
}

template void DualCellTransport::findActive<2>(const Part&);
template void DualCellTransport::findActive<3>(const Part&);
template void DualCellTransport::limit<2>(const Arguments&, TransportReport&);
template void DualCellTransport::limit<3>(const Arguments&, TransportReport&);

} // namespace flotsam
