// SPDX-License-Identifier: GPL-3.0-or-later
/// Sums of entries and the factor of such a sum, again and again in one object: with the same places, with others, without a factor.
#include "algebra/keptCholesky.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

using namespace flotsam;

namespace
{

/// Springs between random pairs of n masses, each held a little: upper half of their matrix, entries of one place apart.
SparseEntries springs(int n, unsigned seed, double stiffness)
{
    std::mt19937 random(seed);
    SparseEntries entries;
    for (int i = 0; i < n; ++i) entries.push_back({i, i, 0.1});
    for (int k = 0; k < 3*n; ++k)
    {
        const int i = int(random() % n), j = int(random() % n);
        if (i == j) continue;
        entries.push_back({i, i, stiffness});
        entries.push_back({j, j, stiffness});
        entries.push_back({std::min(i, j), std::max(i, j), -stiffness});
    }
    return entries;
}

/// Largest residual of the solution for the right-hand side 1, 2, ..., n, over n.
double residual(KeptCholesky& factor, int n, const SparseEntries& entries, double shift)
{
    std::vector<double> x(n), rest(n);
    for (int i = 0; i < n; ++i) x[i] = rest[i] = i + 1;
    factor.solve(x.data());
    for (const SparseEntry& e : entries)
    {
        rest[e.row] -= e.value*x[e.column]*(e.row == e.column ? 1 + shift : 1);
        if (e.row != e.column) rest[e.column] -= e.value*x[e.row];
    }
    double largest = 0;
    for (double r : rest) largest = std::max(largest, std::abs(r)/n);
    return largest;
}

} // namespace

TEST_CASE("a factor solves, also with other numbers in the same places and with other places and sizes")
{
    KeptCholesky factor;
    for (const auto& [n, seed, stiffness, shift] : {std::tuple(40, 1u, 1.0, 0.0), {40, 1u, 3.0, 0.0}, {40, 2u, 1.0, 0.1}, {7, 3u, 2.0, 0.0}, {90, 4u, 1.0, 1e-6}})
    {
        const SparseEntries entries = springs(n, seed, stiffness);
        REQUIRE(factor.factor(n, entries, shift));
        CHECK(residual(factor, n, entries, shift) < 1e-12);
    }
}

TEST_CASE("a pivot of zero is no factor, and the next one is")
{
    KeptCholesky factor;
    CHECK_FALSE(factor.factor(2, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}}));
    const SparseEntries entries{{0, 0, 1}, {0, 1, 1}, {1, 1, 2}};
    REQUIRE(factor.factor(2, entries));
    CHECK(residual(factor, 2, entries, 0) < 1e-14);
}

TEST_CASE("a sum has each place once, columns ascending, and knows whether the places are those of before")
{
    SparseSum sum;
    sum.set(2, 3, {{1, 2, 1}, {0, 1, 2}, {1, 0, 4}, {1, 2, 8}});
    CHECK(sum.isNewPattern());
    CHECK(sum.start() == std::vector<int>{0, 1, 3});
    CHECK(sum.column() == std::vector<int>{1, 0, 2});
    CHECK(sum.value() == std::vector<double>{2, 4, 9});
    sum.set(2, 3, {{1, 2, 3}, {0, 1, 5}, {1, 0, 7}, {1, 2, 1}});
    CHECK_FALSE(sum.isNewPattern());
    CHECK(sum.value() == std::vector<double>{5, 7, 4});
    sum.set(2, 3, {{1, 2, 3}, {0, 0, 5}, {1, 0, 7}, {1, 2, 1}});
    CHECK(sum.isNewPattern());
    CHECK(sum.column() == std::vector<int>{0, 0, 2});
}
