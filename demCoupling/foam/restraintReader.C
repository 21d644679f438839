// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/restraintReader.H"

#include "demCoupling/foam/restraintChain.H"
#include "demCoupling/foam/restraintEnds.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>
#include <set>

namespace flotsam
{

namespace
{

using Kind = RestraintDefinition::Kind;

RestraintEnd readOtherEnd(const Foam::dictionary& dict, const SceneFrame& frame, const BodiesInput& input)
{
    if (dict.found("anchor") == dict.found("otherBody"))
        failIn(dict, "Give the other end: either 'anchor (x y z)', a point of space (or, with 'anchorStructure', of a structure), or 'otherBody' and 'otherRefAttachmentPt (x y z)'.");
    if (dict.found("anchor")) return readAnchor(dict, "anchor", "anchorStructure", frame, input);
    if (dict.found("anchorStructure")) failIn(dict, "'anchorStructure' goes with 'anchor', not with 'otherBody'.");
    return readBodyEnd(dict, "otherBody", "otherRefAttachmentPt", frame, input);
}

RestraintDefinition readRestraint(const std::string& name, const Foam::dictionary& dict, const std::string& type, const SceneFrame& frame, const BodiesInput& input)
{
    RestraintDefinition r;
    r.name = name;
    r.kind = type == "tether" ? Kind::Tether : Kind::LinearSpring;
    const char* const length = lengthOf(r.kind);
    checkKeywords(dict, {"type", "body", "refAttachmentPt", "anchor", "anchorStructure", "otherBody", "otherRefAttachmentPt", length, "stiffness", "damping", "breakingForce"});
    r.end = readBodyEnd(dict, "body", "refAttachmentPt", frame, input);
    r.other = readOtherEnd(dict, frame, input);
    if (r.end.body == r.other.body) failIn(dict, text("Both ends are at body '", input.bodies[r.end.body].name, "', which is rigid: fasten the other end to another body, or to an 'anchor'."));
    r.length = readNumberOr(dict, length, (placeInSpace(r.end, input) - placeInSpace(r.other, input)).norm(), notNegative);
    r.stiffness = readNumber(dict, "stiffness", positive);
    r.damping = readNumber(dict, "damping", notNegative);
    r.breakingForce = readNumberOr(dict, "breakingForce", r.breakingForce, positive);
    return r;
}

/// One restraint, or those of a chain.
std::vector<RestraintDefinition> readEntry(const std::string& name, const Foam::dictionary& dict, const SceneFrame& frame, BodiesInput& input)
{
    const std::vector<std::string> known{"linearSpring", "tether", "chain"};
    const std::string type = readWord(dict, "type", known);
    if (std::find(known.begin(), known.end(), type) == known.end()) failUnknown(dict, "restraint type", type, known);
    return type == "chain" ? readChain(name, dict, frame, input) : std::vector{readRestraint(name, dict, type, frame, input)};
}

/// Files are named by them.
void checkNamesDiffer(const Foam::dictionary& dict, const std::vector<RestraintDefinition>& restraints)
{
    std::set<std::string> names;
    for (const RestraintDefinition& r : restraints)
        if (!names.insert(r.name).second)
            failIn(dict, text("Two restraints are called '", r.name, "': the lines of a chain have its name and a number, chain.0, chain.1, .. Give one of them another name."));
}

} // namespace

std::vector<RestraintDefinition> readRestraints(const Foam::dictionary& dict, const SceneFrame& frame, BodiesInput& input)
{
    std::vector<RestraintDefinition> restraints;
    if (!dict.found("restraints")) return restraints;
    for (const Foam::entry& e : subGroup(dict, "restraints"))
    {
        if (!e.isDict()) failIn(subGroup(dict, "restraints"), text("'", std::string(e.keyword()), "' must be a restraint: name { type tether; body ..; .. }."));
        if (input.bodies.empty()) failIn(e.dict(), "A restraint holds a body, and constant/bodies has none: add it to 'bodies', or remove 'restraints'.");
        const std::vector<RestraintDefinition> lines = readEntry(e.keyword(), e.dict(), frame, input);
        restraints.insert(restraints.end(), lines.begin(), lines.end());
    }
    checkNamesDiffer(subGroup(dict, "restraints"), restraints);
    return restraints;
}

} // namespace flotsam
