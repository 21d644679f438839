// SPDX-License-Identifier: GPL-3.0-or-later
/// Leaves out LIGGGHTS' meshes in sub-steps in which no body is near one.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"

namespace flotsam
{

/// In every sub-step LIGGGHTS asks each triangle for its spheres and clears its force: with a terrain of 100,000 triangles ten times the cost of
/// all else, with no body near it. Its fixes of meshes are left out where that would change nothing.
class MeshTurns
{
public:
    explicit MeshTurns(LiggghtsModel& model) : model_(model) {}
    /// Before the fixes' turns in a sub-step.
    void leaveOutIdle();
    /// Where a sphere can touch a triangle, after all, or the lists were rebuilt.
    void takeAll();
    void noteRebuild();
    void finishStep();

private:
    struct Turns { int *list, *count; std::vector<int> all; };
    void leaveOut(Turns& turns);
    bool isOfMeshes(int fix) const;

    LiggghtsModel& model_;
    std::vector<Turns> shortened_;  ///< with what they held; empty: all have their turns
    bool isIdle_ = false;           ///< forces of and on triangles are zero
};

} // namespace flotsam
