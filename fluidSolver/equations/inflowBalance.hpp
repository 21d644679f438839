// SPDX-License-Identifier: GPL-3.0-or-later
/// Whether what prescribed velocities bring in can leave.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/simplexMesh.hpp"

namespace flotsam
{

/// Whether velocities are prescribed and no patch leaves its own open.
bool needsInflowBalance(const std::vector<BoundaryPatch>& patches);

/// Of patches that need it: throws std::invalid_argument, on every rank, where what the prescribed velocities bring in differs from what they take out by more than 1 % of both: the fluids are incompressible, so the difference would have to appear or vanish within the mesh. values: of the patches; cover: null without solids. Collective.
void checkInflowBalance(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const std::vector<PatchValues>& values, const Cover* cover);

} // namespace flotsam
