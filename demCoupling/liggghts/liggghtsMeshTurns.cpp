// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsMeshTurns.hpp"

#include "demCoupling/liggghts/liggghtsNear.hpp"

#include <mpi.h>

#include "fix_mesh_surface.h"
#include "lammps.h"
#include "modify.h"

#include <algorithm>

namespace flotsam
{

namespace
{

/// Which fixes have a turn is protected; a derived class may name it.
struct TurnAccess : LAMMPS_NS::Modify
{
    static int* preForce(LAMMPS_NS::Modify& modify) { return modify.*&TurnAccess::list_pre_force; }
    static int* postForce(LAMMPS_NS::Modify& modify) { return modify.*&TurnAccess::list_post_force; }
};

} // namespace

bool MeshTurns::isOfMeshes(int fix) const
{
    const LAMMPS_NS::Fix* f = model_.instance.lammps().modify->fix[fix];
    const auto isMesh = [f](const MeshGroup& group) { return group.mesh == f; };
    return f == model_.meshWalls || std::any_of(model_.meshes.begin(), model_.meshes.end(), isMesh);
}

void MeshTurns::leaveOut(Turns& turns)
{
    turns.all.assign(turns.list, turns.list + *turns.count);
    int* const end = std::remove_if(turns.list, turns.list + *turns.count, [this](int fix) { return isOfMeshes(fix); });
    *turns.count = static_cast<int>(end - turns.list);
}

void MeshTurns::leaveOutIdle()
{
    if (!isIdle_ || !model_.near->atMeshes().empty())
        return;
    LAMMPS_NS::Modify& modify = *model_.instance.lammps().modify;
    shortened_ = {{TurnAccess::preForce(modify), &modify.n_pre_force, {}}, {TurnAccess::postForce(modify), &modify.n_post_force, {}}};
    for (Turns& turns : shortened_)
        leaveOut(turns);
}

void MeshTurns::takeAll()
{
    for (const Turns& turns : shortened_)
    {
        std::copy(turns.all.begin(), turns.all.end(), turns.list);
        *turns.count = static_cast<int>(turns.all.size());
    }
    shortened_.clear();
}

void MeshTurns::noteRebuild()
{
    takeAll();
    isIdle_ = false;
}

/// A sub-step in which no sphere could touch a triangle has cleared what was there before.
void MeshTurns::finishStep()
{
    takeAll();
    isIdle_ = model_.meshWalls && model_.near->atMeshes().empty();
}

} // namespace flotsam
