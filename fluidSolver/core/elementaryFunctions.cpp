// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/elementaryFunctions.hpp"

#include <cstdint>
#include <cstring>

/// Also compiled for processors with wider registers, chosen when the program starts. The same results to the last bit: no fused multiplications.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
#define FLOTSAM_ALSO_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define FLOTSAM_ALSO_WIDE
#endif

namespace flotsam
{

namespace
{

/// ln 2 as a sum, the first part with so few digits that its products with exponents are exact.
constexpr double ln2High = 6.93147180369123816490e-01, ln2Low = 1.90821492927058770002e-10;

constexpr int mantissaBits = 52;
constexpr std::uint64_t exponentBias = 1023;

std::uint64_t bitsOf(double x)
{
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}

double numberOf(std::uint64_t bits)
{
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

/// x = k ln 2 + r, exp(r) by its series. The loops that call it have no branches: the compiler then computes several values at once.
[[gnu::always_inline]] inline double exponential(double x)
{
    constexpr double toInteger = 1.5*(std::uint64_t(1) << mantissaBits);  // added, it leaves the nearest integer in the last bits
    constexpr double coefficients[] = {1./39916800, 1./3628800, 1./362880, 1./40320, 1./5040, 1./720, 1./120, 1./24, 1./6, 0.5, 1, 1};
    const double shifted = x*1.44269504088896340736 + toInteger, k = shifted - toInteger;
    const double r = (x - k*ln2High) - k*ln2Low;
    double sum = 1./479001600;
    for (const double c : coefficients)
    {
        sum = sum*r + c;
    }
    return numberOf(bitsOf(sum) + (bitsOf(shifted) << mantissaBits));
}

/// x = 2^k m, m from sqrt(1/2) to sqrt(2): ln m = 2 artanh(s) with s = (m - 1)/(m + 1), by its series.
[[gnu::always_inline]] inline double logarithm(double x)
{
    constexpr std::uint64_t rootOfHalf = 0x3fe6a09e667f3bcd, one = exponentBias << mantissaBits;
    constexpr std::uint64_t twoToThe52 = 0x4330000000000000;    // an integer in its last bits is added
    constexpr double coefficients[] = {2./19, 2./17, 2./15, 2./13, 2./11, 2./9, 2./7, 2./5, 2./3};
    const std::uint64_t exponent = (bitsOf(x) - rootOfHalf + one) >> mantissaBits;     // k + exponentBias
    const double k = numberOf(exponent | twoToThe52) - (double(std::uint64_t(1) << mantissaBits) + double(exponentBias));
    const double f = numberOf(bitsOf(x) - (exponent << mantissaBits) + one) - 1, s = f/(2 + f), square = s*s;
    double sum = 2./21;
    for (const double c : coefficients)
    {
        sum = sum*square + c;
    }
    return k*ln2High + (f - s*(f - square*sum) + k*ln2Low);
}

} // namespace

FLOTSAM_ALSO_WIDE void exponentials(double* x, int n)
{
    for (int k = 0; k < n; ++k)
    {
        x[k] = exponential(x[k]);
    }
}

FLOTSAM_ALSO_WIDE void logarithms(double* x, int n)
{
    for (int k = 0; k < n; ++k)
    {
        x[k] = logarithm(x[k]);
    }
}

} // namespace flotsam
