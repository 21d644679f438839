// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triSurface.hpp"
#include "geometry/solid.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

using namespace flotsam;

namespace
{

using Matrix = Eigen::Matrix3d;

const Vec3 origin(0.3, -0.2, 0.5);
const Vec3 axis = Vec3(1, 2, -0.5).normalized();

std::vector<std::shared_ptr<const Shape>> allShapes()
{
    const auto box = makeBox(origin, {0.2, 0.4, 0.6});
    const auto capsule = makeCapsule(origin, origin + 0.5 * axis, 0.15);
    return {box,
            makeSphere(origin, 0.3),
            makeCylinder(origin - 0.4 * axis, origin + 0.4 * axis, 0.2),
            capsule,
            makePlaced(box, Eigen::Quaterniond(Eigen::AngleAxisd(1, axis)), {1, 2, 3}),
            makeUnion({box, capsule, makeSphere(origin + Vec3(2, 0, 0), 0.1)})};
}

void checkMoments(const Shape& shape, double volume, const Vec3& centroid, const Matrix& inertia, double tolerance = 1e-13)
{
    const VolumeMoments m = shape.moments();
    CHECK(std::abs(m.volume - volume) < tolerance * volume);
    CHECK((m.centroid - centroid).norm() < tolerance * (1 + centroid.norm()));
    CHECK((m.inertia - inertia).norm() < tolerance * inertia.norm());
}

/// Principal values `along` the axis and `across` it.
Matrix axial(double along, double across) { return across * Matrix::Identity() + (along - across) * axis * axis.transpose(); }

std::vector<Vec3> randomPoints(const Shape& shape, int n)
{
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-0.3, 1.3);
    const auto [lower, upper] = shape.bounds();
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i)
        points.push_back(lower + (upper - lower).cwiseProduct(Vec3(uniform(generator), uniform(generator), uniform(generator))));
    return points;
}

} // namespace

TEST_CASE("distances at known points")
{
    const auto box = makeBox(Vec3::Zero(), {2, 4, 6});
    CHECK(box->distance({0, 0, 0}) == -1);
    CHECK(box->distance({3, 0, 0}) == 2);
    CHECK(box->distance({4, 6, 3}) == near(5, 1e-14));
    CHECK(box->distance({0.5, 1.9, 0}) == near(-0.1, 1e-14));

    CHECK(makeSphere({1, 0, 0}, 0.5)->distance({1, 2, 0}) == near(1.5, 1e-14));

    const auto cylinder = makeCylinder({0, 0, -1}, {0, 0, 3}, 0.5);
    CHECK(cylinder->distance({0, 0, 1}) == near(-0.5, 1e-14));
    CHECK(cylinder->distance({0.1, 0, 2.9}) == near(-0.1, 1e-14));
    CHECK(cylinder->distance({2, 0, 0}) == near(1.5, 1e-14));
    CHECK(cylinder->distance({3.5, 0, 7}) == near(5, 1e-14));

    const auto capsule = makeCapsule({0, 0, 0}, {0, 0, 1}, 0.25);
    CHECK(capsule->distance({0, 0, 2}) == near(0.75, 1e-14));
    CHECK(capsule->distance({1, 0, 0.3}) == near(0.75, 1e-14));

    const auto both = makeUnion({box, cylinder});
    CHECK(both->distance({4, 6, 3}) == near(5, 1e-14));
    CHECK(both->distance({0.9, 0, 0}) == near(-0.1, 1e-14));
}

TEST_CASE("the distance changes by at most the way, and is zero on the surface's points")
{
    for (const auto& shape : allShapes())
    {
        const std::vector<Vec3> points = randomPoints(*shape, 200);
        for (std::size_t i = 1; i < points.size(); ++i)
            CHECK(std::abs(shape->distance(points[i]) - shape->distance(points[i - 1])) <= (points[i] - points[i - 1]).norm() * (1 + 1e-12));
        for (const Vec3& x : shape->surface(0.1).points) CHECK(shape->distance(x) < 1e-14);
    }
}

TEST_CASE("moments against closed formulas")
{
    const double r = 0.2, l = 0.8;
    checkMoments(*makeBox(origin, {1, 2, 3}), 6, origin, Vec3(4 + 9, 1 + 9, 1 + 4).asDiagonal() * Matrix(Matrix::Identity() * 0.5));
    const double ball = 4 * M_PI / 3 * r * r * r;
    checkMoments(*makeSphere(origin, r), ball, origin, 0.4 * ball * r * r * Matrix::Identity());
    const double rod = M_PI * r * r * l;
    checkMoments(*makeCylinder(origin, origin + l * axis, r), rod, origin + 0.5 * l * axis,
                 axial(rod * r * r / 2, rod * (3 * r * r + l * l) / 12));
    // two half balls: 83/320 m r^2 about their centroid, which is 3/8 r off the flat side
    const double across = rod * (3 * r * r + l * l) / 12 + ball * (83.0 / 320 * r * r + std::pow(l / 2 + 3 * r / 8, 2));
    checkMoments(*makeCapsule(origin, origin + l * axis, r), rod + ball, origin + 0.5 * l * axis,
                 axial(rod * r * r / 2 + 0.4 * ball * r * r, across));
}

TEST_CASE("moments of placed shapes move and turn with them")
{
    const auto cylinder = makeCylinder({0, 0, -0.4}, {0, 0, 0.4}, 0.2);
    const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis);
    const VolumeMoments m = makeCylinder(origin - 0.4 * axis, origin + 0.4 * axis, 0.2)->moments();
    checkMoments(*makePlaced(cylinder, q, origin), m.volume, m.centroid, m.inertia);
}

TEST_CASE("moments of unions: exact without overlap, close to exact with")
{
    const auto whole = makeBox(Vec3::Zero(), {1, 0.4, 0.2});
    const VolumeMoments m = whole->moments();
    const auto touching = makeUnion({makeBox({-0.3, 0, 0}, {0.4, 0.4, 0.2}), makeBox({0.2, 0, 0}, {0.6, 0.4, 0.2})});
    checkMoments(*touching, m.volume, m.centroid, m.inertia);
    const auto overlapping = makeUnion({makeBox({-0.2, 0, 0}, {0.6, 0.4, 0.2}), makeBox({0.2, 0, 0}, {0.6, 0.4, 0.2})});
    checkMoments(*overlapping, m.volume, m.centroid, m.inertia, 1e-3);
    // a ball half inside another of the same size: union = 2 balls - lens
    const double r = 0.3, d = 0.3, lens = M_PI * (4 * r + d) * std::pow(2 * r - d, 2) / 12;
    const VolumeMoments balls = makeUnion({makeSphere(Vec3::Zero(), r), makeSphere({d, 0, 0}, r)})->moments();
    CHECK(balls.volume == near(8 * M_PI / 3 * r * r * r - lens, 5e-5));
    CHECK(balls.centroid[0] == near(d / 2, 1e-12));
}

TEST_CASE("surfaces are closed, outward, and enclose the shape's volume to the order of the facets")
{
    for (const auto& shape : allShapes())
    {
        const TriSurface s = shape->surface(0.02);
        std::map<std::pair<int, int>, int> edges;
        for (const auto& t : s.triangles)
            for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
        bool isClosed = true;
        for (const auto& [edge, uses] : edges) isClosed = isClosed && uses == 1 && edges.count({edge.second, edge.first}) == 1;
        CHECK(isClosed);
    }
    for (int i = 0; i < 5; ++i) // the union's surface holds the hidden parts twice
    {
        const auto shape = allShapes()[i];
        const VolumeMoments exact = shape->moments(), facets = enclosedMoments(shape->surface(0.02));
        CHECK(facets.volume == near(exact.volume, 3e-3));
        CHECK((facets.centroid - exact.centroid).norm() < 1e-12);
        CHECK((facets.inertia - exact.inertia).norm() < 6e-3 * exact.inertia.norm());
    }
}

TEST_CASE("surfaces of long thin shapes are closed, too, enclose what they should, and have no needles; those of others have no more triangles than they need")
{
    for (const auto& shape : {makeBox(Vec3::Zero(), Vec3(10, 0.005, 0.002)), makeBox(Vec3::Zero(), Vec3(0.004, 10, 20)), makeCylinder(Vec3::Zero(), Vec3(0, 3, 4), 0.002),
        makeCapsule(Vec3::Zero(), Vec3(5, 0, 0), 0.001)})
    {
        const TriSurface s = shape->surface(0.25*0.002);
        std::map<std::pair<int, int>, int> edges;
        double flattest = 1e300;
        for (const auto& t : s.triangles)
        {
            const Vec3 &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
            std::array<double, 3> sides{(b - a).norm(), (c - b).norm(), (a - c).norm()};
            std::sort(sides.begin(), sides.end());
            flattest = std::min(flattest, (b - a).cross(c - a).norm()/(sides[1]*sides[2]));    // sine of the smallest angle
            for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
        }
        CHECK(flattest > 1.05e-3);
        CHECK(std::all_of(edges.begin(), edges.end(), [&](const auto& e) { return e.second == 1 && edges.count({e.first.second, e.first.first}) == 1; }));
        CHECK(enclosedMoments(s).volume == near(shape->moments().volume, 0.05));
    }
    CHECK(makeBox(Vec3::Zero(), Vec3(1, 0.1, 0.01))->surface(0.01).triangles.size() == 12);
}

TEST_CASE("facets follow curved shapes: the sagitta is that of a chord no longer than asked")
{
    const double size = 0.05, smallestRadius[] = {0.3, 0.2, 0.15};
    for (int i = 1; i < 4; ++i)
    {
        const auto shape = allShapes()[i];
        const TriSurface s = shape->surface(size);
        double deepest = 0; // below the surface, at the middles of edges: straight lines of a cylinder may be long
        for (const auto& t : s.triangles)
            for (int k = 0; k < 3; ++k) deepest = std::max(deepest, -shape->distance(0.5 * (s.points[t[k]] + s.points[t[(k + 1) % 3]])));
        const double r = smallestRadius[i - 1];
        CHECK(deepest > 0);
        CHECK(deepest <= (r - std::sqrt(r * r - size * size / 4)) * (1 + 1e-9));
    }
}

TEST_CASE("plane sections")
{
    CHECK(sectionArea(makeBox(Vec3::Zero(), {1, 2, 3})->surface(1), {0, 0, 0.2}, Vec3::UnitZ()) == near(2, 1e-14));
    CHECK(sectionArea(makeSphere(Vec3::Zero(), 0.5)->surface(0.01), {0, 0, 0.3}, Vec3::UnitZ()) == near(M_PI * 0.16, 2e-4));
    // the plane's point far away in it: a body at coordinates of a map, seen from the frame of the mesh (1e-3 off when summed about that point)
    CHECK(sectionArea(makeBox(Vec3::Zero(), {0.1, 0.2, 3})->surface(1), {5e5, 5.6e6, 0.2}, Vec3::UnitZ()) == near(0.02, 1e-12));
}

TEST_CASE("bounds hold the shape; a solid's bounds turn with it")
{
    for (const auto& shape : allShapes())
    {
        Solid solid;
        solid.shape = shape;
        solid.pose.position = {1, -2, 0.5};
        solid.pose.orientation = Eigen::AngleAxisd(0.7, Vec3(1, 1, 0).normalized());
        const auto [lower, upper] = shape->bounds();
        const auto [spaceLower, spaceUpper] = solid.spaceBounds();
        for (const Vec3& x : shape->surface(0.02).points)
        {
            CHECK(((x - lower).minCoeff() > -1e-12 && (upper - x).minCoeff() > -1e-12));
            const Vec3 y = solid.pose.position + solid.pose.orientation * x;
            CHECK(((y - spaceLower).minCoeff() > -1e-12 && (spaceUpper - y).minCoeff() > -1e-12));
            CHECK(solid.distance(y) < 1e-12);
        }
    }
}

TEST_CASE("senseless sizes are refused")
{
    CHECK_THROWS_WITH_AS(makeBox(Vec3::Zero(), {1, 0, 1}), doctest::Contains("size of a box must be positive"), std::runtime_error);
    CHECK_THROWS_AS(makeSphere(Vec3::Zero(), -1), std::runtime_error);
    CHECK_THROWS_AS(makeCylinder(Vec3::Zero(), Vec3::Zero(), 1), std::runtime_error);
    CHECK_THROWS_AS(makeUnion({}), std::runtime_error);
}
