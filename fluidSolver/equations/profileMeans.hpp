// SPDX-License-Identifier: GPL-3.0-or-later
/// Means of the equilibrium profile 1/(1+exp(-psi)), and what they say about the place of its front: for one cell or face, and for many at once.
#pragma once

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// Beyond, the profile is 0 or 1: exp(-35) is below the round-off of 1.
constexpr double profileEnd = 35;

/// int_0^1 of 1/(1+exp(-(psi - s swept))) ds: mean of the profile over what passes a face during a step.
inline double sweptMean(double psi, double swept)
{
    if (std::abs(swept) < 0.3)      // series about the middle, error below 1e-9; a third of the exact form's time
    {
        const double middle = 1/(1 + std::exp(0.5*swept - std::clamp(psi, -profileEnd, profileEnd)));
        const double slope = middle*(1 - middle), square = swept*swept;
        return middle + slope*(1 - 2*middle)*square*(1./24 + square*(1 - 12*slope)/1920);
    }
    const double first = std::clamp(psi, -profileEnd, profileEnd), last = std::clamp(psi - swept, -profileEnd, profileEnd);
    if (first == last)
    {
        return first > 0 ? 1 : 0;
    }
    return std::log((1 + std::exp(first))/(1 + std::exp(last)))/(first - last);
}

/// sweptMean() of n faces; swept is overwritten. Error below 1e-11.
void sweptMeans(const double* psi, double* swept, int n, double* mean);

/// exp(psi at the middle of a slab) from the mean alpha of 1/(1+exp(-psi)) over it; thickness in widths.
inline double frontFromMean(double alpha, double thickness)
{
    const double a = std::exp(0.5*thickness), b = std::expm1(thickness*alpha);
    return std::max(b/(a - (b + 1)/a), 1e-300);
}

/// ln frontFromMean() of n slabs, over thickness. alpha from 1e-4 to 1 - 1e-4; thickness 1e-2 at least. Error below 1e-9.
void frontsFromMeans(const double* alpha, double* thickness, int n);

} // namespace flotsam
