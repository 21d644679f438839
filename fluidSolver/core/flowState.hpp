// SPDX-License-Identifier: GPL-3.0-or-later
/// Nodal unknowns and their older time levels. Copying this is copying the state of the fluid.
#pragma once

#include <vector>

namespace flotsam
{

/// Liquid of a start field that cells were given.
struct StartLiquid
{
    std::vector<double> volume;         ///< nNodes: of the shares of the nodes in the cells [m^dim]; empty: as alpha at the nodes says
    std::vector<char> isAtSide;         ///< nNodes: beside an upright side of a smooth surface; empty: there is none
};

struct FlowState
{
    double time = 0;
    double dt = 0;                      ///< last step [s]; 0 before the first
    std::vector<double> u, uOld;        ///< nNodes*dim velocity at t^n, t^(n-1) [m/s]
    std::vector<double> p, pOld;        ///< nNodes pressure at t^n, t^(n-1) [Pa] (full pressure)
    std::vector<double> alpha, alphaOld; ///< nNodes phase field, 1 liquid
    std::vector<double> alphaOlder;     ///< set as a step begins: alphaOld until then
    StartLiquid startLiquid;            ///< of a start field that is not yet the phase field's profile
    std::vector<double> remainder;      ///< nOwned*(dim+1): of what the last solve has left, force and flux that the next one has to make up for [N; 2D: N/m; m^dim/s]; empty: nothing
    std::vector<double> fineScale, fineScaleOld; ///< nElements*dim: u' = -tau r_m of the last two solves [m/s]
};

} // namespace flotsam
