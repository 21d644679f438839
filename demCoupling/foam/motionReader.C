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

/// What a structure turns about.
struct Hinge
{
    Vec3 origin, axis;

    /// From its pose at the start, by an angle [rad] that grows with a rate [rad/s].
    void turn(const Pose& start, double angle, double rate, Pose& pose, Motion& motion) const
    {
        const Eigen::Quaterniond turned(Eigen::AngleAxisd(angle, axis));
        const Vec3 arm = turned*(start.position - origin);
        pose = {origin + arm, turned*start.orientation};
        motion = {(rate*axis).cross(arm), rate*axis};
    }
};

Hinge readHinge(const Foam::dictionary& dict, const Pose& start) { return {readVec3Or(dict, "origin", start.position), readDirection(dict, "axis")}; }

/// Along a direction, or about an axis. It starts from the given place whatever the phase.
PrescribedMotion oscillation(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, withTimes({"direction", "amplitude", "axis", "origin", "amplitudeDeg", "period", "frequency", "phaseDeg"}));
    if (dict.found("period") == dict.found("frequency")) failIn(dict, "Give either 'period' [s] or 'frequency' [Hz].");
    const bool turns = dict.found("amplitudeDeg");
    if (turns == dict.found("amplitude")) failIn(dict, "Give either 'amplitude' [m] along 'direction', or 'amplitudeDeg' about 'axis'.");
    if (dict.found("direction") == turns || dict.found("axis") != turns || (dict.found("origin") && !turns))
        failIn(dict, turns ? "'amplitudeDeg' goes with 'axis' and 'origin', not with 'direction'." : "'amplitude' goes with 'direction', not with 'axis' and 'origin'.");
    const double frequency = dict.found("period") ? 1/readNumber(dict, "period", positive) : readNumber(dict, "frequency", positive);
    const double phase = readNumberOr(dict, "phaseDeg", 0, {-360, 360})*M_PI/180, omega = 2*M_PI*frequency;
    const auto sine = [=](double time) { return std::pair(std::sin(omega*time + phase) - std::sin(phase), omega*std::cos(omega*time + phase)); };
    if (turns)
        return [start, sine, hinge = readHinge(dict, start), amplitude = readNumber(dict, "amplitudeDeg", {0, 180})*M_PI/180](double time, Pose& pose, Motion& motion)
        {
            const auto [part, rate] = sine(time);
            hinge.turn(start, amplitude*part, amplitude*rate, pose, motion);
        };
    return [start, sine, amplitude = Vec3(readDirection(dict, "direction")*readNumber(dict, "amplitude", notNegative))](double time, Pose& pose, Motion& motion)
    {
        const auto [part, rate] = sine(time);
        pose = start;
        pose.position += amplitude*part;
        motion = {amplitude*rate, Vec3::Zero()};
    };
}

PrescribedMotion rotation(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, withTimes({"origin", "axis", "rpm", "omega"}));
    if (dict.found("rpm") == dict.found("omega")) failIn(dict, "Give either 'rpm' or 'omega' [rad/s].");
    const double omega = dict.found("rpm") ? readNumber(dict, "rpm", {-1e6, 1e6})*M_PI/30 : readNumber(dict, "omega", {-1e6, 1e6});
    return [start, omega, hinge = readHinge(dict, start)](double time, Pose& pose, Motion& motion) { hinge.turn(start, omega*time, omega, pose, motion); };
}

/// name ( (time value) .. )
template<class Value>
std::vector<std::pair<double, Value>> readRows(const Foam::dictionary& dict, const char* name, const char* what)
{
    const auto rows = readAs<Foam::List<Foam::Tuple2<Foam::scalar, Value>>>(dict, name, what);
    if (rows.size() < 2) failIn(dict, text("'", name, "' has ", rows.size(), rows.size() == 1 ? " row" : " rows", ": give two at least."));
    std::vector<std::pair<double, Value>> result;
    for (const auto& row : rows)
    {
        if (!result.empty() && row.first() <= result.back().first)
            failIn(dict, text("Times in '", name, "' must rise: ", row.first(), " s follows ", result.back().first, " s."));
        result.emplace_back(row.first(), row.second());
    }
    return result;
}

std::vector<MotionTable::Point> readDisplacements(const Foam::dictionary& dict)
{
    std::vector<MotionTable::Point> points;
    if (!dict.found("displacement")) return points;
    for (const auto& [time, x] : readRows<Foam::vector>(dict, "displacement", "a list of times [s] and displacements [m]: ( (0 (0 0 0)) (2 (0 0 0.1)) )"))
        points.push_back({time, Vec3(x.x(), x.y(), x.z())});
    return points;
}

/// Angles [rad] as the table's first component.
std::vector<MotionTable::Point> readAngles(const Foam::dictionary& dict)
{
    std::vector<MotionTable::Point> points;
    if (!dict.found("angleDeg")) return points;
    for (const auto& [time, angle] : readRows<Foam::scalar>(dict, "angleDeg", "a list of times [s] and angles [degrees]: ( (0 0) (2 30) )"))
        points.push_back({time, Vec3(angle*M_PI/180, 0, 0)});
    return points;
}

void addSamples(const std::vector<MotionTable::Point>& points, std::vector<double>& samples)
{
    for (std::size_t i = 1; i < points.size(); ++i) samples.push_back(0.5*(points[i - 1].time + points[i].time));
}

/// The tables have their own times: the structure begins and ends at rest. Turned about the hinge, the hinge is displaced.
StructureMotion tabulated(const Foam::dictionary& dict, const Pose& start)
{
    checkKeywords(dict, {"type", "displacement", "angleDeg", "axis", "origin", "timeStart"});
    const std::vector<MotionTable::Point> displacements = readDisplacements(dict), angles = readAngles(dict);
    if (displacements.empty() && angles.empty()) failIn(dict, "Give 'displacement ( (time (x y z)) .. );', or 'angleDeg ( (time angle) .. );' about 'axis', or both.");
    if (angles.empty() && (dict.found("axis") || dict.found("origin"))) failIn(dict, "'axis' and 'origin' go with 'angleDeg ( (time angle) .. );'.");
    const MotionTable::Point rest{0, Vec3::Zero()};
    const auto table = [&](const std::vector<MotionTable::Point>& points) { return MotionTable(points.empty() ? std::vector<MotionTable::Point>{rest, {1, Vec3::Zero()}} : points); };
    StructureMotion result;
    result.samples.clear();
    addSamples(displacements, result.samples);
    addSamples(angles, result.samples);
    const Hinge hinge = angles.empty() ? Hinge{start.position, Vec3::UnitX()} : readHinge(dict, start);
    result.law = [start, hinge, shift = table(displacements), turn = table(angles)](double time, Pose& pose, Motion& motion)
    {
        const auto [displacement, velocity] = shift.at(time);
        const auto [angle, rate] = turn.at(time);
        hinge.turn(start, angle[0], rate[0], pose, motion);
        pose.position += displacement;
        motion.velocity += velocity;
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
