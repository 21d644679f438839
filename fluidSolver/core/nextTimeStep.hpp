// SPDX-License-Identifier: GPL-3.0-or-later
/// How long the next time step is, and why.
#pragma once

#include "core/controls.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace flotsam
{

constexpr double timeStepGrowth = 1.2;  ///< largest, from step to step

/// The first time step of two fluids [s]: `given`, at most the time in which what falls freely from rest gets a Courant number of maxCo: the fields of the start do not tell
/// how fast a dam breaks. shortest: element [m]; gravity [m/s^2], 0: none.
inline double firstTimeStep(double given, double maxCo, double shortest, double gravity)
{
    return gravity > 0 ? std::min(given, std::sqrt(maxCo*shortest/gravity)) : given;
}

/// Time step [s] and the word for what limits it. flowRate, bodyRate: Courant numbers of a step of 1 s [1/s]; last: step before [s].
inline std::pair<double, std::string> nextTimeStep(double flowRate, double bodyRate, const TimeControls& time, double last)
{
    if (!time.adjustTimeStep) return {time.deltaT, "fixed"};
    double dt = timeStepGrowth*last;
    std::string limit = "growth";
    // no quotient of what is as good as zero: the velocity of a body that comes to rest falls to the smallest numbers there are
    const auto cap = [&](double largest, double rate, const char* word) { if (rate*dt > largest) { dt = largest/rate; limit = word; } };
    cap(time.maxCo, flowRate, "flow");
    cap(time.maxBodyCo, bodyRate, "body");
    cap(time.maxDeltaT, 1, "cap");
    return {dt, limit};
}

} // namespace flotsam
