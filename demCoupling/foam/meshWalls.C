// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/meshWalls.H"

#include "algebra/exchange.hpp"
#include "geometry/faceTriangles.hpp"

#include "SubField.H"
#include "boundBox.H"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace flotsam
{

namespace
{

Vec3 toVec3(const Foam::point& p) { return Vec3(p.x(), p.y(), p.z()); }

/// This rank's faces as loose triangles, 9 numbers each, turned towards the fluid (patch normals point out of it).
std::vector<double> localTriangles(const Foam::polyMesh& mesh, const Foam::polyPatch& patch)
{
    std::vector<double> corners;
    for (const Foam::face& f : patch)
    {
        std::vector<Vec3> x;
        for (const Foam::label point : f) x.push_back(toVec3(mesh.points()[point]));
        for (const auto& t : faceTriangles(x))
            for (const int k : {t[0], t[2], t[1]}) corners.insert(corners.end(), x[k].data(), x[k].data() + 3);
    }
    return corners;
}

/// Equal points become one: ranks hold copies of the same numbers.
TriSurface stitched(const std::vector<double>& corners)
{
    TriSurface surface;
    std::map<std::array<double, 3>, int> number;
    for (std::size_t t = 0; t + 9 <= corners.size(); t += 9)
    {
        std::array<int, 3> triangle;
        for (int k = 0; k < 3; ++k)
        {
            const std::array<double, 3> x{corners[t + 3*k], corners[t + 3*k + 1], corners[t + 3*k + 2]};
            const auto [at, isNew] = number.emplace(x, static_cast<int>(surface.points.size()));
            if (isNew) surface.points.emplace_back(x[0], x[1], x[2]);
            triangle[k] = at->second;
        }
        surface.triangles.push_back(triangle);
    }
    return surface;
}

/// Faces in one plane.
struct PlanarPart
{
    Vec3 point, normal;
    TriSurface surface;
};

/// Faces sorted by the planes they lie in; no more than `largest` planes, then empty: the surface is curved.
std::vector<PlanarPart> planarParts(const TriSurface& surface, double tolerance, std::size_t largest)
{
    std::vector<PlanarPart> parts;
    for (const auto& t : surface.triangles)
    {
        const Vec3 corners[3] = {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
        const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
        PlanarPart* found = nullptr;
        for (PlanarPart& part : parts)
        {
            bool isIn = normal.dot(part.normal) > 0.999999;
            for (const Vec3& c : corners) isIn = isIn && std::abs(part.normal.dot(c - part.point)) <= tolerance;
            if (isIn) { found = &part; break; }
        }
        if (!found)
        {
            if (parts.size() == largest) return {};
            parts.push_back({corners[0], normal, {}});
            found = &parts.back();
        }
        for (const Vec3& c : corners) found->surface.points.push_back(c);
        const int n = static_cast<int>(found->surface.points.size());
        found->surface.triangles.push_back({n - 3, n - 2, n - 1});
    }
    return parts;
}

bool isMeshInFront(const Foam::polyMesh& mesh, const Halo& halo, const Vec3& point, const Vec3& normal, double tolerance)
{
    bool isBehind = false;
    for (const Foam::point& p : mesh.points())
        if (normal.dot(toVec3(p) - point) < -tolerance) { isBehind = true; break; }
    return !halo.any(isBehind);
}

} // namespace

std::array<Vec3, 2> meshBounds(const Foam::polyMesh& mesh)
{
    const Foam::boundBox box(mesh.points(), true);
    return {toVec3(box.min()), toVec3(box.max())};
}

TriSurface withoutFolds(TriSurface surface)
{
    const auto corners = [](std::array<int, 3> t) { std::sort(t.begin(), t.end()); return t; };
    std::map<std::array<int, 3>, int> count;
    for (const auto& t : surface.triangles) ++count[corners(t)];
    const auto isFolded = [&](const std::array<int, 3>& t) { return count[corners(t)] % 2 == 0; };
    surface.triangles.erase(std::remove_if(surface.triangles.begin(), surface.triangles.end(), isFolded), surface.triangles.end());
    return surface;
}

std::vector<WallDefinition> makeMeshWalls(const Foam::polyMesh& mesh, const Foam::polyPatch& patch, const Halo& halo, int material)
{
    constexpr std::size_t mostPlanes = 12; // of a patch; a curved one has more
    WallDefinition rest;
    rest.name = rest.patch = patch.name();
    rest.material = material;
    rest.kind = WallDefinition::Kind::Surface;
    rest.surface = withoutFolds(stitched(gatherAll(localTriangles(mesh, patch), halo.comm())));
    if (rest.surface.triangles.empty()) return {}; // tools that cut meshes leave patches without faces
    const auto bounds = meshBounds(mesh);
    const double tolerance = 1e-7*(bounds[1] - bounds[0]).norm();
    const std::vector<PlanarPart> parts = planarParts(rest.surface, tolerance, mostPlanes);
    if (parts.empty()) return {rest};
    std::vector<WallDefinition> walls;
    std::vector<double> corners; // of what is left
    for (const PlanarPart& part : parts)
    {
        if (!isMeshInFront(mesh, halo, part.point, part.normal, tolerance))
        {
            for (const auto& t : part.surface.triangles)
                for (int k : t) corners.insert(corners.end(), part.surface.points[k].data(), part.surface.points[k].data() + 3);
            continue;
        }
        WallDefinition wall;
        wall.name = wall.patch = patch.name();
        if (parts.size() > 1) wall.name += "." + std::to_string(walls.size() + 1);
        wall.material = material;
        wall.kind = WallDefinition::Kind::Plane;
        wall.point = part.point;
        wall.normal = part.normal;
        walls.push_back(std::move(wall));
    }
    rest.surface = stitched(corners);
    if (!corners.empty()) walls.push_back(std::move(rest));
    return walls;
}

} // namespace flotsam
