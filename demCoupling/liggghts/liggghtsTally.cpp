// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsTally.hpp"

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

Load meshLoad(LAMMPS_NS::FixMeshSurface& mesh)
{
    // compute_vector() would give the values of the step before during set-up
    auto& stress = static_cast<LAMMPS_NS::MeshModuleStress&>(*mesh.get_module("stress"));
    return {asVec(stress.f_total_ptr()), asVec(stress.torque_total_ptr())};
}

} // namespace

void ContactTally::install(LiggghtsModel& model)
{
    LAMMPS_NS::Modify& modify = *model.instance.lammps().modify;
    model.instance.addFix({"tally", "all", "lineforce", "1", "0", "0"});
    const int slot = modify.find_fix("tally");
    delete modify.fix[slot];
    std::array<std::string, 3> text = {"tally", "all", "flotsam/tally"};
    std::array<char*, 3> arguments = {text[0].data(), text[1].data(), text[2].data()};
    model.tally = new ContactTally(&model.instance.lammps(), 3, arguments.data(), model);
    modify.fix[slot] = model.tally;
    modify.fmask[slot] = model.tally->setmask();
}

int ContactTally::setmask() { return LAMMPS_NS::FixConst::END_OF_STEP | LAMMPS_NS::FixConst::PRE_NEIGHBOR; }

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

bool ContactTally::readWalls()
{
    bool isTouched = false;
    for (size_t w = 0; w < model_.walls.size(); ++w)
    {
        wallNow_[w] = model_.walls[w].mesh ? meshLoad(*model_.walls[w].mesh) : planeLoad(w);
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
    // the walls' loads are those of the last sub-step, or of the state restored since
    hasContact_ = readBodies();
    for (const Load& load : wallNow_)
        hasContact_ = hasContact_ || !load.force.isZero(0);
    bodySum_.assign(bodyNow_.size(), {});
    wallSum_.assign(wallNow_.size(), {});
    if (hasContact_)
        add(0.5);
}

void ContactTally::end_of_step()
{
    if (readAll())
    {
        hasContact_ = true;
        add(1);
    }
}

void ContactTally::finish(long steps)
{
    if (hasContact_)
        add(-0.5); // the last force is used with its second half only
    const double weight = 1 / static_cast<double>(steps);
    for (size_t b = 0; b < bodySum_.size(); ++b)
        bodyMean_[b] = {bodySum_[b].force * weight, bodySum_[b].moment * weight};
    for (size_t w = 0; w < wallSum_.size(); ++w)
        wallMean_[w] = {wallSum_[w].force * weight, wallSum_[w].moment * weight};
}

} // namespace flotsam
