// SPDX-License-Identifier: GPL-3.0-or-later
/// Density and viscosity of the phase field.
#pragma once

#include "core/controls.hpp"
#include "core/lanes.hpp"

namespace flotsam
{

/// Liquid share used for rho and mu: alpha between the clips c and 1-c mapped to 0..1, so that remnants of alpha below
/// c deep in either fluid make no buoyancy (docs/numerics.md).
template<class Real = double>
inline Real liquidShare(const NumericsControls& n, const typename AsGiven<Real>::Type& alpha)
{
    const Real share = (alpha - n.densityClip)/(1 - 2*n.densityClip);
    return smaller<Real>(Real{} + 1, larger<Real>(Real{}, share));  // in this order no number stays none
}

/// [kg/m^3]
template<class Real = double>
inline Real density(const FluidProperties& f, const NumericsControls& n, const typename AsGiven<Real>::Type& alpha)
{
    if (!f.isTwoPhase) return Real{} + f.rhoLiquid;
    const Real s = liquidShare<Real>(n, alpha);
    return f.rhoLiquid*s + f.rhoGas*(1 - s);
}

/// [Pa s]
inline double viscosity(const FluidProperties& f, const NumericsControls& n, double alpha)
{
    if (!f.isTwoPhase) return f.muLiquid;
    const double s = liquidShare(n, alpha);
    return f.muLiquid*s + f.muGas*(1 - s);
}

} // namespace flotsam
