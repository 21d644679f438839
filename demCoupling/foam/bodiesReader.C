// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodiesReader.H"
#include "demCoupling/foam/bodyGroup.H"
#include "demCoupling/foam/contactReader.H"
#include "demCoupling/foam/meshWalls.H"
#include "demCoupling/foam/movingStructures.H"
#include "demCoupling/foam/repeatedGroups.hpp"
#include "demCoupling/foam/restraintReader.H"
#include "demCoupling/foam/structureChecks.H"
#include "demCoupling/foam/wallTriangles.H"
#include "foam/dictionaryChecks.H"

#include "IOdictionary.H"
#include "OSspecific.H"
#include "Time.H"
#include "processorPolyPatch.H"
#include "symmetryPlanePolyPatch.H"
#include "symmetryPolyPatch.H"

#include <algorithm>
#include <cmath>
#include <set>

namespace flotsam
{

namespace
{

Solid::Wall readWallKind(const Foam::dictionary& dict)
{
    const std::string kind = readWordOr(dict, "wall", "noSlip");
    if (kind == "noSlip") return Solid::Wall::NoSlip;
    if (kind == "slip") return Solid::Wall::Slip;
    failUnknown(dict, "wall", kind, {"noSlip", "slip"});
}

void checkPlanarMotion(const Foam::dictionary& dict, const std::string& name, const StructureMotion& prescribed, const SceneFrame& frame)
{
    if (!prescribed.law) return;
    for (const double time : prescribed.samples)
    {
        Pose pose;
        Motion motion;
        prescribed.law(time, pose, motion);
        checkPlanarMotion(subGroup(dict, "motion"), "structure " + name, motion, frame);
    }
}

void readStructureGroup(const std::string& name, const Foam::dictionary& dict, const SceneFrame& frame, BodiesInput& input)
{
    checkKeywords(dict, {"shape", "material", "wall", "position", "orientation", "array", "motion", "contact", "facetSize", "spheres"});
    const auto shape = readShape(subGroup(dict, "shape"), frame.stlFolder);
    const Pose first = readPose(dict);
    const double facetSize = readNumberOr(dict, "facetSize", 0.25*thinnestExtent(*shape, frame), positive);
    const bool touches = readFlagOr(dict, "contact", true);
    bool isArray = false;
    int i = 0;
    for (const Vec3& offset : readArray(dict, isArray))
    {
        StructureDefinition s;
        s.group = name;
        s.material = readMaterial(dict, "material", input.materials);
        s.facetSize = facetSize;
        s.wall = touches ? 0 : -1; // the number follows when the walls are made
        s.solid.name = isArray ? text(name, ".", i++) : name;
        s.solid.wall = readWallKind(dict);
        s.solid.shape = shape;
        s.solid.pose = {first.position + offset, first.orientation};
        const StructureMotion motion = readMotion(dict, s.solid.pose);
        checkPlanarMotion(dict, name, motion, frame);
        s.motion = motion.timed();
        s.clock = motion.clock;
        s.solid.kind = s.motion ? Solid::Kind::Prescribed : Solid::Kind::Fixed;
        if (s.motion) s.motion(0, s.solid.pose, s.solid.motion);
        readContactSpheres(dict, frame, s);
        input.structures.push_back(std::move(s));
    }
}

void readStructures(const Foam::dictionary& dict, const SceneFrame& frame, BodiesInput& input)
{
    if (!dict.found("structures")) return;
    for (const Foam::entry& e : subGroup(dict, "structures"))
    {
        if (!e.isDict()) failIn(subGroup(dict, "structures"), text("'", std::string(e.keyword()), "' must be a structure: name { shape {..} .. }."));
        readStructureGroup(e.keyword(), e.dict(), frame, input);
    }
}

std::vector<BodyGroup> readGroups(const Foam::dictionary& dict, const SceneFrame& frame, const StoredFinest& stored)
{
    std::vector<BodyGroup> groups;
    if (!dict.found("bodies")) return groups;
    for (const Foam::entry& e : subGroup(dict, "bodies"))
    {
        if (!e.isDict()) failIn(subGroup(dict, "bodies"), text("'", std::string(e.keyword()), "' must be a body: name { shape {..} density ..; .. }."));
        groups.push_back(readBodyGroup(e.keyword(), e.dict(), frame));
    }
    makeSpheres(groups, stored);
    return groups;
}

bool isMirror(const Foam::polyPatch& patch) { return Foam::isA<Foam::symmetryPolyPatch>(patch) || Foam::isA<Foam::symmetryPlanePolyPatch>(patch); }

/// Names of the mesh's patches that are DEM walls. A body that reaches a mirror plane meets its image there, in the middle between both.
std::vector<std::string> wallPatches(const Foam::dictionary& dict, const Foam::polyMesh& mesh)
{
    std::vector<std::string> walls, all;
    for (const Foam::polyPatch& patch : mesh.boundaryMesh())
    {
        if (Foam::isA<Foam::processorPolyPatch>(patch)) continue;
        all.push_back(patch.name());
        if (patch.type() == "wall" || isMirror(patch)) walls.push_back(patch.name());
    }
    if (!dict.found("wallPatches")) return walls;
    const Foam::ITstream& given = valueOf(dict, "wallPatches", "all, none, or names of patches in round brackets");
    if (!given.empty() && given[0].isWord())
    {
        const std::string choice = readWord(dict, "wallPatches");
        if (choice != "all" && choice != "none") failUnknown(dict, "wallPatches", choice, {"all", "none", "(names of patches)"});
        return choice == "all" ? walls : std::vector<std::string>();
    }
    std::vector<std::string> named;
    for (const std::string& name : readWords(dict, "wallPatches"))
    {
        if (std::find(all.begin(), all.end(), name) == all.end()) failUnknown(dict, "patch", name, all);
        if (mesh.boundaryMesh()[name].type() == "empty")
            failIn(dict, text("'wallPatches' names ", name, ", of type empty: it is the front or back of a 2D mesh, which bodies do not feel.\n    Name what they may touch, or leave the entry out: ",
                walls.empty() ? "none" : joined(walls), '.'));
        named.push_back(name);
    }
    return named;
}

TriSurface inSpace(TriSurface surface, const Pose& pose)
{
    for (Vec3& x : surface.points) x = pose.orientation*x + pose.position;
    return surface;
}

void addStructureWalls(BodiesInput& input)
{
    for (StructureDefinition& s : input.structures)
    {
        if (s.wall < 0 || s.motion) continue;
        WallDefinition wall;
        wall.name = s.solid.name;
        wall.kind = WallDefinition::Kind::Surface;
        wall.surface = inSpace(s.solid.shape->surface(s.facetSize), s.solid.pose);
        wall.material = s.material;
        s.wall = static_cast<int>(input.walls.size());
        input.walls.push_back(std::move(wall));
    }
}

void addMovers(const Foam::dictionary& dict, const SceneFrame& frame, const std::vector<BodyGroup>& groups, const StoredFinest& stored, BodiesInput& input)
{
    const double smallest = smallestSphere(groups);
    for (StructureDefinition& s : input.structures)
    {
        if (s.wall < 0 || !s.motion) continue;
        s.wall = static_cast<int>(input.walls.size() + input.movers.size());
        const auto found = stored.find("structure " + s.solid.name);
        input.movers.push_back(makeMover(subGroup(subGroup(dict, "structures"), s.group), frame, s, found == stored.end() ? smallest : found->second));
    }
}

Obstacles makeObstacles(const BodiesInput& input, const SceneFrame& frame)
{
    Obstacles obstacles;
    obstacles.box = input.box;
    if (frame.isPlanar) obstacles.checkBox[frame.planeAxis] = false;
    for (const WallDefinition& wall : input.walls)
    {
        if (wall.kind == WallDefinition::Kind::Plane) obstacles.planes.push_back({wall.name, wall.point, wall.normal});
        else obstacles.facets.push_back({wall.name, wall.surface});
    }
    std::shared_ptr<const SampledShape> sampled; // members of a group share their shape
    for (const StructureDefinition& s : input.structures)
    {
        if (!sampled || &sampled->shape() != s.solid.shape.get()) sampled = sampleShape(s.solid.shape, thinnestExtent(*s.solid.shape, frame));
        obstacles.shapes.push_back({"structure " + s.solid.name, sampled, s.solid.pose});
    }
    return obstacles;
}

void placeAll(std::vector<BodyGroup>& groups, const SceneFrame& frame, Obstacles& obstacles)
{
    for (auto& group : groups)
    {
        if (isRandom(group)) continue;
        placeMembers(group, frame, obstacles);
        checkMembers(group, obstacles);
    }
    for (auto& group : groups)
        if (isRandom(group)) placeMembers(group, frame, obstacles);
}

SceneFrame makeFrame(const Foam::polyMesh& mesh, const SimplexMesh& simplexMesh, const Vec3& gravity)
{
    SceneFrame frame;
    frame.isPlanar = simplexMesh.dim == 2;
    frame.planeAxis = simplexMesh.axes[2];
    frame.midPlane = simplexMesh.planeOffset;
    frame.thickness = simplexMesh.thickness;
    if (gravity.norm() > 0) frame.up = -gravity.normalized();
    frame.stlFolder = mesh.time().globalPath()/mesh.time().constant()/"triSurface";
    return frame;
}

std::string contentsOf(const Foam::fileName& file)
{
    std::string contents, line;
    Foam::autoPtr<Foam::ISstream> stream = Foam::fileHandler().NewIFstream(file);
    while (stream->good())
    {
        stream->getLine(line);
        contents += line + '\n';
    }
    return contents;
}

/// In the file itself: OpenFOAM has merged them by now.
void checkNamesDiffer(const Foam::IOdictionary& dict)
{
    if (dict.empty()) return; // no file
    const auto repeated = repeatedGroups(contentsOf(dict.filePath()), {"structures", "bodies", "restraints"});
    if (repeated.empty()) return;
    const RepeatedGroup& group = repeated.front();
    failIn(dict, text("'", group.name, "' stands twice in '", group.section, "', in lines ", group.firstLine, " and ", group.line,
        ": OpenFOAM would make one group of them.\n    Give every group a name of its own; many bodies of one shape are one group with 'poses', 'array' or 'random'."));
}

/// Without constant/bodies there are none: a file beside it that looks like one must not go unnoticed.
void warnMisnamed(const Foam::Time& time)
{
    const Foam::fileName folder = time.globalPath()/time.constant();
    if (!Foam::Pstream::master() || Foam::isFile(folder/"bodies")) return;
    for (const Foam::fileName& file : Foam::readDir(folder, Foam::fileName::FILE))
    {
        const bool isLike = editDistance(file, "bodies") <= 2 || editDistance(file, "structures") <= 1 || file.find("bodies") != std::string::npos;
        if (isLike) Foam::Info<< "Warning: constant/" << file.c_str() << " is not read: bodies and structures are described in constant/bodies" << Foam::nl;
    }
}

/// OpenFOAM leaves a file whose header it cannot read out, with a warning, where the file may be missing: the run would go on without bodies.
void checkHeader(const Foam::IOdictionary& dict)
{
    const Foam::word& name = dict.headerClassName(); // as it was made (v1912), or none (v2412)
    const bool isRead = !name.empty() && name != Foam::IOobject::typeName;
    if (!Foam::Pstream::master() || isRead || !Foam::isFile(dict.time().globalPath()/dict.time().constant()/"bodies")) return;
    failIn(dict, "constant/bodies does not begin with a header: FoamFile { version 2.0; format ascii; class dictionary; object bodies; }");
}

/// Histories and states know them by their names. Groups differ in theirs, but `bar.0` may be a group of its own beside the group `bar`.
template<class Members, class Name>
void checkMembersDiffer(const Foam::dictionary& dict, const Members& members, const char* what, Name name)
{
    std::set<std::string> names;
    for (const auto& member : members)
        if (!names.insert(name(member)).second)
            failIn(dict, text("Two ", what, " are called '", name(member), "': the members of a group of several have its name and a number, group.0, group.1, .. Give one of the groups another name."));
}

/// Patches of type wall are walls to the fluid whatever bodies feel.
void reportOpenWalls(const Foam::polyMesh& mesh, const std::vector<std::string>& felt)
{
    std::vector<std::string> open;
    for (const Foam::polyPatch& patch : mesh.boundaryMesh())
        if (patch.type() == "wall" && std::find(felt.begin(), felt.end(), patch.name()) == felt.end()) open.push_back(patch.name());
    if (!open.empty())
        Foam::Info<< "constant/bodies: bodies pass through " << joined(open).c_str() << ", of type wall, which 'wallPatches' does not name" << Foam::nl;
}

} // namespace

BodiesInput readBodies(const Foam::dictionary& dict, const Foam::polyMesh& mesh, const SimplexMesh& simplexMesh, const Halo& halo, const Vec3& gravity,
    const StoredFinest& stored)
{
    checkKeywords(dict, {"materials", "contact", "wallMaterial", "wallPatches", "parameters", "structures", "bodies", "restraints"});
    BodiesInput input;
    input.box = meshBounds(mesh);
    MaterialTable table = readMaterials(dict);
    input.materials = table.names;
    input.laws = table.laws;
    SceneFrame frame = makeFrame(mesh, simplexMesh, gravity);
    frame.materials = input.materials;

    readStructures(dict, frame, input);
    checkMembersDiffer(dict, input.structures, "structures", [](const StructureDefinition& s) { return s.solid.name; });
    checkCovering(input, simplexMesh, halo, dict);
    reportStructures(input, frame);
    std::vector<BodyGroup> groups = readGroups(dict, frame, stored);
    if (groups.empty())
    {
        for (StructureDefinition& s : input.structures) s.wall = -1;
        readRestraints(dict, frame, input); // refuses any
        return input;
    }
    const auto patches = input.wallPatches = wallPatches(dict, mesh);
    input.areWallsChosen = dict.found("wallPatches");
    if (input.areWallsChosen) reportOpenWalls(mesh, patches);
    const int wallMaterial = patches.empty() ? 0 : readMaterial(dict, "wallMaterial", input.materials);
    for (const std::string& name : patches)
    {
        const Foam::polyPatch& patch = mesh.boundaryMesh()[name];
        for (WallDefinition& wall : makeMeshWalls(mesh, patch, halo, wallMaterial))
        {
            wall.isMirror = isMirror(patch);
            input.walls.push_back(std::move(wall));
        }
    }
    if (patches.empty() && !dict.found("wallPatches"))
        Foam::Info << "constant/bodies: the mesh has no patch of type wall and no mirror plane, so bodies can leave it everywhere. If that is not meant: wallPatches (names);" << Foam::nl;
    Obstacles obstacles = makeObstacles(input, frame); // the patches; structures by their shapes
    addStructureWalls(input);
    divideWallTriangles(input, dict);
    addMovers(dict, frame, groups, stored, input);
    placeAll(groups, frame, obstacles);
    for (BodyGroup& group : groups)
        for (std::size_t i = 0; i < group.members.size(); ++i)
        {
            input.bodyGroups.push_back(group.name);
            input.givenFrames.push_back(group.kindOf(i).prototype.pose);
            input.bodies.push_back(std::move(group.members[i]));
        }
    checkMembersDiffer(dict, input.bodies, "bodies", [](const BodyDefinition& b) { return b.name; });
    input.restraints = readRestraints(dict, frame, input);
    return input;
}

namespace
{

bool isCutLinearly(const BodyDefinition& body)
{
    for (int k = 0; k < body.shape->nParts(); ++k)
    {
        const Shape& part = body.shape->part(k);
        const Vec3 axis = body.pose.orientation*part.symmetry().axis;
        if (!part.hasPlaneFaces() && (roundThickness(part) == 0 || (body.isPlanar && std::abs(axis[body.planeAxis]) < 1 - 1e-9))) return true;
    }
    return false;
}

/// Smallest extent of those that count, 0: none does.
template <class Counts>
double thinnestOf(const BodiesInput& input, Counts counts)
{
    double result = 0;
    for (const BodyDefinition& body : input.bodies)
        if (counts(body)) result = result == 0 ? body.thinnest : std::min(result, body.thinnest);
    return result;
}

} // namespace

double thinnestBody(const BodiesInput& input)
{
    return thinnestOf(input, [](const BodyDefinition&) { return true; });
}

double thinnestLinearBody(const BodiesInput& input)
{
    return thinnestOf(input, isCutLinearly);
}

BodiesInput readBodies(const Foam::polyMesh& mesh, const SimplexMesh& simplexMesh, const Halo& halo, const Vec3& gravity, const StoredFinest& stored)
{
    warnMisnamed(mesh.time());
    const Foam::IOobject io("bodies", mesh.time().constant(), mesh.time(), Foam::IOobject::READ_IF_PRESENT, Foam::IOobject::NO_WRITE, false);
    const Foam::IOdictionary dict(io);
    checkHeader(dict);
    checkNamesDiffer(dict);
    return readBodies(dict, mesh, simplexMesh, halo, gravity, stored);
}

std::vector<Solid> makeSolids(const BodiesInput& input)
{
    std::vector<Solid> solids;
    for (const auto& s : input.structures) solids.push_back(s.solid);
    for (const auto& b : input.bodies)
    {
        Solid solid;
        solid.name = b.name;
        solid.kind = Solid::Kind::Free;
        solid.shape = b.shape;
        solid.pose = b.pose;
        solid.motion = b.motion;
        solids.push_back(std::move(solid));
    }
    return solids;
}

} // namespace flotsam
