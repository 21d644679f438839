// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/shape.hpp"
#include "geometry/triSurface.hpp"
#include "support/near.hpp"
#include "support/polyhedra.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

using namespace flotsam;

namespace
{

/// Distance of the two nearest spheres.
double closestPair(const std::vector<SurfaceSphere>& spheres)
{
    double closest = 1e300;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, (spheres[i].centre - spheres[j].centre).norm());
    return closest;
}

/// Each sphere touches the surface from inside, none twice.
void checkTouching(const Shape& shape, const std::vector<SurfaceSphere>& spheres)
{
    REQUIRE(!spheres.empty());
    double worst = 0;
    for (const SurfaceSphere& s : spheres) worst = std::max(worst, std::abs(shape.distance(s.centre) + s.radius));
    CHECK(worst < 1e-9);
    CHECK(closestPair(spheres) > 1e-6);
}

/// Largest way from a point of the surface to a sphere's surface.
double largestHole(const Shape& shape, const std::vector<SurfaceSphere>& spheres, double spacing)
{
    double largest = 0;
    for (const SurfacePoint& p : samplePoints(shape.surface(spacing / 4), spacing / 4))
    {
        double nearest = 1e300;
        for (const SurfaceSphere& s : spheres) nearest = std::min(nearest, (p.x - s.centre).norm() - s.radius);
        largest = std::max(largest, nearest);
    }
    return largest;
}

/// Each sphere has a neighbour within the spacing.
double loneliest(const std::vector<SurfaceSphere>& spheres)
{
    double worst = 0;
    for (const SurfaceSphere& s : spheres)
    {
        double nearest = 1e300;
        for (const SurfaceSphere& other : spheres)
            if (&other != &s) nearest = std::min(nearest, (s.centre - other.centre).norm());
        worst = std::max(worst, nearest);
    }
    return worst;
}

} // namespace

TEST_CASE("a bar gets rows of spheres on its surface only")
{
    const auto bar = makeBox(Vec3::Zero(), {0.2, 0.04, 0.04});
    const auto spheres = surfaceSpheres(*bar, 0.01, 0.01);
    // lattice of 19 x 3 x 3 without its inside
    CHECK(spheres.size() == 19 * 9 - 17);
    checkTouching(*bar, spheres);
    CHECK(loneliest(spheres) <= 0.01 * (1 + 1e-9));
    const auto thick = surfaceSpheres(*bar, 0.03, 0.05); // thicker than the bar: one row
    CHECK(thick.size() == 5);
    CHECK(thick[0].radius == near(0.02, 1e-14));
    checkTouching(*bar, thick);
}

TEST_CASE("cylinder, capsule, sphere, placed")
{
    const Vec3 end1(0.1, 0.2, 0), end2(0.4, 0.4, 0.3);
    const auto cylinder = makeCylinder(end1, end2, 0.05), capsule = makeCapsule(end1, end2, 0.05);
    for (const auto& shape : {cylinder, capsule, makePlaced(cylinder, Eigen::Quaterniond(Eigen::AngleAxisd(1, Vec3::UnitX())), {1, 0, 0})})
    {
        const auto spheres = surfaceSpheres(*shape, 0.01, 0.015);
        checkTouching(*shape, spheres);
        CHECK(loneliest(spheres) <= 0.015 * (1 + 1e-9));
        // a hole in a square lattice of 0.015: 0.0106 from the centres, 0.0146 - 0.01 from the surface; edges: sqrt(2) r - r
        CHECK(largestHole(*shape, spheres, 0.015) < 0.0065);
        const auto row = surfaceSpheres(*shape, 0.08, 0.05); // thinner than the sphere: a row on the axis
        CHECK(row[0].radius == near(0.05, 1e-14));
        checkTouching(*shape, row);
    }
    const auto one = surfaceSpheres(*makeSphere(end1, 0.07), 0.01, 0.01);
    REQUIRE(one.size() == 1);
    CHECK(one[0].radius == 0.07);
    CHECK(one[0].centre == end1);
}

TEST_CASE("thick spheres keep a cylinder round: no plane touches it later than by 3 % of its radius")
{
    const double R = 0.05;
    for (const double length : {0.02, 0.3})
        for (const auto& shape : {makeCylinder({0, 0, 0}, {0, 0, length}, R), makeCapsule({0, 0, 0}, {0, 0, length}, R)})
        {
            const auto spheres = surfaceSpheres(*shape, R / 2, R);
            checkTouching(*shape, spheres);
            double least = 1e300;
            for (int k = 0; k < 360; ++k)
            {
                const Vec3 direction(std::cos(k * M_PI / 180), std::sin(k * M_PI / 180), 0);
                double reach = 0;
                for (const SurfaceSphere& s : spheres) reach = std::max(reach, direction.dot(s.centre) + s.radius);
                least = std::min(least, reach);
            }
            CHECK(least > (length > R ? 1 - 1e-9 : 0.97) * R);    // with a row on the axis it is round
            CHECK(spheres.size() < 80);
        }
}

TEST_CASE("union: only spheres at the common surface")
{
    const auto cross = makeUnion({makeBox(Vec3::Zero(), {0.3, 0.06, 0.06}), makeBox(Vec3::Zero(), {0.06, 0.3, 0.06})});
    const auto spheres = surfaceSpheres(*cross, 0.01, 0.012);
    checkTouching(*cross, spheres);
    CHECK(largestHole(*cross, spheres, 0.012) < 0.0125);
    // two boxes lattices would hold more
    CHECK(spheres.size() < 2 * surfaceSpheres(*makeBox(Vec3::Zero(), {0.3, 0.06, 0.06}), 0.01, 0.012).size());
}

TEST_CASE("section: one layer at the rim, whatever the extent across, wherever the plane")
{
    const Vec3 size(0.3, 0.1, 0), point(0, 0, 0.4);
    const auto across = [](double x, double y, double half, double radius) { return makeCylinder({x, y, -half}, {x, y, half}, radius); };
    for (const double half : {0.005, 0.05, 2.0})
    {
        CAPTURE(half);
        const auto box = makeBox(Vec3::Zero(), size + 2 * half * Vec3::UnitZ());
        const auto spheres = sectionSpheres(*box, point, Vec3::UnitZ(), 0.025, 0.05, 0.0125);
        CHECK(spheres.size() == 12);    // 6 x 2
        for (const SurfaceSphere& s : spheres)
        {
            CHECK(s.radius == 0.025);
            CHECK(s.centre.z() == near(0.4, 1e-14));
            CHECK(std::max(std::abs(s.centre.x()) - 0.125, std::abs(s.centre.y()) - 0.025) == within(0, 1e-14));
        }
        const auto disc = sectionSpheres(*across(0.2, 0.1, half, 0.3), point, Vec3::UnitZ(), 0.075, 0.1, 0.05);
        REQUIRE(disc.size() == 1);
        CHECK(disc[0].radius == 0.3);
        CHECK((disc[0].centre - Vec3(0.2, 0.1, 0.4)).norm() < 1e-14);
        // a union, turned and moved within the plane: its parts' spheres, the rest of the box is in the disc
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
        const auto joined = makePlaced(makeUnion({box, across(0, 0, half, 0.08)}), turn, {1, 2, 0});
        const auto both = sectionSpheres(*joined, point, Vec3::UnitZ(), 0.025, 0.05, 0.0125);
        CHECK(both.size() > 5);
        CHECK(both.size() <= 13);
        for (const SurfaceSphere& s : both) CHECK(s.centre.z() == near(0.4, 1e-14));
    }
    const auto inner = sectionSpheres(*makeUnion({makeBox(Vec3::Zero(), {0.3, 0.1, 1}), across(0, 0, 0.5, 0.08)}), Vec3::Zero(), Vec3::UnitZ(), 0.025, 0.05, 0.0125);
    CHECK(inner.size() == 9);           // without the four under the disc's surface, at x = +-0.025
}

TEST_CASE("corners of boxes: in the shape's frame, each in touch with the faces that meet there; other shapes have none")
{
    constexpr double r = 0.01;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
    const auto box = makePlaced(makeBox(Vec3(0.1, 0, 0), {0.3, 0.1, 0.2}), turn, {1, 2, 0});
    const auto corners = cornerSpheres(*box, r);
    CHECK(corners.size() == 8);
    checkTouching(*box, corners);
    for (const SurfaceSphere& s : corners)
        for (int d = 0; d < 3; ++d) // at its depth below three faces
        {
            const Vec3 way = 1.01 * r * (turn * Vec3::Unit(d));
            CHECK(std::max(box->distance(s.centre + way), box->distance(s.centre - way)) == near(0.01 * r, 1e-6));
        }
    for (const SurfaceSphere& a : corners)
        for (const SurfaceSphere& b : corners)
            if (&a != &b) CHECK((a.centre - b.centre).norm() > 0.1 - 2.01 * r);
    const Vec3 point(0, 0, 0.05);
    const auto section = sectionCorners(*box, point, Vec3::UnitZ(), r);
    CHECK(section.size() == 4);
    for (const SurfaceSphere& s : section)
    {
        CHECK(s.centre.z() == near(0.05, 1e-14));
        CHECK(box->distance(s.centre) == near(-r, 1e-12));
    }
    CHECK(sectionCorners(*box, point, Vec3(0.6, 0, 0.8), r).empty());
    CHECK(cornerSpheres(*makeSphere(Vec3::Zero(), 1), r).empty());
    CHECK(cornerSpheres(*makeUnion({makeBox(Vec3::Zero(), Vec3::Ones()), makeSphere(Vec3::Zero(), 0.6)}), r).empty());
}

TEST_CASE("STL: spheres touch from inside, cover the surface, and are the same at every call")
{
    const std::string file = "surfaceSpheresTest." + std::to_string(getpid()) + ".stl";
    const double r = 0.02, spacing = 0.03;
    for (const auto& shape : {makeBox(Vec3::Zero(), {0.3, 0.1, 0.12}), makeCapsule({0, 0, 0}, {0.3, 0.1, 0}, 0.06)})
    {
        writeStl(file, shape->surface(0.03));
        const auto stl = makeStl(file);
        const auto spheres = surfaceSpheres(*stl, r, spacing), again = surfaceSpheres(*stl, r, spacing);
        checkTouching(*stl, spheres);
        for (const SurfaceSphere& s : spheres) CHECK(s.radius == near(r, 2e-6));
        CHECK(loneliest(spheres) <= spacing);
        CHECK(closestPair(spheres) >= 0.6 * spacing * (1 - 1e-12));
        CHECK(largestHole(*stl, spheres, spacing) < 0.75 * r); // sqrt(3) r - r at a corner
        REQUIRE(spheres.size() == again.size());
        for (std::size_t i = 0; i < spheres.size(); ++i) CHECK(spheres[i].centre == again[i].centre);
        MESSAGE(spheres.size() << " spheres, largest hole/r " << largestHole(*stl, spheres, spacing) / r);
    }
    writeStl(file, makeBox(Vec3::Zero(), {0.3, 0.3, 0.02})->surface(0.03)); // a plate thinner than the spheres
    const auto plate = makeStl(file);
    const auto thin = surfaceSpheres(*plate, r, spacing);
    checkTouching(*plate, thin);
    for (const SurfaceSphere& s : thin) CHECK((s.radius > 0.004 && s.radius < 0.0101));
    std::remove(file.c_str());
}

TEST_CASE("narrow triangles: as many points as their area needs, none farther apart than the spacing")
{
    const double length = 1, width = 0.01, spacing = 0.02;
    TriSurface strip;
    strip.points = {Vec3(0, 0, 0), Vec3(length, 0, 0), Vec3(0, width, 0)};
    strip.triangles = {{0, 1, 2}};
    const std::vector<SurfacePoint> points = samplePoints(strip, spacing);
    CHECK(points.size() < 1.1 * length / spacing);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) CHECK((points[i + 1].x - points[i].x).norm() < spacing * (1 + 1e-9));
    for (const SurfacePoint& p : points)
    {
        CHECK(p.normal == Vec3::UnitZ());
        CHECK(p.x[1] > 0);
        CHECK(p.x[1] / width + p.x[0] / length < 1);
    }
}

TEST_CASE("senseless radius or spacing")
{
    CHECK_THROWS_AS(surfaceSpheres(*makeSphere(Vec3::Zero(), 1), 0, 1), std::runtime_error);
    CHECK_THROWS_AS(surfaceSpheres(*makeSphere(Vec3::Zero(), 1), 1, 0), std::runtime_error);
}
