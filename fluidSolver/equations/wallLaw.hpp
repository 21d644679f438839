// SPDX-License-Identifier: GPL-3.0-or-later
/// Mean velocity over a smooth or rough wall: the traction of a layer that no element resolves.
#pragma once

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// u+ = speed / friction velocity at a distance y from the wall, by Spalding's law (1961, doi 10.1115/1.3641728) with kappa = 0.41, B = 5; sand roughness ks moves it as
/// Colebrook's interpolation does, by the factor 1 + 0.3 ks+. reY = speed y/nu, reK = speed ks/nu (0: smooth). Wall traction: rho (speed/u+)^2 [Pa].
/// Toward the wall u+ = sqrt(reY): the traction mu speed/y of a linear profile.
inline double velocityOverFriction(double reY, double reK)
{
    constexpr double kappa = 0.41, b = 5;
    if (reY <= 0) return 0;
    // u+ y+ = reY with y+ = u+ + (1 + 0.3 ks+) exp(-kappa b)(exp(k) - 1 - k - k^2/2 - k^3/6), k = kappa u+, and ks+ = reK/u+: convex in u+, so that
    // Newton's method comes down to the root from a bound above it
    double u = std::min(std::sqrt(reY), std::log(1 + reY)/kappa + b + 2);
    for (int i = 0; i < 50; ++i)
    {
        const double k = kappa*u, rest = std::exp(-kappa*b)*(std::exp(k) - 1 - k*(1 + k*(0.5 + k/6)));
        const double slope = std::exp(-kappa*b)*kappa*(std::exp(k) - 1 - k*(1 + 0.5*k));
        const double f = u*u + (u + 0.3*reK)*rest - reY;
        const double change = f/(2*u + rest + (u + 0.3*reK)*slope);
        u -= change;
        if (std::abs(change) < 1e-6*u) break;
    }
    return u;
}

} // namespace flotsam
