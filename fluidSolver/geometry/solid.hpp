// SPDX-License-Identifier: GPL-3.0-or-later
/// What the fluid sees of a solid: a signed distance, a surface velocity and, for a free body, its inertia and load.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// Position and motion of a rigid solid in space.
struct Pose
{
    Vec3 position = Vec3::Zero();                                       ///< of the solid's origin (free body: centre of mass) [m]
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();    ///< body frame -> space
};

struct Motion
{
    Vec3 velocity = Vec3::Zero();           ///< of the origin, space frame [m/s]
    Vec3 angularVelocity = Vec3::Zero();    ///< space frame [rad/s]
};

struct Solid
{
    enum class Kind { Fixed, Prescribed, Free };
    enum class Wall { NoSlip, Slip };

    std::string name;
    Kind kind = Kind::Fixed;
    Wall wall = Wall::NoSlip;
    std::shared_ptr<const Shape> shape; ///< in the body frame; free body: centroid at the origin, principal axes
    Pose pose;                          ///< at the time the cover was (or is to be) cut
    Motion motion;                      ///< at that time; free body: predicted, the solve corrects it
    double offset = 0;                  ///< surface moved outward by this so that the cut volume is the exact one [m]

    /// Signed distance of a point in space [m], negative inside.
    double distance(const Vec3& x) const
    {
        return shape->distance(pose.orientation.conjugate() * (x - pose.position)) - offset;
    }
    /// Velocity of the rigid motion at a point in space [m/s].
    Vec3 velocityAt(const Vec3& x) const { return motion.velocity + motion.angularVelocity.cross(x - pose.position); }
    /// Axis-aligned bounding box in space [m].
    std::array<Vec3, 2> spaceBounds() const;
};

} // namespace flotsam
