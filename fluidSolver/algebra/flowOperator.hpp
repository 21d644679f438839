// SPDX-License-Identifier: GPL-3.0-or-later
/// Products with a FlowSystem. Vectors: `x` nNodes*(dim+1) local values with the halo up to date, `q` nDof per solid.
#pragma once

#include "algebra/flowSystem.hpp"
#include "algebra/halo.hpp"

namespace flotsam
{

class FlowOperator
{
public:
    FlowOperator(const NodeGraph& graph, const Halo& halo, const FlowSystem& system, int nOwned)
    :   graph_(graph), halo_(halo), s_(system), nOwned_(nOwned)
    {}

    /// y (nOwned*(dim+1)) = fluid rows times (x, q). ofPressure: what gradient() gave for the pressure of x, if that is at hand.
    void fluidRows(const double* x, const double* q, double* y, const double* ofPressure = nullptr) const;
    /// y (nOwned) = continuity rows times (u of x, q of free solids); the pressure of x is not used.
    void divergence(const double* x, const double* q, double* y) const;
    /// y (nOwned*dim) = momentum rows on the graph times the pressure p (nNodes).
    void gradient(const double* p, double* y) const;

    /// r (nDof per solid) = rows of all solids times (x, q), without inertia. Collective: the same on every rank.
    void solidRows(const double* x, const double* q, double* r) const;
    /// The same for the pressure p (nNodes) alone.
    void solidRowsOfPressure(const double* p, double* r) const;

    /// Removes the prescribed directions, fixed pressures and inactive nodes from an owned vector.
    void project(double* y) const;

    int blockSize() const { return s_.dim + 1; }

private:
    template<int D, bool withGradient> void graphRows(const double*, const double*, double*) const;
    template<int D> void addGhosts(const double*, double*) const;
    template<int D> void addSolids(const double*, double*) const;
    template<int D> void fluidRowsT(const double*, const double*, double*, const double*) const;
    template<int D> void divergenceT(const double*, const double*, double*) const;
    template<int D> void gradientT(const double*, double*) const;

    const NodeGraph& graph_;
    const Halo& halo_;
    const FlowSystem& s_;
    int nOwned_;
};

} // namespace flotsam
