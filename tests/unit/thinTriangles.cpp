// SPDX-License-Identifier: GPL-3.0-or-later
/// Thin triangles of surfaces that bodies touch: divided, they are the same surface, without angles that the contact engine refuses.
#include "geometry/closestPoint.hpp"
#include "geometry/thinTriangles.hpp"
#include "geometry/triSurface.hpp"
#include "support/near.hpp"
#include "support/prism.hpp"

#include <doctest/doctest.h>

#include <map>

using namespace flotsam;

namespace
{

constexpr std::size_t most = 1000000;

double distanceTo(const TriSurface& s, const Vec3& p)
{
    double nearest = 1e300;
    for (const auto& t : s.triangles) nearest = std::min(nearest, (closestPointOfTriangle(p, s.points[t[0]], s.points[t[1]], s.points[t[2]]) - p).norm());
    return nearest;
}

double areaOf(const TriSurface& s)
{
    double area = 0;
    for (const auto& t : s.triangles) area += 0.5*(s.points[t[1]] - s.points[t[0]]).cross(s.points[t[2]] - s.points[t[0]]).norm();
    return area;
}

int needlesOf(const TriSurface& s)
{
    int count = 0;
    for (const auto& t : s.triangles) count += ThinTriangle(s.points[t[0]], s.points[t[1]], s.points[t[2]]).isRefused;
    return count;
}

/// Largest distance of points of the one surface, borders of its triangles included, from the other.
double farthest(const TriSurface& from, const TriSurface& to, int parts)
{
    double largest = 0;
    for (const auto& t : from.triangles)
        for (int i = 0; i <= parts; ++i)
            for (int j = 0; i + j <= parts; ++j)
            {
                const double u = double(i)/parts, v = double(j)/parts;
                largest = std::max(largest, distanceTo(to, (1 - u - v)*from.points[t[0]] + u*from.points[t[1]] + v*from.points[t[2]]));
            }
    return largest;
}

/// With points within 1e-9 as one.
TriSurface merged(TriSurface s)
{
    std::map<std::array<long, 3>, int> numbers;
    for (auto& t : s.triangles)
        for (int& i : t)
        {
            const Vec3 x = (s.points[i]*1e9).array().round();
            i = numbers.emplace(std::array<long, 3>{long(x[0]), long(x[1]), long(x[2])}, i).first->second;
        }
    return s;
}

bool isClosed(const TriSurface& s)
{
    std::map<std::pair<int, int>, int> uses;
    for (const auto& t : s.triangles)
        for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    return std::all_of(uses.begin(), uses.end(), [&](const auto& e) { return e.second == 1 && uses.count({e.first.second, e.first.first}) == 1; });
}

void turn(TriSurface& s, Random& random)
{
    const Eigen::Quaterniond q = random.turn();
    for (Vec3& x : s.points) x = q*x + Vec3(3, -2, 1);
}

} // namespace

TEST_CASE("a triangle of any shape is covered by its pieces, in its plane, over its edges by 0.71 of the narrowest width at most")
{
    Random random(1);
    std::size_t mostOfOne = 0;
    int divided = 0;
    for (int i = 0; i < 3000; ++i)
    {
        CAPTURE(i);
        const double width = random.logBetween(1.1e-5, 3e-3), shares[] = {0, random.logBetween(1e-9, 0.5), 0.5, random.between(0, 1), 1};
        TriSurface s;
        s.points = {{0, 0, 0}, {1, 0, 0}, {shares[i % 5], width, 0}, {0.5, 0, 0}};
        s.triangles = {{i % 3, (i + 1) % 3, (i + 2) % 3}};
        turn(s, random);
        const double extent = extentOf(s);
        const ThinTriangle thin(s.points[0], s.points[1], s.points[2]);
        if (thin.isRefused && thin.isNegligible(extent)) continue;
        const DividedSurface d = divideThinTriangles(s, most);
        divided += int(d.divided);
        mostOfOne = std::max(mostOfOne, d.pieces);
        REQUIRE(d.surface.triangles.size() == (d.divided ? d.pieces : 1));
        CHECK((d.divided == 1) == thin.isRefused);
        CHECK(needlesOf(d.surface) == 0);
        CHECK(farthest(s, d.surface, 40) < 1e-10);
        const Vec3 normal = (s.points[1] - s.points[0]).cross(s.points[2] - s.points[0]).normalized();
        double off = 0, over = 0, turned = 0;
        for (const auto& t : d.surface.triangles)
        {
            const Vec3 area = (d.surface.points[t[1]] - d.surface.points[t[0]]).cross(d.surface.points[t[2]] - d.surface.points[t[0]]);
            turned = std::max(turned, (area.normalized() - normal).norm());
            for (int c : t)
            {
                off = std::max(off, std::abs(normal.dot(d.surface.points[c] - s.points[0])));
                over = std::max(over, distanceTo(s, d.surface.points[c]));
            }
        }
        CHECK(off < 1e-10);
        CHECK(turned < 1e-7);
        CHECK(over < 0.71*narrowestWallTriangle*extent);
        CHECK(areaOf(d.surface) > areaOf(s)*(1 - 1e-9));
        CHECK(areaOf(d.surface) < areaOf(s) + narrowestWallTriangle*extent);
    }
    CHECK(divided > 1000);
    CHECK(mostOfOne <= 242);
    CHECK(mostOfOne > 150);
}

TEST_CASE("plane strips of two triangles, straight, tapered and cut askew, are divided exactly, into as few pieces as their widths ask for")
{
    Random random(2);
    for (int i = 0; i < 500; ++i)
    {
        CAPTURE(i);
        const double width = random.logBetween(2e-5, 8e-4), taper = random.between(0.7, 1), askew = random.between(-0.6, 0.6);
        TriSurface s;
        s.points = {{0, 0, 0}, {1, 0, 0}, {1 + askew*width, taper*width, 0}, {-askew*width, width, 0}};
        s.triangles = i % 2 ? std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}} : std::vector<std::array<int, 3>>{{0, 1, 3}, {1, 2, 3}};
        turn(s, random);
        const DividedSurface d = divideThinTriangles(s, most);
        CHECK(d.divided == 2);
        CHECK(needlesOf(d.surface) == 0);
        CHECK(areaOf(d.surface) == near(areaOf(s), 1e-8));
        CHECK(farthest(s, d.surface, 20) < 1e-10);
        CHECK(farthest(d.surface, s, 2) < 3e-7); // closestPointOfTriangle() in a needle
        CHECK(d.pieces <= 2*std::ceil(1/(840*taper*width)));
    }
}

TEST_CASE("two needles that lie on each other are no strip")
{
    TriSurface s;
    s.points = {{0, 0, 0}, {1, 0, 0}, {1, 2e-4, 0}, {0, -2e-4, 0}};
    s.triangles = {{0, 1, 2}, {0, 2, 3}};
    const DividedSurface d = divideThinTriangles(s, most);
    CHECK(needlesOf(d.surface) == 0);
    CHECK(farthest(s, d.surface, 40) < 1e-10);
    CHECK(areaOf(d.surface) > areaOf(s));
    CHECK(areaOf(d.surface) < areaOf(s) + 2*narrowestWallTriangle);
}

TEST_CASE("prisms with sides of 1e3 to 5e4 times their width stay closed and the same, without neighbours that are divided, too")
{
    for (int n : {4, 24, 90})
        for (const double aspect : {1e3, 1e4, 5e4})
        {
            CAPTURE(n);
            CAPTURE(aspect);
            const TriSurface s = prism(circle(n, 0.5/std::sin(M_PI/n)/aspect), Vec3(0, 0, 1));
            const DividedSurface d = divideThinTriangles(s, most);
            CHECK(d.divided == std::size_t(2*n));
            CHECK(needlesOf(d.surface) == 0);
            CHECK(isClosed(s));
            CHECK(isClosed(merged(d.surface))); // cuts of neighbours meet: no point lies within an edge
            CHECK(d.surface.triangles.size() == s.triangles.size() - 2*n + d.pieces);
            CHECK(areaOf(d.surface) == near(areaOf(s), 1e-8));
            CHECK(enclosedMoments(d.surface).volume == near(enclosedMoments(s).volume, 1e-8));
            CHECK(d.pieces == std::size_t(2*n*std::ceil(1.0/(0.85/needleAngle)*aspect)));
        }
}

TEST_CASE("fans of thousands of needles leave no hole in their middle")
{
    const TriSurface s = prism(circle(8000, 0.5), Vec3(0, 0, 0.1));
    const DividedSurface d = divideThinTriangles(s, most);
    REQUIRE(d.pieces < most);
    CHECK(d.divided > 15000);
    CHECK(d.leftOut < 100);
    CHECK(needlesOf(d.surface) == 0);
    Random random(3);
    double farthest = 0;
    for (int i = 0; i < 100; ++i)
    {
        const double r = random.logBetween(1e-4, 0.3), angle = random.between(0.5*M_PI, 1.5*M_PI); // around the corner of the fan
        const Vec3 x(0.5 + r*std::cos(angle), r*std::sin(angle), 0);
        if (x.norm() < 0.49995) farthest = std::max(farthest, distanceTo(d.surface, x));
    }
    CHECK(farthest < 1e-5);
}

TEST_CASE("random collapses of a closed surface: what is not negligible is covered, and nothing is added")
{
    Random random(4);
    int divided = 0;
    for (int i = 0; i < 40; ++i)
    {
        CAPTURE(i);
        TriSurface s = collapsed(prism(circle(7, 1), Vec3(0.1, 0.2, 3)), random);
        turn(s, random);
        const double extent = extentOf(s);
        const DividedSurface d = divideThinTriangles(s, most);
        divided += int(d.divided);
        CHECK(isClosed(s));
        CHECK(needlesOf(d.surface) == 0);
        CHECK(d.pieces <= 242*d.divided);
        CHECK(d.surface.triangles.size() == s.triangles.size() - d.divided - d.leftOut + d.pieces);
        CHECK(farthest(s, d.surface, 20) < narrowestWallTriangle*extent);
        CHECK(farthest(d.surface, s, 2) < 0.71*narrowestWallTriangle*extent);
        if (d.leftOut == 0) CHECK(farthest(s, d.surface, 20) < 1e-9);
    }
    CHECK(divided > 40);
}

TEST_CASE("surfaces without needles stay as they are, and division ends with more pieces than asked for")
{
    const TriSurface box = boxSurface(Vec3::Zero(), Vec3(1, 2, 3)), bar = prism(circle(90, 0.001), Vec3(0, 0, 1));
    const DividedSurface same = divideThinTriangles(box, most);
    CHECK(same.surface.triangles == box.triangles);
    CHECK(same.surface.points == box.points);
    CHECK(same.pieces == 0);
    const std::size_t all = divideThinTriangles(bar, most).pieces, few = divideThinTriangles(bar, 1000).pieces;
    CHECK(all > 1500);
    CHECK(few > 1000);
    CHECK(few < 1300);
}
