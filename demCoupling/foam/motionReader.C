// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/motionReader.H"

#include "demCoupling/core/motionTable.hpp"
#include "demCoupling/foam/shapeReader.H"
#include "foam/dictionaryChecks.H"

#include "Tuple2.H"
#include "vector.H"

#include <cmath>
#include <utility>

namespace flotsam
{

namespace
{

const std::vector<std::string> motionTypes{"linear", "oscillating", "rotating", "tabulated"};

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

/// displacement ( (time (x y z)) .. )
std::vector<MotionTable::Point> readTable(const Foam::dictionary& dict)
{
    using Row = Foam::Tuple2<Foam::scalar, Foam::vector>;
    const auto rows = readAs<Foam::List<Row>>(dict, "displacement", "a list of times [s] and displacements [m]: ( (0 (0 0 0)) (2 (0 0 0.1)) )");
    if (rows.size() < 2) failIn(dict, text("'displacement' has ", rows.size(), rows.size() == 1 ? " row" : " rows", ": give two at least."));
    std::vector<MotionTable::Point> points;
    for (const Row& row : rows)
    {
        const Foam::vector& x = row.second();
        if (!points.empty() && row.first() <= points.back().time)
            failIn(dict, text("Times in 'displacement' must rise: ", row.first(), " s follows ", points.back().time, " s."));
        points.push_back({row.first(), Vec3(x.x(), x.y(), x.z())});
    }
    return points;
}

/// The table has its own times: it begins and ends at rest.
StructureMotion tabulated(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, {"type", "displacement", "timeStart"});
    const std::vector<MotionTable::Point> points = readTable(dict);
    StructureMotion result;
    result.samples.clear();
    for (std::size_t i = 1; i < points.size(); ++i) result.samples.push_back(0.5*(points[i - 1].time + points[i].time));
    result.law = [start, table = MotionTable(points)](double time, Pose& pose, Motion& motion)
    {
        const auto [displacement, velocity] = table.at(time);
        pose = start;
        pose.position += displacement;
        motion = {velocity, Vec3::Zero()};
    };
    result.clock.start = readNumberOr(dict, "timeStart", 0, notNegative);
    return result;
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

StructureMotion withClock(PrescribedMotion law, const Foam::dictionary& dict)
{
    StructureMotion result;
    result.law = std::move(law);
    result.clock = readClock(dict);
    return result;
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
    if (type == "linear") return withClock(linearMotion(dict, start), dict);
    if (type == "oscillating") return withClock(oscillation(dict, start), dict);
    if (type == "rotating") return withClock(rotation(dict, start), dict);
    if (type == "tabulated") return tabulated(dict, start);
    failUnknown(dict, "motion type", type, motionTypes);
}

} // namespace flotsam
