// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/keptCholesky.hpp"

#include <Eigen/SparseCholesky>

#include <numeric>

namespace flotsam
{

/// Order of elimination, and where each entry is then: Eigen orders their numbers.
void KeptCholesky::analyse()
{
    const int n = sum_.nRows();
    std::vector<double> numbers(sum_.nPlaces());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    const Eigen::SparseMatrix<double> lower = Eigen::Map<const Eigen::SparseMatrix<double>>(n, n, sum_.nPlaces(), sum_.start().data(), sum_.column().data(), numbers.data());
    Eigen::SparseMatrix<double> whole, ordered(n, n);
    whole = lower.selfadjointView<Eigen::Lower>();
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(whole, inverse);
    const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation = inverse.inverse();
    ordered.selfadjointView<Eigen::Upper>() = lower.selfadjointView<Eigen::Lower>().twistedBy(permutation);
    place_.assign(permutation.indices().data(), permutation.indices().data() + n);
    orderedStart_.assign(ordered.outerIndexPtr(), ordered.outerIndexPtr() + n + 1);
    orderedRow_.assign(ordered.innerIndexPtr(), ordered.innerIndexPtr() + ordered.nonZeros());
    source_.assign(ordered.valuePtr(), ordered.valuePtr() + ordered.nonZeros());
    countEntries();
}

/// Elimination tree and number of entries of each column of L.
void KeptCholesky::countEntries()
{
    const int n = sum_.nRows();
    parent_.assign(n, -1);
    count_.assign(n, 0);
    tag_.resize(n);
    for (int k = 0; k < n; ++k)
    {
        tag_[k] = k;
        for (int p = orderedStart_[k]; p < orderedStart_[k + 1]; ++p)
            for (int i = orderedRow_[p]; i < k && tag_[i] != k; i = parent_[i])
            {
                if (parent_[i] < 0) parent_[i] = k;
                ++count_[i];
                tag_[i] = k;
            }
    }
    start_.assign(n + 1, 0);
    for (int k = 0; k < n; ++k) start_[k + 1] = start_[k] + count_[k];
    row_.resize(start_[n]);
    value_.resize(start_[n]);
}

/// Scatters column k; its entries in row k of L: from the result on in pattern_, in an order in which they can be eliminated.
int KeptCholesky::reachOf(int k)
{
    int top = sum_.nRows();
    tag_[k] = k;
    for (int p = orderedStart_[k]; p < orderedStart_[k + 1]; ++p)
    {
        int i = orderedRow_[p], length = 0;
        work_[i] += ordered_[p];
        for (; tag_[i] != k; i = parent_[i])
        {
            pattern_[length++] = i;
            tag_[i] = k;
        }
        while (length > 0) pattern_[--top] = pattern_[--length];
    }
    return top;
}

bool KeptCholesky::eliminate()
{
    const int n = sum_.nRows();
    work_.assign(n, 0.0);
    pattern_.resize(n);
    tag_.assign(n, -1);
    diagonal_.resize(n);
    count_.assign(n, 0);
    for (int k = 0; k < n; ++k)
    {
        int top = reachOf(k);
        double d = work_[k];
        work_[k] = 0;
        for (; top < n; ++top)
        {
            const int i = pattern_[top], end = start_[i] + count_[i]++;
            const double y = work_[i], l = y/diagonal_[i];
            work_[i] = 0;
            for (int p = start_[i]; p < end; ++p) work_[row_[p]] -= value_[p]*y;
            d -= l*y;
            row_[end] = k;
            value_[end] = l;
        }
        diagonal_[k] = d;
        if (d == 0) return false;
    }
    return true;
}

bool KeptCholesky::factor(int n, const SparseEntries& entries, double shift)
{
    sum_.set(n, n, entries);
    if (sum_.isNewPattern()) analyse();
    ordered_.resize(source_.size());
    for (int k = 0; k < n; ++k)
        for (int p = orderedStart_[k]; p < orderedStart_[k + 1]; ++p)
            ordered_[p] = sum_.value()[source_[p]]*(orderedRow_[p] == k ? 1 + shift : 1);
    return eliminate();
}

void KeptCholesky::solve(double* x)
{
    const int n = sum_.nRows();
    for (int i = 0; i < n; ++i) work_[place_[i]] = x[i];
    for (int k = 0; k < n; ++k)
        for (int p = start_[k]; p < start_[k + 1]; ++p) work_[row_[p]] -= value_[p]*work_[k];
    for (int k = 0; k < n; ++k) work_[k] /= diagonal_[k];
    for (int k = n; k-- > 0;)
        for (int p = start_[k]; p < start_[k + 1]; ++p) work_[k] -= value_[p]*work_[row_[p]];
    for (int i = 0; i < n; ++i) x[i] = work_[place_[i]];
}

} // namespace flotsam
