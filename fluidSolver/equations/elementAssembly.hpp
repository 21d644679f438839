// SPDX-License-Identifier: GPL-3.0-or-later
/// The volume terms of one element, all node pairs at once, added to the matrix: what pairs have in common is computed once.
#pragma once

#include "algebra/flowSystem.hpp"
#include "equations/elementTerms.hpp"

namespace flotsam
{

/// Factors of one element that belong to a single node. Copies: they stay in registers while the matrix is written.
template<int D>
struct NodeFactors
{
    static constexpr int N = D + 1;
    double grad[N*D], first[N];
    double pspg[N];         ///< tau (c0 int N_b + V a.grad N_b)
    double supg[N];         ///< tau V a.grad N_a (by the streamline density), and the node's extra share of the force (varying density)
    double convection[N];   ///< rho a.grad N_a (streamline density)

    explicit NodeFactors(const ElementData<D>& e)
    {
        for (int k = 0; k < N*D; ++k) grad[k] = e.gradN[k];
        for (int a = 0; a < N; ++a)
        {
            first[a] = e.first[a];
            pspg[a] = e.tau*(e.c0*e.first[a] + e.volume*e.ag[a]);
            supg[a] = e.tau*e.streamlineDensity/e.rho*e.ag[a]*e.volume + (e.isVarying ? e.forceShare[a]*e.first[a] : 0);
            convection[a] = e.streamlineDensity*e.ag[a];
        }
    }
};

/// Inertia, skew-symmetric convection, its SUPG part: the same scalar on every velocity component.
/// With a constant density the skew form is 1/2 sum_b (F_ab rho) u_b, F_ab the fluxes between dual cells. Where the density varies,
/// the transport's own mass fluxes stand there: a uniform velocity then meets no force from density that moves along.
template<int D>
inline double scalarMomentum(const ElementData<D>& e, const NodeFactors<D>& f, int a, int b)
{
    const double galerkin = e.isVarying
        ? (a == b ? e.nodalInertia[a]*f.first[a] : 0) + e.convection[a*(D + 1) + b]
        : e.inertia*e.second[a*(D + 1) + b] + 0.5*(f.convection[b]*f.first[a] - f.convection[a]*f.first[b]);
    return galerkin + f.convection[a]*f.pspg[b];
}

/// Adds gradient column, divergence row and both pressure values of the pair (a,b).
template<int D>
inline void addPressurePair(const NodeFactors<D>& f, int a, int b, double pspg, double schur, std::size_t slot, FlowSystem& system)
{
    const double *ga = f.grad + a*D, *gb = f.grad + b*D;
    double *g = &system.matrix.gradient[slot*D], *d = &system.matrix.divergence[slot*D];
    const double firstA = f.first[a], firstB = f.first[b], supg = f.supg[a], own = f.pspg[b];
    for (int k = 0; k < D; ++k)
    {
        g[k] += supg*gb[k] - firstB*ga[k];  // pressure gradient, SUPG
        d[k] += firstA*gb[k] + own*ga[k];   // continuity, PSPG
    }
    system.matrix.pressure[slot] += pspg;
    system.schur[slot] += schur;
}

/// Adds every volume term of the element to the rows of its nodes; slots (a*N + b): entries of the matrix, negative in rows of other ranks.
template<int D>
inline void addElement(const ElementData<D>& e, const int* slot, FlowSystem& system)
{
    constexpr int N = D + 1;
    const NodeFactors<D> f(e);
    const double viscous = e.mu*e.volume, gradDiv = e.tauCont*e.volume;
    const double pspg = e.tau/e.rho*e.volume, schur = e.volume*(e.tau/e.rho + 1/e.inertia);
    for (int a = 0; a < N; ++a)
    {
        const double* ga = f.grad + a*D;
        for (int b = a; b < N; ++b)
        {
            const int ab = slot[a*N + b], ba = slot[b*N + a];
            if (ab < 0 && ba < 0) continue;
            const double* gb = f.grad + b*D;
            double stress[D*D], laplace = 0;    // of (a,b); that of (b,a) is its transpose
            for (int k = 0; k < D; ++k)
            {
                laplace += ga[k]*gb[k];
                for (int l = 0; l < D; ++l) stress[k*D + l] = viscous*ga[l]*gb[k] + gradDiv*ga[k]*gb[l];
            }
            if (ab >= 0)
            {
                double* m = &system.matrix.velocity[std::size_t(ab)*D*D];
                const double diagonal = scalarMomentum(e, f, a, b) + viscous*laplace;
                for (int k = 0; k < D*D; ++k) m[k] += stress[k];
                for (int k = 0; k < D; ++k) m[k*D + k] += diagonal;
                addPressurePair(f, a, b, pspg*laplace, schur*laplace, ab, system);
            }
            if (a == b || ba < 0) continue;
            double* m = &system.matrix.velocity[std::size_t(ba)*D*D];
            const double diagonal = scalarMomentum(e, f, b, a) + viscous*laplace;
            for (int k = 0; k < D; ++k)
                for (int l = 0; l < D; ++l) m[k*D + l] += stress[l*D + k];
            for (int k = 0; k < D; ++k) m[k*D + k] += diagonal;
            addPressurePair(f, b, a, pspg*laplace, schur*laplace, ba, system);
        }
    }
}

} // namespace flotsam
