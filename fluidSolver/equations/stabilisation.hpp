// SPDX-License-Identifier: GPL-3.0-or-later
/// Stabilisation parameters of the P1/P1 formulation (paper eq 5; Tezduyar 1991, doi 10.1016/S0065-2156(08)70153-4).
#pragma once

#include "core/lanes.hpp"

namespace flotsam
{

/// 1/dt in terms that resist velocities themselves, not their changes [1/s]: grad-div (tau_cont) and the normal velocity on solids. Each step takes its part of what P1 cannot
/// do without divergence or along a cut wall; with 1/dt itself all of it were taken as dt goes to zero, and bodies would answer the later the smaller the steps. It counts up to
/// `most` times sqrt(gravity/h), the rate at which waves as long as an element swing; without gravity [m/s^2] to a third of `most` times speed/h, at which the fastest fluid [m/s]
/// passes an element (as in steps of a Courant number of 0.5), and while all is at rest without bound (docs/numerics, 2.14).
template<class Real>
inline Real penaltyRate(double dt, double gravity, double speed, double most, const Real& h)
{
    const Real rate = Real{} + 1/dt;
    if (gravity > 0) return smaller<Real>(rate, most*squareRoot<Real>(gravity/h));
    return speed > 0 ? smaller<Real>(rate, most/3*speed/h) : rate;
}

/// Squares of the rates at which time steps, convection and viscosity change what an element holds [1/s^2], the viscous one by nu/h^2.
template<class Real>
struct ElementRates
{
    double transient = 0;
    Real convective{}, viscous{};

    ElementRates() = default;
    ElementRates(double dt, const Real& squaredSpeed, const Real& h, const Real& nu) : transient(4/(dt*dt)), viscous(nu*nu/(h*h*h*h)) { setSpeed(squaredSpeed, h); }

    void setSpeed(const Real& squaredSpeed, const Real& h) { convective = 4*squaredSpeed/(h*h); }

    /// tau of SUPG and PSPG [s]: multiplies the momentum residual divided by rho. Where inertia counts `factor` times T (all of it damps vortices),
    /// where viscosity does 3/4 of T (with less the pressure beside cut elements converges slower than with order 1.5, with more the velocity is worse).
    Real tauMomentum(double factor) const { return factor/squareRoot<Real>(transient + convective + factor*factor*16*16*viscous); }

    /// tau_cont [Pa s] of the grad-div term: rho h^2/(12 T), T the time in which an element passes on what happens in it: Tezduyar's tau, with a penaltyRate() for 1/dt.
    /// Without that the two-phase scheme blows up within 30 steps (docs/numerics.md).
    Real tauContinuity(const Real& rho, const Real& h, const Real& rate) const { return rho*(h*h/12*squareRoot<Real>(4*rate*rate + convective + 12*12*viscous)); }

    /// Share of u' that convects (0..1): the inertial part of T. P1 has the viscous stress only as recovered one step late, u' is wrong where that matters, and there it
    /// oscillates from step to step (lid-driven cavity at Re 100); convection is of no importance in such elements.
    Real convectingShare() const
    {
        const Real inertial = transient + convective;
        return inertial/(inertial + 12*12*viscous);
    }
};

/// tau_cont [Pa s] of the grad-div term without the time step: rho (nu + |a| h/2).
template<class Real>
inline Real steadyTauContinuity(const Real& rho, const Real& squaredSpeed, const Real& h, const Real& nu)
{
    return rho*(nu + 0.5*squareRoot(squaredSpeed)*h);
}

} // namespace flotsam
