// SPDX-License-Identifier: GPL-3.0-or-later
/// L D L^T of a small sparse symmetric matrix, step after step in the same memory, its order of elimination (of least degree, by Eigen) found anew only where other entries are there than
/// before. Up-looking (T. A. Davis, ACM Trans. Math. Softw. 31 (2005) 587, doi 10.1145/1114268.1114277), as Eigen's, which takes new memory for every factor.
#pragma once

#include "algebra/sparseSum.hpp"

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
    void analyse();
    void countEntries();
    bool eliminate();
    int reachOf(int k);

    SparseSum sum_;
    std::vector<int> place_;                    // of each row and column in the order of elimination
    std::vector<int> orderedStart_, orderedRow_, source_;   // upper half in that order, by columns: places in sum_
    std::vector<int> parent_, start_, count_;   // elimination tree; columns of L, entries of each so far
    std::vector<int> row_;                      // of the entries of L
    std::vector<double> value_, diagonal_, ordered_;
    std::vector<int> pattern_, tag_;            // work
    std::vector<double> work_;
};

} // namespace flotsam
