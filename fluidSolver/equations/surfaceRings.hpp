// SPDX-License-Identifier: GPL-3.0-or-later
/// Rings of nodes around the elements in which the density varies.
#pragma once

#include "algebra/halo.hpp"
#include "equations/elementLoader.hpp"

namespace flotsam
{

/// Fills nodal.surfaceRing by nodal.fluid. Collective.
void findSurfaceRings(const SimplexMesh& mesh, const Halo& halo, NodalData& nodal);

} // namespace flotsam
