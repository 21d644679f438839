// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/continuedMotion.H"

#include "demCoupling/coupling/scene.hpp"
#include "foam/dictionaryChecks.H"

namespace flotsam
{

namespace
{

constexpr double noJump = 1e-6;     // of a structure's size; of its turn [rad]

std::string textOf(const Vec3& x)
{
    return text('(', x[0], ' ', x[1], ' ', x[2], ')');
}

} // namespace

Pose poseAt(const StructureDefinition& s, double time)
{
    Pose pose = s.solid.pose;
    Motion motion;
    if (s.motion) s.motion(time, pose, motion);
    return pose;
}

std::vector<double> motionJumps(const BodiesInput& input)
{
    std::vector<double> times;
    for (const StructureDefinition& s : input.structures)
    {
        const std::vector<double> own = s.clock.jumps();
        times.insert(times.end(), own.begin(), own.end());
    }
    return times;
}

bool isElsewhere(const StructureDefinition& s, const Pose& a, const Pose& b)
{
    const std::array<Vec3, 2> box = s.solid.shape->bounds();
    return (a.position - b.position).norm() > noJump*(box[1] - box[0]).norm() || a.orientation.angularDistance(b.orientation) > noJump;
}

std::string jumpingStructure(const BodiesInput& input, const std::vector<double>& solids, double time)
{
    const std::vector<Solid> stored = Scene::stored(solids);
    for (std::size_t k = 0; k < std::min(stored.size(), input.structures.size()); ++k)
    {
        const StructureDefinition& s = input.structures[k];
        const bool moved = stored[k].kind == Solid::Kind::Prescribed;
        if (moved != bool(s.motion)) return text("'", s.solid.name, "' ", moved ? "had a `motion` and has none now" : "had no `motion` and has one now");
        if (!s.motion) continue;
        const Pose now = poseAt(s, time);
        if (!isElsewhere(s, stored[k].pose, now)) continue;
        const Vec3 from = stored[k].pose.position, to = now.position;
        return text("'", s.solid.name, "' would jump: it is at ", textOf(from), ", and its `motion` has it at ", textOf(to), " at ", time, " s",
            from == to ? ", turned by another angle" : "");
    }
    return "";
}

std::string bodiesHeldAgain(const BodiesInput& input, const std::vector<double>& solids, double time)
{
    const std::vector<Solid> stored = Scene::stored(solids);
    const std::size_t first = input.structures.size();
    std::string name;
    double release = 0;
    int count = 0;
    for (std::size_t b = 0; first + b < stored.size() && b < input.bodies.size(); ++b)
    {
        const BodyDefinition& body = input.bodies[b];
        if (stored[first + b].kind != Solid::Kind::Free || body.releaseTime <= time) continue;
        if (++count > 1) continue;
        name = body.name;
        release = body.releaseTime;
    }
    if (count == 0) return "";
    return text("body ", name, count > 1 ? text(" (and ", count - 1, " more)") : "", ", which moves in it, is stopped and held until its releaseTime, ", release, " s");
}

} // namespace flotsam
