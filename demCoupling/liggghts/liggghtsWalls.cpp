// SPDX-License-Identifier: GPL-3.0-or-later
/// Walls: axis-aligned planes as primitives, everything else as triangles through a temporary STL file.
#include "demCoupling/liggghts/liggghtsParts.hpp"
#include "geometry/thinTriangles.hpp"

#include <mpi.h>

#include "fix_mesh_surface.h"
#include "lammps.h"
#include "modify.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace flotsam
{

namespace
{

const char* const axisNames[] = {"x", "y", "z"};

int alignedAxis(const WallDefinition& wall)
{
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(wall.normal[axis]) > (1 - 1e-14) * wall.normal.norm())
            return axis;
    return -1;
}

/// Removed from disk when it goes out of scope.
class TemporaryFile
{
public:
    TemporaryFile()
    {
        const char* folder = std::getenv("TMPDIR");
        path_ = std::string(folder && *folder ? folder : "/tmp") + "/flotsam-wall-XXXXXX.stl"; // LIGGGHTS goes by the ending
        const int descriptor = mkstemps(path_.data(), 4);
        if (descriptor < 0)
            throw DemError("cannot write a temporary file for a wall: " + path_ + " (set TMPDIR to a folder with space)");
        file_ = fdopen(descriptor, "w");
    }
    ~TemporaryFile()
    {
        close();
        std::remove(path_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    FILE* file() { return file_; }
    const std::string& path() const { return path_; }
    void close()
    {
        if (file_ && std::fclose(file_) != 0)
            std::fprintf(stderr, "cannot write %s\n", path_.c_str());
        file_ = nullptr;
    }

private:
    std::string path_;
    FILE* file_ = nullptr;
};

void writeStl(TemporaryFile& stl, const TriSurface& surface)
{
    std::fprintf(stl.file(), "solid wall\n");
    for (const std::array<int, 3>& t : surface.triangles)
    {
        const Vec3 &a = surface.points[static_cast<size_t>(t[0])], &b = surface.points[static_cast<size_t>(t[1])],
                   &c = surface.points[static_cast<size_t>(t[2])];
        const Vec3 normal = (b - a).cross(c - a);
        const Vec3 n = normal.normalized();
        std::fprintf(stl.file(), "facet normal %.17g %.17g %.17g\nouter loop\n", n.x(), n.y(), n.z());
        for (const Vec3& p : {a, b, c})
            std::fprintf(stl.file(), "vertex %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
        std::fprintf(stl.file(), "endloop\nendfacet\n");
    }
    std::fprintf(stl.file(), "endsolid wall\n");
    stl.close();
}

/// Two triangles that cover the set-up box and more.
TriSurface largeSquare(const WallDefinition& wall, const DemSetup& setup)
{
    const Vec3 normal = wall.normal.normalized();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vec3 middle = 0.5 * (setup.box[0] + setup.box[1]);
    const Vec3 foot = middle - normal * normal.dot(middle - wall.point);
    const double half = (setup.box[1] - setup.box[0]).norm();
    TriSurface square;
    square.points = {foot - half * u - half * v, foot + half * u - half * v, foot + half * u + half * v,
                     foot - half * u + half * v};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    return square;
}

TriSurface meshOf(const WallDefinition& wall, const DemSetup& setup)
{
    return wall.kind == WallDefinition::Kind::Plane ? largeSquare(wall, setup) : wall.surface;
}

WallHandle addPlane(LiggghtsModel& model, const WallDefinition& wall, int axis, int index)
{
    WallHandle handle;
    handle.axis = axis;
    handle.coordinate = wall.point[axis];
    const std::string id = "plane" + std::to_string(index);
    const int type = model.contacts.classOfWall[static_cast<size_t>(index)] + 1;
    model.instance.addFix(words(id + " all wall/gran model hooke/stiffness tangential history primitive type "
                                + std::to_string(type) + " " + axisNames[axis] + "plane "
                                + exactText(handle.coordinate) + " store_force yes " + contactModelOptions()));
    handle.force = model.instance.findFix("force_" + id);
    handle.history = model.instance.findFix("history_" + id);
    if (!handle.force || !handle.history)
        throw DemError("wall '" + wall.name + "': this LIGGGHTS names its wall data differently from version 3.8");
    return handle;
}

/// At the end of every sub-step LIGGGHTS computes the stress of every triangle, which nobody reads, and adds up what is on one process only.
void dropStresses(LiggghtsModel& model, const std::string& mesh)
{
    LAMMPS_NS::Modify& modify = *model.instance.lammps().modify;
    modify.fmask[modify.find_fix(mesh.c_str())] &= ~LAMMPS_NS::FixConst::FINAL_INTEGRATE;
}

void addMesh(LiggghtsModel& model, const std::string& name, const TriSurface& surface, int contactClass, size_t index)
{
    if (surface.triangles.empty())
        throw DemError("wall '" + name + "': its surface has no triangles");
    TemporaryFile stl;
    writeStl(stl, surface);
    std::vector<std::string> arguments =
        words("mesh" + std::to_string(index) + " all mesh/surface/stress file FILE type " + std::to_string(contactClass + 1)
              + " curvature_tolerant yes stress on");
    arguments[4] = stl.path();
    try
    {
        model.instance.addFix(arguments);
        dropStresses(model, arguments[0]);
    }
    catch (const DemError& e)
    {
        throw DemError("wall '" + name + "': its surface is not accepted: " + e.what());
    }
}

std::array<Vec3, 2> boxOf(const TriSurface& surface, double margin)
{
    std::array<Vec3, 2> box {Vec3::Constant(1e300), Vec3::Constant(-1e300)};
    for (const Vec3& p : surface.points)
        box = {box[0].cwiseMin(p - Vec3::Constant(margin)), box[1].cwiseMax(p + Vec3::Constant(margin))};
    return box;
}

bool areApart(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b)
{
    return (a[0].array() > b[1].array()).any() || (b[0].array() > a[1].array()).any();
}

/// The first mesh this wall can join, or a new one.
MeshGroup& groupFor(LiggghtsModel& model, const std::array<Vec3, 2>& box, int contactClass)
{
    for (MeshGroup& group : model.meshes)
    {
        bool fits = model.contacts.classOfWall[static_cast<size_t>(group.walls.front())] == contactClass;
        for (const std::array<Vec3, 2>& other : group.boxes)
            fits = fits && areApart(box, other);
        if (fits)
            return group;
    }
    model.meshes.emplace_back();
    return model.meshes.back();
}

/// Too narrow or too small for LIGGGHTS, and for anything to be felt. extent: of its own surface, however far the mesh reaches that it is part of.
bool isLeftOut(const Vec3& a, const Vec3& b, const Vec3& c, double extent)
{
    constexpr double tellsPoints = 1e-8; // LIGGGHTS takes nearer ones for one point [m]
    const ThinTriangle thin(a, b, c);
    const double smallest = std::max(1e-6 * extent, 10 * tellsPoints);
    return (thin.isRefused && thin.isNegligible(extent)) || (b - a).cross(c - a).norm() < smallest * smallest;
}

void append(TriSurface& surface, const TriSurface& more)
{
    const int first = static_cast<int>(surface.points.size());
    const double extent = extentOf(more);
    surface.points.insert(surface.points.end(), more.points.begin(), more.points.end());
    for (const std::array<int, 3>& t : more.triangles)
        if (!isLeftOut(more.points[static_cast<size_t>(t[0])], more.points[static_cast<size_t>(t[1])], more.points[static_cast<size_t>(t[2])], extent))
            surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

} // namespace

std::string contactModelOptions()
{
    // limitForce: no attraction at the end of a contact. No tangential dashpot: LIGGGHTS adds it outside Coulomb's
    // limit, a landing bar then feels up to five times the friction its normal force allows (docs/contact.md)
    return "absolute_damping on tangential_damping off limitForce on";
}

std::vector<std::string> words(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> result;
    for (std::string word; stream >> word;)
        result.push_back(word);
    return result;
}

int MeshGroup::wallAt(const Vec3& point) const
{
    for (size_t k = 0; k < walls.size(); ++k)
        if ((point.array() >= boxes[k][0].array()).all() && (point.array() <= boxes[k][1].array()).all())
            return walls[k];
    return -1;
}

void addWalls(LiggghtsModel& model, const DemSetup& setup)
{
    const double margin = 1.001 * largestRadius(setup); // boxes that do not meet: no sphere reaches both walls
    for (size_t w = 0; w < setup.walls.size(); ++w)
    {
        const WallDefinition& wall = setup.walls[w];
        const int index = static_cast<int>(w);
        const int axis = wall.kind == WallDefinition::Kind::Plane ? alignedAxis(wall) : -1;
        model.walls.push_back(axis >= 0 ? addPlane(model, wall, axis, index) : WallHandle());
        if (axis >= 0)
            continue;
        const std::array<Vec3, 2> box = boxOf(meshOf(wall, setup), margin);
        MeshGroup& group = groupFor(model, box, model.contacts.classOfWall[w]);
        group.walls.push_back(index);
        group.boxes.push_back(box);
    }
    if (model.meshes.empty())
        return;
    std::string meshes;
    for (size_t g = 0; g < model.meshes.size(); ++g)
    {
        TriSurface surface;
        std::string names;
        for (const int w : model.meshes[g].walls)
        {
            const WallDefinition& wall = setup.walls[static_cast<size_t>(w)];
            append(surface, meshOf(wall, setup));
            names += (names.empty() ? "" : ", ") + wall.name;
        }
        addMesh(model, names, surface, model.contacts.classOfWall[static_cast<size_t>(model.meshes[g].walls.front())], g);
        meshes += " mesh" + std::to_string(g);
    }
    // LIGGGHTS allows one wall fix of mesh type; it may hold many meshes
    model.meshWalls = model.instance.addFix(words("meshes all wall/gran model hooke/stiffness tangential history mesh n_meshes "
                                                  + std::to_string(model.meshes.size()) + " meshes" + meshes + " store_force yes "
                                                  + contactModelOptions()));
    model.meshForce = model.instance.findFix("force_meshes");
    for (size_t g = 0; g < model.meshes.size(); ++g)
    {
        model.meshes[g].mesh = static_cast<LAMMPS_NS::FixMeshSurface*>(model.instance.findFix("mesh" + std::to_string(g)));
        for (const int w : model.meshes[g].walls)
            model.walls[static_cast<size_t>(w)].mesh = model.meshes[g].mesh;
    }
}

} // namespace flotsam
