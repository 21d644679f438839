// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/meshWalls.H"

#include "SubField.H"
#include "boundBox.H"

#include <cmath>
#include <map>

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
        for (Foam::label k = 1; k + 1 < f.size(); ++k)
            for (const Foam::label point : {f[0], f[k + 1], f[k]})
                for (int d = 0; d < 3; ++d) corners.push_back(mesh.points()[point][d]);
    return corners;
}

std::vector<double> gatherAll(const std::vector<double>& mine, const Halo& halo)
{
    const int n = static_cast<int>(mine.size());
    std::vector<int> counts(halo.size()), starts(halo.size() + 1, 0);
    MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, halo.comm());
    for (int r = 0; r < halo.size(); ++r) starts[r + 1] = starts[r] + counts[r];
    std::vector<double> all(starts.back());
    MPI_Allgatherv(mine.data(), n, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, halo.comm());
    return all;
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

/// Area-weighted normal and centre; true when all points lie in that plane.
bool fitPlane(const TriSurface& surface, Vec3& point, Vec3& normal, double tolerance)
{
    Vec3 sum = Vec3::Zero(), centre = Vec3::Zero();
    double area = 0;
    for (const auto& t : surface.triangles)
    {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        const Vec3 n = 0.5*(b - a).cross(c - a);
        sum += n;
        centre += n.norm()*(a + b + c)/3;
        area += n.norm();
    }
    if (area <= 0 || sum.norm() < 0.999999*area) return false;
    point = centre/area;
    normal = sum.normalized();
    for (const Vec3& x : surface.points)
        if (std::abs(normal.dot(x - point)) > tolerance) return false;
    return true;
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

WallDefinition makeMeshWall(const Foam::polyMesh& mesh, const Foam::polyPatch& patch, const Halo& halo, int material)
{
    WallDefinition wall;
    wall.name = patch.name();
    wall.material = material;
    wall.surface = stitched(gatherAll(localTriangles(mesh, patch), halo));
    const auto bounds = meshBounds(mesh);
    const double tolerance = 1e-7*(bounds[1] - bounds[0]).norm();
    const bool isPlane = fitPlane(wall.surface, wall.point, wall.normal, tolerance)
        && isMeshInFront(mesh, halo, wall.point, wall.normal, tolerance);
    wall.kind = isPlane ? WallDefinition::Kind::Plane : WallDefinition::Kind::Surface;
    if (isPlane) wall.surface = TriSurface();
    return wall;
}

} // namespace flotsam
