// SPDX-License-Identifier: GPL-3.0-or-later
/// Where liquid and gas are, by heights against gravity.
#pragma once

#include "algebra/halo.hpp"
#include "core/flowState.hpp"
#include "core/simplexMesh.hpp"

#include <array>

namespace flotsam
{

/// Heights [m]: along -gravity from the origin of the mesh's coordinates.
struct LiquidPlace
{
    double liquid = 0, gas = 0;                 ///< volumes, what solids cover included [m^3]
    double lowest = 0, highest = 0;             ///< of the liquid and its surface
    double bottom = 0, top = 0;                 ///< of the mesh
    double meanLiquid = 0, meanGas = 0;
    double fastest = 0;                         ///< of the liquid [m/s]
};

/// gravity: not zero. Collective.
LiquidPlace liquidPlace(const SimplexMesh& mesh, const Halo& halo, const FlowState& state, const std::array<double, 3>& gravity);

/// Liquid at rest that hangs from the top of the mesh, with gas all below it: what a reversed gravity makes of a basin. Drops, jets and columns that stand on something are not so.
bool hangsFromTop(const LiquidPlace& place, double gravity);

} // namespace flotsam
