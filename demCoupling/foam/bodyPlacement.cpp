// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/bodyPlacement.hpp"
#include "geometry/triSurface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{

namespace
{

bool boxesApart(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b, double margin)
{
    for (int d = 0; d < 3; ++d)
        if (a[0][d] > b[1][d] + margin || b[0][d] > a[1][d] + margin) return true;
    return false;
}

/// Smallest distance of a's points in b, among those near b: its box in its own frame lies close around it, however it is turned.
double oneSidedGap(const ShapeAtPose& a, const ShapeAtPose& b, double farther)
{
    const Shape& other = b.shape->shape();
    const auto box = other.bounds();
    const Eigen::Matrix3d rotation = a.pose.orientation.toRotationMatrix();
    double smallest = farther;
    for (const Vec3& p : a.shape->points())
    {
        const Vec3 x = b.inFrame(rotation*p + a.pose.position);
        const Vec3 outside = (box[0] - x).cwiseMax(x - box[1]).cwiseMax(0.0);
        if (outside.norm() < std::max(smallest, 1e-300)) smallest = std::min(smallest, other.distance(x));
    }
    return smallest;
}

/// Of a point in the middle of a, where it lies in both: bodies in the same place have all points of their surfaces on each other's.
double gapOfMiddle(const ShapeAtPose& a, const ShapeAtPose& b)
{
    const auto [lower, upper] = a.spaceBounds();
    const Vec3 middle = 0.5*(lower + upper);
    return std::max(a.distance(middle), b.distance(middle));
}

/// Depth by which the body passes a plane or a side of the box (negative: free).
double depthBehind(const ShapeAtPose& body, const Vec3& point, const Vec3& normal)
{
    const Vec3 local = body.pose.orientation.conjugate()*normal;
    const double offset = normal.dot(body.pose.position - point);
    double deepest = -1e30;
    for (const Vec3& p : body.shape->points()) deepest = std::max(deepest, -(local.dot(p) + offset));
    return deepest;
}

double depthInFacets(const ShapeAtPose& body, const TriSurface& surface, double spacing)
{
    const auto box = body.spaceBounds();
    double deepest = -1e30;
    TriSurface one;
    one.triangles = {{0, 1, 2}};
    for (const auto& t : surface.triangles)
    {
        one.points = {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
        const Vec3 lower = one.points[0].cwiseMin(one.points[1]).cwiseMin(one.points[2]);
        const Vec3 upper = one.points[0].cwiseMax(one.points[1]).cwiseMax(one.points[2]);
        if (boxesApart(box, {lower, upper}, spacing)) continue;
        for (const Vec3& x : pointsOnSurface(one, spacing)) deepest = std::max(deepest, -body.distance(x));
    }
    return deepest;
}

double shortestSide(const ShapeAtPose& body)
{
    const auto [lower, upper] = body.shape->shape().bounds();
    return (upper - lower).minCoeff();
}

/// The deepest overlap among those that violate a gap.
class Worst
{
public:
    explicit Worst(const ShapeAtPose& body) : roundOff_(ofSize*shortestSide(body) + coordinateRoundOff(body.spaceBounds())) {}

    void keep(const std::string& with, double overlap, double minGap)
    {
        if (overlap + minGap > roundOff_ && (!found_ || overlap > found_->overlap)) found_ = Conflict{with, overlap};
    }

    const std::optional<Conflict>& found() const { return found_; }

private:
    static constexpr double ofSize = 1e-8;
    const double roundOff_;     // [m]: bodies that touch a wall exactly are welcome
    std::optional<Conflict> found_;
};

/// isFirstEnough: whichever is found first.
std::optional<Conflict> worstConflict(const ShapeAtPose& body, const Obstacles& obstacles, double minGap, bool withBodies, bool isFirstEnough)
{
    Worst worst(body);
    const auto keepOutside = [&](int d, double sideGap)
    {
        worst.keep("the outside of the mesh", depthBehind(body, obstacles.box[0], Vec3::Unit(d)), sideGap);
        worst.keep("the outside of the mesh", depthBehind(body, obstacles.box[1], -Vec3::Unit(d)), sideGap);
    };
    for (int d = 0; d < 3; ++d) // a body that is not in the mesh at all is behind its walls as well: the first says more
    {
        const double x = body.pose.position[d];
        if (obstacles.checkBox[d] && (x < obstacles.box[0][d] || x > obstacles.box[1][d])) keepOutside(d, 0);
    }
    if (worst.found()) return worst.found();
    const auto isEnough = [&] { return isFirstEnough && worst.found(); };
    for (const auto& plane : obstacles.planes) worst.keep("wall " + plane.name, depthBehind(body, plane.point, plane.normal), minGap);
    for (const auto& wall : obstacles.facets)
        if (!isEnough()) worst.keep("wall " + wall.name, depthInFacets(body, wall.surface, 0.25*shortestSide(body)), minGap);
    const auto keepClearOf = [&](const ShapeAtPose& other)
    {
        if (!isEnough()) worst.keep(other.name, -gap(body, other, std::max(minGap, 0.0) + 1e-6), minGap);
    };
    for (const auto& structure : obstacles.shapes) keepClearOf(structure);
    for (const auto& other : obstacles.bodies)
        if (withBodies) keepClearOf(other);
    for (int d = 0; d < 3; ++d)
    {
        // the sides of the box may be open boundaries: a body must be inside, but owes them no gap
        if (obstacles.checkBox[d]) keepOutside(d, std::min(minGap, 0.0));
    }
    return worst.found();
}

/// Edges included, corners not.
void addPointsOfStrip(std::vector<Vec3>& points, const Strip& strip, double spacing)
{
    const int n = strip.rows(spacing);
    for (int i = 0; i < n; ++i)
    {
        const auto [begin, end] = strip.row(static_cast<double>(i)/n);
        const int m = std::max(1, static_cast<int>(std::ceil((end - begin).norm()/spacing)));
        for (int j = 0; j <= m; ++j)
            if (i > 0 || (j > 0 && j < m)) points.push_back(begin + (end - begin)*(static_cast<double>(j)/m));
    }
}

} // namespace

double coordinateRoundOff(const std::array<Vec3, 2>& box)
{
    constexpr double operations = 16;
    return operations*std::numeric_limits<double>::epsilon()*std::max(box[0].cwiseAbs().maxCoeff(), box[1].cwiseAbs().maxCoeff());
}

std::vector<Vec3> pointsOnSurface(const TriSurface& surface, double spacing)
{
    std::vector<Vec3> points = surface.points;
    for (const auto& t : surface.triangles)
    {
        const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
        if (const Strip strip(a, b, c); strip.isNarrow())
        {
            addPointsOfStrip(points, strip, spacing);
            continue;
        }
        const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
        const int n = std::max(1, static_cast<int>(std::ceil(longest/spacing)));
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j)
            {
                const bool isCorner = (i == 0 && j == 0) || i == n || j == n;
                if (!isCorner) points.push_back(a + (b - a)*(static_cast<double>(i)/n) + (c - a)*(static_cast<double>(j)/n));
            }
    }
    return points;
}

SampledShape::SampledShape(std::shared_ptr<const Shape> shape, double spacing)
:
    shape_(std::move(shape)), points_(pointsOnSurface(shape_->surface(spacing), spacing))
{}

std::array<Vec3, 2> ShapeAtPose::spaceBounds() const
{
    const auto [lower, upper] = shape->shape().bounds();
    const Eigen::Matrix3d rotation = pose.orientation.toRotationMatrix();
    const Vec3 centre = pose.position + rotation*(0.5*(lower + upper));
    const Vec3 half = rotation.cwiseAbs()*(0.5*(upper - lower));
    return {Vec3(centre - half), Vec3(centre + half)};
}

Vec3 ShapeAtPose::inFrame(const Vec3& x) const { return pose.orientation.conjugate()*(x - pose.position); }

double ShapeAtPose::distance(const Vec3& x) const
{
    return shape->shape().distance(inFrame(x));
}

double gap(const ShapeAtPose& a, const ShapeAtPose& b, double farther)
{
    if (boxesApart(a.spaceBounds(), b.spaceBounds(), farther)) return farther;
    const double ofSurfaces = std::min(oneSidedGap(a, b, farther), oneSidedGap(b, a, farther));
    const double ofMiddles = std::min(gapOfMiddle(a, b), gapOfMiddle(b, a));
    return ofMiddles < 0 ? std::min(ofSurfaces, ofMiddles) : ofSurfaces;
}

std::optional<Conflict> findConflict(const ShapeAtPose& body, const Obstacles& obstacles, double minGap, bool withBodies)
{
    return worstConflict(body, obstacles, minGap, withBodies, false);
}

bool isPlaceFree(const ShapeAtPose& body, const Obstacles& obstacles, double minGap, bool withBodies)
{
    return !worstConflict(body, obstacles, minGap, withBodies, true);
}

Eigen::Quaterniond RandomNumbers::rotation()
{
    // Shoemake, "Uniform random rotations", Graphics Gems III (1992)
    const double u = uniform(), a = 2*M_PI*uniform(), b = 2*M_PI*uniform();
    return Eigen::Quaterniond(std::sqrt(u)*std::cos(b), std::sqrt(1 - u)*std::sin(a), std::sqrt(1 - u)*std::cos(a), std::sqrt(u)*std::sin(b));
}

} // namespace flotsam
