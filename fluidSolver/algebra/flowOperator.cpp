// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/flowOperator.hpp"

#include <algorithm>

namespace flotsam
{

/// Rows on the node graph. Without gradient: `ofPressure` has its products already, a fifth of the matrix need not be read.
template<int D, bool withGradient>
void FlowOperator::graphRows(const double* x, const double* ofPressure, double* y) const
{
    constexpr int B = D + 1;
    const int* column = graph_.column.data();
    for (int i = 0; i < nOwned_; ++i)
    {
        if (!s_.isActive[i])    // no fluid, no unknowns: the row is empty
        {
            std::fill_n(y + std::size_t(i)*B, B, 0.0);
            continue;
        }
        double sum[B] = {};
        if (!withGradient)
            for (int r = 0; r < D; ++r) sum[r] = ofPressure[std::size_t(i)*D + r];
        for (int k = graph_.rowStart[i]; k < graph_.rowStart[i + 1]; ++k)
        {
            const double* K = &s_.matrix.velocity[std::size_t(k)*D*D];
            const double* G = &s_.matrix.gradient[std::size_t(k)*D];
            const double* W = &s_.matrix.divergence[std::size_t(k)*D];
            const double* v = x + std::size_t(column[k])*B;
            double ofEntry[B] = {};     // apart: a chain of additions to one sum takes longer than to load the matrix
            for (int r = 0; r < D; ++r)
            {
                for (int c = 0; c < D; ++c) ofEntry[r] += K[r*D + c]*v[c];
                if (withGradient) ofEntry[r] += G[r]*v[D];
                ofEntry[D] += W[r]*v[r];
            }
            ofEntry[D] += s_.matrix.pressure[k]*v[D];
            for (int r = 0; r < B; ++r) sum[r] += ofEntry[r];
        }
        for (int r = 0; r < B; ++r) y[std::size_t(i)*B + r] = sum[r];
    }
}

template<int D>
void FlowOperator::addGhosts(const double* x, double* y) const
{
    constexpr int B = D + 1;
    for (const GhostTerm& g : s_.ghosts)
    {
        double jump[B] = {};
        for (int j = 0; j < D + 2; ++j)
        {
            const double* v = x + std::size_t(g.node[j])*B;
            for (int c = 0; c < D; ++c) jump[c] += g.jumpVelocity[j]*v[c];
            jump[D] += g.jumpPressure[j]*v[D];
        }
        for (int j = 0; j < D + 2; ++j)
        {
            if (g.node[j] >= nOwned_) continue;
            double* w = y + std::size_t(g.node[j])*B;
            for (int c = 0; c < D; ++c) w[c] += g.velocityFactor*g.jumpVelocity[j]*jump[c];
            w[D] += g.pressureFactor*g.jumpPressure[j]*jump[D];
        }
    }
}

template<int D>
void FlowOperator::addSolids(const double* q, double* y) const
{
    constexpr int B = D + 1;
    for (std::size_t s = 0; s < s_.solids.size(); ++s)
    {
        const SolidCoupling& solid = s_.solids[s];
        const double* qs = q + s*s_.nDof;
        for (std::size_t k = 0; k < solid.node.size(); ++k)
        {
            if (solid.node[k] >= nOwned_) continue;
            const double* c = solid.column.data() + k*B*s_.nDof;
            for (int r = 0; r < B; ++r)
                for (int d = 0; d < s_.nDof; ++d) y[std::size_t(solid.node[k])*B + r] += c[r*s_.nDof + d]*qs[d];
        }
    }
}

template<int D>
void FlowOperator::fluidRowsT(const double* x, const double* q, double* y, const double* ofPressure) const
{
    if (ofPressure) graphRows<D, false>(x, ofPressure, y);
    else graphRows<D, true>(x, nullptr, y);
    addGhosts<D>(x, y);
    if (q) addSolids<D>(q, y);
}

template<int D>
void FlowOperator::divergenceT(const double* x, const double* q, double* y) const
{
    constexpr int B = D + 1;
    const int* column = graph_.column.data();
    for (int i = 0; i < nOwned_; ++i)
    {
        double sum = 0;
        for (int k = graph_.rowStart[i]; s_.isActive[i] && k < graph_.rowStart[i + 1]; ++k)
        {
            const double* a = &s_.matrix.divergence[std::size_t(k)*D];
            const double* v = x + std::size_t(column[k])*B;
            double ofEntry = 0;
            for (int c = 0; c < D; ++c) ofEntry += a[c]*v[c];
            sum += ofEntry;
        }
        y[i] = sum;
    }
    for (std::size_t s = 0; q && s < s_.solids.size(); ++s)
    {
        const SolidCoupling& solid = s_.solids[s];
        if (!solid.isFree) continue;
        for (std::size_t k = 0; k < solid.node.size(); ++k)
        {
            if (solid.node[k] >= nOwned_) continue;
            const double* c = solid.column.data() + (k*B + D)*s_.nDof;
            for (int d = 0; d < s_.nDof; ++d) y[solid.node[k]] += c[d]*q[s*s_.nDof + d];
        }
    }
}

template<int D>
void FlowOperator::gradientT(const double* p, double* y) const
{
    const int* column = graph_.column.data();
    for (int i = 0; i < nOwned_; ++i)
    {
        double sum[D] = {};
        for (int k = graph_.rowStart[i]; s_.isActive[i] && k < graph_.rowStart[i + 1]; ++k)
        {
            const double* a = &s_.matrix.gradient[std::size_t(k)*D];
            const double v = p[column[k]];
            for (int c = 0; c < D; ++c) sum[c] += a[c]*v;
        }
        for (int c = 0; c < D; ++c) y[std::size_t(i)*D + c] = sum[c];
    }
}

void FlowOperator::fluidRows(const double* x, const double* q, double* y, const double* ofPressure) const
{
    if (s_.dim == 2) fluidRowsT<2>(x, q, y, ofPressure); else fluidRowsT<3>(x, q, y, ofPressure);
}

void FlowOperator::divergence(const double* x, const double* q, double* y) const
{
    if (s_.dim == 2) divergenceT<2>(x, q, y); else divergenceT<3>(x, q, y);
}

void FlowOperator::gradient(const double* p, double* y) const
{
    if (s_.dim == 2) gradientT<2>(p, y); else gradientT<3>(p, y);
}

void FlowOperator::solidRows(const double* x, const double* q, double* r) const
{
    const int B = s_.dim + 1, n = s_.nDof;
    const int total = int(s_.solids.size())*n;
    std::fill(r, r + total, 0.0);
    for (std::size_t s = 0; s < s_.solids.size(); ++s)
    {
        const SolidCoupling& solid = s_.solids[s];
        for (std::size_t k = 0; k < solid.node.size(); ++k)
            for (int d = 0; d < n; ++d)
                for (int c = 0; c < B; ++c)
                    r[s*n + d] += solid.row[(k*n + d)*B + c]*x[std::size_t(solid.node[k])*B + c];
        for (int d = 0; d < n && !solid.block.empty(); ++d)
            for (int c = 0; c < n; ++c) r[s*n + d] += solid.block[d*n + c]*q[s*n + c];
    }
    if (total > 0) halo_.sum(r, total);
}

void FlowOperator::solidRowsOfPressure(const double* p, double* r) const
{
    const int B = s_.dim + 1, n = s_.nDof;
    const int total = int(s_.solids.size())*n;
    std::fill(r, r + total, 0.0);
    for (std::size_t s = 0; s < s_.solids.size(); ++s)
    {
        const SolidCoupling& solid = s_.solids[s];
        if (!solid.isFree) continue;
        for (std::size_t k = 0; k < solid.node.size(); ++k)
            for (int d = 0; d < n; ++d) r[s*n + d] += solid.row[(k*n + d)*B + s_.dim]*p[solid.node[k]];
    }
    if (total > 0) halo_.sum(r, total);
}

void FlowOperator::project(double* y) const
{
    const int B = s_.dim + 1;
    for (const NodeConstraint& c : s_.constraints)
    {
        double* v = y + std::size_t(c.node)*B;
        if (c.nDirections >= s_.dim)
        {
            std::fill(v, v + s_.dim, 0.0);
            continue;
        }
        for (int k = 0; k < c.nDirections; ++k)
        {
            double along = 0;
            for (int d = 0; d < s_.dim; ++d) along += c.direction[k][d]*v[d];
            for (int d = 0; d < s_.dim; ++d) v[d] -= along*c.direction[k][d];
        }
    }
    for (int i = 0; i < nOwned_; ++i)
    {
        if (!s_.isActive[i]) std::fill(y + std::size_t(i)*B, y + std::size_t(i + 1)*B, 0.0);
        else if (s_.isPressureFixed[i]) y[std::size_t(i)*B + s_.dim] = 0;
    }
}

} // namespace flotsam
