// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/ghostHeldNodes.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

constexpr double leastShift = 1e-6; // of the diagonal: a group may have no hold but itself

} // namespace

void GhostHeldNodes::find(const std::vector<double>& ofGhosts, const std::vector<double>& ofElements, const std::vector<char>& isExcluded)
{
    nodes_.clear();
    for (int i = 0; i < int(isExcluded.size()); ++i)
        if (!isExcluded[i] && ofGhosts[i] > std::max(ofElements[i], 0.0)) nodes_.push_back(i);
}

int GhostHeldNodes::position(int node) const
{
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    return at != nodes_.end() && *at == node ? int(at - nodes_.begin()) : -1;
}

void GhostHeldNodes::factor(const Entries& entries, int nValues)
{
    values_.resize(Eigen::Index(nodes_.size()), nValues);
    if (!matrix_.factor(int(nodes_.size()), entries, leastShift)) nodes_.clear();   // each by its own diagonal then
}

} // namespace flotsam
