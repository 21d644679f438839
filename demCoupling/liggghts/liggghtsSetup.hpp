// SPDX-License-Identifier: GPL-3.0-or-later
/// What the engine adds to what it is given before LIGGGHTS starts, and the sub-step it takes where nothing touches.
#pragma once

#include "demCoupling/liggghts/liggghtsEngine.hpp"

namespace flotsam
{

/// `given` with its movers as bodies behind its bodies and, where it is 0, the skin of the neighbour lists [m]. DemError: no bodies, an empty box, negative numbers.
DemSetup completed(const DemSetup& given);

/// The sub-step [s] of free flight over `duration` [s]: under constant loads ways are exact at any step, turning is not, so that no body turns by more than a small angle in one.
/// loads: of fluid and weight [N, N m]; movers count as bodies do.
double freeFlightStep(const DemSetup& setup, const std::vector<BodyState>& states, const std::vector<Load>& loads, const std::vector<char>& isHeld,
                      const std::vector<char>& isGone, double duration);

} // namespace flotsam
