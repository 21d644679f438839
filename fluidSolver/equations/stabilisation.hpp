// SPDX-License-Identifier: GPL-3.0-or-later
/// Stabilisation parameters of the P1/P1 formulation (paper eq 5; Tezduyar 1991, doi 10.1016/S0065-2156(08)70153-4).
#pragma once

#include <cmath>

namespace flotsam
{

/// Time T in which an element passes on what happens in it [s]: Tezduyar's tau. The time step belongs into it: without it the two-phase scheme blows up
/// within 30 steps (docs/numerics.md).
inline double elementTime(double dt, double speed, double h, double nu)
{
    const double transient = 2/dt, convective = 2*speed/h, viscous = 12*nu/(h*h);
    return 1/std::sqrt(transient*transient + convective*convective + viscous*viscous);
}

/// tau of SUPG and PSPG [s]: multiplies the momentum residual divided by rho. Where inertia counts `factor` times T (all of it damps vortices),
/// where viscosity does 3/4 of T (with less the pressure beside cut elements converges slower than with order 1.5, with more the velocity is worse).
inline double tauMomentum(double factor, double dt, double speed, double h, double nu)
{
    const double transient = 2/(factor*dt), convective = 2*speed/(factor*h), viscous = 16*nu/(h*h);
    return 1/std::sqrt(transient*transient + convective*convective + viscous*viscous);
}

/// Share of u' that convects (0..1): its inertial part. The residual of P1 lacks the viscous stress, u' is wrong where that matters, and there it
/// oscillates from step to step (lid-driven cavity at Re 100); convection is of no importance in such elements.
inline double convectingShare(double dt, double speed, double h, double nu)
{
    const double transient = 2/dt, convective = 2*speed/h, viscous = 12*nu/(h*h);
    const double inertial = transient*transient + convective*convective;
    return inertial/(inertial + viscous*viscous);
}

/// tau_cont [Pa s] of the grad-div term: rho h^2/(12 T) (with the time step) or rho (nu + |a| h/2) (without).
inline double tauContinuity(bool withTimeStep, double rho, double speed, double h, double nu, double time)
{
    return withTimeStep ? rho*h*h/(12*time) : rho*(nu + 0.5*speed*h);
}

} // namespace flotsam
