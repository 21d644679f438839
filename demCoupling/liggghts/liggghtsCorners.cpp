// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsCorners.hpp"
#include "geometry/closestPoint.hpp"


#include "atom.h"
#include "fix_multisphere.h"
#include "lammps.h"

namespace flotsam
{

namespace
{

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

/// Whether the line from a to b leads through the triangle.
bool crosses(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t)
{
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double heightA = normal.dot(a - t[0]), heightB = normal.dot(b - t[0]);
    if ((heightA > 0) == (heightB > 0))
        return false;
    const Vec3 x = a + (b - a) * (heightA / (heightA - heightB));
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 &p = t[static_cast<size_t>(k)], &q = t[static_cast<size_t>((k + 1) % 3)];
        if (normal.dot((q - p).cross(x - p)) < 0)
            return false;
    }
    return true;
}

int nearestOf(const std::vector<SurfaceSphere>& spheres, const Vec3& x)
{
    const auto isNearer = [&](const SurfaceSphere& a, const SurfaceSphere& b) { return (a.centre - x).squaredNorm() < (b.centre - x).squaredNorm(); };
    return static_cast<int>(std::min_element(spheres.begin(), spheres.end(), isNearer) - spheres.begin());
}

} // namespace

CornerSpheres::CornerSpheres(LiggghtsModel& model, const DemSetup& setup) : model_(model), walls_(setup.walls)
{
    for (size_t b = 0; b < setup.bodies.size(); ++b)
        for (size_t c = 0; c < setup.bodies[b].corners.size(); ++c)
            corners_.push_back({model.firstCorner[b] + static_cast<int>(c), model.firstSphere[b] + nearestOf(setup.bodies[b].spheres, setup.bodies[b].corners[c].centre)});
    if (!corners_.empty())
        for (const WallDefinition& wall : walls_)
            triangles_.emplace_back(wall.surface);
}

void CornerSpheres::look()
{
    for (const Corner& corner : corners_)
    {
        const bool wasRetreated = model_.isRetreated[static_cast<size_t>(corner.sphere)];
        if (model_.isGone[static_cast<size_t>(model_.multisphere->belongs_to(corner.sphere) - 1)])
            continue;
        const Meeting meeting = meetWalls(corner);
        const bool isRetreated = meeting.isThrough || (wasRetreated && meeting.isTouching);
        if (isRetreated != wasRetreated)
            set(corner, isRetreated);
    }
}

CornerSpheres::Meeting CornerSpheres::meetWalls(const Corner& corner) const
{
    const LAMMPS_NS::Atom& atoms = *model_.instance.lammps().atom;
    Meeting meeting;
    for (size_t w = 0; w < walls_.size(); ++w)
        meet(walls_[w], triangles_[w], asVec(atoms.x[corner.inner]), asVec(atoms.x[corner.sphere]), atoms.radius[corner.sphere], meeting);
    return meeting;
}

void CornerSpheres::meet(const WallDefinition& wall, const TriangleBoxes& triangles, const Vec3& inner, const Vec3& centre, double radius, Meeting& meeting) const
{
    if (wall.kind == WallDefinition::Kind::Plane)
    {
        const Vec3 normal = wall.normal.normalized();
        const double height = normal.dot(centre - wall.point);
        meeting.isTouching = meeting.isTouching || std::abs(height) < radius;
        meeting.isThrough = meeting.isThrough || (height > 0) != (normal.dot(inner - wall.point) > 0);
        return;
    }
    const Vec3 margin = Vec3::Constant(radius);
    triangles.any({inner.cwiseMin(centre) - margin, inner.cwiseMax(centre) + margin}, [&](const TriangleBoxes::Box& box)
    {
        const std::array<int, 3>& nodes = wall.surface.triangles[static_cast<size_t>(box.triangle)];
        std::array<Vec3, 3> t;
        for (size_t k = 0; k < 3; ++k)
            t[k] = wall.surface.points[static_cast<size_t>(nodes[k])];
        if ((t[1] - t[0]).cross(t[2] - t[0]).isZero(0))
            return false; // LIGGGHTS has not got it either
        meeting.isTouching = meeting.isTouching || (closestPointOfTriangle(centre, t[0], t[1], t[2]) - centre).squaredNorm() < radius * radius;
        meeting.isThrough = meeting.isThrough || crosses(inner, centre, t);
        return meeting.isThrough;
    });
}

void CornerSpheres::set(const Corner& corner, bool isRetreated)
{
    model_.isRetreated[static_cast<size_t>(corner.sphere)] = isRetreated;
    markGone(model_, std::vector<char>(model_.isGone));
    forgetWallContacts(model_, corner.sphere);
}

} // namespace flotsam
