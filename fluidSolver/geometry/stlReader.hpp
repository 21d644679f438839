// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads STL files into closed, outward oriented surfaces. Private to geometry.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// ASCII or binary; vertices closer than 1e-7 of the surface's size are one; triangles without area are dropped; turned
/// inside out if the enclosed volume is negative. Throws std::runtime_error naming the file and the first edge that is open,
/// shared by more than two triangles, or between triangles of opposite orientation.
TriSurface readClosedStl(const std::string& file, double scale);

} // namespace flotsam
