// SPDX-License-Identifier: GPL-3.0-or-later
/// Values inside solids for whoever reads written fields beside their surfaces: viewers and probes interpolate over whole cells, in which nodes inside the solid stand, too.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

#include <vector>

namespace flotsam
{

/// Continues `values` (nNodes, halo up to date before and after) to the inactive nodes within `nRings` elements of active ones: each takes the mean over
/// its known neighbours' values and gradients, a node's gradient being the mean over the fluid parts around. Linear fields are continued exactly; deeper
/// nodes keep what they have. Collective.
void extendLinearly(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, std::vector<double>& values, int nRings = 2);

} // namespace flotsam
