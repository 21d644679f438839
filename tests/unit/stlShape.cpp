// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/shape.hpp"
#include "geometry/planeFaces.hpp"
#include "support/near.hpp"
#include "support/polyhedra.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>
#include <stdexcept>

using namespace flotsam;

namespace
{

/// A file name of this process; removed at the end.
struct TemporaryFile
{
    std::string name = "stlShapeTest." + std::to_string(getpid()) + ".stl";
    ~TemporaryFile() { std::remove(name.c_str()); }
};

void writeBinary(const std::string& name, const TriSurface& s)
{
    std::ofstream out(name, std::ios::binary);
    const char header[80] = "solid written by a program that begins binary files like ASCII ones";
    const std::uint32_t n = static_cast<std::uint32_t>(s.triangles.size());
    out.write(header, 80).write(reinterpret_cast<const char*>(&n), 4);
    for (const auto& t : s.triangles)
    {
        float values[12] = {};
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 3; ++d) values[3 + 3 * k + d] = static_cast<float>(s.points[t[k]][d]);
        const std::uint16_t attributes = 0;
        out.write(reinterpret_cast<const char*>(values), sizeof values).write(reinterpret_cast<const char*>(&attributes), 2);
    }
}

void turnInsideOut(TriSurface& s)
{
    for (auto& t : s.triangles) std::swap(t[0], t[1]);
}

using Parts = std::vector<TriSurface>;

TriSurface turned(TriSurface s)
{
    turnInsideOut(s);
    return s;
}

TriSurface boxFrom(const Vec3& lower, const Vec3& upper) { return makeBox(0.5 * (lower + upper), upper - lower)->surface(1); }

TriSurface joined(const Parts& parts)
{
    TriSurface all;
    for (const TriSurface& part : parts)
    {
        const int start = static_cast<int>(all.points.size());
        all.points.insert(all.points.end(), part.points.begin(), part.points.end());
        for (const auto& t : part.triangles) all.triangles.push_back({t[0] + start, t[1] + start, t[2] + start});
    }
    return all;
}

std::vector<Vec3> randomPoints(double extent, int n)
{
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-extent, extent);
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.emplace_back(uniform(generator), uniform(generator), uniform(generator));
    return points;
}

} // namespace

TEST_CASE("an STL box is the box: distance, bounds, moments; ASCII, either orientation")
{
    const auto box = makeBox({0.1, -0.2, 0.3}, {1, 0.6, 0.4});
    for (const bool isTurned : {false, true})
    {
        const TemporaryFile file;
        TriSurface s = box->surface(1);
        if (isTurned) turnInsideOut(s);
        writeStl(file.name, s);
        const auto stl = makeStl(file.name);
        double worst = 0;
        for (const Vec3& x : randomPoints(1.2, 2000)) worst = std::max(worst, std::abs(stl->distance(x) - box->distance(x)));
        CHECK(worst < 1e-12);
        const VolumeMoments a = stl->moments(), b = box->moments();
        CHECK(a.volume == near(b.volume, 1e-14));
        CHECK((a.centroid - b.centroid).norm() < 1e-14);
        CHECK((a.inertia - b.inertia).norm() < 1e-14);
        CHECK((stl->bounds()[0] - box->bounds()[0]).norm() < 1e-15);
    }
}

TEST_CASE("ASCII STL in capitals")
{
    const TemporaryFile file;
    const auto box = makeBox({0.1, -0.2, 0.3}, {1, 0.6, 0.4});
    writeStl(file.name, box->surface(1));
    std::string data;
    {
        std::ifstream in(file.name);
        data.assign(std::istreambuf_iterator<char>(in), {});
    }
    for (char& c : data) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    std::ofstream(file.name) << data;
    CHECK(makeStl(file.name)->moments().volume == near(0.24, 1e-14));
}

TEST_CASE("binary STL with scale: a fine capsule has the capsule's distance and moments")
{
    const auto capsule = makeCapsule({0, 0, -0.4}, {0.1, 0.2, 0.4}, 0.3);
    const TemporaryFile file;
    TriSurface s = capsule->surface(0.02);
    for (Vec3& x : s.points) x *= 1000; // the file is in mm
    writeBinary(file.name, s);
    const auto stl = makeStl(file.name, 1e-3);
    double worst = 0;
    for (const Vec3& x : randomPoints(0.8, 2000)) worst = std::max(worst, std::abs(stl->distance(x) - capsule->distance(x)));
    CHECK(worst < 0.02 * 0.02 / 0.3);
    CHECK(stl->moments().volume == near(capsule->moments().volume, 2e-3));
}

TEST_CASE("the faces of an STL file are those of the convex polyhedron that it is, however many triangles they have")
{
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    for (const bool isBinary : {false, true})   // binary: single precision
        for (const bool isBox : {false, true})
        {
            const TemporaryFile file;
            TriSurface s = isBox ? makeBox({0.1, -0.2, 0.3}, {1, 0.6, 0.4})->surface(1) : wedgeSurface(1, 0.5, 0.7, {-0.3, -0.2, 0.1});
            for (Vec3& x : s.points) x = turned * x;
            isBinary ? writeBinary(file.name, s) : writeStl(file.name, s);
            const auto stl = makeStl(file.name);
            CHECK(stl->hasPlaneFaces());
            double distances[maxFaces], worst = 0;
            for (const Vec3& x : randomPoints(1, 2000))
            {
                REQUIRE(stl->faceDistances(x, distances) == (isBox ? 6 : 5));
                const double largest = *std::max_element(distances, distances + (isBox ? 6 : 5)), d = stl->distance(x);
                worst = std::max(worst, d < 0 ? std::abs(largest - d) : largest > d ? largest - d : 0.0);
                CHECK((largest < 0) == (d < 0));
            }
            CHECK(worst < (isBinary ? 1e-6 : 1e-12));
        }
}

TEST_CASE("the thickness of a polyhedron is that between its faces, however it lies in its frame; in 2D of the section")
{
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    const auto plank = makePlaced(makeBox(Vec3::Zero(), {1, 0.3, 0.02}), turned, {0.3, 0.1, 0});
    CHECK(planeThickness(*plank, Vec3::Zero()) == near(0.02, 1e-12));
    CHECK(planeThickness(*plank, turned * Vec3::UnitZ()) == near(0.3, 1e-12));
    const auto wedge = makeWedge(0.4, 0.3, 0.1);
    CHECK(planeThickness(*wedge, Vec3::Zero()) == near(0.1, 1e-12));
    CHECK(planeThickness(*wedge, Vec3::UnitZ()) == near(0.24, 1e-12));   // the triangle's height over its longest side
}

TEST_CASE("the largest ball in a polyhedron: its thickness for a plank, the inscribed one for others")
{
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    CHECK(largestBall(*makePlaced(makeBox(Vec3::Zero(), {1, 0.3, 0.02}), turned, {0.3, 0.1, 0})) == near(0.02, 1e-9));
    CHECK(largestBall(*makeWedge(0.4, 0.3, 1)) == near(0.2, 1e-9));     // incircle of the triangle: (0.3 + 0.4 - 0.5)/2
    CHECK(largestBall(*makeWedge(0.4, 0.3, 0.1)) == near(0.1, 1e-9));
    TriSurface tetrahedron;
    tetrahedron.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    tetrahedron.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    CHECK(largestBall(*makeClosedSurface(tetrahedron)) == near(2 / std::sqrt(3.), 1e-9));
}

TEST_CASE("STL files that are not convex or have many faces have none")
{
    const TriSurface box = boxFrom({0, 0, 0}, {1, 1, 1});
    const TriSurface dented = [&]
    {
        TriSurface s = wedgeSurface(1, 0.5, 0.7);
        s.points[3][2] += 1e-3; // the point within one of the ends
        return s;
    }();
    for (const TriSurface& s : {joined({box, boxFrom({2, 0, 0}, {3, 1, 1})}), joined({box, turned(boxFrom({0.2, 0.2, 0.2}, {0.6, 0.6, 0.6}))}), dented,
             makeCylinder({0, 0, 0}, {0, 0, 1}, 0.3)->surface(0.05)})
    {
        const TemporaryFile file;
        writeStl(file.name, s);
        double distances[maxFaces];
        CHECK(makeStl(file.name)->faceDistances(Vec3::Zero(), distances) == 0);
    }
}

TEST_CASE("the sign is right near sharp edges and corners, where face normals fail")
{
    // a spike: a thin tetrahedron; its inside is known from four planes
    TriSurface s;
    s.points = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.5, 0.6, 1}};
    s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const TemporaryFile file;
    writeStl(file.name, s);
    const auto spike = makeStl(file.name);
    int wrong = 0;
    for (const Vec3& x : randomPoints(1.2, 5000))
    {
        bool isInside = true;
        for (const auto& t : s.triangles)
        {
            const Vec3 &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
            isInside = isInside && (b - a).cross(c - a).dot(x - a) < 0;
        }
        wrong += isInside != (spike->distance(x) < 0);
    }
    CHECK(wrong == 0);
}

TEST_CASE("surfaces that enclose nothing are refused, naming the file and the edge")
{
    const TemporaryFile file;
    TriSurface s = makeBox(Vec3::Zero(), {2, 2, 2})->surface(1);
    s.triangles.pop_back();
    writeStl(file.name, s);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains(file.name.c_str()), std::runtime_error);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("the surface is open: the edge ("), std::runtime_error);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("close them in the CAD program"), std::runtime_error);

    s = makeBox(Vec3::Zero(), {2, 2, 2})->surface(1);
    std::swap(s.triangles[3][0], s.triangles[3][1]);
    writeStl(file.name, s);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("opposite orientation"), std::runtime_error);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("surfaceOrient"), std::runtime_error);

    s = makeBox(Vec3::Zero(), {2, 2, 2})->surface(1);
    s.triangles.push_back(s.triangles[0]);
    writeStl(file.name, s);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("wanted 2; one of them is there twice: surfaceClean"), std::runtime_error);

    // a corner that one triangle has elsewhere by more than what makes points one
    s = makeBox(Vec3::Zero(), {2, 2, 2})->surface(4);
    s.points.push_back(s.points[s.triangles[0][0]] + Vec3(1e-5, 0, 0));
    s.triangles[0][0] = static_cast<int>(s.points.size()) - 1;
    writeStl(file.name, s);
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("m away, and would close it: surfacePointMerge"), std::runtime_error);

    // two boxes with a common edge, with a common face
    writeStl(file.name, joined({boxFrom({-1, -1, -1}, {0, 1, 0}), boxFrom({0, -1, 0}, {1, 1, 1})}));
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("4 triangles, wanted 2; parts with a common edge or face: unite"), std::runtime_error);
    writeStl(file.name, joined({boxFrom({-1, -1, -1}, {0, 1, 1}), boxFrom({0, -1, -1}, {1, 1, 1})}));
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("parts with a common edge or face: unite"), std::runtime_error);

    // at coordinates of a map, where single precision knows half metres
    for (const Vec3& size : {Vec3(0.3, 0.3, 0.3), Vec3(10, 0.3, 10)})
    {
        s = makeBox({5.2e5, 5.6e6, 350}, size)->surface(1);
        writeBinary(file.name, s);
        CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("coordinates reach 5.6e+06 m"), std::runtime_error);
        CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("near its origin, and give its place as 'position'"), std::runtime_error);
    }

    std::ofstream(file.name) << "something else";
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("neither binary"), std::runtime_error);
    CHECK_THROWS_WITH_AS(makeStl("no/such/file.stl"), doctest::Contains("cannot be opened"), std::runtime_error);
}

TEST_CASE("closed parts that reach into each other are refused: lapped, crossed, one in the other, in a cavity's wall")
{
    const TemporaryFile file;
    const Parts lapped = {boxFrom({-0.2, -0.02, -0.025}, {0.05, 0.02, 0.025}), boxFrom({-0.05, -0.02, -0.025}, {0.2, 0.02, 0.025})};
    const Parts crossed = {boxFrom({-10, -0.02, -0.02}, {10, 0.02, 0.02}), boxFrom({-0.03, -10, -0.03}, {0.03, 10, 0.01})};
    const Parts nested = {boxFrom({-1, -1, -1}, {1, 1, 1}), boxFrom({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})};
    const Parts islandInWall = {nested[0], turned(nested[1]), boxFrom({-0.1, -0.1, 0.2}, {0.2, 0.2, 0.6})};
    const Parts cavityInAir = {nested[0], turned(boxFrom({0.5, -0.3, -0.3}, {1.5, 0.3, 0.3}))};
    const Parts balls = {makeSphere(Vec3::Zero(), 1)->surface(0.1), makeSphere({1.5, 0, 0}, 1)->surface(0.1)};
    for (const Parts& parts : {lapped, crossed, nested, islandInWall, cavityInAir, balls})
    {
        writeStl(file.name, joined(parts));
        CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains(file.name.c_str()), std::runtime_error);
        CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("closed parts reach into each other"), std::runtime_error);
    }
    writeStl(file.name, joined({nested[0], turned(boxFrom({2, 2, 2}, {2.5, 2.5, 2.5}))}));
    CHECK_THROWS_WITH_AS(makeStl(file.name), doctest::Contains("is oriented inwards"), std::runtime_error);
}

TEST_CASE("closed parts may lie apart, touch, and be cavities and islands in them: volumes add up")
{
    const TemporaryFile file;
    const TriSurface outer = boxFrom({-1, -1, -1}, {1, 1, 1}), cavity = turned(boxFrom({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
    const TriSurface island = boxFrom({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}), beside = boxFrom({1, -0.5, -0.5}, {1.5, 0.5, 0.5});
    const std::pair<Parts, double> cases[] = {{{outer, boxFrom({3, 3, 3}, {4, 4, 4})}, 9}, {{outer, beside}, 8.5}, {{outer, cavity}, 7}, {{outer, cavity, island, beside}, 7.716}};
    for (const auto& [parts, volume] : cases)
    {
        writeStl(file.name, joined(parts));
        CHECK(makeStl(file.name)->moments().volume == near(volume, 1e-12));
    }
}

TEST_CASE("a union of STL shapes counts what they share once")
{
    const TemporaryFile a, b{"stlShapeTest.b." + std::to_string(getpid()) + ".stl"};
    writeStl(a.name, boxFrom({-0.2, -0.02, -0.025}, {0.05, 0.02, 0.025}));
    writeStl(b.name, boxFrom({-0.05, -0.02, -0.025}, {0.2, 0.02, 0.025}));
    const VolumeMoments m = makeUnion({makeStl(a.name), makeStl(b.name)})->moments(), exact = makeBox(Vec3::Zero(), {0.4, 0.04, 0.05})->moments();
    CHECK(m.volume == near(exact.volume, 2e-5));
    CHECK(m.centroid.norm() < 1e-6);
    CHECK((m.inertia - exact.inertia).norm() < 2e-5 * exact.inertia.norm());
}
