// SPDX-License-Identifier: GPL-3.0-or-later
/// The shapes behind shape.hpp's factory functions; private to geometry (surfaceSpheres needs their parameters).
#pragma once

#include "geometry/shape.hpp"

#include <functional>
#include <mutex>

namespace flotsam
{

class BoxShape : public Shape
{
public:
    BoxShape(const Vec3& centre, const Vec3& half) : centre_(centre), half_(half) {}
    double distance(const Vec3& x) const override;
    int faceDistances(const Vec3& x, double* distances) const override;
    bool hasPlaneFaces() const override { return true; }
    std::array<Vec3, 2> bounds() const override { return {Vec3(centre_ - half_), Vec3(centre_ + half_)}; }
    VolumeMoments moments() const override;
    TriSurface surface(double size) const override;
    const Vec3& centre() const { return centre_; }
    const Vec3& half() const { return half_; }

private:
    Vec3 centre_, half_;
};

class SphereShape : public Shape
{
public:
    SphereShape(const Vec3& centre, double radius) : centre_(centre), radius_(radius) {}
    double distance(const Vec3& x) const override { return (x - centre_).norm() - radius_; }
    Symmetry symmetry() const override { return {Symmetry::Kind::Point, centre_, Vec3::Zero()}; }
    std::array<Vec3, 2> bounds() const override;
    VolumeMoments moments() const override;
    TriSurface surface(double size) const override;
    const Vec3& centre() const { return centre_; }
    double radius() const { return radius_; }

private:
    Vec3 centre_;
    double radius_;
};

/// Straight cylinder with flat ends.
class CylinderShape : public Shape
{
public:
    CylinderShape(const Vec3& end1, const Vec3& end2, double radius);
    double distance(const Vec3& x) const override;
    int faceDistances(const Vec3& x, double* distances) const override;
    Symmetry symmetry() const override { return {Symmetry::Kind::Axis, centre_, axis_}; }
    std::array<Vec3, 2> bounds() const override;
    VolumeMoments moments() const override;
    TriSurface surface(double size) const override;
    const Vec3& centre() const { return centre_; }
    const Vec3& axis() const { return axis_; }
    double halfLength() const { return halfLength_; }
    double radius() const { return radius_; }

private:
    Vec3 centre_, axis_;
    double halfLength_, radius_;
};

/// All points closer than the radius to the segment end1-end2.
class CapsuleShape : public Shape
{
public:
    CapsuleShape(const Vec3& end1, const Vec3& end2, double radius);
    double distance(const Vec3& x) const override;
    Symmetry symmetry() const override { return {Symmetry::Kind::Axis, centre_, axis_}; }
    std::array<Vec3, 2> bounds() const override;
    VolumeMoments moments() const override;
    TriSurface surface(double size) const override;
    const Vec3& centre() const { return centre_; }
    const Vec3& axis() const { return axis_; }
    double halfLength() const { return halfLength_; }
    double radius() const { return radius_; }

private:
    Vec3 centre_, axis_;
    double halfLength_, radius_;
};

class PlacedShape : public Shape
{
public:
    PlacedShape(std::shared_ptr<const Shape> shape, const Eigen::Quaterniond& rotation, const Vec3& translation);
    double distance(const Vec3& x) const override { return shape_->distance(toInner(x)); }
    int faceDistances(const Vec3& x, double* distances) const override { return shape_->faceDistances(toInner(x), distances); }
    bool hasPlaneFaces() const override { return shape_->hasPlaneFaces(); }
    int nParts() const override { return shape_->nParts(); }
    const Shape& part(int number) const override { return parts_.empty() ? *this : *parts_[number]; }
    Symmetry symmetry() const override;
    std::array<Vec3, 2> bounds() const override;
    VolumeMoments moments() const override;
    double sectionArea(const Vec3& point, const Vec3& normal) const override;
    TriSurface surface(double size) const override;
    const Shape& inner() const { return *shape_; }
    Vec3 toInner(const Vec3& x) const { return rotation_.transpose() * (x - translation_); }
    Vec3 toOuter(const Vec3& x) const { return rotation_ * x + translation_; }

private:
    std::shared_ptr<const Shape> shape_;
    Eigen::Matrix3d rotation_;
    Vec3 translation_;
    std::vector<std::shared_ptr<const Shape>> parts_;   // placed ones, of a union
};

class UnionShape : public Shape
{
public:
    explicit UnionShape(std::vector<std::shared_ptr<const Shape>> parts);
    double distance(const Vec3& x) const override;
    int nParts() const override { return static_cast<int>(cutParts_.size()); }
    const Shape& part(int number) const override { return *cutParts_[number]; }
    std::array<Vec3, 2> bounds() const override;
    /// Found at the first call.
    VolumeMoments moments() const override;
    double sectionArea(const Vec3& point, const Vec3& normal) const override;
    Symmetry symmetry() const override;
    /// The parts' surfaces one after the other; pieces inside another part are kept.
    TriSurface surface(double size) const override;
    const std::vector<std::shared_ptr<const Shape>>& parts() const { return parts_; }

private:
    std::vector<std::shared_ptr<const Shape>> parts_, cutParts_;    // cutParts_: Shape::part() of the parts
    mutable std::once_flag isIntegrated_;
    mutable VolumeMoments moments_;
};

constexpr double sameSphere = 1e-6;  ///< over a radius: spheres of that radius nearer to each other are one

bool hasSphereAt(const std::vector<SurfaceSphere>& spheres, const Vec3& x, double radius);

/// The parts' spheres, each once, without those that do not reach the common surface.
std::vector<SurfaceSphere> unionSpheres(const UnionShape& shape, const std::function<std::vector<SurfaceSphere>(const Shape&)>& ofPart);

} // namespace flotsam
