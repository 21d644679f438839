// SPDX-License-Identifier: GPL-3.0-or-later
/// The contacts of this instant, one per pair of bodies or of body and wall.
#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "geometry/closestPoint.hpp"

#include "atom.h"
#include "fix.h"
#include "fix_multisphere.h"
#include "lammps.h"

#include <map>

namespace flotsam
{

namespace
{

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

/// Sphere contacts of one pair, added up; the point is the mean weighted by force.
struct Sum
{
    Vec3 force = Vec3::Zero(), weightedPoint = Vec3::Zero(), plainPoint = Vec3::Zero();
    double weight = 0, overlap = 0;
    int count = 0;

    void add(const Vec3& f, const Vec3& point, double depth)
    {
        force += f;
        weightedPoint += f.norm() * point;
        weight += f.norm();
        plainPoint += point;
        overlap = std::max(overlap, depth);
        ++count;
    }
    Vec3 point() const { return weight > 0 ? Vec3(weightedPoint / weight) : Vec3(plainPoint / count); }
};

using Sums = std::map<std::pair<int, int>, Sum>;

/// The law of the pair evaluated again with the velocities at the end of the sub-step (LIGGGHTS keeps no pair force).
Vec3 pairForce(const ContactTable& table, const LAMMPS_NS::Atom& atoms, int i, int j, const double* spring)
{
    const size_t entry = table.entryOf(atoms.type[i], atoms.type[j]);
    const Vec3 separation = asVec(atoms.x[i]) - asVec(atoms.x[j]);
    const double distance = separation.norm();
    const Vec3 normal = separation / distance;
    const double overlap = atoms.radius[i] + atoms.radius[j] - distance;
    // rotation moves the contact point along the surfaces only
    const Vec3 approach = asVec(atoms.v[i]) - asVec(atoms.v[j]);
    const double normalSpeed = approach.dot(normal);
    const double normalForce = std::max(0.0, table.stiffness[entry] * overlap - table.dampingOf(atoms.type[i], atoms.type[j]) * normalSpeed);
    Vec3 tangential = -table.stiffness[entry] * asVec(spring);
    const double limit = table.friction[entry] * normalForce;
    if (tangential.norm() > limit)
        tangential *= limit / tangential.norm();
    return normalForce * normal + tangential;
}

void addPairs(const LiggghtsModel& model, Sums& sums)
{
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    forEachPairContact(model, [&](int i, int j, const double* spring, int) {
        const Vec3 separation = asVec(atoms.x[i]) - asVec(atoms.x[j]);
        const double overlap = atoms.radius[i] + atoms.radius[j] - separation.norm();
        if (overlap <= 0)
            return;
        const Vec3 point = asVec(atoms.x[j]) + separation.normalized() * (atoms.radius[j] - 0.5 * overlap);
        Vec3 force = pairForce(model.contacts, atoms, i, j, spring);
        int a = model.multisphere->belongs_to(i) - 1, b = model.multisphere->belongs_to(j) - 1;
        if (a > b)
        {
            std::swap(a, b);
            force = -force;
        }
        sums[{a, b}].add(force, point, overlap);
    });
}

void addPlane(const LiggghtsModel& model, const WallHandle& wall, int index, Sums& sums)
{
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    for (int i = 0; i < atoms.nlocal; ++i)
    {
        const double distance = atoms.x[i][wall.axis] - wall.coordinate;
        const double overlap = atoms.radius[i] - std::abs(distance);
        if (overlap <= 0 || !model.touchesWalls(i))
            continue;
        Vec3 point = asVec(atoms.x[i]);
        point[wall.axis] = wall.coordinate;
        sums[{model.multisphere->belongs_to(i) - 1, -1 - index}].add(asVec(wall.force->array_atom[i]), point, overlap);
    }
}

Vec3 closestPoint(const TriSurface& surface, const Vec3& p)
{
    Vec3 best = surface.points.front();
    for (const std::array<int, 3>& t : surface.triangles)
    {
        const Vec3 q = closestPointOfTriangle(p, surface.points[static_cast<size_t>(t[0])],
                                              surface.points[static_cast<size_t>(t[1])], surface.points[static_cast<size_t>(t[2])]);
        if ((q - p).squaredNorm() < (best - p).squaredNorm())
            best = q;
    }
    return best;
}

Vec3 closestPoint(const WallDefinition& wall, const Vec3& p)
{
    if (wall.kind == WallDefinition::Kind::Surface)
        return closestPoint(wall.surface, p);
    const Vec3 n = wall.normal.normalized();
    return p - n * n.dot(p - wall.point);
}

/// LIGGGHTS keeps one force per sphere for all meshes together: a sphere that touches several meshes at once gets
/// it shared out by overlap.
void addMeshes(const LiggghtsModel& model, const DemSetup& setup, Sums& sums)
{
    if (!model.meshForce)
        return;
    const LAMMPS_NS::Atom& atoms = *model.instance.lammps().atom;
    struct Touch { int wall; Vec3 point; double overlap; };
    std::vector<Touch> touches;
    for (int i = 0; i < atoms.nlocal; ++i)
    {
        touches.clear();
        double total = 0;
        for (size_t w = 0; w < model.walls.size(); ++w)
        {
            if (!model.walls[w].mesh || !model.touchesWalls(i) || !touchesMesh(*model.walls[w].mesh, i))
                continue;
            const Vec3 point = closestPoint(setup.walls[w], asVec(atoms.x[i]));
            const double overlap = std::max(atoms.radius[i] - (point - asVec(atoms.x[i])).norm(), 0.0);
            touches.push_back({static_cast<int>(w), point, overlap});
            total += overlap;
        }
        for (const Touch& t : touches)
            if (t.overlap > 0)
                sums[{model.multisphere->belongs_to(i) - 1, -1 - t.wall}].add(
                    asVec(model.meshForce->array_atom[i]) * (t.overlap / total), t.point, t.overlap);
    }
}

} // namespace

std::vector<Contact> listContacts(const LiggghtsModel& model, const DemSetup& setup)
{
    Sums sums;
    addPairs(model, sums);
    for (size_t w = 0; w < model.walls.size(); ++w)
        if (!model.walls[w].mesh)
            addPlane(model, model.walls[w], static_cast<int>(w), sums);
    addMeshes(model, setup, sums);
    std::vector<Contact> contacts;
    for (const auto& [key, sum] : sums)
        contacts.push_back({key.first, key.second, sum.point(), sum.force, sum.overlap});
    return contacts;
}

} // namespace flotsam
