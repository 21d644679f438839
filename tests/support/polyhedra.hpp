// SPDX-License-Identifier: GPL-3.0-or-later
/// Polyhedra as an STL file would give them.
#pragma once

#include "geometry/stlReader.hpp"

#include <algorithm>
#include <fstream>
#include <string>

namespace flotsam
{

/// Over the triangle (0 0) (length 0) (0 height) in x and y from -depth/2 to depth/2 in z, shifted by `origin` [m]: a sill with a ramp. Every face of several triangles.
inline TriSurface wedgeSurface(double length, double height, double depth, const Vec3& origin = Vec3::Zero())
{
    TriSurface s;
    for (const double z : {-0.5 * depth, 0.5 * depth})
        for (const Vec3& corner : {Vec3(0, 0, z), Vec3(length, 0, z), Vec3(0, height, z), Vec3(length / 3, height / 3, z)}) s.points.push_back(origin + corner);
    for (const auto& t : {std::array<int, 3>{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) // the ends, about a point within them
    {
        s.triangles.push_back({t[0], t[2], t[1]});
        s.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    }
    for (const auto& side : {std::array<int, 2>{0, 1}, {1, 2}, {2, 0}})
    {
        s.triangles.push_back({side[0], side[1], side[1] + 4});
        s.triangles.push_back({side[0], side[1] + 4, side[0] + 4});
    }
    return s;
}

inline std::shared_ptr<const Shape> makeWedge(double length, double height, double depth, const Vec3& origin = Vec3::Zero())
{
    return makeClosedSurface(wedgeSurface(length, height, depth, origin));
}

/// A polygon in x and y, counter-clockwise, from -depth/2 to depth/2 in z. Its ends: triangles about the points that see the next two ("ears").
inline TriSurface extruded(const std::vector<std::array<double, 2>>& polygon, double depth)
{
    const int n = static_cast<int>(polygon.size());
    TriSurface s;
    for (const double z : {-0.5 * depth, 0.5 * depth})
        for (const auto& [x, y] : polygon) s.points.emplace_back(x, y, z);
    for (int i = 0; i < n; ++i)
    {
        const int next = (i + 1) % n;
        s.triangles.push_back({i, next, next + n});
        s.triangles.push_back({i, next + n, i + n});
    }
    const auto area = [&](int a, int b, int c) { return (s.points[b] - s.points[a]).cross(s.points[c] - s.points[a]).z(); };
    std::vector<int> left(n);
    for (int i = 0; i < n; ++i) left[i] = i;
    while (left.size() > 2)
        for (std::size_t k = 0; k < left.size(); ++k)
        {
            const int a = left[k], b = left[(k + 1) % left.size()], c = left[(k + 2) % left.size()];
            const auto isIn = [&](int i) { return i != a && i != b && i != c && area(a, b, i) >= 0 && area(b, c, i) >= 0 && area(c, a, i) >= 0; };
            if (area(a, b, c) <= 0 || std::any_of(left.begin(), left.end(), isIn)) continue;
            s.triangles.push_back({a, c, b});
            s.triangles.push_back({a + n, b + n, c + n});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>((k + 1) % left.size()));
            break;
        }
    return s;
}

/// ASCII, with all digits.
inline void writeStl(const std::string& file, const TriSurface& surface)
{
    std::ofstream out(file);
    out.precision(17);
    out << "solid test\n";
    for (const auto& t : surface.triangles)
    {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int i : t) out << "vertex " << surface.points[i].transpose() << '\n';
        out << "endloop\nendfacet\n";
    }
    out << "endsolid test\n";
}

} // namespace flotsam
