// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/restraintEnds.H"

#include "foam/dictionaryChecks.H"

#include <algorithm>

namespace flotsam
{

namespace
{

Vec3 inFrameOf(const Pose& pose, const Vec3& point) { return pose.orientation.conjugate()*(point - pose.position); }

/// 2D: of the mid-plane, as the bodies.
Vec3 inPlane(Vec3 point, const SceneFrame& frame)
{
    if (frame.isPlanar) point[frame.planeAxis] = frame.midPlane;
    return point;
}

Vec3 readPoint(const Foam::dictionary& dict, const char* keyword, const SceneFrame& frame) { return inPlane(readVec3(dict, keyword), frame); }

/// Index of a body by its name in the output.
int readBody(const Foam::dictionary& dict, const char* keyword, const BodiesInput& input)
{
    const std::string name = readWord(dict, keyword);
    std::vector<std::string> names;
    for (const BodyDefinition& body : input.bodies) names.push_back(body.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return int(found - names.begin());
    const auto count = std::count(input.bodyGroups.begin(), input.bodyGroups.end(), name);
    if (count > 0) failIn(dict, text("Entry '", keyword, "' is '", name, "', a group of ", count, " bodies: name one of them, ", name, ".0 to ", name, '.', count - 1, ", or tie them to each other by type chain."));
    for (const StructureDefinition& s : input.structures)
        if (s.solid.name == name || s.group == name)
            failIn(dict, text("Entry '", keyword, "' is '", name, "', a structure: it stands, or moves as prescribed, whatever pulls at it.\n",
                "    Name a body there, and fasten the other end to the structure: anchor (x y z); anchorStructure ", name, ';'));
    failUnknown(dict, "body", name, names);
}

} // namespace

RestraintEnd readBodyEnd(const Foam::dictionary& dict, const char* body, const char* point, const SceneFrame& frame, const BodiesInput& input)
{
    RestraintEnd end;
    end.body = readBody(dict, body, input);
    end.place = inFrameOf(input.bodies[end.body].pose, readPoint(dict, point, frame));
    return end;
}

RestraintEnd readAnchor(const Foam::dictionary& dict, const char* point, const char* structure, const SceneFrame& frame, const BodiesInput& input)
{
    RestraintEnd end;
    end.place = readPoint(dict, point, frame);
    if (!dict.found(structure)) return end;
    const std::string name = readWord(dict, structure);
    std::vector<std::string> names;
    for (const StructureDefinition& s : input.structures)
    {
        names.push_back(s.solid.name);
        if (s.solid.name != name) continue;
        if (!s.motion) return end; // a point of space
        if (s.wall < 0)
            failIn(dict, text("Structure '", name, "' moves, but has 'contact off': restraints follow the structures that bodies feel.\n    Remove 'contact off' there, or take a fixed anchor."));
        end.mover = s.wall - int(input.walls.size());
        end.place = inFrameOf(s.solid.pose, end.place);
        return end;
    }
    failUnknown(dict, "structure", name, names);
}

RestraintEnd bodyEnd(int body, const Vec3& givenPoint, const SceneFrame& frame, const BodiesInput& input)
{
    RestraintEnd end;
    end.body = body;
    end.place = inFrameOf(input.givenFrames[body], givenPoint);
    if (!frame.isPlanar) return end;
    const Pose& pose = input.bodies[body].pose;
    end.place = inFrameOf(pose, inPlane(pose.position + pose.orientation*end.place, frame));
    return end;
}

Vec3 placeInSpace(const RestraintEnd& end, const BodiesInput& input)
{
    Pose pose;
    Motion motion;
    if (end.body >= 0) pose = input.bodies[end.body].pose;
    else if (end.mover >= 0) input.movers[end.mover].motion(0, pose, motion);
    return pose.position + pose.orientation*end.place;
}

} // namespace flotsam
