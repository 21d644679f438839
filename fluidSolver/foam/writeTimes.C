// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/writeTimes.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// What the clock knows of write times is protected; a derived class may name it.
struct ClockAccess : Foam::Time
{
    static bool isAdjusted(const Foam::Time& t) { return t.*&ClockAccess::writeControl_ == wcAdjustableRunTime; }
    static bool isCounted(const Foam::Time& t) { return isAdjusted(t) || t.*&ClockAccess::writeControl_ == wcRunTime; }
    static bool isOfSteps(const Foam::Time& t) { return t.*&ClockAccess::writeControl_ == wcTimeStep; }
    static double interval(const Foam::Time& t) { return t.*&ClockAccess::writeInterval_; }
    /// Number of the last write time of this run: the clock is at one after a step when the number has grown.
    static Foam::label& written(Foam::Time& t) { return t.*&ClockAccess::writeTimeIndex_; }
};

constexpr double excess = 0.01;    // of the wanted step that a step may take besides to end at a write time, as Time's own
constexpr double nothing = 1e-6;    // of a step: a jump so near has been met
constexpr const char* inflow = "inflow";
constexpr double least = 0.1;       // of the wanted step: none is made shorter for what is let in
constexpr double few = 2;           // steps before a jump from which on they are made to meet it: none is less than half as long as wanted

/// The longest step of at most `wanted` of which a whole number lies in `left`; all in s.
double wholeSteps(double left, double wanted)
{
    return left/std::max(1.0, std::ceil(left/wanted - excess));
}

/// Number of write times from `first` to `time`, as Time counts them: one less than half a step ahead has come.
double count(const Foam::Time& clock, double first, double time, double step)
{
    return std::floor((time - first + 0.5*step)/ClockAccess::interval(clock));
}

} // namespace

WriteTimes::WriteTimes(Foam::Time& clock, double first, double lastStep, const std::vector<double>& motions, const std::vector<TimeJump>& flows)
:   clock_(clock), first_(first), time_(clock.value()), lastStep_(lastStep)
{
    for (const double time : motions) jumps_.push_back({{time, 0}, "motion"});
    for (const TimeJump& flow : flows) jumps_.push_back({flow, inflow});
}

bool WriteTimes::isBehindInflow() const
{
    const auto isBehind = [this](const Jump& jump)
    {
        const double since = time_ - jump.at.time;
        return jump.word == inflow && jump.at.length <= lastStep_ && (std::abs(since) < nothing*lastStep_ || std::abs(since - lastStep_) < nothing*lastStep_);
    };
    return std::any_of(jumps_.begin(), jumps_.end(), isBehind);
}

double WriteTimes::setStep(double wanted)
{
    if (isBehindInflow()) wanted = std::min(wanted, lastStep_);
    double step = wanted;
    if (ClockAccess::isAdjusted(clock_))
    {
        const double left = first_ + (count(clock_, first_, time_, lastStep_) + 1)*ClockAccess::interval(clock_) - time_;
        step = wholeSteps(left, wanted);
    }
    reason_ = "write";
    for (const Jump& jump : jumps_)
    {
        const double left = jump.at.time - time_;
        const bool isNear = jump.word == inflow && left < least*wanted; // at the start: no step before it can be shorter
        if (left < nothing*step || left > few*step || jump.at.length > wanted || isNear) continue;
        const double shorter = wholeSteps(left, wanted);
        if (shorter >= step) continue;
        step = shorter;
        reason_ = jump.word;
    }
    clock_.setDeltaT(step, false);
    clock_.functionObjects().adjustTimeStep();
    return clock_.deltaTValue();
}

bool WriteTimes::isDueAfter(double step) const { return count(clock_, first_, time_ + step, step) > count(clock_, first_, time_, lastStep_); }

bool WriteTimes::mayWriteAfter(double step) const
{
    if (ClockAccess::isCounted(clock_)) return isDueAfter(step);
    const Foam::label interval = Foam::label(ClockAccess::interval(clock_));
    return !ClockAccess::isOfSteps(clock_) || (interval != 0 && (clock_.timeIndex() + 1) % interval == 0);
}

bool WriteTimes::comeBy(double end) const
{
    constexpr double roundOff = 1e-9;   // of a step: a write time at the end is one
    return !ClockAccess::isCounted(clock_) || count(clock_, first_, end, roundOff*ClockAccess::interval(clock_)) > count(clock_, first_, time_, lastStep_);
}

void WriteTimes::advance(double step)
{
    clock_.setDeltaT(step, false);
    if (ClockAccess::isCounted(clock_))
    {
        ClockAccess::written(clock_) = isDueAfter(step) ? -1 : Foam::labelMax;
        ++clock_;
        ClockAccess::written(clock_) = 0; // a changed interval multiplies it
    }
    else ++clock_;
    time_ = clock_.value();
    lastStep_ = step;
}

} // namespace flotsam
