// SPDX-License-Identifier: GPL-3.0-or-later
/// One BoomerAMG V-cycle of a matrix on the owned nodes, which serves later matrices in its scaled form: with the diagonal D then and now the cycle V
/// becomes W V W, W^2 = D_then/D_now. A change of the time step is met exactly, and where the surface passes a node its diagonal changes by the density
/// ratio; unscaled, a cycle built for water there is a thousand times too strong for gas, and each such node costs GMRES an iteration.
#pragma once

#include "algebra/flowSystem.hpp"
#include "algebra/halo.hpp"

#include <petscpc.h>

namespace flotsam
{

class ScaledCycle
{
public:
    /// prefix: of its PETSc options.
    ScaledCycle(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const char* prefix);
    ~ScaledCycle();
    ScaledCycle(const ScaledCycle&) = delete;
    ScaledCycle& operator=(const ScaledCycle&) = delete;

    /// An empty matrix with room for the graph and the ghost faces, which reach beyond it and move with the solids.
    Mat newMatrix(const FlowSystem& system);
    /// A cycle of that matrix, filled. scale(i): 1/sqrt(diagonal) of owned node i. Collective.
    void build(const std::vector<double>& scale);
    /// The cycle is to serve a matrix with these diagonals.
    void rescale(const std::vector<double>& scale);

    /// p (nOwned) = one V-cycle on r (nOwned).
    void apply(const double* r, double* p);

private:
    void create();

    const SimplexMesh& mesh_;
    const NodeGraph& graph_;
    const Halo& halo_;
    std::string prefix_;
    Mat matrix_ = nullptr;
    PC cycle_ = nullptr;
    Vec in_ = nullptr, out_ = nullptr;
    std::vector<double> builtScale_, weight_;   // nOwned: scale then; diagonal of W
};

} // namespace flotsam
