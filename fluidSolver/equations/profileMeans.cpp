// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/profileMeans.hpp"

#include "core/elementaryFunctions.hpp"

namespace flotsam
{

namespace
{

/// So many are computed together: what they need stays near the processor.
constexpr int blockSize = 128;

constexpr double longest = 700;     // slab in widths

void sweptBlock(const double* psi, double* swept, int n, double* mean)
{
    constexpr double isShort = 1e-3;    // below, a series
    double first[blockSize], last[blockSize];
    for (int k = 0; k < n; ++k)
    {
        first[k] = std::clamp(psi[k], -profileEnd, profileEnd);
        last[k] = std::clamp(psi[k] - swept[k], -profileEnd, profileEnd);
        swept[k] = first[k] - last[k];
    }
    exponentials(first, n);
    exponentials(last, n);
    for (int k = 0; k < n; ++k)
    {
        mean[k] = (1 + first[k])/(1 + last[k]);
    }
    logarithms(mean, n);
    for (int k = 0; k < n; ++k)
    {
        const double value = first[k]/(1 + first[k]), slope = value*(1 - value);
        const double series = value - swept[k]*slope*(0.5 - swept[k]*(1 - 2*value)/6);
        mean[k] = std::abs(swept[k]) < isShort ? series : mean[k]/swept[k];
    }
}

/// The mean alpha is that of psi + thickness s, s from -1/2 to 1/2: exp(psi) = sinh(thickness alpha/2)/sinh(thickness (1 - alpha)/2).
void frontBlock(const double* alpha, double* thickness, int n)
{
    double full[blockSize], empty[blockSize];
    for (int k = 0; k < n; ++k)
    {
        full[k] = std::max(-thickness[k]*alpha[k], -longest);
        empty[k] = std::max(-thickness[k]*(1 - alpha[k]), -longest);
    }
    exponentials(full, n);
    exponentials(empty, n);
    for (int k = 0; k < n; ++k)
    {
        full[k] = (1 - full[k])/(1 - empty[k]);
    }
    logarithms(full, n);
    for (int k = 0; k < n; ++k)
    {
        thickness[k] = thickness[k]*(alpha[k] - 0.5) + full[k];
    }
}

} // namespace

void sweptMeans(const double* psi, double* swept, int n, double* mean)
{
    for (int k = 0; k < n; k += blockSize)
    {
        sweptBlock(psi + k, swept + k, std::min(blockSize, n - k), mean + k);
    }
}

void frontsFromMeans(const double* alpha, double* thickness, int n)
{
    for (int k = 0; k < n; k += blockSize)
    {
        frontBlock(alpha + k, thickness + k, std::min(blockSize, n - k));
    }
}

} // namespace flotsam
