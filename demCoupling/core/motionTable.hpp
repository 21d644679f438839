// SPDX-License-Identifier: GPL-3.0-or-later
/// Displacements given at some times, and what lies between them.
#pragma once

#include "geometry/planeFaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace flotsam
{

/// Piecewise cubic: meets every point, does not go beyond its neighbours (each component by itself), with a continuous velocity; at rest before the first point and
/// after the last. Slopes: Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300, DOI 10.1137/0905021.
class MotionTable
{
public:
    struct Point { double time; Vec3 displacement; };   // [s], [m]

    /// Two points at least, of rising times.
    explicit MotionTable(std::vector<Point> points) : points_(std::move(points)), slopes_(points_.size(), Vec3::Zero())
    {
        for (std::size_t i = 1; i + 1 < points_.size(); ++i)
            for (int d = 0; d < 3; ++d) slopes_[i][d] = slope(i, d);
    }

    /// Displacement [m] and velocity [m/s].
    std::pair<Vec3, Vec3> at(double time) const
    {
        if (time <= points_.front().time) return {points_.front().displacement, Vec3::Zero()};
        if (time >= points_.back().time) return {points_.back().displacement, Vec3::Zero()};
        const auto next = std::upper_bound(points_.begin(), points_.end(), time, [](double t, const Point& p) { return t < p.time; });
        const std::size_t i = std::size_t(next - points_.begin()) - 1;
        const double h = length(i), x = (time - points_[i].time)/h;
        const Vec3 step = points_[i + 1].displacement - points_[i].displacement, &a = slopes_[i], &b = slopes_[i + 1];
        // Hermite's cubic
        const Vec3 displacement = points_[i].displacement + x*x*(3 - 2*x)*step + h*x*(1 - x)*((1 - x)*a - x*b);
        const Vec3 velocity = 6*x*(1 - x)*step/h + (1 - x)*(1 - 3*x)*a + x*(3*x - 2)*b;
        return {displacement, velocity};
    }

private:
    double length(std::size_t i) const { return points_[i + 1].time - points_[i].time; }
    double chord(std::size_t i, int d) const { return (points_[i + 1].displacement[d] - points_[i].displacement[d])/length(i); }
    /// Weighted harmonic mean of the chords beside a point, 0 where they do not go the same way.
    double slope(std::size_t i, int d) const
    {
        const double before = chord(i - 1, d), after = chord(i, d);
        if (before*after <= 0) return 0;
        const double share = (length(i - 1) + 2*length(i))/(3*(length(i - 1) + length(i)));
        return before*after/(share*after + (1 - share)*before);
    }

    std::vector<Point> points_;
    std::vector<Vec3> slopes_;
};

} // namespace flotsam
