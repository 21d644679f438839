// SPDX-License-Identifier: GPL-3.0-or-later
/// Shapes made of shapes: placed and union.
#include "geometry/primitives.hpp"
#include "geometry/triSurface.hpp"
#include "geometry/unionOverlap.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flotsam
{
namespace
{

/// Rotations that are of both; size: of the shapes [m].
Symmetry commonSymmetry(const Symmetry& a, const Symmetry& b, double size)
{
    using Kind = Symmetry::Kind;
    const double same = 1e-9;
    if (a.kind == Kind::None || b.kind == Kind::None) return {};
    if (a.kind == Kind::Point && b.kind == Kind::Axis) return commonSymmetry(b, a, size);
    const Vec3 between = b.point - a.point;
    if (a.kind == Kind::Point) // points both
        return between.norm() <= same * size ? a : Symmetry{Kind::Axis, a.point, between.normalized()};
    const bool isOnAxis = between.cross(a.axis).norm() <= same * size;
    return isOnAxis && (b.kind == Kind::Point || b.axis.cross(a.axis).norm() <= same) ? a : Symmetry{};
}

} // namespace

UnionShape::UnionShape(std::vector<std::shared_ptr<const Shape>> parts) : parts_(std::move(parts))
{
    for (const auto& part : parts_)
        for (int k = 0; k < part->nParts(); ++k) cutParts_.emplace_back(part, &part->part(k));
}

double UnionShape::distance(const Vec3& x) const
{
    double d = parts_[0]->distance(x);
    for (std::size_t i = 1; i < parts_.size(); ++i) d = std::min(d, parts_[i]->distance(x));
    return d;
}

std::array<Vec3, 2> UnionShape::bounds() const
{
    std::array<Vec3, 2> all = parts_[0]->bounds();
    for (const auto& part : parts_)
    {
        const auto [lower, upper] = part->bounds();
        all[0] = all[0].cwiseMin(lower);
        all[1] = all[1].cwiseMax(upper);
    }
    return all;
}

VolumeMoments UnionShape::moments() const
{
    std::call_once(isIntegrated_, [&]
    {
        RawMoments sum;
        sum.origin = parts_[0]->moments().centroid;
        for (const auto& part : parts_) sum.add(part->moments());
        const RawMoments excess = overlapMoments(parts_, sum.origin, sum.volume);
        sum.volume -= excess.volume;
        sum.first -= excess.first;
        sum.second -= excess.second;
        moments_ = sum.aboutCentroid();
    });
    return moments_;
}

double UnionShape::sectionArea(const Vec3& point, const Vec3& normal) const
{
    double sum = 0;
    for (const auto& part : parts_) sum += part->sectionArea(point, normal);
    return sum > 0 ? sum - overlapArea(parts_, point, normal, sum) : 0;
}

Symmetry UnionShape::symmetry() const
{
    const auto [lower, upper] = bounds();
    Symmetry all = parts_[0]->symmetry();
    for (std::size_t i = 1; i < parts_.size(); ++i) all = commonSymmetry(all, parts_[i]->symmetry(), (upper - lower).norm());
    return all;
}

TriSurface UnionShape::surface(double size) const
{
    TriSurface all;
    for (const auto& part : parts_)
    {
        const TriSurface s = part->surface(size);
        const int start = static_cast<int>(all.points.size());
        all.points.insert(all.points.end(), s.points.begin(), s.points.end());
        for (const auto& t : s.triangles) all.triangles.push_back({t[0] + start, t[1] + start, t[2] + start});
    }
    return all;
}

PlacedShape::PlacedShape(std::shared_ptr<const Shape> shape, const Eigen::Quaterniond& rotation, const Vec3& translation)
    : shape_(std::move(shape)), rotation_(rotation.normalized().toRotationMatrix()), translation_(translation)
{
    for (int k = 0; k < shape_->nParts() && shape_->nParts() > 1; ++k) parts_.push_back(makePlaced({shape_, &shape_->part(k)}, rotation, translation));
}

Symmetry PlacedShape::symmetry() const
{
    const Symmetry inner = shape_->symmetry();
    return {inner.kind, toOuter(inner.point), rotation_*inner.axis};
}

std::array<Vec3, 2> PlacedShape::bounds() const
{
    const auto b = shape_->bounds();
    const Vec3 centre = toOuter(0.5 * (b[0] + b[1])), half = rotation_.cwiseAbs() * (0.5 * (b[1] - b[0]));
    return {Vec3(centre - half), Vec3(centre + half)};
}

VolumeMoments PlacedShape::moments() const
{
    VolumeMoments m = shape_->moments();
    m.centroid = toOuter(m.centroid);
    m.inertia = rotation_ * m.inertia * rotation_.transpose();
    return m;
}

double PlacedShape::sectionArea(const Vec3& point, const Vec3& normal) const
{
    return shape_->sectionArea(toInner(point), rotation_.transpose() * normal);
}

TriSurface PlacedShape::surface(double size) const
{
    TriSurface s = shape_->surface(size);
    for (Vec3& p : s.points) p = toOuter(p);
    return s;
}

std::shared_ptr<const Shape> makeUnion(std::vector<std::shared_ptr<const Shape>> parts)
{
    if (parts.empty()) throw std::runtime_error("a union needs at least one shape, found none");
    std::vector<std::shared_ptr<const Shape>> all; // parts of parts are parts: what they share is found as well
    for (auto& part : parts)
    {
        const auto* inner = dynamic_cast<const UnionShape*>(part.get());
        if (inner) all.insert(all.end(), inner->parts().begin(), inner->parts().end());
        else all.push_back(std::move(part));
    }
    if (all.size() == 1) return all[0]; // with its faces, also where it is placed
    return std::make_shared<UnionShape>(std::move(all));
}

std::shared_ptr<const Shape> makePlaced(std::shared_ptr<const Shape> shape, const Eigen::Quaterniond& rotation, const Vec3& translation)
{
    return std::make_shared<PlacedShape>(std::move(shape), rotation, translation);
}

} // namespace flotsam
