// SPDX-License-Identifier: GPL-3.0-or-later
/// The volume terms of the momentum and continuity equations on one simplex or its fluid part; one function per term.
///
/// Weak form (paper eq 5, momentum convection skew-symmetric, see docs/numerics.md):
///   (w, d(rho u)/dt - 1/2 drho/dt u) + 1/2 [(w, rho a.grad u) - (rho a.grad w, u)]              inertia, convection
/// + (eps(w), 2 mu eps(u)) - (div w, p) + (q, div u) + (div w, tau_c div u)                      stress, continuity
/// + sum_e (tau a.grad w + tau grad q/rho, rho (du/dt + a.grad u) + grad p - mu lap u - f) = (w, f)  SUPG, PSPG
/// a = u + u', u' = -tau (residual)/rho of the last step: only the sum is free of divergence, and momentum is conserved by what is
/// (Hughes & Wells 2005, doi 10.1016/j.cma.2004.06.034).
/// Where the density varies mass is lumped with the nodes' own densities, and the force grad p - f of an element goes to its nodes in proportion
/// to these: one acceleration for all of them, as the pressure's gradient is one. SUPG, which moves momentum between the nodes, has the
/// density of the lightest: with the mean's it would move a gas node beside water a thousand times as much as the residual asks for.
/// P1: gradients are constant; all integrals are exact from V, int N_a and int N_a N_b of the fluid part.
#pragma once

#include "core/lanes.hpp"

namespace flotsam
{

/// N*N: int N_a N_b; null: not cut, V (1 + delta_ab)/(N (N + 1)). No element in the lanes of vectors is cut.
template<class Real> struct CutMoments { static constexpr const double* second = nullptr; };
template<> struct CutMoments<double> { const double* second; };

/// One element (Real is double) or several, one in each lane.
template<int D, class Real = double>
struct ElementData : CutMoments<Real>
{
    static constexpr int N = D + 1;     ///< nodes
    static constexpr int B = D + 1;     ///< unknowns of a node: u, p

    bool isVarying;                     ///< density varies: the mass matrix is lumped and the transport's mass fluxes convect. In all lanes or in none
    Real volume;                        ///< fluid part [m^D]
    Real first[N];                      ///< int N_a
    const Real* gradN;                  ///< N*D
    Real rho, mu;                       ///< density, viscosity at t^(n+1): means over the fluid part
    Real molecular;                     ///< viscosity without that of eddies: of walls [Pa s]
    Real c0;                            ///< du/dt = c0 u - history [1/s]
    /// d(rho u)/dt - 1/2 drho/dt u = inertia u - momentumHistory with BDF of rho u and rho: inertia =
    /// 1/2 (c0 rho - c1 rho^n - c2 rho^(n-1)) stays positive when a node turns from water to gas in one step, where
    /// c0 rho + 1/2 drho/dt does not (BDF1: Guermond & Quartapelle 2000, doi 10.1006/jcph.2000.6609).
    Real inertia;                       ///< [kg/(m^3 s)]
    Real isSecondOrder[N];              ///< 1 for nodes whose inertia is second order in time, if the step is, else 0 (varying)
    Real nodalInertia[N];               ///< like inertia, of the nodes (varying)
    Real convection[N*N];               ///< of row a by node b: half the mass flux from a to b, see loadConvection() [kg/s] (varying)
    Real streamlineDensity;             ///< of the SUPG terms [kg/m^3]
    Real forceShare[N];                 ///< density of the node over the mean, - 1: see above (varying)
    Real densityRate[N];                ///< drho/dt at the nodes (their mean if not varying) [kg/(m^3 s)]
    Real tau, tauCont;                  ///< [s], [Pa s]
    Real advection[D];                  ///< a: mean over the fluid part [m/s]
    Real force[D];                      ///< f [N/m^3]
    Real viscousForce[D];               ///< mu lap u of the residual [N/m^3]
    Real history[N*D];                  ///< nodal -(c1 u^n + c2 u^(n-1)) [m/s^2]
    Real momentumHistory[N*D];          ///< nodal -(c1 rho^n u^n + c2 rho^(n-1) u^(n-1)) [N/m^3]
    Real ag[N];                         ///< a . grad N_a, from prepare()

    void prepare()
    {
        for (int a = 0; a < N; ++a)
        {
            Real sum{};     // through ag every addition would wait for the last one's way to memory and back
            for (int d = 0; d < D; ++d) sum += advection[d]*gradN[a*D + d];
            ag[a] = sum;
        }
    }
};

/// What a uniform steady velocity 1 leaves of inertia and convection in row a: 1/2 (drho/dt + div of the mass flux), integrated.
template<int D, class Real>
inline Real massDefect(const ElementData<D, Real>& e, int a)
{
    if (!e.isVarying) return 0.5*(e.densityRate[a]*e.first[a] - e.rho*e.ag[a]*e.volume);
    Real halfOutflow{};
    for (int b = 0; b <= D; ++b) halfOutflow += e.convection[a*(D + 1) + b];
    return 0.5*e.densityRate[a]*e.first[a] + halfOutflow;
}

/// int N_a N_b for a != b of an element that is not cut; twice that for a = b.
template<int D, class Real>
inline Real mixedMoment(const ElementData<D, Real>& e)
{
    return e.volume*(1.0/((D + 1)*(D + 2)));
}

/// What all rows of an element have of its nodal histories.
template<int D, class Real>
struct ElementHistory
{
    Real velocity[D] = {};  ///< integral over the fluid part
    Real momentum[D] = {};  ///< one density, not cut: of the integral times N_a, but for the node's own second half
    Real residual[D];       ///< with the forces over the density: what SUPG and PSPG have on the right

    explicit ElementHistory(const ElementData<D, Real>& e)
    {
        const bool isPlain = !e.isVarying && !e.second;
        for (int b = 0; b <= D; ++b)
            for (int k = 0; k < D; ++k) velocity[k] += e.first[b]*e.history[b*D + k];
        for (int b = 0; b <= D && isPlain; ++b)
            for (int k = 0; k < D; ++k) momentum[k] += e.momentumHistory[b*D + k];
        const Real mixed = mixedMoment(e), volumeOverRho = e.volume/e.rho;
        for (int k = 0; k < D; ++k)
        {
            momentum[k] *= mixed;
            residual[k] = velocity[k] + volumeOverRho*(e.force[k] + e.viscousForce[k]);
        }
    }
};

/// Right-hand side of node a: history and body force with their SUPG and PSPG parts.
template<int D, class Real>
struct NodeSource
{
    Real momentum[D], continuity{};

    NodeSource(const ElementData<D, Real>& e, int a, const ElementHistory<D, Real>& history)
    {
        constexpr int N = D + 1;
        const Real* ga = e.gradN + a*D;
        const Real streamline = e.tau*e.streamlineDensity*e.ag[a];
        const Real forced = e.isVarying ? (1 + e.forceShare[a])*e.first[a] : e.first[a];
        const Real own = e.isVarying ? e.first[a] : e.second ? Real{} : mixedMoment(e);
        for (int k = 0; k < D; ++k)
        {
            Real mass = history.momentum[k] + own*e.momentumHistory[a*D + k];
            for (int b = 0; b < N && e.second && !e.isVarying; ++b) mass += e.second[a*N + b]*e.momentumHistory[b*D + k];
            momentum[k] = mass + streamline*history.residual[k] + forced*e.force[k];
            continuity += ga[k]*history.residual[k];
        }
        continuity *= e.tau;
    }
};

/// u' = -tau (du/dt + a.grad u + (grad p - f - mu lap u)/rho) of the nodes' solution x (N*(D + 1)) [m/s].
template<int D, class Real>
inline void fineScaleVelocity(const ElementData<D, Real>& e, const Real* x, Real* result)
{
    const Real volume = 1/e.volume, density = 1/e.rho;
    Real rate[D] = {}, gradP[D] = {};
    for (int a = 0; a <= D; ++a)
    {
        const Real *u = x + a*(D + 1), mean = e.first[a]*volume, fromU = e.c0*mean + e.ag[a];
        for (int d = 0; d < D; ++d)
        {
            rate[d] += fromU*u[d] - mean*e.history[a*D + d];
            gradP[d] += e.gradN[a*D + d]*u[D];
        }
    }
    for (int d = 0; d < D; ++d) result[d] = -e.tau*(rate[d] + (gradP[d] - e.force[d] - e.viscousForce[d])*density);
}

} // namespace flotsam
