// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/motionReader.H"

#include "demCoupling/foam/shapeReader.H"
#include "foam/dictionaryChecks.H"

#include <cmath>

namespace flotsam
{

namespace
{

const std::vector<std::string> motionTypes{"linear", "oscillating", "rotating"};

/// Entries of a motion's dictionary.
std::vector<std::string> withTimes(std::vector<std::string> ofType)
{
    ofType.insert(ofType.begin(), "type");
    ofType.insert(ofType.end(), {"timeStart", "timeEnd", "rampTime"});
    return ofType;
}

PrescribedMotion linearMotion(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, withTimes({"velocity"}));
    return [start, v = readVec3(dict, "velocity")](double time, Pose& pose, Motion& motion)
    {
        pose = start;
        pose.position += v*time;
        motion = {v, Vec3::Zero()};
    };
}

PrescribedMotion oscillation(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, withTimes({"direction", "amplitude", "period", "frequency", "phaseDeg"}));
    if (dict.found("period") == dict.found("frequency")) failIn(dict, "Give either 'period' [s] or 'frequency' [Hz].");
    const double frequency = dict.found("period") ? 1/readNumber(dict, "period", positive) : readNumber(dict, "frequency", positive);
    const Vec3 amplitude = readDirection(dict, "direction")*readNumber(dict, "amplitude", notNegative);
    const double phase = readNumberOr(dict, "phaseDeg", 0, {-360, 360})*M_PI/180, omega = 2*M_PI*frequency;
    return [start, amplitude, phase, omega](double time, Pose& pose, Motion& motion)
    {
        // starts from the given place whatever the phase
        pose = start;
        pose.position += amplitude*(std::sin(omega*time + phase) - std::sin(phase));
        motion = {amplitude*(omega*std::cos(omega*time + phase)), Vec3::Zero()};
    };
}

PrescribedMotion rotation(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, withTimes({"origin", "axis", "rpm", "omega"}));
    if (dict.found("rpm") == dict.found("omega")) failIn(dict, "Give either 'rpm' or 'omega' [rad/s].");
    const double omega = dict.found("rpm") ? readNumber(dict, "rpm", {-1e6, 1e6})*M_PI/30 : readNumber(dict, "omega", {-1e6, 1e6});
    return [start, omega, origin = readVec3Or(dict, "origin", start.position), axis = readDirection(dict, "axis")](double time, Pose& pose, Motion& motion)
    {
        const Eigen::Quaterniond turned(Eigen::AngleAxisd(omega*time, axis));
        const Vec3 arm = turned*(start.position - origin);
        pose = {origin + arm, turned*start.orientation};
        motion = {(omega*axis).cross(arm), omega*axis};
    };
}

MotionClock readClock(const Foam::dictionary& dict)
{
    MotionClock clock;
    clock.start = readNumberOr(dict, "timeStart", clock.start, notNegative);
    clock.ramp = readNumberOr(dict, "rampTime", clock.ramp, notNegative);
    if (!dict.found("timeEnd")) return clock;
    clock.end = readNumber(dict, "timeEnd", positive);
    if (clock.end <= clock.start) failIn(dict, text("The motion ends at timeEnd ", clock.end, " s, but begins at timeStart ", clock.start, " s: timeEnd must be later."));
    if (clock.end - clock.start < 2*clock.ramp)
        failIn(dict, text("The motion takes ", clock.end - clock.start, " s, from timeStart to timeEnd: too short for two ramps of rampTime ", clock.ramp, " s, up to speed and to rest. Give a rampTime of ",
            0.5*(clock.end - clock.start), " s at most."));
    return clock;
}

} // namespace

PrescribedMotion StructureMotion::timed() const
{
    if (!law) return {};
    return [law = law, clock = clock](double time, Pose& pose, Motion& motion)
    {
        const auto [lawTime, rate] = clock.at(time);
        law(lawTime, pose, motion);
        motion.velocity *= rate;
        motion.angularVelocity *= rate;
    };
}

StructureMotion readMotion(const Foam::dictionary& parent, const Pose& start)
{
    if (!parent.found("motion")) return {};
    const Foam::dictionary& dict = subGroup(parent, "motion");
    const std::string type = readWord(dict, "type", motionTypes);
    if (type == "linear") return {linearMotion(dict, start), readClock(dict)};
    if (type == "oscillating") return {oscillation(dict, start), readClock(dict)};
    if (type == "rotating") return {rotation(dict, start), readClock(dict)};
    failUnknown(dict, "motion type", type, motionTypes);
}

} // namespace flotsam
