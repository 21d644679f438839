// SPDX-License-Identifier: GPL-3.0-or-later
/// Triangles of the faces of polyhedral cells.
#pragma once

#include "geometry/shape.hpp"

#include <array>
#include <vector>

namespace flotsam
{

/// Height over the longest edge of a triangle, 0 of one without area.
double flatness(const Vec3& a, const Vec3& b, const Vec3& c);

/// Of which that is less a triangle is a sliver: it has a normal of round-off.
constexpr double sliverFlatness = 1e-3;

/// Triangles of a polygon, n - 2 of n corners, in its sense. The fan of its first corner, as long as no triangle of that is a sliver: corners in the middle
/// of an edge (hanging points, beside finer cells) give such. Otherwise those whose flattest one is the least flat.
std::vector<std::array<int, 3>> faceTriangles(const std::vector<Vec3>& corners);

} // namespace flotsam
