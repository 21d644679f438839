// SPDX-License-Identifier: GPL-3.0-or-later
/// Nodes at slivers of the fluid, whose values the ghost penalty holds rather than the entries of their elements: solved together, directly, in the preconditioner.
///
/// The penalty vanishes for linear fields. Groups of such nodes, in gaps that bodies close, turn like flaps about the fluid beside them: large diagonals, little energy.
/// Diagonal blocks and the smoothers of a multigrid cycle leave these modes to GMRES, one after the other (docs/numerics.md, section 5).
#pragma once

#include "algebra/flowSystem.hpp"
#include "algebra/keptCholesky.hpp"

#include <Eigen/Dense>

namespace flotsam
{

/// A scalar matrix on some of a rank's nodes, factored.
class GhostHeldNodes
{
public:
    using Entries = SparseEntries;  // row, column: positions in nodes()

    /// Of nOwned nodes those for which the ghost faces add more to the diagonal than the elements, but for the excluded ones.
    void find(const std::vector<double>& ofGhosts, const std::vector<double>& ofElements, const std::vector<char>& isExcluded);

    void clear() { nodes_.clear(); }

    const std::vector<int>& nodes() const { return nodes_; }    // owned, ascending
    bool isEmpty() const { return nodes_.empty(); }
    /// In nodes(); -1: none of them.
    int position(int node) const;

    /// Factors the sum of the entries, of the upper half (row <= column); leaves no nodes where that fails. nValues: number of values a node in values().
    void factor(const Entries& entries, int nValues);

    /// A row a node, to be set before solve(), which replaces it by the solution.
    Eigen::MatrixXd& values() { return values_; }
    void solve() { for (Eigen::Index k = 0; k < values_.cols(); ++k) matrix_.solve(values_.col(k).data()); }

private:
    std::vector<int> nodes_;
    KeptCholesky matrix_;
    Eigen::MatrixXd values_;
};

} // namespace flotsam
