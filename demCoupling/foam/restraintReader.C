// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/restraintReader.H"

#include "demCoupling/foam/shapeReader.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>

namespace flotsam
{

namespace
{

using Kind = RestraintDefinition::Kind;

Vec3 inFrameOf(const Pose& pose, const Vec3& point) { return pose.orientation.conjugate()*(point - pose.position); }

/// 2D: of the mid-plane, as the bodies.
Vec3 readPoint(const Foam::dictionary& dict, const char* keyword, const SceneFrame& frame)
{
    Vec3 point = readVec3(dict, keyword);
    if (frame.isPlanar) point[frame.planeAxis] = frame.midPlane;
    return point;
}

/// Index of a body by its name in the output.
int readBody(const Foam::dictionary& dict, const char* keyword, const BodiesInput& input)
{
    const std::string name = readWord(dict, keyword);
    std::vector<std::string> names;
    for (const BodyDefinition& body : input.bodies) names.push_back(body.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return int(found - names.begin());
    const auto count = std::count(input.bodyGroups.begin(), input.bodyGroups.end(), name);
    if (count > 0) failIn(dict, text("Entry '", keyword, "' is '", name, "', a group of ", count, " bodies: name one of them, ", name, ".0 to ", name, '.', count - 1, '.'));
    for (const StructureDefinition& s : input.structures)
        if (s.solid.name == name || s.group == name)
            failIn(dict, text("Entry '", keyword, "' is '", name, "', a structure: it stands, or moves as prescribed, whatever pulls at it.\n",
                "    Name a body there, and fasten the other end to the structure: anchor (x y z); anchorStructure ", name, ';'));
    failUnknown(dict, "body", name, names);
}

RestraintEnd readBodyEnd(const Foam::dictionary& dict, const char* body, const char* point, const SceneFrame& frame, const BodiesInput& input)
{
    RestraintEnd end;
    end.body = readBody(dict, body, input);
    end.place = inFrameOf(input.bodies[end.body].pose, readPoint(dict, point, frame));
    return end;
}

RestraintEnd readAnchor(const Foam::dictionary& dict, const SceneFrame& frame, const BodiesInput& input)
{
    RestraintEnd end;
    end.place = readPoint(dict, "anchor", frame);
    if (!dict.found("anchorStructure")) return end;
    const std::string name = readWord(dict, "anchorStructure");
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

RestraintEnd readOtherEnd(const Foam::dictionary& dict, const SceneFrame& frame, const BodiesInput& input)
{
    if (dict.found("anchor") == dict.found("otherBody"))
        failIn(dict, "Give the other end: either 'anchor (x y z)', a point of space (or, with 'anchorStructure', of a structure), or 'otherBody' and 'otherRefAttachmentPt (x y z)'.");
    if (dict.found("anchor")) return readAnchor(dict, frame, input);
    if (dict.found("anchorStructure")) failIn(dict, "'anchorStructure' goes with 'anchor', not with 'otherBody'.");
    return readBodyEnd(dict, "otherBody", "otherRefAttachmentPt", frame, input);
}

/// At time 0.
Vec3 inSpace(const RestraintEnd& end, const BodiesInput& input)
{
    Pose pose;
    Motion motion;
    if (end.body >= 0) pose = input.bodies[end.body].pose;
    else if (end.mover >= 0) input.movers[end.mover].motion(0, pose, motion);
    return pose.position + pose.orientation*end.place;
}

RestraintDefinition readRestraint(const std::string& name, const Foam::dictionary& dict, const SceneFrame& frame, const BodiesInput& input)
{
    const std::string type = readWord(dict, "type", {"linearSpring", "tether"});
    if (type != "linearSpring" && type != "tether") failUnknown(dict, "restraint type", type, {"linearSpring", "tether"});
    RestraintDefinition r;
    r.name = name;
    r.kind = type == "tether" ? Kind::Tether : Kind::LinearSpring;
    const char* const length = r.kind == Kind::Tether ? "length" : "restLength";
    checkKeywords(dict, {"type", "body", "refAttachmentPt", "anchor", "anchorStructure", "otherBody", "otherRefAttachmentPt", length, "stiffness", "damping", "breakingForce"});
    r.end = readBodyEnd(dict, "body", "refAttachmentPt", frame, input);
    r.other = readOtherEnd(dict, frame, input);
    if (r.end.body == r.other.body) failIn(dict, text("Both ends are at body '", input.bodies[r.end.body].name, "', which is rigid: fasten the other end to another body, or to an 'anchor'."));
    r.length = readNumberOr(dict, length, (inSpace(r.end, input) - inSpace(r.other, input)).norm(), notNegative);
    r.stiffness = readNumber(dict, "stiffness", positive);
    r.damping = readNumber(dict, "damping", notNegative);
    r.breakingForce = readNumberOr(dict, "breakingForce", r.breakingForce, positive);
    return r;
}

} // namespace

std::vector<RestraintDefinition> readRestraints(const Foam::dictionary& dict, const SceneFrame& frame, const BodiesInput& input)
{
    std::vector<RestraintDefinition> restraints;
    if (!dict.found("restraints")) return restraints;
    for (const Foam::entry& e : subGroup(dict, "restraints"))
    {
        if (!e.isDict()) failIn(subGroup(dict, "restraints"), text("'", std::string(e.keyword()), "' must be a restraint: name { type tether; body ..; .. }."));
        if (input.bodies.empty()) failIn(e.dict(), "A restraint holds a body, and constant/bodies has none: add it to 'bodies', or remove 'restraints'.");
        restraints.push_back(readRestraint(e.keyword(), e.dict(), frame, input));
    }
    return restraints;
}

} // namespace flotsam
