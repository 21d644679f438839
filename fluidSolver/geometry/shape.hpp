// SPDX-License-Identifier: GPL-3.0-or-later
/// Shapes of structures and bodies: ONE definition for the fluid (signed distance), the DEM (surface spheres,
/// mass, inertia), the output (triangulated surface) and the statistics.
#pragma once

#include <Eigen/Dense>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace flotsam
{

using Vec3 = Eigen::Vector3d;

/// Integrals over a solid of density 1, in the frame in which the shape is given.
struct VolumeMoments
{
    double volume = 0;                              ///< [m^3]
    Vec3 centroid = Vec3::Zero();                   ///< [m]
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero(); ///< about the centroid, density 1 [m^5]
};

/// Closed triangulated surface, outward normals by the right-hand rule.
struct TriSurface
{
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
};

/// As many as a dodecahedron has (PlaneFaces). STL files with more plane faces are cut by their distance.
constexpr int maxFaces = 12;

/// Rotations that turn a shape into itself, in its frame: none, about one axis, or all about a point.
struct Symmetry
{
    enum class Kind { None, Axis, Point } kind = Kind::None;
    Vec3 point = Vec3::Zero();  ///< on the axis [m]
    Vec3 axis = Vec3::Zero();   ///< unit
};

/// A closed shape in its own frame. Immutable, safe to share.
class Shape
{
public:
    virtual ~Shape() = default;

    /// Signed distance [m], negative inside. Exact for the primitives; for unions the minimum.
    virtual double distance(const Vec3& x) const = 0;

    /// Signed distances [m] from the smooth faces that bound the shape if it is what lies inside of all of them: their number, at most
    /// maxFaces. 0 for other shapes.
    virtual int faceDistances(const Vec3& /*x*/, double* /*distances*/) const { return 0; }

    /// Whether all faces of faceDistances() are plane.
    virtual bool hasPlaneFaces() const { return false; }

    /// Shapes that it is the union of, none of them of several parts: a union's, of an STL file with few plane faces convex ones, of others itself.
    virtual int nParts() const { return 1; }
    virtual const Shape& part(int /*number*/) const { return *this; }

    virtual Symmetry symmetry() const { return {}; }

    /// Axis-aligned bounding box {lower, upper} in the shape's frame [m].
    virtual std::array<Vec3, 2> bounds() const = 0;

    /// Exact for box, cylinder, sphere, capsule, closed STL, and for unions whose parts overlap only where they are boxes or not at all; for others to 1e-5.
    virtual VolumeMoments moments() const = 0;

    /// Of the section with the plane through `point` with unit normal `normal`, in the shape's frame [m^2]: that of a surface of facets of 1/100 of the smallest
    /// extent, which unions count once where parts overlap.
    virtual double sectionArea(const Vec3& point, const Vec3& normal) const;

    /// Triangulated surface; no edge that bends with the shape is longer than `size` [m] (straight lines stay whole).
    virtual TriSurface surface(double size) const = 0;
};

/// Sphere of the DEM model, in the shape's frame [m].
struct SurfaceSphere { Vec3 centre; double radius; };

/// Spheres of radius `radius` whose surfaces touch the shape's surface from inside, neighbouring centres at most
/// `spacing` apart, on the surface only (paper: "placed on the body's surface only"). The radius is reduced where
/// the shape is thinner than 2*radius. What is round has spheres of its own radius: a sphere one, capsules and cylinders that are longer than thick a row on
/// the axis, centres at most `rowSpacing` and half of its radius apart, cylinders besides it those at their ends.
std::vector<SurfaceSphere> surfaceSpheres(const Shape& shape, double radius, double spacing, double rowSpacing);
inline std::vector<SurfaceSphere> surfaceSpheres(const Shape& shape, double radius, double spacing) { return surfaceSpheres(shape, radius, spacing, spacing); }

/// Likewise of what reaches through a 2D mesh: one layer, with its centres in the plane through `point` with unit normal `normal`, for boxes with a side and cylinders
/// with their axis along it (these one sphere of their own radius, which rolls as they do), and unions of these, whatever their extent along it. More layers would touch
/// what one touches. Of other shapes one layer of surfaceSpheres() where that has all that the section needs, else all of them.
std::vector<SurfaceSphere> sectionSpheres(const Shape& shape, const Vec3& point, const Vec3& normal, double radius, double spacing, double rowSpacing);

/// Spheres of this radius in the corners of a box, which touch its three faces there; of other shapes none.
std::vector<SurfaceSphere> cornerSpheres(const Shape& shape, double radius);
/// The same in the plane through `point` with unit normal `normal`, where a side of the box is along it, else none.
std::vector<SurfaceSphere> sectionCorners(const Shape& shape, const Vec3& point, const Vec3& normal, double radius);

std::shared_ptr<const Shape> makeBox(const Vec3& centre, const Vec3& size);
std::shared_ptr<const Shape> makeSphere(const Vec3& centre, double radius);
std::shared_ptr<const Shape> makeCylinder(const Vec3& end1, const Vec3& end2, double radius);
std::shared_ptr<const Shape> makeCapsule(const Vec3& end1, const Vec3& end2, double radius);
/// Reads ASCII or binary STL. Throws std::runtime_error naming the file and the first open or non-manifold edge.
std::shared_ptr<const Shape> makeStl(const std::string& file, double scale = 1);
std::shared_ptr<const Shape> makeUnion(std::vector<std::shared_ptr<const Shape>> parts);
/// `shape` moved by x -> rotation*x + translation.
std::shared_ptr<const Shape> makePlaced(std::shared_ptr<const Shape> shape, const Eigen::Quaterniond& rotation, const Vec3& translation);

} // namespace flotsam
