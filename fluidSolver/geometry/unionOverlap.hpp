// SPDX-License-Identifier: GPL-3.0-or-later
/// What shapes have in common; private to geometry.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// int 1, r, r r^T with r = x - origin: these add up, moments about centroids do not.
struct RawMoments
{
    Vec3 origin = Vec3::Zero();     // near the shape: no cancellation far from the frame's origin
    double volume = 0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    void add(const VolumeMoments& m)
    {
        const Vec3 r = m.centroid - origin;
        volume += m.volume;
        first += m.volume * r;
        second += m.volume * r * r.transpose() + 0.5 * m.inertia.trace() * Eigen::Matrix3d::Identity() - m.inertia;
    }

    VolumeMoments aboutCentroid() const
    {
        const Vec3 r = first / volume;
        const Eigen::Matrix3d s = second - volume * r * r.transpose();
        return {volume, origin + r, s.trace() * Eigen::Matrix3d::Identity() - s};
    }
};

using Shapes = std::vector<std::shared_ptr<const Shape>>;

/// What a sum over the shapes counts more than once: the integrals of n - 1 over all points that lie in n > 1 of them. `volume`: of all shapes [m^3].
/// Exact for boxes, nothing but round-off where shapes touch in plane faces; else to 1e-5 of the volume.
RawMoments overlapMoments(const Shapes& shapes, const Vec3& origin, double volume);

/// Likewise of the shapes' sections with the plane through `point` with unit normal `normal`, all of them together of `area` [m^2].
double overlapArea(const Shapes& shapes, const Vec3& point, const Vec3& normal, double area);

} // namespace flotsam
