// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsTally.hpp"

#include "demCoupling/liggghts/liggghtsHistory.hpp"

#include "atom.h"
#include "fix_mesh_surface.h"
#include "mesh_module_stress.h"
#include "lammps.h"
#include "modify.h"
#include "neighbor.h"

namespace flotsam
{

namespace
{

Vec3 asVec(const double* v) { return Vec3(v[0], v[1], v[2]); }

/// The force on a triangle is protected; a derived class may name it.
struct StressAccess : LAMMPS_NS::MeshModuleStress
{
    static const double* force(LAMMPS_NS::MeshModuleStress& stress, int triangle)
    {
        double* (LAMMPS_NS::MeshModuleStress::*method)(int) = &StressAccess::f;
        return (stress.*method)(triangle);
    }
};

Load meshLoad(LAMMPS_NS::FixMeshSurface& mesh)
{
    // compute_vector() would give the values of the step before during set-up
    auto& stress = static_cast<LAMMPS_NS::MeshModuleStress&>(*mesh.get_module("stress"));
    return {asVec(stress.f_total_ptr()), asVec(stress.torque_total_ptr())};
}

} // namespace

void ContactTally::install(LiggghtsModel& model, const DemSetup& setup)
{
    LAMMPS_NS::Modify& modify = *model.instance.lammps().modify;
    model.instance.addFix({"tally", "all", "lineforce", "1", "0", "0"});
    const int slot = modify.find_fix("tally");
    delete modify.fix[slot];
    std::array<std::string, 3> text = {"tally", "all", "flotsam/tally"};
    std::array<char*, 3> arguments = {text[0].data(), text[1].data(), text[2].data()};
    model.tally = new ContactTally(&model.instance.lammps(), 3, arguments.data(), model, setup);
    modify.fix[slot] = model.tally;
    modify.fmask[slot] = model.tally->setmask();
}

int ContactTally::setmask()
{
    return LAMMPS_NS::FixConst::END_OF_STEP | LAMMPS_NS::FixConst::PRE_NEIGHBOR | LAMMPS_NS::FixConst::PRE_FORCE;
}

bool ContactTally::readBodies()
{
    const BodyArrays& b = model_.bodies;
    bodyNow_.resize(static_cast<size_t>(b.count));
    bool isTouched = false;
    for (int i = 0; i < b.count; ++i)
    {
        Load& load = bodyNow_[static_cast<size_t>(i)];
        load.force = asVec(b.fcm[i]) - asVec(b.drag[i]);
        load.moment = asVec(b.torque[i]) - asVec(b.hdTorque[i]);
        isTouched = isTouched || !load.force.isZero(0) || !load.moment.isZero(0);
    }
    return isTouched;
}

void ContactTally::pre_neighbor()
{
    const LAMMPS_NS::Atom& atoms = *lmp->atom;
    const double skin = lmp->neighbor->skin;
    nearPlane_.resize(model_.walls.size());
    for (size_t w = 0; w < model_.walls.size(); ++w)
    {
        const WallHandle& wall = model_.walls[w];
        nearPlane_[w].clear();
        if (wall.mesh)
            continue;
        for (int i = 0; i < atoms.nlocal; ++i)
            if (std::abs(atoms.x[i][wall.axis] - wall.coordinate) <= atoms.radius[i] + skin)
                nearPlane_[w].push_back(i);
    }
}

Load ContactTally::planeLoad(size_t index) const
{
    const LAMMPS_NS::Atom& atoms = *lmp->atom;
    const WallHandle& wall = model_.walls[index];
    Load load;
    for (const int i : nearPlane_[index])
    {
        const double* f = wall.force->array_atom[i];
        if (f[0] == 0 && f[1] == 0 && f[2] == 0)
            continue;
        // point at which LIGGGHTS lets the force act: half the overlap inside the sphere
        Vec3 point = asVec(atoms.x[i]);
        const double distance = point[wall.axis] - wall.coordinate;
        const double lever = atoms.radius[i] - 0.5 * (atoms.radius[i] - std::abs(distance));
        point[wall.axis] -= distance > 0 ? lever : -lever;
        load.force -= asVec(f);
        load.moment -= point.cross(asVec(f));
    }
    return load;
}

void ContactTally::readSharedMeshForces(const MeshGroup& group)
{
    for (const int w : group.walls)
        wallNow_[static_cast<size_t>(w)] = {};
    auto& stress = static_cast<LAMMPS_NS::MeshModuleStress&>(*group.mesh->get_module("stress"));
    LAMMPS_NS::TriMesh& mesh = *group.mesh->triMesh();
    for (int t = 0; t < mesh.sizeLocal(); ++t)
    {
        const double* f = StressAccess::force(stress, t);
        if (f[0] == 0 && f[1] == 0 && f[2] == 0)
            continue;
        Vec3 centre;
        mesh.center(t, centre.data());
        wallNow_[static_cast<size_t>(group.wallAt(centre))].force += asVec(f);
    }
}

/// From the force of all meshes on a sphere, the only one LIGGGHTS keeps: exact unless a sphere touches two triangles that do not lie
/// in one plane, which get it shared out by overlap.
void ContactTally::readSharedMeshMoments()
{
    const LAMMPS_NS::Atom& atoms = *lmp->atom;
    for (int i = 0; i < atoms.nlocal; ++i)
    {
        const Vec3 force = asVec(model_.meshForce->array_atom[i]);
        if (force.isZero(0))
            continue;
        findMeshTouches(model_, i, touches_);
        double total = 0;
        for (const MeshTouch& touch : touches_)
            total += touch.overlap;
        for (const MeshTouch& touch : touches_)
        {
            const MeshGroup& group = model_.meshes[touch.mesh];
            if (group.walls.size() > 1)
                wallNow_[static_cast<size_t>(group.wallAt(touch.point))].moment -= touch.point.cross(force) * (touch.overlap / total);
        }
    }
}

void ContactTally::readMeshes()
{
    bool isAnyShared = false;
    for (const MeshGroup& group : model_.meshes)
        if (group.walls.size() == 1)
            wallNow_[static_cast<size_t>(group.walls.front())] = meshLoad(*group.mesh);
        else
        {
            isAnyShared = true;
            readSharedMeshForces(group);
        }
    if (isAnyShared)
        readSharedMeshMoments();
}

bool ContactTally::readWalls()
{
    readMeshes();
    bool isTouched = false;
    for (size_t w = 0; w < model_.walls.size(); ++w)
    {
        if (!model_.walls[w].mesh)
            wallNow_[w] = planeLoad(w);
        isTouched = isTouched || !wallNow_[w].force.isZero(0);
    }
    return isTouched;
}

bool ContactTally::readAll()
{
    const bool isBodyTouched = readBodies(); // a body squeezed evenly feels nothing, its walls do
    return readWalls() || isBodyTouched;
}

void ContactTally::sample()
{
    wallNow_.assign(model_.walls.size(), {});
    readAll();
    bodyMean_.assign(bodyNow_.size(), {});
    wallMean_.assign(wallNow_.size(), {});
}

void ContactTally::add(double weight)
{
    for (size_t b = 0; b < bodyNow_.size(); ++b)
    {
        bodySum_[b].force += weight * bodyNow_[b].force;
        bodySum_[b].moment += weight * bodyNow_[b].moment;
    }
    for (size_t w = 0; w < wallNow_.size(); ++w)
    {
        wallSum_[w].force += weight * wallNow_[w].force;
        wallSum_[w].moment += weight * wallNow_[w].moment;
    }
}

void ContactTally::start()
{
    hasContact_ = false;
    readBodies();
    bodySum_.assign(bodyNow_.size(), {});
    wallSum_.assign(wallNow_.size(), {});
}

void ContactTally::startSteps(double step)
{
    step_ = step;
    damping_.startSteps(step);
    // the walls' loads are those of the last sub-step, or of the state restored since
    hasContact_ = readBodies() || hasContact_;
    for (const Load& load : wallNow_)
        hasContact_ = hasContact_ || !load.force.isZero(0);
    if (hasContact_)
        add(0.5 * step_);
}

void ContactTally::end_of_step()
{
    if (readAll())
    {
        hasContact_ = true;
        add(step_);
    }
}

void ContactTally::finishSteps()
{
    damping_.finishSteps();
    if (hasContact_)
        add(-0.5 * step_); // the last force is used with its second half only
}

void ContactTally::finish(double duration)
{
    for (size_t b = 0; b < bodySum_.size(); ++b)
        bodyMean_[b] = {bodySum_[b].force / duration, bodySum_[b].moment / duration};
    for (size_t w = 0; w < wallSum_.size(); ++w)
        wallMean_[w] = {wallSum_[w].force / duration, wallSum_[w].moment / duration};
}

} // namespace flotsam
