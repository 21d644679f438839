// SPDX-License-Identifier: GPL-3.0-or-later
/// The volume terms of one element, all node pairs at once, added to the matrix: what pairs have in common is computed once.
#pragma once

#include "algebra/flowSystem.hpp"
#include "equations/elementTerms.hpp"

#include <Eigen/Core>

namespace flotsam
{

/// Values of the four corners b of an element, with which the processor computes several at once. In 2D the last one stays zero.
using Corners = Eigen::Array4d;

/// Values of an element's corners that lie `stride` apart.
template<int D>
inline Corners load(const double* v, int stride = 1)
{
    return {v[0], v[stride], v[2*stride], D == 3 ? v[3*stride] : 0};
}

/// Factors of one element that belong to a single node.
template<int D>
struct NodeFactors
{
    Corners grad[D], first;
    Corners pspg;           ///< tau (c0 int N_b + V a.grad N_b)
    Corners convection;     ///< rho a.grad N_a (streamline density)
    double streamline;      ///< tau V (by the streamline density)

    explicit NodeFactors(const ElementData<D>& e)
    :   first(load<D>(e.first)), streamline(e.tau*e.volume*e.streamlineDensity/e.rho)
    {
        for (int k = 0; k < D; ++k) grad[k] = load<D>(e.gradN + k, D);
        const Corners ag = load<D>(e.ag);
        pspg = e.tau*(e.c0*first + e.volume*ag);
        convection = e.streamlineDensity*ag;
    }
};

/// Inertia, skew-symmetric convection, its SUPG part in row a: the same scalar on every velocity component.
/// With a constant density the skew form is 1/2 sum_b (F_ab rho) u_b, F_ab the fluxes between dual cells. Where the density varies,
/// the transport's own mass fluxes stand there: a uniform velocity then meets no force from density that moves along.
/// Without ownMass().
template<int D>
inline Corners scalarMomentum(const ElementData<D>& e, const NodeFactors<D>& f, int a)
{
    const double own = e.streamlineDensity*e.ag[a];
    const Corners streamline = own*f.pspg;
    if (e.isVarying) return load<D>(e.convection + a*(D + 1)) + streamline;
    const Corners convection = 0.5*(f.convection*e.first[a] - own*f.first) + streamline;
    if (e.second) return e.inertia*load<D>(e.second + a*(D + 1)) + convection;
    return e.inertia*mixedMoment(e) + convection;
}

/// What row a has on its diagonal alone: the lumped mass where the density varies, the second half of the consistent one of an element that is not cut.
template<int D>
inline double ownMass(const ElementData<D>& e, int a)
{
    return e.isVarying ? e.nodalInertia[a]*e.first[a] : e.second ? 0 : e.inertia*mixedMoment(e);
}

/// What an element adds to one row of the matrix: every kind of entry for all corners.
template<int D>
struct ElementRow
{
    Corners velocity[D*D], gradient[D], divergence[D], laplace;

    /// viscous: mu V, gradDiv: tau_cont V.
    [[gnu::always_inline]] ElementRow(const ElementData<D>& e, const NodeFactors<D>& f, int a, double viscous, double gradDiv)
    {
        const double* ga = e.gradN + a*D;
        const double first = e.first[a], supg = f.streamline*e.ag[a] + (e.isVarying ? e.forceShare[a]*first : 0);
        laplace = ga[0]*f.grad[0];
        for (int k = 1; k < D; ++k) laplace += ga[k]*f.grad[k];
        const Corners scalar = scalarMomentum(e, f, a) + viscous*laplace;
        for (int k = 0; k < D; ++k)
        {
            for (int l = 0; l < D; ++l) velocity[k*D + l] = (viscous*ga[l])*f.grad[k] + (gradDiv*ga[k])*f.grad[l];
            velocity[k*(D + 1)] += scalar;
            gradient[k] = supg*f.grad[k] - ga[k]*f.first;       // pressure gradient, SUPG
            divergence[k] = first*f.grad[k] + ga[k]*f.pspg;     // continuity, PSPG
        }
    }
};

template<int n>
inline void addColumn(const Corners* values, int b, double* sums)
{
    Eigen::Map<Eigen::Array<double, n, 1>> all(sums);
    Eigen::Array<double, n, 1> v;
    for (int c = 0; c < n; ++c) v[c] = values[c][b];
    all += v;
}

/// Adds every volume term of the element to the rows of its nodes; slots (a*N + b): entries of the matrix, negative in rows of other ranks.
template<int D>
inline void addElement(const ElementData<D>& e, const int* slot, FlowSystem& system)
{
    constexpr int N = D + 1;
    const NodeFactors<D> f(e);
    const double viscous = e.mu*e.volume, gradDiv = e.tauCont*e.volume;
    const double pspg = e.tau/e.rho*e.volume, schur = pspg + e.volume/e.inertia;
    double *velocity = system.matrix.velocity.data(), *gradient = system.matrix.gradient.data(), *divergence = system.matrix.divergence.data();
    double *pressure = system.matrix.pressure.data(), *ofSchur = system.schur.data();
    for (int a = 0; a < N; ++a)
    {
        if (slot[a*N] < 0) continue;
        const ElementRow<D> row(e, f, a, viscous, gradDiv);
        for (int b = 0; b < N; ++b)
        {
            const std::size_t k = slot[a*N + b];
            addColumn<D*D>(row.velocity, b, velocity + k*D*D);
            addColumn<D>(row.gradient, b, gradient + k*D);
            addColumn<D>(row.divergence, b, divergence + k*D);
            pressure[k] += pspg*row.laplace[b];
            ofSchur[k] += schur*row.laplace[b];
        }
        double *own = velocity + std::size_t(slot[a*(N + 1)])*D*D, mass = ownMass(e, a);
        for (int c = 0; c < D; ++c) own[c*(D + 1)] += mass;
    }
}

} // namespace flotsam
