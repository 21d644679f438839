// SPDX-License-Identifier: GPL-3.0-or-later
/// Stabilisation parameters of the P1/P1 formulation (paper eq 5; Tezduyar 1991, doi 10.1016/S0065-2156(08)70153-4).
#pragma once

#include <cmath>

namespace flotsam
{

/// Rates at which time steps, convection and viscosity change what an element holds [1/s], the viscous one by nu/h^2.
struct ElementRates
{
    double transient, convective, viscous;

    ElementRates(double dt, double speed, double h, double nu) : transient(2/dt), convective(2*speed/h), viscous(nu/(h*h)) {}

    /// Time by these, with the inertial ones times `inertial` and so many nu/h^2 [s].
    double time(double inertial, double viscosities) const
    {
        const double a = inertial*transient, b = inertial*convective, c = viscosities*viscous;
        return 1/std::sqrt(a*a + b*b + c*c);
    }
};

/// Time T in which an element passes on what happens in it [s]: Tezduyar's tau. The time step belongs into it: without it the two-phase scheme blows up
/// within 30 steps (docs/numerics.md).
inline double elementTime(double dt, double speed, double h, double nu)
{
    return ElementRates(dt, speed, h, nu).time(1, 12);
}

/// tau of SUPG and PSPG [s]: multiplies the momentum residual divided by rho. Where inertia counts `factor` times T (all of it damps vortices),
/// where viscosity does 3/4 of T (with less the pressure beside cut elements converges slower than with order 1.5, with more the velocity is worse).
inline double tauMomentum(double factor, double dt, double speed, double h, double nu)
{
    return ElementRates(dt, speed, h, nu).time(1/factor, 16);
}

/// Share of u' that convects (0..1): the inertial part of T. The residual of P1 lacks the viscous stress, u' is wrong where that matters, and there it
/// oscillates from step to step (lid-driven cavity at Re 100); convection is of no importance in such elements.
inline double convectingShare(double dt, double speed, double h, double nu)
{
    const ElementRates r(dt, speed, h, nu);
    const double inertial = r.transient*r.transient + r.convective*r.convective, viscous = 12*r.viscous;
    return inertial/(inertial + viscous*viscous);
}

/// tau_cont [Pa s] of the grad-div term: rho h^2/(12 T) (with the time step) or rho (nu + |a| h/2) (without).
inline double tauContinuity(bool withTimeStep, double rho, double speed, double h, double nu, double time)
{
    return withTimeStep ? rho*h*h/(12*time) : rho*(nu + 0.5*speed*h);
}

} // namespace flotsam
