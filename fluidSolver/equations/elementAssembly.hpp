// SPDX-License-Identifier: GPL-3.0-or-later
/// The volume terms of an element, or of several at once, added to the matrix: what nodes and pairs of nodes have in common is computed once.
#pragma once

#include "algebra/flowSystem.hpp"
#include "equations/elementTerms.hpp"

namespace flotsam
{

/// Factors of an element that belong to a single node, and those of all.
template<int D, class Real>
struct NodeFactors
{
    static constexpr int N = D + 1;

    Real pspg[N];           ///< tau (c0 int N_b + V a.grad N_b)
    Real convection[N];     ///< rho a.grad N_a (streamline density)
    Real streamline[N];     ///< of the pressure gradient: SUPG; where the density varies also the node's share of the force
    Real viscous, gradDiv;  ///< mu V, tau_cont V
    Real pressure, schur;   ///< of grad q.grad p: PSPG; with the inertial part of the Schur complement

    explicit NodeFactors(const ElementData<D, Real>& e)
    :   viscous(e.mu*e.volume), gradDiv(e.tauCont*e.volume), pressure(e.tau/e.rho*e.volume), schur(pressure + e.volume/e.inertia)
    {
        for (int a = 0; a < N; ++a)
        {
            pspg[a] = e.tau*(e.c0*e.first[a] + e.volume*e.ag[a]);
            convection[a] = e.streamlineDensity*e.ag[a];
            streamline[a] = pressure*convection[a];
            if (e.isVarying) streamline[a] += e.forceShare[a]*e.first[a];
        }
    }
};

/// Inertia, skew-symmetric convection, its SUPG part in row a by node b: the same scalar on every velocity component.
/// With a constant density the skew form is 1/2 sum_b (F_ab rho) u_b, F_ab the fluxes between dual cells. Where the density varies,
/// the transport's own mass fluxes stand there: a uniform velocity then meets no force from density that moves along; mass is lumped there.
template<int D, class Real>
inline Real scalarMomentum(const ElementData<D, Real>& e, const NodeFactors<D, Real>& f, int a, int b)
{
    const int ab = a*(D + 1) + b;
    const Real streamline = f.convection[a]*f.pspg[b];
    if (e.isVarying) return e.convection[ab] + streamline + (a == b ? e.nodalInertia[a]*e.first[a] : Real{});
    const Real convection = 0.5*(f.convection[b]*e.first[a] - f.convection[a]*e.first[b]) + streamline;
    if (e.second) return e.inertia*e.second[ab] + convection;
    const Real mixed = e.inertia*mixedMoment(e);
    return a == b ? 2*mixed + convection : mixed + convection;
}

/// grad N_b.grad N_a and, by components k of the test function and l of the velocity, viscous stress and grad-div: the stress of (b, a) is the transpose.
template<int D, class Real>
struct PairStress
{
    Real laplace{}, stress[D][D];

    PairStress(const ElementData<D, Real>& e, const NodeFactors<D, Real>& f, int a, int b)
    {
        const Real *ga = e.gradN + a*D, *gb = e.gradN + b*D;
        for (int k = 0; k < D; ++k) laplace += ga[k]*gb[k];
        const Real ofAll = f.viscous*laplace;
        for (int k = 0; k < D; ++k)
        {
            const Real viscous = f.viscous*gb[k], gradDiv = f.gradDiv*ga[k];
            for (int l = 0; l < D; ++l) stress[k][l] = viscous*ga[l] + gradDiv*gb[l];
            stress[k][k] += ofAll;
        }
    }
};

/// Where an element's entries go: the arrays of a FlowSystem.
struct EntryTarget
{
    double *velocity, *gradient, *divergence, *pressure, *schur;

    explicit EntryTarget(FlowSystem& s)
    :   velocity(s.matrix.velocity.data()), gradient(s.matrix.gradient.data()), divergence(s.matrix.divergence.data()),
        pressure(s.matrix.pressure.data()), schur(s.schur.data())
    {}
};

/// Adds row a, column b of every lane's element. pair: of (a, b), or of (b, a) with isTransposed. slot: of the lanes, negative in rows of other ranks.
template<bool isTransposed, int D, class Real>
inline void addEntry(const ElementData<D, Real>& e, const NodeFactors<D, Real>& f, const PairStress<D, Real>& pair, int a, int b,
    const int* slot, const EntryTarget& target)
{
    const Real *ga = e.gradN + a*D, *gb = e.gradN + b*D;
    const Real scalar = scalarMomentum(e, f, a, b), pressure = f.pressure*pair.laplace, schur = f.schur*pair.laplace;
    Real velocity[D*D], gradient[D], divergence[D];
    for (int k = 0; k < D; ++k)
    {
        for (int l = 0; l < D; ++l) velocity[k*D + l] = isTransposed ? pair.stress[l][k] : pair.stress[k][l];
        velocity[k*(D + 1)] += scalar;
        gradient[k] = f.streamline[a]*gb[k] - ga[k]*e.first[b];     // pressure gradient, SUPG
        divergence[k] = e.first[a]*gb[k] + ga[k]*f.pspg[b];         // continuity, PSPG
    }
    for (int l = 0; l < widthOf<Real>; ++l)
    {
        const std::ptrdiff_t k = slot[l];
        if (k < 0) continue;
        addLane<D*D>(velocity, l, target.velocity + k*D*D);
        addLane<D>(gradient, l, target.gradient + k*D);
        addLane<D>(divergence, l, target.divergence + k*D);
        target.pressure[k] += lane(pressure, l);
        target.schur[k] += lane(schur, l);
    }
}

/// Adds every volume term of the elements to the rows of their nodes; slot[a*N + b][lane]: entries of the matrix, negative in rows of other ranks.
template<int D, class Real>
inline void addElement(const ElementData<D, Real>& e, const int (*slot)[widthOf<Real>], FlowSystem& system)
{
    constexpr int N = D + 1;
    const NodeFactors<D, Real> f(e);
    const EntryTarget target(system);
    for (int a = 0; a < N; ++a)
    {
        for (int b = a; b < N; ++b)
        {
            const PairStress<D, Real> pair(e, f, a, b);
            addEntry<false>(e, f, pair, a, b, slot[a*N + b], target);
            if (b != a) addEntry<true>(e, f, pair, b, a, slot[b*N + a], target);
        }
    }
}

} // namespace flotsam
