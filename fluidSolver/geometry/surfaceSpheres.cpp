// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/primitives.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace flotsam
{
namespace
{

using Spheres = std::vector<SurfaceSphere>;

/// Equal parts of a length, none longer than `spacing` (1e-9: a length that is a multiple of it up to round-off).
int parts(double length, double spacing) { return static_cast<int>(std::ceil(length / spacing * (1 - 1e-9))); }

/// Rows of spheres on all faces: the boundary of a lattice.
Spheres boxSpheres(const BoxShape& box, double radius, double spacing)
{
    const double r = std::min(radius, box.half().minCoeff());
    const Vec3 inner = (box.half().array() - r).max(0.0);
    int n[3];
    for (int d = 0; d < 3; ++d) n[d] = parts(2 * inner[d], spacing);
    auto at = [&](int i, int d) { return n[d] > 0 ? inner[d] * (2.0 * i / n[d] - 1) : 0; };
    auto isEnd = [&](int i, int d) { return i == 0 || i == n[d]; };
    Spheres spheres;
    for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
            for (int i = 0; i <= n[0]; ++i)
                if (isEnd(i, 0) || isEnd(j, 1) || isEnd(k, 2))
                    spheres.push_back({box.centre() + Vec3(at(i, 0), at(j, 1), at(k, 2)), r});
    return spheres;
}

/// Half of the angle between neighbours on a circle of radius `turn`: along the chord at most `spacing`, and the flat that bridges two
/// spheres lies at most a twentieth of their radius inside the circle around all. Thick spheres alone would make a square of a cylinder.
double halfAngle(double turn, double sphereRadius, double spacing)
{
    return std::min(std::asin(std::min(1.0, 0.5 * spacing / turn)), std::acos(std::max(-1.0, 1 - 0.05 * sphereRadius / turn)));
}

/// Spheres on a ring about an axis.
void addRing(Spheres& spheres, const Vec3& origin, const Vec3& axis, ProfilePoint p, double sphereRadius, double spacing)
{
    const Vec3 u = anyNormalTo(axis), v = axis.cross(u);
    const int n = p.radius > 0 ? std::max(1, parts(M_PI, halfAngle(p.radius, sphereRadius, spacing))) : 1;
    for (int i = 0; i < n; ++i)
    {
        const double angle = 2 * M_PI * i / n;
        spheres.push_back({origin + p.along * axis + p.radius * (std::cos(angle) * u + std::sin(angle) * v), sphereRadius});
    }
}

/// A row on the axis, as thick as the body: on a polygon of thinner spheres it would lose speed at each of them as it rolls. Half a radius apart grooves are 3 % of the
/// radius deep, a quarter 0.8 %.
void addRow(Spheres& spheres, const Vec3& centre, const Vec3& axis, double halfLength, double radius, double spacing)
{
    const int n = parts(2 * halfLength, std::min(spacing, 0.5 * radius));
    for (int i = 0; i <= n; ++i) spheres.push_back({centre + (n > 0 ? halfLength * (2.0 * i / n - 1) : 0) * axis, radius});
}

/// Rings whose centres lie on the cylinder `radius` inside, and on the ends' faces. Where a row has room it stands for the rings but for those beyond its ends. There the last
/// ones, which make the rims, stay off the ground that the row rolls on.
Spheres cylinderSpheres(const CylinderShape& c, double radius, double spacing, double rowSpacing)
{
    constexpr double rimDepth = 0.01;   // inside the cylinder, over its radius
    const double r = std::min({radius, c.radius(), c.halfLength()});
    const double length = c.halfLength() - r, turn = c.radius() - r, row = c.halfLength() - c.radius();
    Spheres spheres;
    const auto addRings = [&](double along, double ring) { addRing(spheres, c.centre(), c.axis(), {along, ring}, r, spacing); };
    const auto addFace = [&](double along, double rim)
    {
        const int m = std::max(1, parts(rim, spacing));
        for (int k = rim > 0 ? 0 : 1; k <= m; ++k) addRings(along, rim * k / m);
    };
    if (row < 0)
    {
        const int n = parts(2 * length, spacing);
        for (int i = 1; i < n; ++i) addRings(length * (2.0 * i / n - 1), turn);
        addFace(length, turn);
        if (n > 0) addFace(-length, turn);
        return spheres;
    }
    addRow(spheres, c.centre(), c.axis(), row, c.radius(), rowSpacing);
    const int n = parts(length - row, spacing);
    for (const int side : {-1, 1})
    {
        for (int i = 1; i < n; ++i) addRings(side * (row + (length - row) * i / n), turn);
        if (n > 0) addFace(side * length, std::max(0.0, turn - rimDepth * c.radius()));
    }
    return spheres;
}

/// As thick as the capsule: it is what such a sphere sweeps.
Spheres capsuleSpheres(const CapsuleShape& c, double spacing)
{
    Spheres spheres;
    addRow(spheres, c.centre(), c.axis(), c.halfLength(), c.radius(), spacing);
    return spheres;
}

Vec3 distanceGradient(const Shape& shape, const Vec3& x, double step)
{
    Vec3 g;
    for (int d = 0; d < 3; ++d) g[d] = (shape.distance(x + step * Vec3::Unit(d)) - shape.distance(x - step * Vec3::Unit(d))) / (2 * step);
    return g;
}

/// Newton steps to distance = -radius; false near the medial axis, where there may be no such point.
bool pushInside(const Shape& shape, double radius, Vec3& x)
{
    for (int i = 0; i < 30; ++i)
    {
        const double defect = shape.distance(x) + radius;
        if (std::abs(defect) < 1e-11 * radius) return true;
        const Vec3 g = distanceGradient(shape, x, 1e-4 * radius);
        if (g.squaredNorm() < 0.25) return false;
        x -= defect / g.squaredNorm() * g;
    }
    return false;
}

/// Whether the ball of radius t that touches the surface at the point lies inside the shape.
bool fits(const Shape& shape, const SurfacePoint& p, double t) { return shape.distance(p.x - t * p.normal) <= -t * (1 - 1e-9); }

/// Radius of the largest ball inside the shape that touches its surface at the point, up to `radius`.
double ballRadius(const Shape& shape, const SurfacePoint& p, double radius)
{
    if (fits(shape, p, radius)) return radius;
    double low = 0, high = radius;
    for (int i = 0; i < 40; ++i) (fits(shape, p, 0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
    return low;
}

/// Of all points. Most need a look at most: where the largest ball so far does not fit there is no larger one.
double largestBallRadius(const Shape& shape, const std::vector<SurfacePoint>& points, double radius)
{
    double largest = 0;
    for (const SurfacePoint& p : points)
    {
        if (largest == radius) break;
        if (largest == 0 || fits(shape, p, largest)) largest = std::max(largest, ballRadius(shape, p, radius));
    }
    return largest;
}

struct Candidate
{
    SurfaceSphere sphere;
    int rank;   // how far it had to be pushed: corners before edges before faces
};

/// Balls under the points; where the shape is thinner than the ball, the largest that fits, unless a mere crumb at an edge.
std::vector<Candidate> candidates(const Shape& shape, const std::vector<SurfacePoint>& points, double r)
{
    std::vector<Candidate> result;
    for (const SurfacePoint& p : points)
    {
        const Vec3 start = p.x - r * p.normal;
        SurfaceSphere s{start, r};
        if (!pushInside(shape, r, s.centre))
        {
            s.radius = ballRadius(shape, p, r);
            if (s.radius < 0.5 * r) continue;
            s.centre = p.x - s.radius * p.normal;
            s.radius = -shape.distance(s.centre);
        }
        result.push_back({s, static_cast<int>(20 * (s.centre - start).norm() / r)});
    }
    std::stable_sort(result.begin(), result.end(), [](const Candidate& a, const Candidate& b) { return a.rank > b.rank; });
    return result;
}

/// Spheres at least a distance apart, in boxes of that length: of tens of thousands only those in the boxes around are compared.
class ThinnedSpheres
{
public:
    explicit ThinnedSpheres(double distance) : distance_(distance) {}

    void addIfApart(const SurfaceSphere& sphere)
    {
        const std::array<long, 3> box = boxOf(sphere.centre);
        for (long i = -1; i <= 1; ++i)
            for (long j = -1; j <= 1; ++j)
                for (long k = -1; k <= 1; ++k)
                    if (isNearOne({box[0] + i, box[1] + j, box[2] + k}, sphere)) return;
        inBox_[box].push_back(static_cast<int>(spheres_.size()));
        spheres_.push_back(sphere);
    }
    Spheres take() { return std::move(spheres_); }

private:
    std::array<long, 3> boxOf(const Vec3& x) const
    {
        const auto place = [&](int d) { return static_cast<long>(std::floor(x[d] / distance_)); };
        return {place(0), place(1), place(2)};
    }
    bool isNearOne(const std::array<long, 3>& box, const SurfaceSphere& sphere) const
    {
        const auto found = inBox_.find(box);
        if (found == inBox_.end()) return false;
        return std::any_of(found->second.begin(), found->second.end(), [&](int other) { return (spheres_[other].centre - sphere.centre).squaredNorm() < distance_ * distance_; });
    }

    double distance_;
    Spheres spheres_;
    std::map<std::array<long, 3>, std::vector<int>> inBox_;
};

/// Any shape: balls under a dense sampling of the surface, thinned in order. The thinning distance makes neighbours
/// `spacing` apart at most in a triangular pattern.
Spheres sampledSpheres(const Shape& shape, double radius, double spacing)
{
    const std::vector<SurfacePoint> points = samplePoints(shape.surface(0.5 * spacing), 0.25 * spacing);
    const double thickest = largestBallRadius(shape, points, radius);
    ThinnedSpheres spheres(0.6 * spacing);
    for (const Candidate& c : candidates(shape, points, std::min(radius, thickest * (1 - 1e-6)))) spheres.addIfApart(c.sphere);
    return spheres.take();
}

} // namespace

bool hasSphereAt(const std::vector<SurfaceSphere>& spheres, const Vec3& x, double radius)
{
    return std::any_of(spheres.begin(), spheres.end(), [&](const SurfaceSphere& s) { return s.radius == radius && (s.centre - x).norm() < sameSphere * radius; });
}

std::vector<SurfaceSphere> unionSpheres(const UnionShape& shape, const std::function<std::vector<SurfaceSphere>(const Shape&)>& ofPart)
{
    Spheres all;
    for (const auto& part : shape.parts())
        for (const SurfaceSphere& s : ofPart(*part))
            if (shape.distance(s.centre) > -s.radius * (1 + 1e-9) && !hasSphereAt(all, s.centre, s.radius)) all.push_back(s);
    return all;
}

std::vector<SurfaceSphere> surfaceSpheres(const Shape& shape, double radius, double spacing, double rowSpacing)
{
    if (!(radius > 0) || !(spacing > 0))
        throw std::runtime_error("surface spheres need a positive radius and spacing, found " + std::to_string(radius) + " and "
                                 + std::to_string(spacing));
    if (const auto* sphere = dynamic_cast<const SphereShape*>(&shape)) return {{sphere->centre(), sphere->radius()}};
    if (const auto* box = dynamic_cast<const BoxShape*>(&shape)) return boxSpheres(*box, radius, spacing);
    if (const auto* cylinder = dynamic_cast<const CylinderShape*>(&shape)) return cylinderSpheres(*cylinder, radius, spacing, rowSpacing);
    if (const auto* capsule = dynamic_cast<const CapsuleShape*>(&shape)) return capsuleSpheres(*capsule, rowSpacing);
    if (const auto* joined = dynamic_cast<const UnionShape*>(&shape))
        return unionSpheres(*joined, [&](const Shape& part) { return surfaceSpheres(part, radius, spacing, rowSpacing); });
    if (const auto* placed = dynamic_cast<const PlacedShape*>(&shape))
    {
        Spheres spheres = surfaceSpheres(placed->inner(), radius, spacing, rowSpacing);
        for (SurfaceSphere& s : spheres) s.centre = placed->toOuter(s.centre);
        return spheres;
    }
    return sampledSpheres(shape, radius, spacing);
}

} // namespace flotsam
