// SPDX-License-Identifier: GPL-3.0-or-later
/// Triangles of surfaces that bodies touch which are too thin for the contact engine.
#pragma once

#include "geometry/faceTriangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flotsam
{

/// Of the extent of its surface: a narrower triangle may be left out. The crack is so narrow that a sphere of a hundredth of the extent sinks into it by 1e-7 of its radius.
constexpr double narrowestWallTriangle = 1e-5;

struct ThinTriangle
{
    bool isRefused = false;     ///< for an angle
    double length = 0, width = 0; ///< longest edge, height over it [m]

    ThinTriangle(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        const std::array<double, 3> edges{(b - a).norm(), (c - b).norm(), (a - c).norm()};
        length = *std::max_element(edges.begin(), edges.end());
        width = length*flatness(a, b, c);
        const double second = edges[0] + edges[1] + edges[2] - length - *std::min_element(edges.begin(), edges.end());
        isRefused = !(width > std::sin(needleAngle)*second); // the smallest angle is between the two longer edges
    }
    /// extent: of the surface, the diagonal of the box around it [m].
    bool isNegligible(double extent) const { return width < narrowestWallTriangle*extent; }
};

/// Of the box around a surface, its diagonal [m].
double extentOf(const TriSurface& surface);

/// A surface without triangles that the contact engine refuses.
struct DividedSurface
{
    TriSurface surface;     ///< the points of the given one first
    std::size_t divided = 0, pieces = 0, leftOut = 0;   ///< triangles that were divided, of these pieces, and negligible ones without pieces
};

/// Divides thin triangles across their length, each on its own or with its neighbour where both make a plane strip; the others stay as they are. Pieces lie in the triangle's plane and cover it,
/// exactly (to round-off) where it is wider than narrowestWallTriangle; towards a corner with an angle below the limit, which no division makes larger, they are of that width instead, over the
/// edges by 0.71 of it at most. So are those of triangles that are nowhere wider, where several lie side by side; single ones are left out, and any that are narrower than round-off. A triangle
/// becomes at most 242 pieces. Where there would be more than `most` the division ends, with pieces > most.
/// New points lie on edges of neighbours that are not divided: contact goes by the nearest points of triangles, and has one of each place.
DividedSurface divideThinTriangles(const TriSurface& surface, std::size_t most);

} // namespace flotsam
