// SPDX-License-Identifier: GPL-3.0-or-later
/// Distance of the nodes from patches of the mesh.
#pragma once

#include "algebra/halo.hpp"
#include "core/simplexMesh.hpp"

namespace flotsam
{

/// nNodes: distance from the nearest face of `patches` (numbers in mesh.patches) on any rank, at most `farthest` [m], which everything beyond has. Collective.
std::vector<double> distanceFromPatches(const SimplexMesh& mesh, const Halo& halo, const std::vector<int>& patches, double farthest);

} // namespace flotsam
