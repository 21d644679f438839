// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/gmres.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double singleReduction = 3e-6;    // smaller ones of the residual need a basis in double precision
constexpr double roundOff = 1e-14;          // of the residual at the start: no reduction goes further (a right-hand side of zero has the target 0)
constexpr int keptVectors = 8;              // preconditioned ones
constexpr double cancellation = 0.1;        // of a vector by projection: below, rounding would leave it oblique
constexpr std::size_t chunk = 512;          // entries that are worked on together, in the fastest cache

/// In four sums: independent of each other, so that they can be computed at once.
template<class Real>
double dot(const Real* v, const double* w, std::size_t n)
{
    double sum[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < 4; ++k) sum[k] += double(v[i + k])*w[i + k];
    for (; i < n; ++i) sum[0] += double(v[i])*w[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

template<class Real>
void add(double factor, const Real* v, double* w, std::size_t n)
{
    for (std::size_t i = 0; i < n; ++i) w[i] += factor*double(v[i]);
}

/// f(begin, length) for all parts of n entries.
template<class Function>
void inChunks(std::size_t n, const Function& f)
{
    for (std::size_t begin = 0; begin < n; begin += chunk) f(begin, std::min(chunk, n - begin));
}

template<class Real>
void normalise(const std::vector<double>& w, double norm, std::vector<std::vector<Real>>& basis, int index)
{
    if (index == int(basis.size())) basis.emplace_back();
    std::vector<Real>& v = basis[index];
    v.resize(w.size());
    const double factor = 1/norm;
    for (std::size_t i = 0; i < w.size(); ++i) v[i] = Real(w[i]*factor);
}

} // namespace

double Gmres::norm(const std::vector<double>& v) const
{
    return std::sqrt(halo_.sum(dot(v.data(), v.data(), v.size())));
}

/// Projects `work` out of the basis (classical Gram-Schmidt, again where much cancels): coefficients into column_; returns the norm of what is left.
template<class Real>
double Gmres::orthogonalise(const Basis<Real>& basis, int count, std::vector<double>& work)
{
    column_.assign(count, 0.0);
    std::vector<double> sums(count + 1);
    for (int pass = 0;; ++pass)
    {
        std::fill(sums.begin(), sums.end(), 0.0);
        inChunks(work.size(), [&](std::size_t begin, std::size_t n) {
            for (int j = 0; j < count; ++j) sums[j] += dot(basis[j].data() + begin, &work[begin], n);
            sums[count] += dot(&work[begin], &work[begin], n);
        });
        halo_.sum(sums.data(), count + 1);
        double square = 0;
        inChunks(work.size(), [&](std::size_t begin, std::size_t n) {
            for (int j = 0; j < count; ++j) add(-sums[j], basis[j].data() + begin, &work[begin], n);
            square += dot(&work[begin], &work[begin], n);
        });
        square = halo_.sum(square);
        for (int j = 0; j < count; ++j) column_[j] += sums[j];
        if (pass == 1 || !(square < cancellation*cancellation*sums[count])) return std::sqrt(square);
    }
}

/// Takes column_ and the norm of the rest as the next column of the Hessenberg matrix and rotates it to a triangle; returns the new residual.
double Gmres::rotate(int column, double next)
{
    for (int row = 0; row < column; ++row)
    {
        const double upper = column_[row], lower = column_[row + 1];
        column_[row] = cosine_[row]*upper + sine_[row]*lower;
        column_[row + 1] = cosine_[row]*lower - sine_[row]*upper;
    }
    const double length = std::hypot(column_[column], next);
    cosine_[column] = length > 0 ? column_[column]/length : 1;
    sine_[column] = length > 0 ? next/length : 0;
    column_[column] = length;
    for (int row = 0; row <= column; ++row) hessenberg(row, column) = column_[row];
    right_[column + 1] = -sine_[column]*right_[column];
    right_[column] *= cosine_[column];
    return std::abs(right_[column + 1]);
}

void Gmres::solveTriangular(int count)
{
    for (int row = count - 1; row >= 0; --row)
    {
        for (int k = row + 1; k < count; ++k) right_[row] -= hessenberg(row, k)*right_[k];
        right_[row] = hessenberg(row, row) != 0 ? right_[row]/hessenberg(row, row) : 0;
    }
}

/// The preconditioned vectors that were kept, and the preconditioner applied to the sum of the others.
template<class Real>
void Gmres::addSolution(Basis<Real>& basis, int count, std::vector<double>& x, std::vector<double>& q, std::vector<double>& work)
{
    if (count > keptVectors)
    {
        inChunks(work.size(), [&](std::size_t begin, std::size_t n) {
            double sum[chunk] = {};
            for (int j = keptVectors; j < count; ++j) add(right_[j], basis[j].data() + begin, sum, n);
            for (std::size_t i = 0; i < n; ++i) basis[0][begin + i] = Real(sum[i]);
        });
        system_.precondition(basis[0].data(), work.data());
    }
    else std::fill(work.begin(), work.end(), 0.0);
    inChunks(work.size(), [&](std::size_t begin, std::size_t n) {
        for (int j = 0; j < std::min(count, keptVectors); ++j) add(right_[j], &preconditioned_[j][begin], &work[begin], n);
    });
    system_.addTo(x, q, work.data());
}

/// Up to `restart` iterations; work: the residual, of norm `first`.
template<class Real>
void Gmres::cycle(Basis<Real>& basis, std::vector<double>& x, std::vector<double>& q, std::vector<double>& work, double first, double target,
    int maxIterations, Result& result)
{
    normalise(work, first, basis, 0);
    right_.assign(restart_ + 1, 0.0);
    right_[0] = first;
    int count = 0;
    while (count < restart_ && result.iterations < maxIterations)
    {
        if (count < keptVectors && count == int(preconditioned_.size())) preconditioned_.emplace_back();
        double* kept = nullptr;
        if (count < keptVectors)
        {
            preconditioned_[count].resize(work.size());
            kept = preconditioned_[count].data();
        }
        system_.multiplyPreconditioned(basis[count].data(), work.data(), kept);
        const double next = orthogonalise(basis, count + 1, work);
        result.residual = rotate(count, next);
        ++count;
        ++result.iterations;
        if (!(result.residual < 1e300) || result.residual <= target || next == 0) break;
        if (count < restart_ && result.iterations < maxIterations) normalise(work, next, basis, count);
    }
    solveTriangular(count);
    addSolution(basis, count, x, q, work);
}

Gmres::Result Gmres::solve(std::vector<double>& x, std::vector<double>& q, std::vector<double>& residual, double first, double target, int maxIterations)
{
    Result result;
    result.residual = first;
    hessenberg_.resize(std::size_t(restart_)*(restart_ + 1));
    cosine_.resize(restart_);
    sine_.resize(restart_);
    target = std::max(target, roundOff*first);
    const bool isSingle = target >= singleReduction*first;
    while (result.iterations < maxIterations)
    {
        if (isSingle) cycle(single_, x, q, residual, result.residual, target, maxIterations, result);
        else cycle(double_, x, q, residual, result.residual, target, maxIterations, result);
        result.hasConverged = result.residual <= target;
        if (result.hasConverged || !(result.residual < 1e300)) return result;
        if (result.iterations >= maxIterations) break;
        system_.residual(x, q, residual.data());
        result.residual = norm(residual);
    }
    return result;
}

} // namespace flotsam
