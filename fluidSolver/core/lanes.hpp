// SPDX-License-Identifier: GPL-3.0-or-later
/// Several elements at once: vectors with one number of each, on which the compiler works with the processor's vector instructions.
/// Functions that are templates of `Real` compute one element (double) or several (Lanes2, Lanes4) by the same formula.
#pragma once

#include <cmath>

namespace flotsam
{

using Lanes2 = double __attribute__((vector_size(2*sizeof(double))));   ///< what every x86-64 has instructions for
using Lanes4 = double __attribute__((vector_size(4*sizeof(double))));   ///< AVX2

// Functions that work with Lanes4 are compiled for AVX2, with all that they call; call them only where hasWideLanes(). Products and sums are one
// instruction there: results differ from those of Lanes2 by round-off.
#ifdef __x86_64__
#define FLOTSAM_WIDE_LANES [[gnu::target("avx2,fma"), gnu::flatten]]
inline bool hasWideLanes() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#else
#define FLOTSAM_WIDE_LANES
inline bool hasWideLanes() { return false; }
#endif

template<class Real> constexpr int widthOf = sizeof(Real)/sizeof(double);

template<class Real>
inline double lane(const Real& v, int l)
{
    if constexpr (widthOf<Real> == 1) return v;
    else return v[l];
}

/// value(l) in lane l.
template<class Real, class Value>
inline Real gather(const Value& value)
{
    Real v;
    for (int l = 0; l < widthOf<Real>; ++l) v[l] = value(l);
    return v;
}

template<class Real>
inline Real squareRoot(const Real& v)
{
    if constexpr (widthOf<Real> == 1) return std::sqrt(v);
    else return gather<Real>([&](int l) { return std::sqrt(v[l]); });
}

/// The type of an argument that does not say which Real a template has: an integer literal would.
template<class Real> struct AsGiven { using Type = Real; };

/// Of every lane. For the larger, smaller and chosen of two, both are computed: `condition ? a : b` does that for vectors.
template<class Real> inline Real absolute(const Real& v) { return v < 0 ? -v : v; }
template<class Real> inline Real larger(const Real& a, const Real& b) { return a > b ? a : b; }
template<class Real> inline Real smaller(const Real& a, const Real& b) { return a < b ? a : b; }

/// Adds lane l of n values to n sums, two at a time.
template<int n, class Real>
inline void addLane(const Real* values, int l, double* sums)
{
    using Pair = double __attribute__((vector_size(2*sizeof(double)), aligned(sizeof(double)), may_alias));
    for (int c = 0; c + 1 < n; c += 2) *reinterpret_cast<Pair*>(sums + c) += Pair{lane(values[c], l), lane(values[c + 1], l)};
    if (n % 2) sums[n - 1] += lane(values[n - 1], l);
}

} // namespace flotsam
