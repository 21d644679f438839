// SPDX-License-Identifier: GPL-3.0-or-later
/// From a sharp start field to the phase field's equilibrium profile.
#pragma once

#include "algebra/halo.hpp"
#include "core/flowState.hpp"
#include "core/nodeGraph.hpp"

namespace flotsam
{

class DualCells;

/// Replaces a sharp nodal field (0..1, values between allowed, e.g. averages of cell values; halo up to date) by
/// alpha_i = mean of 1/(1 + exp(-d/width_i)) over the node's dual cell (cells null: at the node), d = distance to the level 0.5 of the given field,
/// positive in the liquid.
/// A shift of d gives int alpha (nodal values times dual volumes of the whole mesh) the volume of `liquid`, at and away from its sides each: what a side lacks must not
/// lower the level. A field that does not cross 0.5 is left as it is. Collective; the result does not depend on the number of ranks.
void makeStartProfile(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo,
    const std::vector<double>& width, std::vector<double>& alpha, const StartLiquid& liquid = {}, const DualCells* cells = nullptr);

} // namespace flotsam
