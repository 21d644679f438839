// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether what prescribed velocities bring in can leave.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/simplexMesh.hpp"

namespace flotsam
{

/// Throws std::invalid_argument, on every rank, where no patch leaves its velocity open and what the prescribed ones bring in differs from what they take out by more than 1 %
/// of both: the fluids are incompressible, so the difference would have to appear or vanish within the mesh. values: of the patches; cover: null without solids. Collective.
void checkInflowBalance(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values, const Cover* cover);

} // namespace flotsam
