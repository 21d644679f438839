// SPDX-License-Identifier: GPL-3.0-or-later
/// Approximate inverse of the velocity block of a FlowSystem, which only preconditions: its diagonal blocks, in single precision. A symmetric
/// Gauss-Seidel sweep takes a quarter of the iterations away, but makes forces noisy in 2D and costs what it saves in 3D (docs/numerics.md, section 5).
#pragma once

#include "algebra/flowSystem.hpp"

namespace flotsam
{

class VelocityBlock
{
public:
    VelocityBlock(const NodeGraph& graph, int nOwned, int dim) : graph_(graph), nOwned_(nOwned), dim_(dim), inverse_(std::size_t(nOwned)*dim*dim) {}

    /// ghost: what the ghost faces add to the diagonal of each node.
    void set(const FlowSystem& system, const std::vector<double>& ghost);

    /// z (dim+1 values a node, velocity first; the pressures become 0) = approximate inverse times the momentum rows of r, which were
    /// multiplied by scale (dim+1 values a node, one for the node's velocity).
    void solve(const double* r, const double* scale, double* z) const;

    /// Takes the inverse diagonal blocks times g (dim values a node) from the velocities of z.
    void subtractDiagonal(const double* g, double* z) const;

private:
    template<int D> void setT(const FlowSystem& system, const std::vector<double>& ghost);
    template<int D> void solveT(const double* r, const double* scale, double* z) const;
    template<int D> void subtractT(const double* g, double* z) const;

    const NodeGraph& graph_;
    const int nOwned_, dim_;
    std::vector<float> inverse_;    // nOwned*dim*dim
};

} // namespace flotsam
