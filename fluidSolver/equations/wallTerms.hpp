// SPDX-License-Identifier: GPL-3.0-or-later
/// Terms on the surface of a solid inside one cut element (paper eq 5, last term; docs/numerics.md).
///
/// n: out of the fluid. Jumps [u] = u - ubar, [w] = w - W with rigid ubar, W: P1 functions on the element. Nitsche:
///   - (sigma(u,p) n).[w] - q n.[u] + (2 mu eps(w) n).[u] + gamma mu/h [u].[w]
///   + (c rho h r + 0.1 rho |a|) ([u].n)([w].n) + rho max(0, -(a - ubar).n) [u].[w]
/// (non-symmetric; Massing, Schott & Wall 2018, doi 10.1016/j.cma.2017.09.003, coefficients measured for this method). c = 0.1; slip walls: 0.01, and
/// the products of jumps by their means over the facet, as P1 cannot follow every facet of a round wall that nothing else holds.
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
    double adjoint = 1;     ///< factor of (viscous traction of w).[u]: 1 non-symmetric, stable with any factor of [u].[w]; -1 symmetric, adjoint-consistent
    double convection;      ///< 1/2 rho (ubar.n): boundary part of the skew-symmetric convection, on u.w
};

/// Of the Nitsche condition, without the surface's convection. Eddies transfer nothing to a no-slip wall: there the layer below them does.
/// rate: penaltyRate() [1/s]; outflow: (a - ubar).n that counts, mean over the facet [m/s].
template<int D>
inline WallCoefficients nitscheCoefficients(const ElementData<D>& e, bool isSlip, double gamma, double h, double rate, double outflow)
{
    double speed = 0;
    for (int d = 0; d < D; ++d) speed += e.advection[d]*e.advection[d];
    WallCoefficients c{};
    c.isNitsche = true;
    c.isSlip = isSlip;
    c.mu = isSlip ? e.mu : e.molecular;
    c.tangential = gamma*c.mu/h + e.rho*std::max(0.0, -outflow);
    c.normal = e.rho*((isSlip ? 0.01 : 0.1)*h*rate + 0.1*std::sqrt(speed));
    return c;
}

inline WallCoefficients penaltyCoefficients(bool isSlip, double penalty)
{
    WallCoefficients c{};
    c.isSlip = isSlip;
    c.tangential = penalty;
    return c;
}

/// The terms of one facet group, n its normal: what the blocks of all pairs of nodes have in common.
template<int D>
class WallTerms
{
public:
    WallTerms(const WallCoefficients& c, const double* n, const double* gradN)
    :   adjoint_(c.adjoint)
    {
        for (int k = 0; k < D; ++k)
        {
            pressure_[k] = c.isNitsche ? n[k] : 0;
            for (int l = 0; l < D; ++l) held_[k][l] = (c.isSlip ? c.tangential + c.normal : c.normal)*n[k]*n[l];
            if (!c.isSlip) held_[k][k] += c.tangential;
        }
        for (int a = 0; a <= D && c.isNitsche; ++a) setTraction(c, n, gradN + a*D, traction_[a]);
    }

    /// block (a,b) of the jumps: (D + 1)^2, row-major, velocity first. m1 = int N_a, m2 = int N_a N_b over the group; held: m2, or that of their means.
    void block(int a, int b, double m1a, double m1b, double m2, double held, double* m) const
    {
        constexpr int B = D + 1;
        for (int k = 0; k < D; ++k)
        {
            for (int l = 0; l < D; ++l) m[k*B + l] = held*held_[k][l] + adjoint_*m1b*traction_[a][l][k] - m1a*traction_[b][k][l];
            m[k*B + D] = m2*pressure_[k];
            m[D*B + k] = -m2*pressure_[k];
        }
        m[D*B + D] = 0;
    }

private:
    /// Viscous traction of a node with gradient g: T[k][l] = mu (dn N delta_kl + d_k N n_l). Slip: n n.T, only the normal one works on the normal jump.
    static void setTraction(const WallCoefficients& c, const double* n, const double* g, double (*T)[D])
    {
        double gn = 0; // dn N
        for (int d = 0; d < D; ++d) gn += g[d]*n[d];
        for (int k = 0; k < D; ++k)
        {
            for (int l = 0; l < D; ++l) T[k][l] = c.isSlip ? 2*c.mu*gn*n[k]*n[l] : c.mu*g[k]*n[l];
            if (!c.isSlip) T[k][k] += c.mu*gn;
        }
    }

    double traction_[D + 1][D][D] = {}; // of the nodes
    double held_[D][D];                 // factor of [u].[w]
    double pressure_[D];
    double adjoint_;
};

} // namespace flotsam
