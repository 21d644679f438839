// SPDX-License-Identifier: GPL-3.0-or-later
/// Where bodies are at the start: overlaps of placed shapes, and random placement without overlaps.
#pragma once

#include "geometry/solid.hpp"

#include <cstdint>
#include <optional>
#include <random>
#include <string>

namespace flotsam
{

/// A shape with points on its surface, no further apart than `spacing`; overlaps are found by the points of one in the distance of the other.
class SampledShape
{
public:
    SampledShape(std::shared_ptr<const Shape> shape, double spacing);
    const Shape& shape() const { return *shape_; }
    const std::vector<Vec3>& points() const { return points_; }

private:
    std::shared_ptr<const Shape> shape_;
    std::vector<Vec3> points_;  ///< in the shape's frame
};

/// What is lost of lengths that are differences of coordinates in a box [m]: at those of a map more than in a flume.
double coordinateRoundOff(const std::array<Vec3, 2>& box);

/// Sample points of a triangulated surface, neighbours no further apart than `spacing` [m].
std::vector<Vec3> pointsOnSurface(const TriSurface& surface, double spacing);

/// A sampled shape at a place. Box and points in space.
struct ShapeAtPose
{
    std::string name;
    std::shared_ptr<const SampledShape> shape;
    Pose pose;

    std::array<Vec3, 2> spaceBounds() const;
    Vec3 inFrame(const Vec3& x) const;      ///< a point in space -> in the shape's frame
    double distance(const Vec3& x) const;   ///< of a point in space [m]
};

/// Smallest gap between two placed shapes [m], negative: depth of the overlap. Larger than `farther` is returned as `farther`.
double gap(const ShapeAtPose& a, const ShapeAtPose& b, double farther);

/// What bodies must keep clear of. A plane's normal points to the allowed side.
struct Obstacles
{
    std::vector<ShapeAtPose> shapes;        ///< structures
    std::vector<ShapeAtPose> bodies;        ///< that are there at the start
    struct Plane { std::string name; Vec3 point, normal; };
    std::vector<Plane> planes;
    struct Facets { std::string name; TriSurface surface; };
    std::vector<Facets> facets;             ///< walls that are not planes: no triangle may reach into a body
    std::array<Vec3, 2> box{Vec3::Constant(-1e30), Vec3::Constant(1e30)}; ///< the mesh's bounding box
    std::array<bool, 3> checkBox{true, true, true}; ///< per axis; off along the empty axis of a 2D mesh
};

/// The deepest overlap among what is nearer than `minGap` (negative: overlaps up to -minGap are allowed); nothing when the place is free.
struct Conflict { std::string with; double overlap; /* [m], negative: a gap too small */ };
std::optional<Conflict> findConflict(const ShapeAtPose& body, const Obstacles& obstacles, double minGap, bool withBodies = true);

/// Whether findConflict() would find none: ends at the first one, which is what a random placement needs of its many tries.
bool isPlaceFree(const ShapeAtPose& body, const Obstacles& obstacles, double minGap, bool withBodies = true);

/// Reproducible numbers, the same with every compiler and on every rank.
class RandomNumbers
{
public:
    explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}
    double uniform() { return static_cast<double>(engine_() >> 11)*0x1p-53; }   ///< [0,1)
    Eigen::Quaterniond rotation();                                              ///< uniform over all rotations
private:
    std::mt19937_64 engine_;
};

} // namespace flotsam
