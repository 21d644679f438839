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

/// Triangles with a smaller angle are needles [rad]: LIGGGHTS refuses those with one below 1e-3 ("Bad mesh", surface_mesh_I.h); a little more, as it computes with other digits.
constexpr double needleAngle = 1.001e-3;

/// Triangles of a polygon, n - 2 of n corners, in its sense. The fan of its first corner, as long as none of it is flatter than a needle, with a normal of round-off: corners in the middle
/// of an edge (hanging points, beside finer cells) give such. Otherwise those whose flattest one is the least flat.
std::vector<std::array<int, 3>> faceTriangles(const std::vector<Vec3>& corners);

} // namespace flotsam
