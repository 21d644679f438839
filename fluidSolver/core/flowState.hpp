// SPDX-License-Identifier: GPL-3.0-or-later
/// Nodal unknowns and their older time levels. Copying this is copying the state of the fluid.
#pragma once

#include <vector>

namespace flotsam
{

struct FlowState
{
    double time = 0;
    double dt = 0;                      ///< last step [s]; 0 before the first
    std::vector<double> u, uOld;        ///< nNodes*dim velocity at t^n, t^(n-1) [m/s]
    std::vector<double> p, pOld;        ///< nNodes pressure at t^n, t^(n-1) [Pa] (full pressure)
    std::vector<double> alpha, alphaOld; ///< nNodes phase field, 1 liquid
    std::vector<double> alphaOlder;     ///< set as a step begins: alphaOld until then
    double startLiquid = -1;            ///< volume of a sharp start field [m^dim]; negative: that of alpha at the nodes
    std::vector<double> fineScale, fineScaleOld; ///< nElements*dim: u' = -tau r_m of the last two solves [m/s]
};

} // namespace flotsam
