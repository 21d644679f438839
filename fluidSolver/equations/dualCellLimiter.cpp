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
        for (std::size_t k = storedStart_[l]; k < storedStart_[l + 1]; ++k)
        {
            if (isBulk(stored_[k]))
            {
                continue;
            }
            active_.push_back(k);
            activeLevel_.push_back(l);
            const int* nodes = &mesh_.elements[std::size_t(stored_[k])*(dim + 1)];
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
    findAround();
}

/// All elements around the active nodes in which alpha varies.
void DualCellTransport::findAround()
{
    aroundActive_.clear();
    for (int i : activeNodes_)
    {
        for (int k = graph_.nodeElementStart[i]; k < graph_.nodeElementStart[i + 1]; ++k)
        {
            const int e = graph_.nodeElement[k];
            if (!isListed_[e] && !isBulk(e))
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
    const auto forAllPairs = [&](auto&& act) {
        for (std::size_t k = 0; k < active_.size(); ++k)
        {
            const int* nodes = &mesh_.elements[std::size_t(stored_[active_[k]])*(dim + 1)];
            for (int p = 0; p < Pairs::count; ++p)
            {
                const double flux = antiFlux_[k*Pairs::count + p];
                if (flux != 0)
                {
                    act(flux > 0 ? nodes[Pairs::first[p]] : nodes[Pairs::second[p]],
                        flux > 0 ? nodes[Pairs::second[p]] : nodes[Pairs::first[p]], flux, k, p);
                }
            }
        }
    };
    forAllPairs([&](int from, int to, double signedFlux, std::size_t, int) {
        const double flux = std::abs(signedFlux);
        limiter_[2*std::size_t(to)] += flux;
        limiter_[2*std::size_t(from) + 1] += flux;
    });
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
    forAllPairs([&](int from, int to, double signedFlux, std::size_t k, int p) {
        const double flux = std::abs(signedFlux);
        const int e = stored_[active_[k]];
        const double factor = std::min(limiter_[2*std::size_t(to)], limiter_[2*std::size_t(from) + 1]);
        liquid_[to] += factor*flux;
        liquid_[from] -= factor*flux;
        liquidFlux_[active_[k]*Pairs::count + p] += factor*signedFlux/in.dt;
        const int level = largestLevel_ == 0 ? 0 : elementLevel(e);
        if (isMeeting_[to] && level_[to] == level) firstLiquid_[to] += factor*flux;
        if (isMeeting_[from] && level_[from] == level) firstLiquid_[from] -= factor*flux;
        report.nLimited += factor < 1 && (1 - factor)*flux > reportedLimit*mesh_.volume[e] && mesh_.isOwnedElement[e];
    });
}

template void DualCellTransport::findActive<2>(const Part&);
template void DualCellTransport::findActive<3>(const Part&);
template void DualCellTransport::limit<2>(const Arguments&, TransportReport&);
template void DualCellTransport::limit<3>(const Arguments&, TransportReport&);

} // namespace flotsam
