// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads STL files into closed, outward oriented surfaces, and makes shapes of them. Private to geometry.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// ASCII or binary; vertices closer than 1e-7 of the surface's size are one; triangles without area are dropped; turned
/// inside out if the enclosed volume is negative. Throws std::runtime_error naming the file and the first edge that is open,
/// shared by more than two triangles, or between triangles of opposite orientation.
TriSurface readClosedStl(const std::string& file, double scale);

/// Throws std::runtime_error naming the file and a place if closed parts of the surface reach into each other: what they share would count twice, and sides of
/// one inside of the other would be surface. Parts may lie apart, touch, and be cavities of others (inside, oriented the other way).
void requireSeparateParts(const std::string& file, const TriSurface& surface);

/// The solid inside of a closed surface oriented outwards.
std::shared_ptr<const Shape> makeClosedSurface(TriSurface surface);

} // namespace flotsam
