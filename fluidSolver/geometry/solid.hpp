// SPDX-License-Identifier: GPL-3.0-or-later
/// What the fluid sees of a solid: a signed distance, a surface velocity and, for a free body, its inertia and load.
#pragma once

#include "geometry/planeFaces.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

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
    std::vector<std::shared_ptr<const PlaneFaces>> planeFaces;  ///< of each of its parts what is cut instead then, of what is round; or null. Empty: it is not thin
    double offset = 0;                  ///< surface moved outward by this so that the cut volume is the exact one [m]
    Vec3 offsetSlope = Vec3::Zero();    ///< and by its product with the distance from the origin, in space: so that its centre is, too

    /// Cut by the faces of its own parts, between other solids, too: thin ones, and unions, whose distance at the nodes knows neither edges nor re-entrant corners.
    bool isSharp() const { return isThin || shape->nParts() > 1; }
    /// At rest for good, and cut alone: CoverBuilder cuts such solids once.
    bool isCutOnce() const { return kind == Kind::Fixed && !isSharp(); }
    /// Signed distance of a point in space [m], negative inside.
    double distance(const Vec3& x) const
    {
        return shape->distance(pose.orientation.conjugate() * (x - pose.position)) - offsetAt(x);
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

/// One of the parts that a solid's shape is the union of (Shape::part()): they are cut one after the other. Refers to the solid.
class SolidPart
{
public:
    SolidPart(const Solid& solid, int number) : solid_(&solid), shape_(&solid.shape->part(number)), faces_(solid.planeFaces.empty() ? nullptr : solid.planeFaces[number].get()) {}

    const Solid& solid() const { return *solid_; }
    const Shape& shape() const { return *shape_; }
    /// Of something round, for which plane faces stand.
    bool isReplaced() const { return faces_; }

    /// Signed distance of a point in space, negative inside, without the solid's offset [m].
    double plainDistance(const Vec3& x) const { return shape_->distance(toBody(x)); }
    /// The same of the shape's faces, of the plane faces if there are any: their number, 0 of shapes without.
    int plainFaceDistances(const Vec3& x, double* distances) const
    {
        return faces_ ? faces_->distances(toBody(x), distances) : shape_->faceDistances(toBody(x), distances);
    }
    /// With the offset.
    int faceDistances(const Vec3& x, double* distances) const
    {
        const int n = plainFaceDistances(x, distances);
        const double offset = offsetAt(x);
        for (int k = 0; k < n; ++k) distances[k] -= offset;
        return n;
    }
    /// Of the solid, less than zero for round parts alone: plane faces are where they are, and moved inward two that lie on each other would leave a slit between them.
    double offsetAt(const Vec3& x) const { return shape_->hasPlaneFaces() ? std::max(solid_->offsetAt(x), 0.0) : solid_->offsetAt(x); }
    /// As Solid::spaceBounds().
    std::array<Vec3, 2> spaceBounds() const;

private:
    Vec3 toBody(const Vec3& x) const { return solid_->pose.orientation.conjugate() * (x - solid_->pose.position); }

    const Solid* solid_;
    const Shape* shape_;
    const PlaneFaces* faces_;
};

} // namespace flotsam
