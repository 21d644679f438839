// SPDX-License-Identifier: GPL-3.0-or-later
/// Closed surfaces with long narrow triangles: prisms as CAD programs triangulate them, and what random collapses leave.
#pragma once

#include "geometry/shape.hpp"

#include <cmath>
#include <random>

namespace flotsam
{

/// Sides of two triangles, fans of the first corner as ends; the outline runs counter-clockwise, seen from where `along` goes to.
inline TriSurface prism(const std::vector<Vec3>& outline, const Vec3& along)
{
    TriSurface s;
    const int n = int(outline.size());
    for (const Vec3& x : outline) s.points.push_back(x);
    for (const Vec3& x : outline) s.points.push_back(x + along);
    for (int i = 0; i < n; ++i)
    {
        const int j = (i + 1) % n;
        s.triangles.push_back({i, j, n + j});
        s.triangles.push_back({i, n + j, n + i});
        if (i > 0 && j > i) { s.triangles.push_back({0, j, i}); s.triangles.push_back({n, n + i, n + j}); }
    }
    return s;
}

inline std::vector<Vec3> circle(int n, double radius)
{
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.emplace_back(radius*std::cos(2*M_PI*i/n), radius*std::sin(2*M_PI*i/n), 0);
    return points;
}

struct Random
{
    std::mt19937 generator;
    explicit Random(unsigned seed) : generator(seed) {}
    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(generator); }
    double logBetween(double a, double b) { return std::exp(between(std::log(a), std::log(b))); }
    Eigen::Quaterniond turn() { return Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(0.1, 1)).normalized(); }
};

/// Corners moved to others of their triangles, or to their edges, nearly all of the way.
inline TriSurface collapsed(TriSurface s, Random& random)
{
    for (int k = 0; k < 6; ++k)
    {
        const auto t = s.triangles[std::size_t(random.between(0, double(s.triangles.size())))];
        const double rest = random.logBetween(1e-5, 1e-2), share = k % 2 ? 1 : random.between(0.2, 0.8);
        const Vec3 aim = share*s.points[t[1]] + (1 - share)*s.points[t[2]];
        s.points[t[0]] = aim + rest*(s.points[t[0]] - aim);
    }
    return s;
}

} // namespace flotsam
