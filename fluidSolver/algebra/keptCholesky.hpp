// SPDX-License-Identifier: GPL-3.0-or-later
/// L D L^T (Eigen's) of a small sparse symmetric matrix, step after step in the same memory: its order of elimination, of least degree, and the places of its factor are found
/// anew only where other entries are there than before.
#pragma once

#include "algebra/sparseSum.hpp"

#include <Eigen/SparseCholesky>

namespace flotsam
{

class KeptCholesky
{
public:
    /// Factors the sum of the entries, of the upper half (row <= column), its diagonal times 1 + shift. False: a pivot is zero.
    bool factor(int n, const SparseEntries& entries, double shift = 0);

    /// Replaces x (n) by the solution.
    void solve(double* x);

private:
    using Matrix = Eigen::SparseMatrix<double>;

    void analyse();

    SparseSum sum_;
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order_;
    Matrix ordered_;            // upper half in the order of elimination: given to Eigen in that order, it is not copied
    std::vector<int> source_;   // of its values: places in sum_
    Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
    Eigen::VectorXd work_;
};

} // namespace flotsam
