// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/wallForces.H"

#include "foam/dictionaryChecks.H"

#include "processorPolyPatch.H"
#include "vector.H"
#include "wordRes.H"

#include <algorithm>

namespace flotsam
{

namespace
{

/// A mirror plane is none: what acts on it is the other half's.
bool isWallForForces(const BoundaryPatch& patch, const SimplexMesh& mesh)
{
    const std::string& type = mesh.patches[patch.meshPatch].type;
    if (type == "symmetry" || type == "symmetryPlane") return false;
    return patch.isWall() || patch.isNoSlipWall || (type == "wall" && patch.velocity == BoundaryPatch::Velocity::Fixed);
}

std::string wallNames(const SimplexMesh& mesh, const std::vector<BoundaryPatch>& boundary)
{
    std::vector<std::string> names;
    for (const BoundaryPatch& patch : boundary)
        if (isWallForForces(patch, mesh)) names.push_back(patch.name);
    return names.empty() ? "none" : joined(names);
}

/// By name or pattern, and groups of patches.
std::vector<std::string> meant(const Foam::wordRe& entry, const Foam::polyBoundaryMesh& meshPatches)
{
    std::vector<std::string> names;
    for (const Foam::polyPatch& patch : meshPatches)
    {
        if (Foam::isA<Foam::processorPolyPatch>(patch)) continue;
        const Foam::wordList& groups = patch.inGroups();
        if (entry.match(patch.name()) || std::any_of(groups.begin(), groups.end(), [&](const Foam::word& group) { return entry.match(group); })) names.push_back(patch.name());
    }
    return names;
}

[[noreturn]] void failUnknownPatch(const Foam::dictionary& dict, const Foam::wordRe& entry, const Foam::polyBoundaryMesh& meshPatches, const std::string& walls)
{
    std::vector<std::string> names;
    for (const Foam::polyPatch& patch : meshPatches)
        if (!Foam::isA<Foam::processorPolyPatch>(patch)) names.push_back(patch.name());
    const auto near = nearestWords(entry, names);
    failIn(dict, text("patches: '", std::string(entry), "' is no patch, pattern or group of patches of the mesh. Walls of the mesh: ", walls, '.',
        near.empty() ? "" : text("\n    Did you mean: ", joined(near), " ?")));
}

void addPatch(const Foam::dictionary& dict, const std::string& name, const SimplexMesh& mesh, const std::vector<BoundaryPatch>& boundary, WallForceGroup& group)
{
    const auto found = std::find_if(boundary.begin(), boundary.end(), [&](const BoundaryPatch& p) { return p.name == name; });
    if (found == boundary.end() || !isWallForForces(*found, mesh))
        failIn(dict, text("patches: ", name, " is no wall (", found == boundary.end() ? "front or back of a 2D mesh" : mesh.patches[found->meshPatch].type.substr(0, 8) == "symmetry"
            ? "a mirror plane" : "fluid passes through it", "). Walls of the mesh: ", wallNames(mesh, boundary), ".\n    Walls are patches whose U is noSlip or slip, and those of type wall that move."));
    const int patch = int(found - boundary.begin());
    if (std::find(group.patches.begin(), group.patches.end(), patch) != group.patches.end()) return;
    group.patches.push_back(patch);
    group.patchNames.push_back(name);
}

WallForceGroup readGroup(const std::string& name, const Foam::dictionary& dict, const Foam::polyBoundaryMesh& meshPatches, const SimplexMesh& mesh,
    const std::vector<BoundaryPatch>& boundary)
{
    checkKeywords(dict, {"patches", "origin"});
    WallForceGroup group;
    group.name = name;
    const auto entries = readAs<Foam::List<Foam::wordRe>>(dict, "patches", "a list of patches, for instance (dam \"pier.*\")");
    if (entries.empty()) failValue(dict, "patches", text("a list of at least one patch; walls of the mesh: ", wallNames(mesh, boundary)));
    for (const Foam::wordRe& entry : entries)
    {
        const auto names = meant(entry, meshPatches);
        if (names.empty()) failUnknownPatch(dict, entry, meshPatches, wallNames(mesh, boundary));
        for (const std::string& patch : names) addPatch(dict, patch, mesh, boundary, group);
    }
    if (!dict.found("origin")) return group;
    const auto origin = readAs<Foam::vector>(dict, "origin", "a point (x y z) [m]");
    group.origin = Vec3(origin.x(), origin.y(), origin.z());
    return group;
}

} // namespace

std::vector<WallForceGroup> readWallForces(const Foam::dictionary& controlDict, const Foam::polyBoundaryMesh& meshPatches, const SimplexMesh& mesh,
    const std::vector<BoundaryPatch>& boundary)
{
    std::vector<WallForceGroup> groups;
    if (!controlDict.found("wallForces")) return groups;
    const Foam::dictionary& dict = subGroup(controlDict, "wallForces");
    for (const Foam::entry& e : dict)
    {
        const Foam::keyType& name = e.keyword();
        if (!e.isDict() || !name.isLiteral())
            failIn(dict, text("wallForces: '", std::string(name), "' is no group of patches; give each a name and its patches: ", e.isDict() ? "piers" : std::string(name),
                " { patches (names); origin (0 0 0); }"));
        groups.push_back(readGroup(name, e.dict(), meshPatches, mesh, boundary));
    }
    return groups;
}

void reportWallForces(const std::vector<WallForceGroup>& groups)
{
    for (const WallForceGroup& g : groups)
        Foam::Info<< "Forces on patches " << joined(g.patchNames).c_str() << ", moments about " << Foam::vector(g.origin[0], g.origin[1], g.origin[2]) << ": postProcessing/"
            << g.name.c_str() << "/<start time>/force.dat, moment.dat" << Foam::nl;
    if (!groups.empty()) Foam::Info<< Foam::endl;
}

std::vector<int> watchedPatches(const std::vector<WallForceGroup>& groups)
{
    std::vector<int> patches;
    for (const WallForceGroup& g : groups) patches.insert(patches.end(), g.patches.begin(), g.patches.end());
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    return patches;
}

} // namespace flotsam
