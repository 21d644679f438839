// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/heldPressure.hpp"

#include <algorithm>

namespace flotsam
{

/// Nodes without a free pressure, and those with neighbours on other ranks, whose pressures are not at hand.
void HeldPressure::exclude(const FlowSystem& system, std::vector<char>& isExcluded) const
{
    const int n = system.dim + 2;
    for (int i = 0; i < nOwned_; ++i)
        isExcluded[i] = !isFreePressure(system, i)
            || std::any_of(graph_.column.begin() + graph_.rowStart[i], graph_.column.begin() + graph_.rowStart[i + 1], [&](int j) { return j >= nOwned_; });
    for (const GhostTerm& g : system.ghosts)
        if (std::any_of(g.node, g.node + n, [&](int j) { return j >= nOwned_; }))
            for (int j = 0; j < n; ++j)
                if (g.node[j] < nOwned_) isExcluded[g.node[j]] = 1;
}

/// By position and node.
void HeldPressure::findRows(const FlowSystem& system)
{
    entries_.clear();
    const auto add = [&](int row, int node, double value) { if (isFreePressure(system, node)) entries_.push_back({row, node, value}); };
    for (int k = 0; k < int(held_.nodes().size()); ++k)
    {
        const int i = held_.nodes()[k];
        for (int e = graph_.rowStart[i]; e < graph_.rowStart[i + 1]; ++e) add(k, graph_.column[e], system.schur[e]);
    }
    for (const GhostTerm& g : system.ghosts)
        for (int i = 0; i < system.dim + 2; ++i)
        {
            const int row = held_.position(g.node[i]);
            for (int j = 0; row >= 0 && j < system.dim + 2; ++j) add(row, g.node[j], g.pressureFactor*g.jumpPressure[i]*g.jumpPressure[j]);
        }
}

void HeldPressure::set(const FlowSystem& system, const std::vector<double>& ghost)
{
    held_.clear();
    if (system.ghosts.empty()) return;
    isExcluded_.assign(nOwned_, 0);
    ofElements_.resize(nOwned_);
    exclude(system, isExcluded_);
    for (int i = 0; i < nOwned_; ++i) ofElements_[i] = system.schur[graph_.diagonal[i]];
    held_.find(ghost, ofElements_, isExcluded_);
    if (held_.isEmpty()) return;
    findRows(system);
    rows_.set(int(held_.nodes().size()), nOwned_, entries_);
    block_.clear();
    for (const SparseEntry& e : entries_)
        if (const int column = held_.position(e.column); column >= e.row) block_.push_back({e.row, column, e.value});
    held_.factor(block_, 1);
}

void HeldPressure::correct(const double* r, double* p)
{
    if (held_.isEmpty()) return;
    Eigen::MatrixXd& change = held_.values();
    for (std::size_t k = 0; k < held_.nodes().size(); ++k)
    {
        double product = 0;
        for (int e = rows_.start()[k]; e < rows_.start()[k + 1]; ++e) product += rows_.value()[e]*p[rows_.column()[e]];
        change(k, 0) = r[held_.nodes()[k]] - product;
    }
    held_.solve();
    for (std::size_t k = 0; k < held_.nodes().size(); ++k) p[held_.nodes()[k]] += change(k, 0);
}

} // namespace flotsam
