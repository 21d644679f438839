// SPDX-License-Identifier: GPL-3.0-or-later
/// Speeds and ways that no flow of this size has: slips of the pen, other units.
#include "demCoupling/foam/motionChecks.H"

#include "demCoupling/foam/continuedMotion.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr int nSamples = 1000;          // of a motion in a run
constexpr double fastFalls = 100;       // diagonals of the mesh that what is as fast has fallen through

double diagonalOf(const BodiesInput& input) { return (input.box[1] - input.box[0]).norm(); }

/// Of the mesh's box.
double distanceFrom(const BodiesInput& input, const Vec3& point) { return (point - point.cwiseMax(input.box[0]).cwiseMin(input.box[1])).norm(); }

/// Where a motion is farthest from the mesh, and where its structure is fastest.
struct Extremes { double speed = 0, whenFastest = 0, away = 0, whenAway = 0; };

Extremes extremesOf(const StructureDefinition& structure, const BodiesInput& input, double endTime)
{
    Extremes extremes;
    const std::array<Vec3, 2> box = structure.solid.shape->bounds();
    for (int i = 0; i <= nSamples; ++i)
    {
        const double time = (i + (i > 0 && i < nSamples ? 0.137 : 0))*endTime/nSamples;     // of no common period with an oscillation
        Pose pose;
        Motion motion;
        structure.motion(time, pose, motion);
        const double speed = fastestCorner(box, pose, motion), away = distanceFrom(input, pose.position + pose.orientation*(0.5*(box[0] + box[1])));
        if (speed > extremes.speed) { extremes.speed = speed; extremes.whenFastest = time; }
        if (away > extremes.away) { extremes.away = away; extremes.whenAway = time; }
    }
    return extremes;
}

std::string tooFast(const std::string& who, double speed, double fast)
{
    return text(who, " with ", speed, " m/s: faster than what has fallen ", fastFalls, " times through the mesh (", fast, " m/s), and time steps are as short as that asks for. Speeds are in m/s,"
        " `rpm` in turns a minute, `omega` in rad/s, times in s");
}

} // namespace

std::vector<std::string> doubtfulMotions(const BodiesInput& input, double gravity, double endTime)
{
    std::vector<std::string> doubts;
    const double fast = gravity > 0 ? std::sqrt(2*gravity*fastFalls*diagonalOf(input)) : 1e300;     // without gravity there is nothing to compare a speed with
    bool isFarTold = false, isFastTold = false;
    for (const StructureDefinition& s : input.structures)
    {
        if (!s.motion) continue;
        const Extremes extremes = extremesOf(s, input, endTime);
        if (extremes.away > diagonalOf(input) && !isFarTold)
        {
            doubts.push_back(text("structure ", s.solid.name, " moves far out of the mesh: at ", extremes.whenAway, " s it is ", extremes.away, " m away from it, whose diagonal is ", diagonalOf(input),
                " m. Lengths are in m, angles in degrees; `timeEnd` ends a motion"));
            isFarTold = true;
        }
        if (extremes.speed > fast && !isFastTold)
        {
            doubts.push_back(tooFast(text("structure ", s.solid.name, " moves, at ", extremes.whenFastest, " s,"), extremes.speed, fast));
            isFastTold = true;
        }
    }
    for (const BodyDefinition& body : input.bodies)
    {
        const double speed = fastestCorner(body.shape->bounds(), body.pose, body.motion);
        if (speed <= fast) continue;
        doubts.push_back(tooFast(text("body ", body.name, " begins"), speed, fast));
        break;
    }
    return doubts;
}

} // namespace flotsam
