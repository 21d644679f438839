// SPDX-License-Identifier: GPL-3.0-or-later
/// Terms on the surface of a solid inside one cut element (paper eq 5, last term; docs/numerics.md).
///
/// n: out of the fluid. Jumps [u] = u - ubar, [w] = w - W with rigid ubar, W: P1 functions on the element. Nitsche:
///   - (sigma(u,p) n).[w] - q n.[u] + (2 mu eps(w) n).[u] + gamma mu/h [u].[w]
///   + (0.1 rho h/dt + 0.1 rho |a|) ([u].n)([w].n) + rho max(0, -(a - ubar).n) [u].[w]
/// (non-symmetric; Massing, Schott & Wall 2018, doi 10.1016/j.cma.2017.09.003, coefficients measured for this method).
/// Pure penalty (the paper's): pbar [u].[w] alone.
/// A rigid motion has no stress and is a P1 function, so all blocks are built for the nodal jumps; the solid's rows and
/// columns follow by transport of the nodal values: action equals reaction to round-off.
#pragma once

#include "equations/elementTerms.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

struct WallCoefficients
{
    bool isNitsche;
    bool isSlip;            ///< only the normal component is held
    double mu;              ///< [Pa s]
    double tangential;      ///< factor of [u].[w] [Pa s/m]
    double normal;          ///< additional factor of ([u].n)([w].n) [Pa s/m]
    double convection;      ///< 1/2 rho (ubar.n): boundary part of the skew-symmetric convection, on u.w
};

/// Of the Nitsche condition, without the surface's convection. dt [s]; outflow: (a - ubar).n, mean over the facet [m/s].
template<int D>
inline WallCoefficients nitscheCoefficients(const ElementData<D>& e, double gamma, double h, double dt, double outflow)
{
    double speed = 0;
    for (int d = 0; d < D; ++d) speed += e.advection[d]*e.advection[d];
    WallCoefficients c{};
    c.isNitsche = true;
    c.mu = e.mu;
    c.tangential = gamma*e.mu/h + e.rho*std::max(0.0, -outflow);
    c.normal = 0.1*e.rho*(h/dt + std::sqrt(speed));
    return c;
}

/// block (a,b) of the jumps for one facet group. m1 = int N_a, m2 = int N_a N_b over the facet; N = D+1 nodes.
template<int D>
inline void wallBlock(const WallCoefficients& c, const double* n, const double* gradN, double m1a, double m1b, double m2,
    int a, int b, double* m)
{
    constexpr int B = D + 1;
    const double* ga = gradN + a*D;
    const double* gb = gradN + b*D;
    for (int k = 0; k < B*B; ++k) m[k] = 0;
    if (!c.isNitsche)
    {
        for (int k = 0; k < D; ++k)
            if (c.isSlip) for (int l = 0; l < D; ++l) m[k*B + l] += c.tangential*m2*n[k]*n[l];
            else m[k*B + k] += c.tangential*m2;
        return;
    }
    double gna = 0, gnb = 0; // dn N
    for (int d = 0; d < D; ++d) { gna += ga[d]*n[d]; gnb += gb[d]*n[d]; }
    // viscous traction of node b: T_b[k][l] = mu (dn N_b delta_kl + d_k N_b n_l)
    double Ta[D][D], Tb[D][D];
    for (int k = 0; k < D; ++k)
        for (int l = 0; l < D; ++l)
        {
            Ta[k][l] = c.mu*((k == l ? gna : 0) + ga[k]*n[l]);
            Tb[k][l] = c.mu*((k == l ? gnb : 0) + gb[k]*n[l]);
        }
    if (c.isSlip) // only the normal traction works on the normal jump
    {
        double na[D], nb[D]; // n.T
        for (int l = 0; l < D; ++l)
        {
            na[l] = nb[l] = 0;
            for (int k = 0; k < D; ++k) { na[l] += n[k]*Ta[k][l]; nb[l] += n[k]*Tb[k][l]; }
        }
        for (int k = 0; k < D; ++k)
            for (int l = 0; l < D; ++l)
                m[k*B + l] += -m1a*n[k]*nb[l] + na[k]*n[l]*m1b + (c.tangential + c.normal)*m2*n[k]*n[l];
    }
    else
    {
        for (int k = 0; k < D; ++k)
        {
            for (int l = 0; l < D; ++l)
                m[k*B + l] += -m1a*Tb[k][l] + Ta[l][k]*m1b + c.normal*m2*n[k]*n[l];
            m[k*B + k] += c.tangential*m2;
        }
    }
    for (int k = 0; k < D; ++k)
    {
        m[k*B + D] += m2*n[k];
        m[D*B + k] -= m2*n[k];
    }
}

} // namespace flotsam
