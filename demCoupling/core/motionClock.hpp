// SPDX-License-Identifier: GPL-3.0-or-later
/// When a prescribed motion begins and ends, and how it gets up to speed and comes to rest.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace flotsam
{

/// The motion is a law of a time of its own, which stands until `start`, runs as the run's does from `ramp` later on, slows down from `ramp` before `end` and stands
/// from there on. Within a ramp its rate is 3x^2 - 2x^3: no jump of velocity or acceleration, which water without a free surface would answer with an infinite or a jumping force.
struct MotionClock
{
    double start = 0, end = std::numeric_limits<double>::infinity(), ramp = 0; ///< [s]; start >= 0, end - start >= 2 ramp

    /// Time of the law [s] and its rate at a time of the run [s]. Where the rate jumps it is that of the step which ends there: a step's velocity is that of its end.
    std::pair<double, double> at(double time) const
    {
        const double sinceStart = time - start, untilEnd = end - time;
        if (isStill(time)) return {sinceStart > roundOff ? end - start - ramp : 0, 0};
        if (sinceStart < ramp) return ramped(sinceStart);
        if (ramp == 0) return {std::min(sinceStart, end - start), 1};
        if (untilEnd >= ramp) return {sinceStart - 0.5*ramp, 1};
        const auto [left, rate] = ramped(untilEnd);
        return {end - start - ramp - left, rate};
    }

    /// Times at which the velocity jumps [s], not that of the run's start: steps should end there.
    std::vector<double> jumps() const
    {
        std::vector<double> times;
        if (ramp > 0) return times;
        if (start > 0) times.push_back(start);
        if (std::isfinite(end)) times.push_back(end);
        return times;
    }

private:
    static constexpr double roundOff = 1e-9; // [s], as of the bodies' releases: steps that end at a jump do so to the last digits

    /// What moves from the run's start on has its velocity then already.
    bool isStill(double time) const { return (start > 0 || ramp > 0 ? time <= start + roundOff : time < 0) || time > end + roundOff; }
    /// The rate and its integral.
    std::pair<double, double> ramped(double time) const
    {
        const double x = time/ramp;
        return {ramp*x*x*x*(1 - 0.5*x), x*x*(3 - 2*x)};
    }
};

} // namespace flotsam
