// SPDX-License-Identifier: GPL-3.0-or-later
/// Approximate inverse of the velocity block of a FlowSystem where viscosity reaches over many elements in a step: a V-cycle for each component, on the
/// block's own entries between equal components and the ghost faces. Spectrally equivalent to the whole block by Korn's inequality, whatever mu dt/(rho h^2).
#pragma once

#include "algebra/scaledCycle.hpp"

#include <memory>

namespace flotsam
{

class ViscousBlock
{
public:
    ViscousBlock(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

    /// scale (dim+1 values a node): 1/sqrt(diagonal), of a node's velocity the first. Collective.
    void build(const FlowSystem& system, const std::vector<double>& scale);
    /// For another system with these diagonals.
    void rescale(const std::vector<double>& scale);

    /// z (dim+1 values a node; the pressures become 0) = approximate inverse times the momentum rows of r, which were multiplied by scale.
    void solve(const double* r, const double* scale, double* z);
    /// Takes the approximate inverse times g (dim values a node) from the velocities of z.
    void subtract(const double* g, double* z);

private:
    void fill(const FlowSystem& system, int component, Mat matrix);
    void findHeld(const FlowSystem& system);
    bool isFree(int i, int component) const { return isFree_[std::size_t(i)*mesh_.dim + component]; }
    void setScale(const std::vector<double>& scale);

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    std::vector<std::unique_ptr<ScaledCycle>> cycles_;  // one a component
    std::vector<double> isFree_;                        // nNodes*dim: 1, or 0 where a component is prescribed or the node inactive
    std::vector<double> scale_, in_, out_;              // nOwned
};

} // namespace flotsam
