// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/contactModes.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

using Directions = std::vector<Vec3>;
struct ContactPoint { Vec3 place; double weight; };
using ContactPoints = std::vector<ContactPoint>;

/// Largest eigenvalue [1/kg] of M^-1 sum(A^T A): the square of the highest frequency of the free body on springs of
/// these stiffnesses [1] at these points, in these directions.
double stiffestMode(const BodyDefinition& body, const ContactPoints& points, const Directions& directions)
{
    Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> inverseRoot, row;
    inverseRoot.head<3>().setConstant(1 / std::sqrt(body.mass));
    inverseRoot.tail<3>() = body.principalInertia.cwiseSqrt().cwiseInverse();
    for (const ContactPoint& point : points)
        for (const Vec3& direction : directions)
        {
            row << direction, point.place.cross(direction);
            row.array() *= inverseRoot.array();
            stiffness += point.weight * row * row.transpose();
        }
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(stiffness, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
}

/// Of those of the spheres that touch the plane of normal +-axis, in the body frame.
ContactPoints facePoints(const BodyDefinition& body, const std::vector<SurfaceSphere>& spheres, double weight, int axis, double sign)
{
    const double extent = outerRadius(body);
    double top = -1e300;
    for (const SurfaceSphere& s : body.spheres)
        top = std::max(top, sign * s.centre[axis] + s.radius);
    ContactPoints points;
    for (const SurfaceSphere& s : spheres)
        if (sign * s.centre[axis] + s.radius > top - 1e-6 * std::max(1.0, extent))
            points.push_back({s.centre + Vec3::Unit(axis) * (sign * s.radius), weight});
    return points;
}

/// A planar body never lands on a face of the plane it moves in.
bool canLandOn(const BodyDefinition& body, int axis)
{
    return !body.isPlanar || std::abs((body.pose.orientation * Vec3::Unit(axis))[body.planeAxis]) < 0.5;
}

/// Largest number of spheres that touch one plane at once, over the six principal directions.
int largestFace(const BodyDefinition& body, const std::vector<SurfaceSphere>& spheres)
{
    size_t count = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
            if (canLandOn(body, axis))
                count = std::max(count, facePoints(body, spheres, 1, axis, sign).size());
    return static_cast<int>(count);
}

/// Per stiffness and dashpot of a sphere that is no corner; corners have these weights, 0 where the other one is no wall.
ContactModes stiffestModes(const BodyDefinition& body, double cornerSpring, double cornerDashpot)
{
    const Directions all = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    ContactModes modes;
    const auto take = [&](double& mode, const ContactPoints& points, const Directions& directions)
    { mode = std::max(mode, stiffestMode(body, points, directions)); };
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
        {
            if (!canLandOn(body, axis))
                continue;
            const ContactPoints spheres = facePoints(body, body.spheres, 1, axis, sign);
            const auto together = [&](double cornerWeight)
            {
                ContactPoints points = facePoints(body, body.corners, cornerWeight, axis, sign);
                points.insert(points.begin(), spheres.begin(), spheres.end());
                return points;
            };
            take(modes.face, together(cornerSpring), all);
            take(modes.faceNormal, together(cornerSpring), {Vec3::Unit(axis)});
            take(modes.faceDashpots, together(cornerDashpot), {Vec3::Unit(axis)});
            for (const ContactPoint& point : spheres)
                take(modes.sphere, {point}, all);
            for (const ContactPoint& point : facePoints(body, body.corners, cornerSpring, axis, sign))
                take(modes.corner, {point}, all);
        }
    return modes;
}

} // namespace

ModesOfBody::ModesOfBody(const BodyDefinition& body) : other_(stiffestModes(body, 0, 0))
{
    const double spring = cornerStiffening(body);
    wall_ = body.corners.empty() ? other_ : stiffestModes(body, spring, std::sqrt(spring));
    flatWall_ = body.corners.empty() ? other_ : stiffestModes(body, spring, spring);
}

int flattestFaceCount(const BodyDefinition& body) { return std::max(1, largestFace(body, body.spheres)); }

int cornersOfFace(const BodyDefinition& body) { return largestFace(body, body.corners); }

double cornerStiffening(const BodyDefinition& body)
{
    return body.corners.empty() ? 1 : body.spheres.front().radius / body.corners.front().radius;
}

} // namespace flotsam
