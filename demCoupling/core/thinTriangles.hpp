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

} // namespace flotsam
