// SPDX-License-Identifier: GPL-3.0-or-later
/// Polyhedra: plane faces are cut exactly, whatever the elements' size. Shapes that are some, and what is cut in place of a round shape where elements are too coarse for it:
/// a linear cut knows a shape by its distance at the nodes, and of what is thinner than an element it may see nothing.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// Over a surface's size: STL files have coordinates of six or seven digits. So much may a corner lie off the plane of its face.
constexpr double planeTolerance = 1e-5;

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

/// Of a closed surface, oriented outwards, that is a convex polyhedron with at most maxFaces faces, to 1e-5 of its size; null for others.
std::shared_ptr<const PlaneFaces> convexFaces(const TriSurface& surface);

/// Least distance [m] between one of a shape's plane faces (Shape::hasPlaneFaces) and the farthest corner behind it, without the faces that look more along `across`
/// (unit, in the shape's frame; zero: none) than not: infinite without others.
double planeThickness(const Shape& shape, const Vec3& across);

/// Diameter of the largest ball in a shape that has plane faces (Shape::hasPlaneFaces) [m].
double largestBall(const Shape& shape);

} // namespace flotsam
