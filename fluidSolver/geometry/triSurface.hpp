// SPDX-License-Identifier: GPL-3.0-or-later
/// Triangulated surfaces: exact moments of what they enclose, plane sections, surfaces of revolution, sampling.
#pragma once

#include "geometry/shape.hpp"

namespace flotsam
{

/// Moments of the enclosed volume by the divergence theorem (sum over tetrahedra to a common point): exact.
VolumeMoments enclosedMoments(const TriSurface& surface);

/// Axis-aligned box around its points {lower, upper} [m].
std::array<Vec3, 2> boundsOf(const TriSurface& surface);

/// Triangles with their area [m^2], a vector, twice; the largest first: their planes are the most exact. Those without area are left out.
struct Facet
{
    std::array<Vec3, 3> corners;
    Vec3 area;
};
std::vector<Facet> largestFirst(const TriSurface& surface);

/// Area of the section of the enclosed volume with the plane through `point` with unit normal `normal` [m^2].
double sectionArea(const TriSurface& surface, const Vec3& point, const Vec3& normal);

/// Point of a profile: position along the axis and distance from it [m].
struct ProfilePoint { double along, radius; };

/// Into how many pieces of equal length a strip is divided so that none of its triangles is a needle (needleAngle).
int stripPieces(double length, double width);

/// Surface of a box from `lower` to `upper`: two triangles a face, more where they would be needles.
TriSurface boxSurface(const Vec3& lower, const Vec3& upper);

/// Closed surface of the profile turned about the axis, whose straight parts are divided where strips of their length would be needles. The profile runs in the direction of the axis, from radius 0 to
/// radius 0 (other points > 0); `nAround` points per ring.
TriSurface surfaceOfRevolution(const Vec3& origin, const Vec3& axis, const std::vector<ProfilePoint>& profile, int nAround);

/// Points inside the triangles (none on edges), not further apart than `spacing`.
struct SurfacePoint { Vec3 x, normal; };
std::vector<SurfacePoint> samplePoints(const TriSurface& surface, double spacing);

/// A triangle as rows parallel to its shortest edge. CAD programs write a pipe as strips of its length: as many points across these as along them
/// would be millions.
class Strip
{
public:
    Strip(const Vec3& a, const Vec3& b, const Vec3& c);
    bool isNarrow() const { return narrowness_ < 0.25; }
    int rows(double spacing) const;                     ///< so many that neighbours are not further apart
    std::array<Vec3, 2> row(double share) const;        ///< ends; share 0: the shortest edge, 1: the corner opposite of it

private:
    std::array<Vec3, 3> corners_;   ///< the shortest edge first
    double longest_, narrowness_;   ///< longest edge [m], shortest over longest
};

/// A second unit vector normal to `axis`; with the third it makes a right-handed frame {axis, u, axis x u}.
Vec3 anyNormalTo(const Vec3& axis);

} // namespace flotsam
