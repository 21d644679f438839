// SPDX-License-Identifier: GPL-3.0-or-later
/// What one step of the phase transport did, and the account of the liquid's volume.
#pragma once

#include "algebra/halo.hpp"

#include <vector>

namespace flotsam
{

struct TransportReport
{
    int subSteps = 0;
    double liquidBefore = 0, liquidAfter = 0;   ///< int alpha over the fluid part, all ranks [m^dim]
    double inflow = 0, outflow = 0;             ///< liquid volume that crossed the boundary in this step, both >= 0
    double redistributed = 0;                   ///< liquid moved by the global correction (cut cells that change size)
    double minAlpha = 0, maxAlpha = 1;          ///< before values beyond [0,1] are cut to it
    long nLimited = 0;                          ///< faces on which the bounds limiter acted
    long nRoof = 0, nBand = 0;                  ///< in the last sub-step, all ranks
};

/// int alpha over this rank's owned dual cells [m^dim].
double liquidOf(const SimplexMesh& mesh, const std::vector<double>& dualVolume, const std::vector<double>& alpha);

/// max |u| over all ranks [m/s]. u: nNodes*dim. Collective.
double largestSpeed(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& u);

/// Makes int alpha = liquidBefore + inflow - outflow by alpha += c alpha(1 - alpha), |c| <= 1: this keeps 0 and 1 and the
/// values between them, and the volume is linear in c. Sets liquidAfter and redistributed. The report's volumes are sums
/// over ranks; alpha: nNodes, halo up to date before and after. Collective.
void restoreLiquid(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& dualVolume,
    std::vector<double>& alpha, TransportReport& report);

} // namespace flotsam
