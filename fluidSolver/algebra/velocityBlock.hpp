// SPDX-License-Identifier: GPL-3.0-or-later
/// Approximate inverse of the velocity block of a FlowSystem, which only preconditions: its diagonal blocks, damped, in single precision, and where these are far
/// off: one block for all nodes that ghost penalty holds, a symmetric Gauss-Seidel sweep over gas nodes beside water (docs/numerics.md, section 5).
#pragma once

#include "algebra/ghostHeldNodes.hpp"

namespace flotsam
{

class VelocityBlock
{
public:
    VelocityBlock(const NodeGraph& graph, int nOwned, int dim) : graph_(graph), nOwned_(nOwned), dim_(dim), inverse_(std::size_t(nOwned)*dim*dim) {}

    /// Keeps the system by reference. ghost: what the ghost faces add to the diagonal of each node.
    void set(const FlowSystem& system, const std::vector<double>& ghost);

    /// z (dim+1 values a node, velocity first; the pressures become 0) = approximate inverse times the momentum rows of r, which were
    /// multiplied by scale (dim+1 values a node, one for the node's velocity).
    void solve(const double* r, const double* scale, double* z);

    /// Symmetric Gauss-Seidel on the light nodes, from the z of solve() without its prescribed directions; r and scale as there.
    void relaxLightNodes(const double* r, const double* scale, double* z) const;

    /// Takes the damped inverse blocks times g (dim values a node) from the velocities of z.
    void subtractDiagonal(const double* g, double* z);

private:
    template<int D> void setT(const FlowSystem& system, const std::vector<double>& ghost);
    template<int D> void solveT(const double* r, const double* scale, double* z) const;
    void setHeldNodes(const FlowSystem& system, const std::vector<double>& ghost);
    void addHeldValues(double factor, double* z);
    void findLightNodes(const FlowSystem& system);
    template<int D> void relaxNode(int i, const double* r, const double* scale, double* z) const;
    template<int D> void relaxT(const double* r, const double* scale, double* z) const;
    template<int D> void subtractT(const double* g, double* z) const;

    const NodeGraph& graph_;
    const int nOwned_, dim_;
    const FlowSystem* system_ = nullptr;
    std::vector<float> inverse_;    // nOwned*dim*dim; 0 at the nodes of held_
    GhostHeldNodes held_;           // without prescribed directions
    std::vector<int> lightNodes_;   // ascending: FlowSystem::isLight, but for nodes with prescribed directions and those of held_
    std::vector<char> isHeld_;      // owned nodes, work of findLightNodes() and setHeldNodes()
    std::vector<double> ofElements_;    // owned nodes, work of setHeldNodes()
    SparseEntries entries_;             // likewise
};

} // namespace flotsam
