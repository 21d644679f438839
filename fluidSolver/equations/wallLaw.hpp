// SPDX-License-Identifier: GPL-3.0-or-later
/// Mean velocity over a smooth or rough wall: the traction of a layer that no element resolves.
#pragma once

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// u+ = speed / friction velocity at a distance y from the wall. Smooth: Spalding's law (1961, doi 10.1115/1.3641728) with kappa = 0.41, B = 5. Sand roughness ks brings
/// Nikuradse's rough wall (1933), u+ = ln(1 + y/z0)/kappa with z0 = ks exp(-8.5 kappa), which is ln(y/ks)/kappa + 8.5 from some ks on; y+ of both laws are added, as Colebrook's
/// interpolation does. reY = speed y/nu, reK = speed ks/nu (0: smooth). Wall traction: rho (speed/u+)^2 [Pa]. Toward a smooth wall u+ = sqrt(reY): the traction mu speed/y of
/// a linear profile.
inline double velocityOverFriction(double reY, double reK)
{
    constexpr double kappa = 0.41, b = 5, rough = 8.5;
    if (reY <= 0) return 0;
    // u+ y+ = reY with y+ = u+ + exp(-kappa b)(exp(k) - 1 - k - k^2/2 - k^3/6) + z0+ (exp(k) - 1), k = kappa u+, z0+ u+ = exp(-kappa rough) reK: convex in u+, so that Newton's method
    // comes down to the root from a bound above it
    const double smooth = std::exp(-kappa*b), z0 = std::exp(-kappa*rough)*reK;
    double u = std::min(std::sqrt(reY), std::log(1 + reY)/kappa + b + 2);
    for (int i = 0; i < 50; ++i)
    {
        const double k = kappa*u, e = std::exp(k), rest = smooth*(e - 1 - k*(1 + k*(0.5 + k/6))), slope = smooth*kappa*(e - 1 - k*(1 + 0.5*k));
        const double f = u*(u + rest) + z0*(e - 1) - reY;
        const double change = f/(2*u + rest + u*slope + z0*kappa*e);
        u -= change;
        if (std::abs(change) < 1e-6*u) break;
    }
    return u;
}

} // namespace flotsam
