// SPDX-License-Identifier: GPL-3.0-or-later
/// Sub-step that springs and tethers need. Nothing here knows LIGGGHTS.
#pragma once

#include "demCoupling/liggghts/liggghtsEngine.hpp"

namespace flotsam
{

/// Largest velocity that a unit impulse at `place` (frame of the body) gives that point [1/kg]: of the free body, in 2D in its plane.
double largestMobility(const BodyDefinition& body, const Vec3& place);

/// Over all bodies, as if the restraints that each has added up: bounds of the square of the highest frequency [1/s^2] and of the rate of damping [1/s].
struct RestraintRates { double stiffness = 0, damping = 0; };
RestraintRates restraintRates(const DemSetup& setup);

/// Sub-step [s] that resolves them; huge without restraints.
double restraintTimeStep(const DemSetup& setup);

/// DemError: the given sub-step is more than the restraints can take, or none that they can take is practical.
void checkRestraintStep(const DemSetup& setup, double step);

/// Undamped period [s] of the dry bodies along the line of the restraint at the start, and its damping ratio.
struct RestraintPeriod { double period = 0, dampingRatio = 0; };
RestraintPeriod naturalPeriod(const RestraintDefinition& restraint, const std::vector<BodyDefinition>& bodies, const std::vector<MoverDefinition>& movers, double startTime);

/// Between the ends at the start [m]: vector from `other` to `end`.
Vec3 initialLine(const RestraintDefinition& restraint, const std::vector<BodyDefinition>& bodies, const std::vector<MoverDefinition>& movers, double startTime);

} // namespace flotsam
