// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/primitives.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace flotsam
{
namespace
{

Eigen::Matrix3d axialInertia(const Vec3& axis, double along, double across)
{
    return across * Eigen::Matrix3d::Identity() + (along - across) * axis * axis.transpose();
}

void requirePositive(double value, const char* what)
{
    if (!(value > 0)) throw std::runtime_error(std::string(what) + " must be positive, found " + std::to_string(value));
}

void requireSize(double size) { requirePositive(size, "facet size of a surface"); }

/// Facets: rings and profile pieces so short that the diagonals are no longer than `size`.
int ringPoints(double radius, double size) { return std::max(8, static_cast<int>(std::ceil(2 * M_PI * radius * std::sqrt(2.0) / size))); }
int pieces(double length, double size) { return std::max(1, static_cast<int>(std::ceil(length * std::sqrt(2.0) / size))); }

/// Half circles of a capsule (a sphere: halfLength 0) with the straight part between.
std::vector<ProfilePoint> capsuleProfile(double halfLength, double radius, double size)
{
    const int n = std::max(2, pieces(0.5 * M_PI * radius, size)), m = pieces(2 * halfLength, size);
    std::vector<ProfilePoint> profile{{-halfLength - radius, 0}};
    for (int i = 1; i <= n; ++i)
    {
        const double angle = 0.5 * M_PI * i / n;
        profile.push_back({-halfLength - radius * std::cos(angle), radius * std::sin(angle)});
    }
    for (int i = 1; halfLength > 0 && i <= m; ++i) profile.push_back({halfLength * (2.0 * i / m - 1), radius});
    for (int i = n - 1; i > 0; --i)
    {
        const double angle = 0.5 * M_PI * i / n;
        profile.push_back({halfLength + radius * std::cos(angle), radius * std::sin(angle)});
    }
    profile.push_back({halfLength + radius, 0});
    return profile;
}

} // namespace

// box

double BoxShape::distance(const Vec3& x) const
{
    const Vec3 q = (x - centre_).cwiseAbs() - half_;
    const double inside = std::min(q.maxCoeff(), 0.0);
    return inside < 0 ? inside : q.cwiseMax(0.0).norm();
}

int BoxShape::faceDistances(const Vec3& x, double* distances) const
{
    for (int d = 0; d < 3; ++d)
    {
        distances[2 * d] = x[d] - centre_[d] - half_[d];
        distances[2 * d + 1] = centre_[d] - x[d] - half_[d];
    }
    return 6;
}

VolumeMoments BoxShape::moments() const
{
    VolumeMoments m;
    m.volume = 8 * half_.prod();
    m.centroid = centre_;
    const Vec3 s = half_.cwiseAbs2() * (m.volume / 3);
    m.inertia = Vec3(s.sum() - s.array()).asDiagonal();
    return m;
}

TriSurface BoxShape::surface(double) const
{
    return boxSurface(centre_ - half_, centre_ + half_);
}

// sphere

std::array<Vec3, 2> SphereShape::bounds() const
{
    return {Vec3(centre_.array() - radius_), Vec3(centre_.array() + radius_)};
}

VolumeMoments SphereShape::moments() const
{
    const double volume = 4.0 / 3 * M_PI * radius_ * radius_ * radius_;
    return {volume, centre_, 0.4 * volume * radius_ * radius_ * Eigen::Matrix3d::Identity()};
}

TriSurface SphereShape::surface(double size) const
{
    requireSize(size);
    return surfaceOfRevolution(centre_, Vec3::UnitZ(), capsuleProfile(0, radius_, size), ringPoints(radius_, size));
}

// cylinder

CylinderShape::CylinderShape(const Vec3& end1, const Vec3& end2, double radius)
    : centre_(0.5 * (end1 + end2)), axis_((end2 - end1).normalized()), halfLength_(0.5 * (end2 - end1).norm()), radius_(radius)
{
}

double CylinderShape::distance(const Vec3& x) const
{
    const Vec3 r = x - centre_;
    const double along = axis_.dot(r);
    const double qa = std::abs(along) - halfLength_, qr = (r - along * axis_).norm() - radius_;
    const double inside = std::max(qa, qr);
    return inside < 0 ? inside : std::hypot(std::max(qa, 0.0), std::max(qr, 0.0));
}

int CylinderShape::faceDistances(const Vec3& x, double* distances) const
{
    const Vec3 r = x - centre_;
    const double along = axis_.dot(r);
    distances[0] = (r - along * axis_).norm() - radius_;
    distances[1] = along - halfLength_;
    distances[2] = -along - halfLength_;
    return 3;
}

std::array<Vec3, 2> CylinderShape::bounds() const
{
    const Vec3 extent = halfLength_ * axis_.cwiseAbs() + radius_ * (1 - axis_.array().square()).max(0.0).sqrt().matrix();
    return {Vec3(centre_ - extent), Vec3(centre_ + extent)};
}

VolumeMoments CylinderShape::moments() const
{
    const double r2 = radius_ * radius_, volume = 2 * halfLength_ * M_PI * r2;
    return {volume, centre_, axialInertia(axis_, 0.5 * volume * r2, volume * (r2 / 4 + halfLength_ * halfLength_ / 3))};
}

TriSurface CylinderShape::surface(double size) const
{
    requireSize(size);
    // flat caps and straight sides need no facets of their own: the DEM pays for every triangle of a structure in every sub-step
    const std::vector<ProfilePoint> profile{{-halfLength_, 0}, {-halfLength_, radius_}, {halfLength_, radius_}, {halfLength_, 0}};
    return surfaceOfRevolution(centre_, axis_, profile, ringPoints(radius_, size));
}

// capsule

CapsuleShape::CapsuleShape(const Vec3& end1, const Vec3& end2, double radius)
    : centre_(0.5 * (end1 + end2)), axis_((end2 - end1).normalized()), halfLength_(0.5 * (end2 - end1).norm()), radius_(radius)
{
}

double CapsuleShape::distance(const Vec3& x) const
{
    const Vec3 r = x - centre_;
    const double along = std::clamp(axis_.dot(r), -halfLength_, halfLength_);
    return (r - along * axis_).norm() - radius_;
}

std::array<Vec3, 2> CapsuleShape::bounds() const
{
    const Vec3 extent = (halfLength_ * axis_.cwiseAbs()).array() + radius_;
    return {Vec3(centre_ - extent), Vec3(centre_ + extent)};
}

VolumeMoments CapsuleShape::moments() const
{
    // a cylinder and two half spheres, whose centroids are 3/8 R off their flat sides
    const double r = radius_, l = halfLength_;
    const double rod = 2 * l * M_PI * r * r, ball = 4.0 / 3 * M_PI * r * r * r;
    const double along = 0.5 * rod * r * r + 0.4 * ball * r * r;
    const double across = rod * (r * r / 4 + l * l / 3) + ball * (0.4 * r * r + l * l + 0.75 * l * r);
    return {rod + ball, centre_, axialInertia(axis_, along, across)};
}

TriSurface CapsuleShape::surface(double size) const
{
    requireSize(size);
    return surfaceOfRevolution(centre_, axis_, capsuleProfile(halfLength_, radius_, size), ringPoints(radius_, size));
}

// factories

std::shared_ptr<const Shape> makeBox(const Vec3& centre, const Vec3& size)
{
    requirePositive(size.minCoeff(), "size of a box");
    return std::make_shared<BoxShape>(centre, 0.5 * size);
}

std::shared_ptr<const Shape> makeSphere(const Vec3& centre, double radius)
{
    requirePositive(radius, "radius of a sphere");
    return std::make_shared<SphereShape>(centre, radius);
}

std::shared_ptr<const Shape> makeCylinder(const Vec3& end1, const Vec3& end2, double radius)
{
    requirePositive(radius, "radius of a cylinder");
    requirePositive((end2 - end1).norm(), "length of a cylinder");
    return std::make_shared<CylinderShape>(end1, end2, radius);
}

std::shared_ptr<const Shape> makeCapsule(const Vec3& end1, const Vec3& end2, double radius)
{
    requirePositive(radius, "radius of a capsule");
    requirePositive((end2 - end1).norm(), "distance of a capsule's end points (use a sphere for none)");
    return std::make_shared<CapsuleShape>(end1, end2, radius);
}

} // namespace flotsam
