// SPDX-License-Identifier: GPL-3.0-or-later
/// Basins in which no boundary prescribes a pressure: each keeps the mean of its gas at FluidProperties::pRefValue.
#include "equations/flowEquation.hpp"

#include "equations/basins.hpp"
#include "equations/shutPockets.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double leastGas = 1e-3;   // of a basin's volume: with less its level is the mean of all
constexpr int byBoundary = -1;      // no level to keep

/// Level of every basin: first their own numbers, byBoundary where a pressure is prescribed.
void setOwnLevels(const std::vector<char>& hasPressure, std::vector<int>& level)
{
    level.resize(hasPressure.size());
    for (std::size_t b = 0; b < level.size(); ++b) level[b] = hasPressure[b] ? byBoundary : int(b);
}

/// 0, 1, ... for the levels that are left; returns how many. kept: work.
int renumber(std::vector<int>& level, std::vector<int>& kept)
{
    kept = level;
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    kept.erase(kept.begin(), std::upper_bound(kept.begin(), kept.end(), byBoundary));
    for (int& l : level)
        if (l != byBoundary) l = int(std::lower_bound(kept.begin(), kept.end(), l) - kept.begin());
    return int(kept.size());
}

} // namespace

/// Volume of every basin that has a level to keep, then of its gas (2*count). Collective.
void FlowEquation::findLevelVolumes(const std::vector<int>& level, std::vector<double>& volume) const
{
    volume.assign(2*level.size(), 0.0);
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        const int b = step_.basins->of(i);
        if (b < 0 || level[b] == byBoundary) continue;
        volume[2*b] += system_.dualVolume[i];
        volume[2*b + 1] += system_.dualVolume[i]*gasShare(i);
    }
    halo_.sum(volume.data(), int(volume.size()));
}

/// Liquid without gas that a free body divides from other fluid presses on the body: its level is no matter of choice, but what the body's motion, which must
/// keep the volume, makes it. The body's equation ties it to that of the fluid on the body's other side. Shut pockets are no fluid of their own.
void FlowEquation::joinByBodies(const std::vector<char>& hasGas, std::vector<int>& level) const
{
    const auto isTied = [&](int b) { return b >= 0 && level[b] != byBoundary && !hasGas[b]; };
    bool hasTied = false;
    for (std::size_t b = 0; b < level.size(); ++b) hasTied = hasTied || isTied(int(b));
    if (!hasTied) return;
    std::vector<int> least(system_.solids.size());
    for (bool isMoving = true; isMoving; )
    {
        for (std::size_t s = 0; s < system_.solids.size(); ++s)
        {
            least[s] = int(level.size());
            if (!system_.solids[s].isFree) continue;
            for (int i : system_.solids[s].node)
            {
                const int b = step_.basins->of(i);
                if (b >= 0 && !(step_.pockets && step_.pockets->isNode(i))) least[s] = std::min(least[s], isTied(b) ? level[b] : byBoundary);
            }
        }
        MPI_Allreduce(MPI_IN_PLACE, least.data(), int(least.size()), MPI_INT, MPI_MIN, halo_.comm());
        std::vector<int> joined(level);
        for (std::size_t s = 0; s < system_.solids.size(); ++s)
            for (int i : system_.solids[s].node)
            {
                const int b = step_.basins->of(i);
                if (isTied(b)) joined[b] = std::min(joined[b], least[s]);
            }
        MPI_Allreduce(MPI_IN_PLACE, joined.data(), int(joined.size()), MPI_INT, MPI_MIN, halo_.comm());
        isMoving = joined != level;
        level = joined;
    }
}

void FlowEquation::findPressureLevels()
{
    system_.nLevels = 0;
    system_.level.clear();
    system_.levelWeight.clear();
    auto& [isGiven, hasPressure, hasGas, level, kept, volume, sum] = levels_;
    isGiven = system_.isPressureFixed;
    for (int i = 0; i < mesh_.nNodes; ++i) isGiven[i] |= isPressureWeak_[i];
    step_.basins->haveAny(isGiven, hasPressure);
    setOwnLevels(hasPressure, level);
    if (std::count(level.begin(), level.end(), byBoundary) == long(level.size())) return;
    findLevelVolumes(level, volume);
    hasGas.resize(level.size());
    for (std::size_t b = 0; b < level.size(); ++b) hasGas[b] = volume[2*b + 1] > leastGas*volume[2*b];
    joinByBodies(hasGas, level);
    system_.nLevels = renumber(level, kept);
    sum.assign(system_.nLevels, 0.0); // of what the mean is over
    for (std::size_t b = 0; b < level.size(); ++b)
        if (level[b] != byBoundary) sum[level[b]] += volume[2*b + hasGas[b]];
    system_.level.assign(mesh_.nNodes, byBoundary);
    system_.levelWeight.assign(mesh_.nOwned, 0.0);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        const int b = step_.basins->of(i);
        if (b < 0 || level[b] == byBoundary) continue;
        system_.level[i] = level[b];
        if (i < mesh_.nOwned) system_.levelWeight[i] = system_.dualVolume[i]*(hasGas[b] ? gasShare(i) : 1)/sum[level[b]];
    }
}

void FlowEquation::setPressureLevel(std::vector<double>& x)
{
    if (system_.nLevels == 0) return;
    const int dim = mesh_.dim, B = dim + 1;
    std::vector<double>& mean = levels_.sum;
    mean.assign(system_.nLevels, 0.0);
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (system_.level[i] >= 0) mean[system_.level[i]] += system_.levelWeight[i]*x[std::size_t(i)*B + dim];
    halo_.sum(mean.data(), system_.nLevels);
    for (int i = 0; i < mesh_.nNodes; ++i)
        if (system_.level[i] >= 0) x[std::size_t(i)*B + dim] += fluid_.pRefValue - mean[system_.level[i]];
}

} // namespace flotsam
