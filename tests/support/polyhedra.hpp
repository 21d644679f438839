// SPDX-License-Identifier: GPL-3.0-or-later
/// Polyhedra as an STL file would give them.
#pragma once

#include "geometry/stlReader.hpp"

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
