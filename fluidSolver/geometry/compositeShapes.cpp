// SPDX-License-Identifier: GPL-3.0-or-later
/// Shapes made of shapes: placed and union.
#include "geometry/primitives.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flotsam
{
namespace
{

/// int 1, x, x x^T: these add up, moments about centroids do not.
struct RawMoments
{
    double volume = 0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    void add(double weight, const Vec3& x)
    {
        volume += weight;
        first += weight * x;
        second += weight * x * x.transpose();
    }

    void add(const VolumeMoments& m)
    {
        add(m.volume, m.centroid);
        second += 0.5 * m.inertia.trace() * Eigen::Matrix3d::Identity() - m.inertia;
    }

    VolumeMoments aboutCentroid() const
    {
        const Vec3 c = first / volume;
        const Eigen::Matrix3d s = second - volume * c * c.transpose();
        return {volume, c, s.trace() * Eigen::Matrix3d::Identity() - s};
    }
};

struct Bounds
{
    Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);

    bool isEmpty() const { return (upper - lower).minCoeff() <= 0; }
    void include(const Bounds& b)
    {
        lower = lower.cwiseMin(b.lower);
        upper = upper.cwiseMax(b.upper);
    }
};

Bounds commonBounds(const Shape& a, const Shape& b)
{
    const auto x = a.bounds(), y = b.bounds();
    return {x[0].cwiseMax(y[0]), x[1].cwiseMin(y[1])};
}

/// Whether a point of a's surface lies inside b (sampled, 1/40 of the smaller shape).
bool reachesInto(const Shape& a, const Shape& b)
{
    const auto x = a.bounds(), y = b.bounds();
    const double size = std::min((x[1] - x[0]).minCoeff(), (y[1] - y[0]).minCoeff());
    for (const SurfacePoint& p : samplePoints(a.surface(size / 20), size / 40))
        if (b.distance(p.x) < -1e-6 * size) return true;
    return false;
}

bool overlap(const Shape& a, const Shape& b)
{
    return !commonBounds(a, b).isEmpty() && (reachesInto(a, b) || reachesInto(b, a));
}

/// What the parts' own moments count more than once, by cells of 1/120 of the overlap with a smoothed indicator.
RawMoments sampledExcess(const std::vector<std::shared_ptr<const Shape>>& parts, const Bounds& box)
{
    const double cell = (box.upper - box.lower).maxCoeff() / 120;
    int n[3];
    for (int d = 0; d < 3; ++d) n[d] = std::max(8, static_cast<int>(std::ceil((box.upper[d] - box.lower[d]) / cell)));
    const Vec3 size = (box.upper - box.lower).cwiseQuotient(Vec3(n[0], n[1], n[2]));
    const double width = size.maxCoeff(), volume = size.prod();
    RawMoments excess;
    for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i)
            {
                const Vec3 x = box.lower + size.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
                double sum = 0, largest = 0;
                for (const auto& part : parts)
                {
                    const double share = std::clamp(0.5 - part->distance(x) / width, 0.0, 1.0);
                    sum += share;
                    largest = std::max(largest, share);
                }
                if (sum > largest) excess.add((sum - largest) * volume, x);
            }
    return excess;
}

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

double UnionShape::distance(const Vec3& x) const
{
    double d = parts_[0]->distance(x);
    for (std::size_t i = 1; i < parts_.size(); ++i) d = std::min(d, parts_[i]->distance(x));
    return d;
}

std::array<Vec3, 2> UnionShape::bounds() const
{
    Bounds all;
    for (const auto& part : parts_)
    {
        const auto b = part->bounds();
        all.include({b[0], b[1]});
    }
    return {all.lower, all.upper};
}

VolumeMoments UnionShape::moments() const
{
    RawMoments sum;
    for (const auto& part : parts_) sum.add(part->moments());
    Bounds common;
    for (std::size_t i = 0; i < parts_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (overlap(*parts_[i], *parts_[j])) common.include(commonBounds(*parts_[i], *parts_[j]));
    if (!common.isEmpty())
    {
        const RawMoments excess = sampledExcess(parts_, common);
        sum.volume -= excess.volume;
        sum.first -= excess.first;
        sum.second -= excess.second;
    }
    return sum.aboutCentroid();
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

TriSurface PlacedShape::surface(double size) const
{
    TriSurface s = shape_->surface(size);
    for (Vec3& p : s.points) p = toOuter(p);
    return s;
}

std::shared_ptr<const Shape> makeUnion(std::vector<std::shared_ptr<const Shape>> parts)
{
    if (parts.empty()) throw std::runtime_error("a union needs at least one shape, found none");
    return std::make_shared<UnionShape>(std::move(parts));
}

std::shared_ptr<const Shape> makePlaced(std::shared_ptr<const Shape> shape, const Eigen::Quaterniond& rotation, const Vec3& translation)
{
    return std::make_shared<PlacedShape>(std::move(shape), rotation, translation);
}

} // namespace flotsam
