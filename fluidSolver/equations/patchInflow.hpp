// SPDX-License-Identifier: GPL-3.0-or-later
/// What patches bring into the flow and hold against it, in the numbers of a hydraulic engineer: discharges and water levels.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/controls.hpp"
#include "core/flowState.hpp"
#include "core/simplexMesh.hpp"

namespace flotsam
{

/// Through a patch with a given velocity, what leaves counted negative [m^3/s].
struct PatchInflow
{
    double all = 0;
    double liquid = 0;
    double gasAtLiquid = 0;     ///< gas that enters where liquid stands at the patch
};

/// values: of the patch at that state; cover: null without solids. Collective.
PatchInflow prescribedInflow(const SimplexMesh& mesh, const Halo& halo, const BoundaryPatch& patch, const PatchValues& values, const FlowState& state, const Cover* cover);

/// Height along the vertical (against gravity) up to which liquid at rest outside would give the patches with a given pressure theirs, one per patch; -infinity where no liquid stands
/// outside, or the velocity is prescribed. The gas outside of all of them is taken to have the lowest of their pressures. Two fluids with gravity. Collective.
std::vector<double> outsideLevels(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const FluidProperties& fluid, double time);

/// How much the pressures that patches give to gas differ from those of gas at rest [Pa]; 0 where fewer than two nodes give one. The second: as much as a patch with one pressure all over
/// (a free overfall) makes in a mesh of this height. Patches below the liquid's level do not count, nor where liquid enters. alpha: at the nodes. Two fluids with gravity. Collective.
struct GasPressures { double spread = 0, ofHeight = 0; };
GasPressures gasPressures(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const FluidProperties& fluid,
    const std::vector<double>& alpha, double time);

} // namespace flotsam
