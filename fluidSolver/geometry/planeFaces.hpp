// SPDX-License-Identifier: GPL-3.0-or-later
/// What is cut in place of a round shape where elements are too coarse for it.
///
/// A linear cut knows a shape by its distance at the nodes: of what is thinner than an element it may see nothing. Plane faces are cut exactly whatever the elements' size.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// The faces of a convex polyhedron.
struct PlaneFaces
{
    struct Plane { Vec3 normal; double distance; };  ///< outward, unit; of the plane from the origin along it [m]

    std::vector<Plane> planes;      ///< at most maxFaces

    /// As Shape::faceDistances().
    int distances(const Vec3& x, double* distances) const;
};

/// Of a shape that makePlaneFaces() knows; 0 for others.
double roundThickness(const Shape& shape);

/// Polyhedron with the shape's volume, centroid and axis: of a cylinder and a capsule a hexagonal prism, of a sphere a dodecahedron. Null for other shapes.
/// Corners reach up to a fifth of the radius beyond the shape.
std::shared_ptr<const PlaneFaces> makePlaneFaces(const Shape& shape);

} // namespace flotsam
