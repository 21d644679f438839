// SPDX-License-Identifier: GPL-3.0-or-later
/// The fluid block of a FlowSystem as one sparse matrix, and its condition number. One rank only.
#pragma once

#include "algebra/flowSystem.hpp"
#include "core/simplexMesh.hpp"

#include <Eigen/Sparse>

namespace flotsam
{

struct SystemMatrix
{
    Eigen::SparseMatrix<double> matrix; ///< free unknowns of the active nodes, ghost faces included; rows, columns scaled by 1/sqrt|a_ii|
    Eigen::VectorXd scale;              ///< 1/sqrt|a_ii|
    std::vector<int> unknown;           ///< nNodes*(dim+1): row, -1 when prescribed or inactive
};

/// Prescribed velocities must be whole vectors. isScaled false: as assembled.
SystemMatrix systemMatrix(const SimplexMesh& mesh, const NodeGraph& graph, const FlowSystem& system, bool isScaled = true);

/// Largest over smallest singular value, by power iteration with the matrix and its LU factors, on the complement of the constant
/// pressure when no pressure is prescribed.
double conditionNumber(const SimplexMesh& mesh, const FlowSystem& system, const SystemMatrix& matrix);

} // namespace flotsam
