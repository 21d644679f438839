// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/basins.hpp"

#include "algebra/exchange.hpp"

#include <algorithm>
#include <numeric>

namespace flotsam
{

int Basins::root(int i)
{
    while (basin_[i] != i) i = basin_[i] = basin_[basin_[i]];
    return i;
}

void Basins::joinLocally(const Cover* cover, const std::vector<int>* isLeftOut)
{
    const int n = mesh_.dim + 1;
    basin_.resize(mesh_.nNodes);
    std::iota(basin_.begin(), basin_.end(), 0);
    lowest_.assign(mesh_.nNodes, -1);
    for (int e = 0; e < mesh_.nElements; ++e)
    {
        if (cover && cover->state[e] == ElementState::Solid) continue;
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        int first = -1;
        for (int a = 0; a < n; ++a)
        {
            const int i = nodes[a];
            if (isLeftOut && (*isLeftOut)[i]) continue;
            if (first < 0) first = root(i);
            if (lowest_[i] < 0) lowest_[i] = double(mesh_.globalNode[i]);
            if (basin_[i] != first) basin_[root(i)] = first;
        }
    }
    for (int i = 0; i < mesh_.nNodes; ++i) basin_[i] = root(i);
}

/// Every basin has one node with its own lowest number, on the rank that owns it.
void Basins::number()
{
    own_.clear();
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (lowest_[i] == double(mesh_.globalNode[i])) own_.push_back(lowest_[i]);
    gatherAll(own_, halo_.comm(), all_);
    count_ = int(all_.size());
    for (int i = 0; i < mesh_.nNodes; ++i) // global numbers ascend with the ranks
        basin_[i] = lowest_[i] < 0 ? -1 : int(std::lower_bound(all_.begin(), all_.end(), lowest_[i]) - all_.begin());
}

void Basins::find(const Cover* cover, const std::vector<int>* isLeftOut)
{
    joinLocally(cover, isLeftOut);
    std::vector<double>& least = least_;
    least.resize(mesh_.nNodes);
    for (bool isMoving = true; halo_.any(isMoving); )
    {
        halo_.update(lowest_, 1); // a second-ring copy may not see the element that makes it fluid
        std::fill(least.begin(), least.end(), double(mesh_.nGlobal));
        for (int i = 0; i < mesh_.nNodes; ++i)
            if (lowest_[i] >= 0) least[basin_[i]] = std::min(least[basin_[i]], lowest_[i]);
        isMoving = false;
        for (int i = 0; i < mesh_.nNodes; ++i)
        {
            if (lowest_[i] < 0 || lowest_[i] == least[basin_[i]]) continue;
            lowest_[i] = least[basin_[i]];
            isMoving = true;
        }
    }
    number();
}

void Basins::haveAny(const std::vector<char>& isNode, std::vector<char>& any) const
{
    any.assign(count_, 0);
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (basin_[i] >= 0 && isNode[i]) any[basin_[i]] = 1;
    MPI_Allreduce(MPI_IN_PLACE, any.data(), count_, MPI_SIGNED_CHAR, MPI_MAX, halo_.comm());
}

} // namespace flotsam
