// SPDX-License-Identifier: GPL-3.0-or-later
/// Corners of boxes that were pressed through a wall.
#pragma once

#include "demCoupling/liggghts/liggghtsParts.hpp"
#include "demCoupling/liggghts/reach.hpp"

namespace flotsam
{

/// The centre of a small sphere gets through a wall sooner than that of a large one, and its spring would then hold the body there. Such a
/// corner retreats: it touches nothing, the body's other spheres hold it, until it is free of all walls again. It so gives back no more work than
/// was done on it. Looked at after every advance, so that it is part of the state.
class CornerSpheres
{
public:
    CornerSpheres(LiggghtsModel& model, const DemSetup& setup);

    /// With all spheres in their places.
    void look();

private:
    struct Corner { int sphere, inner; };   ///< inner: the nearest of the body's other spheres
    struct Meeting { bool isTouching = false, isThrough = false; };
    Meeting meetWalls(const Corner& corner) const;
    void meet(const WallDefinition& wall, const TriangleBoxes& triangles, const Vec3& inner, const Vec3& centre, double radius, Meeting& meeting) const;
    void set(const Corner& corner, bool isRetreated);

    LiggghtsModel& model_;
    const std::vector<WallDefinition>& walls_;
    std::vector<TriangleBoxes> triangles_;  ///< of each wall
    std::vector<Corner> corners_;
};

} // namespace flotsam
