// SPDX-License-Identifier: GPL-3.0-or-later
/// Rigid bodies and contact materials as plain data: what the dictionary gives, what the DEM engine needs.
#pragma once

#include "geometry/solid.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace flotsam
{

/// Contact law of one pair of materials (paper eqs 11-14: linear spring, dashpot, Coulomb slider).
struct ContactLaw
{
    double stiffness = 1e6;         ///< K_n = K_s [N/m], see perBody
    double restitution = 0.2;       ///< normal, see flatRestitution
    double frictionAngleDeg = 30;   ///< Coulomb friction tan(angle)
    /// true: the stiffness is that of the BODY landing flat, each sphere of its flattest face carries an equal share.
    /// false: that of each touching sphere (paper), so that n touching spheres are n times as stiff.
    bool perBody = true;
    /// perBody only. false: the restitution holds where one sphere touches (corners, crossing bars); flat landings
    /// rebound less. true: it holds for a flat landing; single-sphere contacts rebound more.
    bool flatRestitution = false;
};

/// A free rigid body. Body frame: centre of mass at the origin, principal axes of inertia.
struct BodyDefinition
{
    std::string name;
    std::shared_ptr<const Shape> shape;     ///< in the body frame
    double mass = 0;                        ///< [kg], exact
    double volume = 0;                      ///< exact volume of the shape [m^3]
    Vec3 principalInertia = Vec3::Zero();   ///< [kg m^2], exact
    std::vector<SurfaceSphere> spheres;     ///< DEM surface, body frame
    std::vector<SurfaceSphere> corners;     ///< smaller ones that touch walls alone, no other body
    int material = 0;                       ///< index of the contact material
    Pose pose;                              ///< at the start
    Motion motion;
    double releaseTime = 0;                 ///< held in place until then [s]
    bool entersAtRelease = false;           ///< not there until then, instead of held
    bool isPlanar = false;                  ///< 2D scene: moves in the mesh plane only, see planeAxis
    int planeAxis = 2;                      ///< normal of that plane
    double thinnest = 0;                    ///< smallest extent [m] (2D: in the plane), of a union that of its thinnest part
    double finest = 0;                      ///< radius of the smallest spheres of other bodies that its own are near enough to each other for [m]
};

/// Of the sphere about a body's centre of mass that holds all of its contact spheres [m].
inline double outerRadius(const BodyDefinition& body)
{
    double radius = 0;
    for (const auto* spheres : {&body.spheres, &body.corners})
        for (const SurfaceSphere& s : *spheres) radius = std::max(radius, s.centre.norm() + s.radius);
    return radius;
}

/// With the corners behind the others.
inline std::vector<SurfaceSphere> spheresAtWalls(const BodyDefinition& body)
{
    std::vector<SurfaceSphere> all = body.spheres;
    all.insert(all.end(), body.corners.begin(), body.corners.end());
    return all;
}

/// Speed of the fastest corner of a box around a body, whose lower and upper corners are given in its own frame [m/s]: no point of the body is faster. A log that
/// rolls about its length has slow ends, and in 2D its extent across does not count, which the distance of the farthest point times the angular velocity does not know.
inline double fastestCorner(const std::array<Vec3, 2>& box, const Pose& pose, const Motion& motion)
{
    const Vec3 velocity = pose.orientation.conjugate()*motion.velocity, turning = pose.orientation.conjugate()*motion.angularVelocity;
    double fastest = 0;
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec3 x(box[corner & 1][0], box[corner >> 1 & 1][1], box[corner >> 2][2]);
        const double speed = (velocity + turning.cross(x)).norm();
        if (!(speed <= fastest)) fastest = speed;   // also one that is no number
    }
    return fastest;
}

/// A structure that moves as prescribed, which bodies can touch.
struct MoverDefinition
{
    std::string name;
    std::vector<SurfaceSphere> spheres;     ///< DEM surface, in the frame of the pose
    int material = 0;
    std::function<void(double time, Pose&, Motion&)> motion;    ///< time in s
    double finest = 0;                      ///< as a body's
};

/// A fixed structure the bodies can touch.
struct WallDefinition
{
    enum class Kind { Plane, Surface };
    std::string name;
    std::string patch;                      ///< of the mesh; empty: a structure
    Kind kind = Kind::Plane;
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ(); ///< plane; normal points to the side of the bodies
    TriSurface surface;                     ///< Surface: in space
    int material = 0;
    bool isMirror = false;                  ///< a body meets its image, which slides along with it: no friction
};

/// Dynamic state of one body.
struct BodyState
{
    Pose pose;
    Motion motion;
    Vec3 angularMomentum = Vec3::Zero();    ///< space frame, about the centre of mass [kg m^2/s]
};

/// Force [N] and moment about the centre of mass [N m], space frame.
struct Load
{
    Vec3 force = Vec3::Zero();
    Vec3 moment = Vec3::Zero();

    bool isZero() const { return force.isZero(0) && moment.isZero(0); }
};

inline Load operator-(const Load& a, const Load& b) { return {a.force - b.force, a.moment - b.moment}; }

using Vector6 = Eigen::Matrix<double, 6, 1>;   ///< force and moment
/// What a body keeps of a load once the fluid has answered it: rows and columns force and moment.
using LoadShare = Eigen::Matrix<double, 6, 6>;

struct BodyShare
{
    int body;
    LoadShare share;
};

/// One touching pair at the end of an advance().
struct Contact
{
    int body;       ///< index of the body
    int other;      ///< index of the other body, or -1 - wall
    Vec3 point;     ///< [m]
    Vec3 force;     ///< on `body` [N], last sub-step
    double overlap; ///< of the two DEM surfaces [m], > 0
};

} // namespace flotsam
