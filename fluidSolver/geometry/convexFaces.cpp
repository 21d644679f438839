// SPDX-License-Identifier: GPL-3.0-or-later
/// Which triangulated surfaces are convex polyhedra of few faces: containers, wedges, sills and weirs drawn in a CAD program. Cut by their faces they keep edges and volume. Sizes of polyhedra.
#include "geometry/planeFaces.hpp"
#include "geometry/triSurface.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flotsam
{
namespace
{

/// A face as it is put together from triangles.
struct Face
{
    Vec3 point, normal;             // of its largest triangle, unit
    Vec3 area = Vec3::Zero();       // vector, twice
    double moment = 0;              // sum of twice the areas times the planes' distances from the origin

    double height(const Vec3& x) const { return normal.dot(x - point); }
};

/// Empty: more than maxFaces.
std::vector<Face> joinFacets(const TriSurface& surface, double tolerance)
{
    std::vector<Face> faces;
    for (const Facet& facet : largestFirst(surface))
    {
        const double twiceArea = facet.area.norm();
        const auto contains = [&](const Face& face)
        {
            return std::all_of(facet.corners.begin(), facet.corners.end(), [&](const Vec3& x) { return std::abs(face.height(x)) < tolerance; });
        };
        auto face = std::find_if(faces.begin(), faces.end(), contains);
        if (face == faces.end())
        {
            if (faces.size() == maxFaces) return {};
            face = faces.insert(faces.end(), Face{facet.corners[0], facet.area / twiceArea, Vec3::Zero(), 0});
        }
        face->area += facet.area;
        face->moment += facet.area.dot(facet.corners[0] + facet.corners[1] + facet.corners[2]) / 3;
    }
    return faces;
}

} // namespace

std::shared_ptr<const PlaneFaces> convexFaces(const TriSurface& surface)
{
    const auto [lower, upper] = boundsOf(surface);
    const double tolerance = planeTolerance * (upper - lower).norm();
    const auto result = std::make_shared<PlaneFaces>();
    for (const Face& face : joinFacets(surface, tolerance))
    {
        const double size = face.area.norm();
        result->planes.push_back({face.area / size, face.moment / size});
        const PlaneFaces::Plane& plane = result->planes.back();
        for (const Vec3& x : surface.points)
            if (!(plane.normal.dot(x) - plane.distance < tolerance)) return nullptr;
    }
    return result->planes.empty() ? nullptr : result;
}

/// Among the centres and radii (x, r) for which a ball touches four faces from inside and reaches through none is the one with the largest r: a corner of a linear programme.
double largestBall(const Shape& shape)
{
    const auto [lower, upper] = shape.bounds();
    const Vec3 centre = 0.5 * (lower + upper);
    double here[maxFaces], beside[maxFaces];
    const int n = shape.faceDistances(centre, here);
    Eigen::Matrix<double, maxFaces, 4> face;    // (normal, 1): with (x - centre, r) the negative distance of the centre at the most
    for (int d = 0; d < 3; ++d)
    {
        shape.faceDistances(centre + Vec3::Unit(d), beside);
        for (int f = 0; f < n; ++f) face(f, d) = beside[f] - here[f];
    }
    face.col(3).setOnes();
    const double slack = 1e-9 * (upper - lower).norm();
    double largest = 0;
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j)
            for (int k = j + 1; k < n; ++k)
                for (int l = k + 1; l < n; ++l)
                {
                    Eigen::Matrix4d touched;
                    touched << face.row(i), face.row(j), face.row(k), face.row(l);
                    const Eigen::FullPivLU<Eigen::Matrix4d> solver(touched);
                    if (!solver.isInvertible()) continue;
                    const Eigen::Vector4d ball = solver.solve(Eigen::Vector4d(-here[i], -here[j], -here[k], -here[l]));
                    bool isInside = true;
                    for (int f = 0; f < n; ++f) isInside = isInside && face.row(f).dot(ball) + here[f] < slack;
                    if (isInside) largest = std::max(largest, ball[3]);
                }
    return 2 * largest;
}

double planeThickness(const Shape& shape, const Vec3& across)
{
    const auto [lower, upper] = shape.bounds();
    const Vec3 centre = 0.5 * (lower + upper);
    double here[maxFaces], beside[maxFaces], values[maxFaces], deepest[maxFaces] = {};
    const int n = shape.faceDistances(centre, here);
    shape.faceDistances(centre + across, beside);
    for (const Vec3& x : shape.surface((upper - lower).norm()).points)
    {
        shape.faceDistances(x, values);
        for (int f = 0; f < n; ++f) deepest[f] = std::min(deepest[f], values[f]);
    }
    double least = std::numeric_limits<double>::infinity();
    for (int f = 0; f < n; ++f)
        if (std::abs(beside[f] - here[f]) < std::sqrt(0.5)) least = std::min(least, -deepest[f]);
    return least;
}

} // namespace flotsam
