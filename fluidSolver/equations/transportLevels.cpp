// SPDX-License-Identifier: GPL-3.0-or-later
/// Local time steps of the dual-cell transport: who advances in how many parts.
#include "equations/dualCellTransport.hpp"

#include <algorithm>
#include <array>
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
constexpr int maxLevel = 10;

/// Items of level 1 and above; those of a level stay in their order. `sorted` is working space.
template<class LevelOf>
void sortByFallingLevel(std::vector<int>& items, std::vector<int>& sorted, const LevelOf& levelOf)
{
    std::array<std::size_t, maxLevel + 1> next{};   // per level: place of its next item
    for (int k : items)
    {
        ++next[levelOf(k) - 1];
    }
    for (int l = maxLevel; l > 0; --l)
    {
        next[l - 1] += next[l];
    }
    sorted.resize(items.size());
    for (int k : items)
    {
        sorted[next[levelOf(k)]++] = k;
    }
    items.swap(sorted);
}

} // namespace

void DualCellTransport::findPhases(const std::vector<double>& alpha, int begin, int end)
{
    for (int i = begin; i < end; ++i)
    {
        phase_[i] = alpha[i] <= bulkTolerance ? Empty : alpha[i] >= 1 - bulkTolerance ? Full : Empty | Full;
    }
}

int DualCellTransport::elementLevel(int e) const
{
    const int n = mesh_.dim + 1;
    const int* nodes = &mesh_.elements[std::size_t(e)*n];
    int level = 0;
    for (int a = 0; a < n; ++a)
    {
        level = std::max(level, level_[nodes[a]]);
    }
    return level;
}

/// Fluxes of all elements: their sums at the nodes, and those of the elements that alpha varies in, which are stored.
template<int dim>
void DualCellTransport::sumElementRates(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    std::fill(inflow_.begin(), inflow_.end(), 0.);
    std::fill(outflow_.begin(), outflow_.end(), 0.);
    std::fill(rest_.begin(), rest_.end(), 0.);
    for (int e : stored_) storedAt_[e] = -1;
    stored_.clear();
    for (int e = 0; e < mesh_.nInnerElements; ++e) if (!isBulk<dim>(e)) stored_.push_back(e);
    flux_.resize(stored_.size()*Pairs::count);
    std::size_t position = 0;
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        double flux[Pairs::count];
        volumeFlux_.ofElement<dim>(e, in.u, in.fineScale, in.cover, flux);
        const CornerSums<dim> sums(flux);
        const bool isStored = position < stored_.size() && stored_[position] == e;
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        for (int a = 0; a < n; ++a)
        {
            inflow_[nodes[a]] += sums.in[a];
            outflow_[nodes[a]] += sums.out[a];
            if (!isStored) rest_[nodes[a]] += sums.in[a] - sums.out[a];
        }
        if (!isStored) continue;
        storedAt_[e] = static_cast<int>(position);
        std::copy(flux, flux + Pairs::count, &flux_[position*Pairs::count]);
        ++position;
    }
}

void DualCellTransport::sumOtherRates(const Arguments& in)
{
    for (const PairFlux& pair : in.pairFlux)
    {
        const int from = pair.flux > 0 ? pair.a : pair.b, to = pair.flux > 0 ? pair.b : pair.a;
        outflow_[from] += std::abs(pair.flux);
        inflow_[to] += std::abs(pair.flux);
    }
    for (const BoundaryFlux& b : boundary_.fluxes())
    {
        (b.flux > 0 ? outflow_ : inflow_)[b.node] += std::abs(b.flux);
    }
}

/// Level: parts of the step in which at most transportCourant of the cell's volume flows in.
void DualCellTransport::findNodeLevels(const Arguments& in)
{
    double most = 0;    // share of a cell's volume that flows in during the step
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const double share = inflow_[i]*in.dt/effectiveVolume(i);
        most = std::isfinite(share) ? std::max(most, share) : std::numeric_limits<double>::max();
        level_[i] = share <= controls_.transportCourant
            ? 0 : std::min(maxLevel, int(std::ceil(std::log2(share/controls_.transportCourant) - 1e-9)));
    }
    most = halo_.max(most);
    if (most > std::ldexp(controls_.transportCourant, maxLevel))
    {
        throw std::runtime_error("phase transport: a dual cell takes in " + std::to_string(most)
            + " times its volume in one step of " + std::to_string(in.dt) + " s (at most "
            + std::to_string(std::ldexp(controls_.transportCourant, maxLevel)) + "): the velocity is wrong or the step too long");
    }
    largestLevel_ = most <= controls_.transportCourant ? 0 : int(std::ceil(std::log2(most/controls_.transportCourant) - 1e-9));
    if (halo_.size() > 1)
    {
        halo_.update(level_, 1);
    }

    steppedNodes_.clear();
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (level_[i] > 0)
        {
            steppedNodes_.push_back(i);
        }
    }
    sortByFallingLevel(steppedNodes_, sorted_, [this](int i) { return level_[i]; });
    steppedPairs_.clear();
    for (std::size_t k = 0; k < in.pairFlux.size() && largestLevel_ > 0; ++k)
    {
        if (level_[in.pairFlux[k].a] > 0 || level_[in.pairFlux[k].b] > 0)
        {
            steppedPairs_.push_back(int(k));
        }
    }
    sortByFallingLevel(steppedPairs_, sorted_, [&](int k) { return std::max(level_[in.pairFlux[k].a], level_[in.pairFlux[k].b]); });
}

/// Elements of higher levels exchange several times, and alpha may begin to vary in them on the way: they are stored as well.
template<int dim>
void DualCellTransport::storeSteppedBulk(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        if (storedAt_[e] >= 0 || elementLevel(e) == 0)
        {
            continue;
        }
        storedAt_[e] = static_cast<int>(stored_.size());
        stored_.push_back(e);
        flux_.resize(flux_.size() + Pairs::count);
        double* flux = &flux_[flux_.size() - Pairs::count];
        volumeFlux_.ofElement<dim>(e, in.u, in.fineScale, in.cover, flux);
        const int* nodes = &mesh_.elements[std::size_t(e)*(dim + 1)];
        for (int p = 0; p < Pairs::count; ++p)
        {
            rest_[nodes[Pairs::first[p]]] += flux[p];
            rest_[nodes[Pairs::second[p]]] -= flux[p];
        }
    }
}

/// Positions of the stored elements by level.
void DualCellTransport::sortElements()
{
    const auto levelOf = [this](std::size_t k) { return largestLevel_ > 0 ? elementLevel(stored_[k]) : 0; };
    levelStart_.assign(largestLevel_ + 2, 0);
    for (std::size_t k = 0; k < stored_.size(); ++k)
    {
        ++levelStart_[levelOf(k) + 1];
    }
    for (int l = 0; l <= largestLevel_; ++l)
    {
        levelStart_[l + 1] += levelStart_[l];
    }
    byLevel_.resize(stored_.size());
    std::array<std::size_t, maxLevel + 1> next{};
    std::copy(levelStart_.begin(), levelStart_.end() - 1, next.begin());
    for (std::size_t k = 0; k < stored_.size(); ++k)
    {
        byLevel_[next[levelOf(k)]++] = static_cast<int>(k);
    }
}

void DualCellTransport::findMeetingNodes()
{
    const int n = mesh_.dim + 1;
    for (std::vector<int>& nodes : meeting_)
    {
        for (int i : nodes)
        {
            isMeeting_[i] = 0;
        }
        nodes.clear();
    }
    meeting_.resize(std::max(meeting_.size(), std::size_t(largestLevel_) + 1));
    for (int l = 1; l <= largestLevel_; ++l)
    {
        for (std::size_t k = levelStart_[l]; k < levelStart_[l + 1]; ++k)
        {
            const int* nodes = &mesh_.elements[std::size_t(stored_[byLevel_[k]])*n];
            for (int a = 0; a < n; ++a)
            {
                const int i = nodes[a];
                if (level_[i] < l && !isMeeting_[i])
                {
                    isMeeting_[i] = 1;
                    meeting_[level_[i]].push_back(i);
                }
            }
        }
    }
}

template<int dim>
void DualCellTransport::findLevels(const Arguments& in)
{
    findPhases(in.alpha, 0, mesh_.nNodes);
    sumElementRates<dim>(in);
    sumOtherRates(in);
    findNodeLevels(in);
    if (largestLevel_ > 0)
    {
        storeSteppedBulk<dim>(in);
    }
    nNeeded_ = stored_.size();
    if (isEverywhere_) storeNeedless();
    liquidFlux_.resize(flux_.size());
    sortElements();
    findMeetingNodes();
}

/// All other elements, without fluxes: these are in rest_.
void DualCellTransport::storeNeedless()
{
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        if (storedAt_[e] < 0) stored_.push_back(e);
    }
    flux_.resize(stored_.size()*(mesh_.dim == 2 ? CornerPairs<2>::count : CornerPairs<3>::count), 0.);
}

DualCellTransport::Part DualCellTransport::partAt(int index) const
{
    Part part{index, index == 0 ? 0 : largestLevel_};
    for (int k = index; k > 0 && k % 2 == 0; k /= 2)
    {
        --part.level;
    }
    return part;
}

template void DualCellTransport::findLevels<2>(const Arguments&);
template void DualCellTransport::findLevels<3>(const Arguments&);

} // namespace flotsam
