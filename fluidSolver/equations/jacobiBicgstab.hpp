// SPDX-License-Identifier: GPL-3.0-or-later
/// BiCGStab (van der Vorst 1992, doi:10.1137/0913035) with Jacobi preconditioning for a scalar equation on the mesh's rows.
#pragma once

#include "algebra/halo.hpp"
#include "core/nodeGraph.hpp"

#include <vector>

namespace flotsam
{

/// Solves sum_k matrix[k] x[column[k]] = rhs on the owned rows of all ranks. x: nNodes, start value in, halo up to date
/// before and after. Stops at |residual| <= tolerance |rhs|, both scaled by the diagonal. Returns the iterations done,
/// -1 when maxIterations were not enough. Collective.
int solveJacobiBicgstab(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<double>& matrix,
    const std::vector<double>& rhs, std::vector<double>& x, double tolerance, int maxIterations);

} // namespace flotsam
