// SPDX-License-Identifier: GPL-3.0-or-later
/// Separation of a boundary layer that the elements do not resolve (docs/numerics/3-solids.md, 3.9).
///
/// gamma mu/h takes from a stream what its layer's friction takes, but from an element of fluid instead of a thin layer: the stream hardly slows down, stays attached
/// to round bodies, and leaves no wake. A laminar layer separates where the velocity along the wall has fallen by a tenth (Thwaites 1949, doi 10.1017/S0001925900000184).
/// So the wall takes, where the stream along it slows down, in proportion to what the pressure takes from the element's fluid there, rho h a (-da/ds). Separation takes
/// as long as the stream needs past the body: what swings to and fro by less than its size changes faster than it slows down along itself.
#pragma once

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// Factor of [u].[w] that a no-slip wall holds the velocity with at least [Pa s/m]: share rho (-h da/ds - 0.02 a) if that is
/// positive, fading out where the layer is resolved.
/// mean: velocity relative to the wall in the element (D) [m/s]; nodal: the same at its nodes ((D + 1)*D); rate: its change in time where the wall is (D) [m/s^2];
/// gradN: (D + 1)*D [1/m]; h: of the element [m].
template<int D>
double separationHold(double share, double rho, double mu, double h, const double* mean, const double* nodal, const double* rate, const double* gradN)
{
    constexpr double resolved = 100;    // Reynolds number of an element whose layer separates by itself: spheres and cylinders of 10 elements at 300 to 1000
    constexpr double uneven = 0.02;     // of the velocity, over an element: so uneven is a stream along a plane wall, and of that only what slows down would count
    double squared = 0, slowing = 0, change = 0;    // |a|^2; -a.(grad a) a; a.da/dt
    for (int d = 0; d < D; ++d)
    {
        squared += mean[d]*mean[d];
        change += mean[d]*rate[d];
    }
    for (int a = 0; a <= D; ++a)
    {
        double along = 0, slope = 0;
        for (int d = 0; d < D; ++d)
        {
            along += mean[d]*nodal[a*D + d];
            slope += mean[d]*gradN[a*D + d];
        }
        slowing -= along*slope;
    }
    slowing -= uneven*squared*std::sqrt(squared)/h;
    if (slowing <= 0 || squared <= 0) return 0;
    const double reynolds = rho*std::sqrt(squared)*h/mu, unresolved = 1/(1 + resolved*resolved/(reynolds*reynolds)), steady = slowing/(slowing + std::abs(change));
    return share*unresolved*steady*rho*h*slowing/squared;
}

} // namespace flotsam
