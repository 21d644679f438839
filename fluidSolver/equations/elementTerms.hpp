// SPDX-License-Identifier: GPL-3.0-or-later
/// The volume terms of the momentum and continuity equations on one simplex or its fluid part; one function per term.
///
/// Weak form (paper eq 5, momentum convection skew-symmetric, see docs/numerics.md):
///   (w, d(rho u)/dt - 1/2 drho/dt u) + 1/2 [(w, rho a.grad u) - (rho a.grad w, u)]              inertia, convection
/// + (eps(w), 2 mu eps(u)) - (div w, p) + (q, div u) + (div w, tau_c div u)                      stress, continuity
/// + sum_e (tau a.grad w + tau grad q/rho, rho (du/dt + a.grad u) + grad p - f) = (w, f)         SUPG, PSPG
/// a = u + u', u' = -tau (residual)/rho of the last step: only the sum is free of divergence, and momentum is conserved by what is
/// (Hughes & Wells 2005, doi 10.1016/j.cma.2004.06.034).
/// Where the density varies mass is lumped with the nodes' own densities, and the force grad p - f of an element goes to its nodes in proportion
/// to these: one acceleration for all of them, as the pressure's gradient is one. SUPG, which moves momentum between the nodes, has the
/// density of the lightest: with the mean's it would move a gas node beside water a thousand times as much as the residual asks for.
/// P1: gradients are constant; all integrals are exact from V, int N_a and int N_a N_b of the fluid part.
#pragma once


namespace flotsam
{

template<int D>
struct ElementData
{
    static constexpr int N = D + 1;     ///< nodes
    static constexpr int B = D + 1;     ///< unknowns of a node: u, p

    double volume;                      ///< fluid part [m^D]
    double first[N];                    ///< int N_a
    double second[N*N];                 ///< int N_a N_b
    const double* gradN;                ///< N*D
    double rho, mu;                     ///< density, viscosity at t^(n+1): means over the fluid part
    double c0;                          ///< du/dt = c0 u - history [1/s]
    /// d(rho u)/dt - 1/2 drho/dt u = inertia u - momentumHistory with BDF of rho u and rho: inertia =
    /// 1/2 (c0 rho - c1 rho^n - c2 rho^(n-1)) stays positive when a node turns from water to gas in one step, where
    /// c0 rho + 1/2 drho/dt does not (BDF1: Guermond & Quartapelle 2000, doi 10.1006/jcph.2000.6609).
    double inertia;                     ///< [kg/(m^3 s)]
    bool isVarying;                     ///< density varies: the mass matrix is lumped and the transport's mass fluxes convect
    double nodalInertia[N];             ///< like inertia, of the nodes (varying)
    double convection[N*N];             ///< of row a by node b: half the mass flux from a to b, see loadConvection() [kg/s] (varying)
    double streamlineDensity;           ///< of the SUPG terms [kg/m^3]
    double forceShare[N];               ///< density of the node over the mean, - 1: see above (varying)
    double densityRate[N];              ///< drho/dt at the nodes (their mean if not varying) [kg/(m^3 s)]
    double tau, tauCont;                ///< [s], [Pa s]
    double advection[D];                ///< a: mean over the fluid part [m/s]
    double force[D];                    ///< f [N/m^3]
    double history[N*D];                ///< nodal -(c1 u^n + c2 u^(n-1)) [m/s^2]
    double momentumHistory[N*D];        ///< nodal -(c1 rho^n u^n + c2 rho^(n-1) u^(n-1)) [N/m^3]
    double ag[N];                       ///< a . grad N_a, from prepare()

    void prepare()
    {
        for (int a = 0; a < N; ++a)
        {
            ag[a] = 0;
            for (int d = 0; d < D; ++d) ag[a] += advection[d]*gradN[a*D + d];
        }
    }
};

/// Element matrix: block (a,b) at [(a*N + b)*B*B], row-major; right-hand side B per node.
template<int D>
struct ElementMatrix
{
    static constexpr int N = D + 1, B = D + 1;
    double block[N*N*B*B];
    double rhs[N*B];
};

/// Inertia, skew-symmetric convection, its SUPG part: the same scalar on every velocity component.
/// With a constant density the skew form is 1/2 sum_b (F_ab rho) u_b, F_ab the fluxes between dual cells. Where the density varies,
/// the transport's own mass fluxes stand there: a uniform velocity then meets no force from density that moves along.
template<int D>
inline double scalarMomentum(const ElementData<D>& e, int a, int b)
{
    const double galerkin = e.isVarying
        ? (a == b ? e.nodalInertia[a]*e.first[a] : 0) + e.convection[a*(D + 1) + b]
        : e.inertia*e.second[a*(D + 1) + b] + 0.5*e.rho*(e.ag[b]*e.first[a] - e.ag[a]*e.first[b]);
    return galerkin
         + e.tau*e.streamlineDensity*e.ag[a]*(e.c0*e.first[b] + e.volume*e.ag[b]);
}

/// What a uniform steady velocity 1 leaves of inertia and convection in row a: 1/2 (drho/dt + div of the mass flux), integrated.
template<int D>
inline double massDefect(const ElementData<D>& e, int a)
{
    if (!e.isVarying) return 0.5*(e.densityRate[a]*e.first[a] - e.rho*e.ag[a]*e.volume);
    double halfOutflow = 0;
    for (int b = 0; b <= D; ++b) halfOutflow += e.convection[a*(D + 1) + b];
    return 0.5*e.densityRate[a]*e.first[a] + halfOutflow;
}

/// Adds every volume term of node pair (a,b) into its block.
template<int D>
inline void addPair(const ElementData<D>& e, int a, int b, double* m)
{
    constexpr int B = D + 1;
    const double* ga = e.gradN + a*D;
    const double* gb = e.gradN + b*D;
    double gg = 0;
    for (int d = 0; d < D; ++d) gg += ga[d]*gb[d];
    const double viscous = e.mu*e.volume, gradDiv = e.tauCont*e.volume;
    const double diagonal = scalarMomentum(e, a, b) + viscous*gg;
    const double streamline = e.tau*e.streamlineDensity/e.rho*e.ag[a]*e.volume;
    const double pspg = e.tau*(e.c0*e.first[b] + e.volume*e.ag[b]);
    for (int k = 0; k < D; ++k)
    {
        for (int l = 0; l < D; ++l) m[k*B + l] = viscous*ga[l]*gb[k] + gradDiv*ga[k]*gb[l];
        m[k*B + k] += diagonal;
        m[k*B + D] = -ga[k]*e.first[b] + streamline*gb[k];  // pressure gradient, SUPG
        m[D*B + k] = e.first[a]*gb[k] + ga[k]*pspg;                     // continuity, PSPG
    }
    if (e.isVarying)
        for (int k = 0; k < D; ++k) m[k*B + D] += e.forceShare[a]*e.first[a]*gb[k];
    m[D*B + D] = e.tau/e.rho*e.volume*gg;                               // PSPG
}

/// Right-hand side of node a: history and body force with their SUPG and PSPG parts.
template<int D>
inline void addSource(const ElementData<D>& e, int a, double* rhs)
{
    constexpr int N = D + 1;
    const double* ga = e.gradN + a*D;
    const double streamline = e.tau*e.streamlineDensity*e.ag[a];
    for (int k = 0; k < D; ++k)
    {
        double mass = 0, mean = 0;
        for (int b = 0; b < N; ++b)
        {
            if (!e.isVarying) mass += e.second[a*N + b]*e.momentumHistory[b*D + k];
            else if (a == b) mass += e.first[a]*e.momentumHistory[b*D + k];
            mean += e.first[b]*e.history[b*D + k];
        }
        rhs[k] = mass + streamline*(mean + e.volume*e.force[k]/e.rho) + e.first[a]*e.force[k];
        if (e.isVarying) rhs[k] += e.forceShare[a]*e.first[a]*e.force[k];
        rhs[D] = (k == 0 ? 0 : rhs[D]) + e.tau*ga[k]*(mean + e.volume*e.force[k]/e.rho);
    }
}

} // namespace flotsam
