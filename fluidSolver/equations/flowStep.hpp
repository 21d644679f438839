// SPDX-License-Identifier: GPL-3.0-or-later
/// What the assembly of one time step reads.
#pragma once

#include "core/boundary.hpp"
#include "core/flowState.hpp"
#include "core/timeScheme.hpp"
#include "equations/dualCellTransport.hpp"
#include "equations/surfacePressure.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

class Basins;
class GasRegion;
class MassFluxes;
class ShutPockets;

/// Everything a step's assembly reads.
struct FlowStepData
{
    TimeScheme time;
    double gravity = 0;                         ///< its size [m/s^2]; bounds penaltyRate()
    double speed = 0;                           ///< largest of the fluid at t^n, without gravity [m/s]; bounds penaltyRate() then
    const FlowState* state = nullptr;           ///< t^n, t^(n-1); alpha already at t^(n+1)
    const Cover* cover = nullptr;               ///< null: no solids
    const GasRegion* gas = nullptr;             ///< null: no gas is left out
    const Basins* basins = nullptr;             ///< of the cover
    const ShutPockets* pockets = nullptr;       ///< null: no solids
    const std::vector<Solid>* solids = nullptr; ///< pose and motion at t^(n+1); free: predicted
    const std::vector<PatchValues>* patchValues = nullptr; ///< at t^(n+1)
    const DualCellTransport* transport = nullptr;           ///< its last fluxes carry the momentum; null: a rho does
    const MassFluxes* massFluxes = nullptr;                 ///< of the last step; null: not extrapolated
    const std::vector<double>* fineScale = nullptr;         ///< nElements*dim: u' of the last solve, part of what convects [m/s]; null: 0
    const std::vector<double>* elementForce = nullptr;      ///< nElements*dim: gravity [N/m^3]
    const std::vector<double>* level = nullptr;             ///< nNodes: distance from the surface [m], positive in the liquid; null: not found
    const std::vector<FacetPressure>* surfacePressure = nullptr; ///< that solids feel besides p; null: none
    const std::vector<double>* viscousForce = nullptr;      ///< nElements*dim: see ViscousForce [N/m^3]; null: 0
};

} // namespace flotsam
