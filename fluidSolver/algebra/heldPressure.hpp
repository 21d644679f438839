// SPDX-License-Identifier: GPL-3.0-or-later
/// What a V-cycle on the Schur approximation leaves at the nodes whose pressures ghost penalty holds.
#pragma once

#include "algebra/ghostHeldNodes.hpp"

namespace flotsam
{

class HeldPressure
{
public:
    HeldPressure(const NodeGraph& graph, int nOwned) : graph_(graph), nOwned_(nOwned) {}

    /// ghost: what the ghost faces add to the diagonal of each node.
    void set(const FlowSystem& system, const std::vector<double>& ghost);

    /// Changes p (owned nodes) at these nodes so that their rows of the Schur approximation times p are r.
    void correct(const double* r, double* p);

private:
    void exclude(const FlowSystem& system, std::vector<char>& isExcluded) const;
    void findRows(const FlowSystem& system);

    const NodeGraph& graph_;
    const int nOwned_;
    GhostHeldNodes held_;
    SparseSum rows_;                // held_.nodes() by owned nodes
    SparseEntries entries_, block_; // their numbers, and the upper half of those between held nodes
    std::vector<char> isExcluded_;
    std::vector<double> ofElements_;
};

} // namespace flotsam
