// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/keptCholesky.hpp"

#include <numeric>

namespace flotsam
{

/// Order of elimination, and where each entry is then: Eigen orders their numbers.
void KeptCholesky::analyse()
{
    const int n = sum_.nRows();
    std::vector<double> numbers(sum_.nPlaces());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    const Matrix lower = Eigen::Map<const Matrix>(n, n, sum_.nPlaces(), sum_.start().data(), sum_.column().data(), numbers.data()); // rows of the upper half are columns of the lower one
    Matrix whole;
    whole = lower.selfadjointView<Eigen::Lower>();
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(whole, inverse);
    order_ = inverse.inverse();
    ordered_.resize(n, n);
    ordered_.selfadjointView<Eigen::Upper>() = lower.selfadjointView<Eigen::Lower>().twistedBy(order_);
    source_.assign(ordered_.valuePtr(), ordered_.valuePtr() + ordered_.nonZeros());
    factor_.analyzePattern(ordered_);
}

bool KeptCholesky::factor(int n, const SparseEntries& entries, double shift)
{
    sum_.set(n, n, entries);
    if (sum_.isNewPattern()) analyse();
    for (int k = 0; k < n; ++k)
        for (int p = ordered_.outerIndexPtr()[k]; p < ordered_.outerIndexPtr()[k + 1]; ++p)
            ordered_.valuePtr()[p] = sum_.value()[source_[p]]*(ordered_.innerIndexPtr()[p] == k ? 1 + shift : 1);
    factor_.factorize(ordered_);
    return factor_.info() == Eigen::Success;
}

void KeptCholesky::solve(double* x)
{
    Eigen::Map<Eigen::VectorXd> solution(x, sum_.nRows());
    work_ = order_*solution;
    factor_.matrixL().solveInPlace(work_);
    work_ = work_.cwiseQuotient(factor_.vectorD());
    factor_.matrixU().solveInPlace(work_);
    solution = order_.transpose()*work_;
}

} // namespace flotsam
