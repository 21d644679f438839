// SPDX-License-Identifier: GPL-3.0-or-later
/// What the fluid sees of a solid: a signed distance, a surface velocity and, for a free body, its inertia and load.
#pragma once

#include "geometry/planeFaces.hpp"

#include <cmath>

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
    bool isLoose = false;               ///< nothing joins it to the mesh's walls: a film is left between them, see WallFilm
    std::shared_ptr<const Shape> shape; ///< in the body frame; free body: centroid at the origin, principal axes
    Pose pose;                          ///< at the time the cover was (or is to be) cut
    Motion motion;                      ///< at that time; free body: predicted, the solve corrects it
    bool isThin = false;                ///< for the mesh around it, and all of its faces that are cut are plane: CoverBuilder::buildExactVolume()
    std::shared_ptr<const PlaneFaces> planeFaces;   ///< what is cut instead of the shape then, of what is round; or null
    double offset = 0;                  ///< surface moved outward by this so that the cut volume is the exact one [m]
    Vec3 offsetSlope = Vec3::Zero();    ///< and by its product with the distance from the origin, in space: so that its centre is, too

    /// At rest for good, and resolved: CoverBuilder cuts such solids once.
    bool isCutOnce() const { return kind == Kind::Fixed && !isThin; }
    /// Signed distance of a point in space [m], negative inside.
    double distance(const Vec3& x) const
    {
        return shape->distance(pose.orientation.conjugate() * (x - pose.position)) - offsetAt(x);
    }
    /// Shape::faceDistances in space, of the plane faces if there are any.
    int faceDistances(const Vec3& x, double* distances) const
    {
        const Vec3 y = pose.orientation.conjugate() * (x - pose.position);
        const int n = planeFaces ? planeFaces->distances(y, distances) : shape->faceDistances(y, distances);
        for (int k = 0; k < n; ++k) distances[k] -= offsetAt(x);
        return n;
    }
    double offsetAt(const Vec3& x) const { return offset + offsetSlope.dot(x - pose.position); }
    /// Bound of |offsetAt| over the shape's bounding box [m].
    double offsetBound() const { return std::abs(offset) + offsetSlope.norm() * radius(); }
    /// Of a sphere about the origin that holds the shape's bounding box [m].
    double radius() const;
    /// Projection of angular velocities on those about the origin that turn the solid into itself (Shape::symmetry(); zero: none), in space.
    Eigen::Matrix3d turning() const;
    /// Velocity of the rigid motion at a point in space [m/s].
    Vec3 velocityAt(const Vec3& x) const { return motion.velocity + motion.angularVelocity.cross(x - pose.position); }
    /// Axis-aligned bounding box in space [m].
    std::array<Vec3, 2> spaceBounds() const;
};

} // namespace flotsam
