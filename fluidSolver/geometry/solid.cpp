// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/solid.hpp"

namespace flotsam
{

namespace
{

/// In space, of a shape in a solid's frame whose surface is moved by its offsets.
std::array<Vec3, 2> boundsInSpace(const Shape& shape, const Solid& solid)
{
    const auto [lower, upper] = shape.bounds();
    const Eigen::Matrix3d rotation = solid.pose.orientation.toRotationMatrix();
    const Vec3 centre = solid.pose.position + rotation * (0.5 * (lower + upper));
    const Vec3 half = (rotation.cwiseAbs() * (0.5 * (upper - lower))).array() + solid.offsetBound();
    return {Vec3(centre - half), Vec3(centre + half)};
}

} // namespace

std::array<Vec3, 2> Solid::spaceBounds() const
{
    return boundsInSpace(*shape, *this);
}

std::array<Vec3, 2> SolidPart::spaceBounds() const
{
    return boundsInSpace(*shape_, *solid_);
}

Eigen::Matrix3d Solid::turning() const
{
    const Symmetry symmetry = shape->symmetry();
    const Vec3 beside = symmetry.point - symmetry.axis*symmetry.axis.dot(symmetry.point);   // of the origin
    if (symmetry.kind == Symmetry::Kind::None || beside.norm() > 1e-9*radius()) return Eigen::Matrix3d::Zero();
    if (symmetry.kind == Symmetry::Kind::Point) return Eigen::Matrix3d::Identity();
    const Vec3 axis = pose.orientation*symmetry.axis;
    return axis*axis.transpose();
}

double Solid::radius() const
{
    const auto [lower, upper] = shape->bounds();
    return lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).norm();
}

} // namespace flotsam
