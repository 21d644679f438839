// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsTally.hpp"

#include "demCoupling/liggghts/liggghtsHistory.hpp"
#include "demCoupling/liggghts/liggghtsNear.hpp"
#include "demCoupling/liggghts/liggghtsRestraints.hpp"

#include "fix_mesh_surface.h"
#include "fix_multisphere.h"
#include "mesh_module_stress.h"
#include "modify.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>

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

/// Puts a fix of our own in place of one without effect: LIGGGHTS makes fixes only of styles it was compiled with.
template <class OwnFix, class... Arguments>
OwnFix* installFix(LiggghtsModel& model, const std::string& id, Arguments&... arguments)
{
    LAMMPS_NS::Modify& modify = *model.instance.lammps().modify;
    model.instance.addFix({id, "all", "lineforce", "1", "0", "0"});
    const int slot = modify.find_fix(id.c_str());
    delete modify.fix[slot];
    std::array<std::string, 3> text = {id, "all", "flotsam/" + id};
    std::array<char*, 3> words = {text[0].data(), text[1].data(), text[2].data()};
    OwnFix* const fix = new OwnFix(&model.instance.lammps(), 3, words.data(), arguments...);
    modify.fix[slot] = fix;
    modify.fmask[slot] = fix->setmask();
    return fix;
}

void keepLarger(const Vec3& now, Vec3& peak)
{
    if (now.squaredNorm() > peak.squaredNorm())
        peak = now;
}

Load meshLoad(LAMMPS_NS::FixMeshSurface& mesh)
{
    // compute_vector() would give the values of the step before during set-up
    auto& stress = static_cast<LAMMPS_NS::MeshModuleStress&>(*mesh.get_module("stress"));
    return {asVec(stress.f_total_ptr()), asVec(stress.torque_total_ptr())};
}

} // namespace

void ContactTally::install(LiggghtsModel& model, const DemSetup& setup)
{
    model.near = std::make_unique<NearSpheres>(model, setup);
    model.restraints = std::make_unique<Restraints>(model, setup);
    model.tally = installFix<ContactTally>(model, "tally", model, setup);
}

void WallLimit::install(LiggghtsModel& model) { installFix<WallLimit>(model, "wallLimit", model); }

void WallLimit::post_force(int)
{
    const std::vector<int>& spheres = model_.near->atMeshes();
    lmp->atom->nlocal = spheres.empty() ? 0 : spheres.back() + 1;
    model_.tally->clearPlanes();
}

/// What LIGGGHTS does for every sphere.
void ContactTally::clearPlanes()
{
    for (size_t w = 0; w < nearPlane_.size(); ++w)
        for (const int i : nearPlane_[w])
            std::fill_n(model_.walls[w].force->array_atom[i], 3, 0.0);
}

int ContactTally::setmask()
{
    using namespace LAMMPS_NS::FixConst;
    return PRE_INITIAL_INTEGRATE | POST_INTEGRATE | PRE_NEIGHBOR | PRE_FORCE | POST_FORCE | PRE_FINAL_INTEGRATE | END_OF_STEP;
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

/// Before LIGGGHTS asks whether the lists are to be rebuilt.
void ContactTally::post_integrate()
{
    showSpheres();
    placeSpheres(model_, model_.near->active());
    if (model_.near->keepUp())
        return meshTurns_.leaveOutIdle();
    model_.multisphere->next_reneighbor = lmp->update->ntimestep;
    placeSpheres(model_);
}

void ContactTally::pre_force(int)
{
    if (isRebuilt_)
        model_.near->takeLists(nearPlane_);
    isRebuilt_ = false;
    damping_.beforeForces(nearPlane_);
    if (!model_.near->atMeshes().empty())
        meshTurns_.takeAll();
    if (step_ > 0) // else the lists alone are rebuilt
        facets_.leaveOut();
}

void ContactTally::post_force(int)
{
    showSpheres();
    facets_.takeBack();
    if (pairs_.isDue())
        pairs_.readPairs();
}

void ContactTally::pre_final_integrate()
{
    takeForces(model_, model_.near->active());
    model_.restraints->pull(lmp->update->dt);
    answerContacts(model_, model_.loads);
    hideSpheres();
}

void ContactTally::pre_neighbor()
{
    isRebuilt_ = true;
    meshTurns_.noteRebuild();
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
            if (std::abs(atoms.x[i][wall.axis] - wall.coordinate) <= atoms.radius[i] + skin && model_.touchesWalls(i))
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
    for (const int t : model_.near->touchable(group))
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
    for (const int i : model_.near->atMeshes())
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
    pairs_.readPairs();
    pairs_.readWalls(nearPlane_);
    bodyMean_.assign(bodyNow_.size(), {});
    wallMean_.assign(wallNow_.size(), {});
    clearPeaks();
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

void ContactTally::clearPeaks()
{
    bodyPeak_.assign(bodyNow_.size(), Vec3::Zero());
    wallPeak_.assign(wallNow_.size(), Vec3::Zero());
    groupPeak_.assign(wallGroups_.size(), Vec3::Zero());
}

void ContactTally::keepPeaks()
{
    for (size_t b = 0; b < bodyNow_.size(); ++b)
        keepLarger(bodyNow_[b].force, bodyPeak_[b]);
    for (size_t w = 0; w < wallNow_.size(); ++w)
        keepLarger(wallNow_[w].force, wallPeak_[w]);
    for (size_t g = 0; g < wallGroups_.size(); ++g)
    {
        Vec3 sum = Vec3::Zero();
        for (const int w : wallGroups_[g])
            sum += wallNow_[static_cast<size_t>(w)].force;
        keepLarger(sum, groupPeak_[g]);
    }
}

void ContactTally::start()
{
    hasContact_ = false;
    readBodies();
    bodySum_.assign(bodyNow_.size(), {});
    wallSum_.assign(wallNow_.size(), {});
    clearPeaks();
    pairs_.start();
    model_.restraints->start();
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
    pairs_.add(0.5 * step_);
    model_.restraints->startSteps(step_);
}

void ContactTally::end_of_step()
{
    showSpheres();
    meshTurns_.finishStep();
    model_.near->dropOpenedContacts();
    if (readAll())
    {
        hasContact_ = true;
        add(step_);
        keepPeaks();
    }
    if (pairs_.isDue())
    {
        pairs_.readWalls(nearPlane_);
        pairs_.add(step_);
    }
    model_.restraints->endStep(step_);
}

void ContactTally::finishSteps()
{
    damping_.finishSteps();
    if (hasContact_)
        add(-0.5 * step_); // the last force is used with its second half only
    pairs_.add(-0.5 * step_);
    model_.restraints->finishSteps(step_);
    step_ = 0;
}

void ContactTally::finish(double duration)
{
    for (size_t b = 0; b < bodySum_.size(); ++b)
        bodyMean_[b] = {bodySum_[b].force / duration, bodySum_[b].moment / duration};
    for (size_t w = 0; w < wallSum_.size(); ++w)
        wallMean_[w] = {wallSum_[w].force / duration, wallSum_[w].moment / duration};
    pairs_.finish(duration);
    model_.restraints->finish(duration);
}

} // namespace flotsam
