// SPDX-License-Identifier: GPL-3.0-or-later
/// Closed prisms as CAD programs triangulate them: long narrow triangles.
#pragma once

#include "geometry/shape.hpp"

#include <cmath>

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

} // namespace flotsam
