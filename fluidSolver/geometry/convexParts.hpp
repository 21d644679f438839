// SPDX-License-Identifier: GPL-3.0-or-later
/// Polyhedra that are not convex, as the union of convex ones.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// Of a closed surface, oriented outwards: at most 32 convex polyhedra of at most maxFaces faces each, whose union is what it encloses, to 1e-5 of the volume. Empty: it has more than 40
/// plane faces or 200,000 triangles, or needs more parts.
std::vector<std::shared_ptr<const Shape>> convexParts(const TriSurface& surface);

} // namespace flotsam
