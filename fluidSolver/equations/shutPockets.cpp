// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/shutPockets.hpp"

#include "equations/solidExtension.hpp"

#include <algorithm>

namespace flotsam
{

void ShutPockets::find(const Cover& cover, const std::vector<char>& isPressureFixed)
{
    const int n = mesh_.dim + 1;
    isIn_.clear();
    fluids_.find(&cover, Basins::JoinedBy::FluidNodes);
    std::vector<char> isOpen(mesh_.nNodes, 1); // whole elements all around, or a pressure from a boundary
    for (int e = 0; e < mesh_.nElements; ++e)
        for (int a = 0; a < n && cover.state[e] != ElementState::Fluid; ++a) isOpen[mesh_.elements[std::size_t(e)*n + a]] = 0;
    for (int i = 0; i < mesh_.nNodes; ++i) isOpen[i] |= isPressureFixed[i];
    const std::vector<char> isOutside = fluids_.haveAny(isOpen);
    const auto nOutside = std::count(isOutside.begin(), isOutside.end(), 1);
    if (nOutside == 0 || nOutside == fluids_.count()) return;
    isIn_.resize(mesh_.nNodes);
    isOutside_.resize(mesh_.nNodes);
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        const int f = fluids_.of(i);
        isIn_[i] = f >= 0 && !isOutside[f];
        isOutside_[i] = f >= 0 && isOutside[f];
    }
    addNodesInSolids(cover);
}

/// Those that no element of other fluid holds.
void ShutPockets::addNodesInSolids(const Cover& cover)
{
    const int n = mesh_.dim + 1;
    std::vector<char> isOfPocket(mesh_.nNodes, 0), isOfOther(mesh_.nNodes, 0);
    for (const CutElement& cut : cover.cuts)
    {
        const int* nodes = &mesh_.elements[std::size_t(cut.element)*n];
        const bool isPocket = std::any_of(nodes, nodes + n, [&](int i) { return isIn_[i] && cover.distance[i] > 0; });
        for (int a = 0; a < n; ++a) (isPocket ? isOfPocket : isOfOther)[nodes[a]] = 1;
    }
    for (int i = 0; i < mesh_.nOwned; ++i) isIn_[i] = isIn_[i] || (isOfPocket[i] && !isOfOther[i]);
    halo_.update(isIn_, 1);
}

void ShutPockets::setPressures(const std::vector<double>& p, const std::vector<double>& rho, const std::array<double, 3>& gravity)
{
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
