// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/shutPockets.hpp"

#include "equations/solidExtension.hpp"

#include <algorithm>

namespace flotsam
{

/// From reached nodes over the elements `open_` of this rank, as far as it goes. True when any node was new.
bool ShutPockets::spread()
{
    const int n = mesh_.dim + 1;
    bool isNew = false;
    for (bool isMoving = true; isMoving; )
    {
        isMoving = false;
        for (int e : open_)
        {
            const int* nodes = &mesh_.elements[std::size_t(e)*n];
            const int count = int(std::count_if(nodes, nodes + n, [&](int i) { return isReached_[i] != 0; }));
            if (count == 0 || count == n) continue;
            for (int a = 0; a < n; ++a) isReached_[nodes[a]] = 1;
            isMoving = isNew = true;
        }
    }
    return isNew;
}

void ShutPockets::find(const Cover& cover, const std::vector<char>& isPressureFixed)
{
    const int n = mesh_.dim + 1;
    isReached_.assign(mesh_.nNodes, 1);
    for (int e = 0; e < mesh_.nElements; ++e)
        for (int a = 0; a < n && cover.state[e] != ElementState::Fluid; ++a) isReached_[mesh_.elements[std::size_t(e)*n + a]] = 0;
    for (int i = 0; i < mesh_.nNodes; ++i)
        if (cover.isActiveNode[i] && isPressureFixed[i]) isReached_[i] = 1;
    halo_.update(isReached_, 1);
    open_.clear();
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        if (cover.state[e] != ElementState::Solid && std::any_of(nodes, nodes + n, [&](int i) { return !isReached_[i]; })) open_.push_back(e);
    }
    const bool hasOutside = halo_.any(std::find(isReached_.begin(), isReached_.end(), 1) != isReached_.end());
    while (halo_.any(spread())) halo_.update(isReached_, 1);
    isIn_.assign(mesh_.nNodes, 0);
    isOutside_.assign(mesh_.nNodes, 0);
    for (int i = 0; i < mesh_.nNodes; ++i) (isReached_[i] ? isOutside_ : isIn_)[i] = cover.isActiveNode[i];
    const bool any = std::find(isIn_.begin(), isIn_.begin() + mesh_.nOwned, 1) != isIn_.begin() + mesh_.nOwned;
    if (!halo_.any(any) || !hasOutside) isIn_.clear();
}

void ShutPockets::setPressures(const std::vector<double>& p, const std::vector<double>& rho, const std::array<double, 3>& gravity)
{
    if (isIn_.empty()) return;
    const int dim = mesh_.dim;
    pressure_ = p;
    extendIntoSolids(mesh_, graph_, halo_, isOutside_, pressure_);
    std::vector<double> source(mesh_.nNodes);
    for (int d = 0; d < dim; ++d) // where it was taken from: the same mean of places
    {
        for (int i = 0; i < mesh_.nNodes; ++i) source[i] = mesh_.x[std::size_t(i)*dim + d];
        extendIntoSolids(mesh_, graph_, halo_, isOutside_, source);
        for (int i = 0; i < mesh_.nNodes; ++i)
            if (isIn_[i]) pressure_[i] += rho[i]*gravity[d]*(mesh_.x[std::size_t(i)*dim + d] - source[i]);
    }
}

} // namespace flotsam
