// SPDX-License-Identifier: GPL-3.0-or-later
/// constant/bodies: contact spheres of shapes with thin and thick parts.
#include "demCoupling/foam/bodyPlacement.hpp"
#include "support/bodiesScene.H"
#include "support/near.hpp"
#include "support/polyhedra.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

using namespace flotsam;

/// An STL file of what turns round the x axis, twelve-sided: (x, radius) from end to end.
void writeTurned(const std::string& file, const std::vector<std::array<double, 2>>& profile)
{
    constexpr int n = 12;
    std::ofstream out(file);
    out << "solid turned\n";
    const auto at = [&](std::size_t k, int j) { return Vec3(profile[k][0], profile[k][1]*std::cos(2*M_PI*(j % n)/n), profile[k][1]*std::sin(2*M_PI*(j % n)/n)); };
    const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c)
    {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& x : {a, b, c}) out << "vertex " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
        out << "endloop\nendfacet\n";
    };
    const std::size_t last = profile.size() - 1;
    for (int j = 0; j < n; ++j)
    {
        facet(Vec3(profile[0][0], 0, 0), at(0, j + 1), at(0, j));
        facet(Vec3(profile[last][0], 0, 0), at(last, j), at(last, j + 1));
        for (std::size_t k = 0; k < last; ++k)
        {
            facet(at(k, j), at(k, j + 1), at(k + 1, j + 1));
            facet(at(k, j), at(k + 1, j + 1), at(k + 1, j));
        }
    }
    out << "endsolid turned\n";
}

TEST_CASE("the trunk of an STL log with a root wad has contact spheres all along")
{
    BodiesScene s;
    const std::string folder = s.foam.folder() + "/constant/triSurface/";
    if (s.halo.rank() == 0)
    {
        std::filesystem::create_directories(folder);
        writeTurned(folder + "log.stl", {{{0, 0.08}}, {{0.04, 0.08}}, {{0.04, 0.02}}, {{0.4, 0.02}}});
        writeTurned(folder + "drum.stl", {{{0, 0.08}}, {{0.16, 0.08}}});
    }
    MPI_Barrier(MPI_COMM_WORLD);
    const auto read = [&](const std::string& file) { return s.read(bodies("shape { type stl; file \"" + file + "\"; } density 600; position (0.5 0.5 0.2);")).bodies[0]; };
    const BodyDefinition log = read("log.stl");
    CHECK(log.thinnest < 0.08);
    CHECK(log.thinnest > 0.02);
    double longest = 0;     // way along the trunk to the next sphere
    for (double x = 0.05; x <= 0.4; x += 0.01)
    {
        double nearest = 1e300;
        for (const SurfaceSphere& sphere : log.spheres) // at x along the log in the frame of the file
            nearest = std::min(nearest, std::abs((log.pose.orientation*sphere.centre + log.pose.position)[0] - 0.5 - x) - sphere.radius);
        longest = std::max(longest, nearest);
    }
    CHECK(longest < 0.01);
    CHECK(read("drum.stl").thinnest == near(0.16, 0.02*0.16)); // stout ones keep theirs
}

TEST_CASE("acute edges of an STL file do not ask for ever smaller spheres: half as large as the ball that it holds")
{
    BodiesScene s;
    const std::string folder = s.foam.folder() + "/constant/triSurface/";
    if (s.halo.rank() == 0)
    {
        std::filesystem::create_directories(folder);
        writeStl(folder + "wedge.stl", wedgeSurface(0.4, 0.1, 0.2));
    }
    MPI_Barrier(MPI_COMM_WORLD);
    const BodyDefinition wedge = s.read(bodies("shape { type stl; file \"wedge.stl\"; } density 600; position (0.5 0.5 0.2);")).bodies[0];
    const double ball = 0.4 + 0.1 - std::hypot(0.4, 0.1); // diameter of the triangle's incircle
    CHECK(wedge.thinnest == near(ball, 1e-4));
    CHECK(wedge.spheres[0].radius == near(0.25*ball, 1e-4));
    CHECK(wedge.spheres.size() < 500);   // by what is left bare at the edges 8 times as small: 64 times as many
}

/// Whether a ball of that radius inside the shape touches the surface at x: no edge.
bool isFlat(const Shape& shape, const Vec3& x, double radius)
{
    Vec3 normal;
    for (int d = 0; d < 3; ++d) normal[d] = shape.distance(x + 1e-6*Vec3::Unit(d)) - shape.distance(x - 1e-6*Vec3::Unit(d));
    return shape.distance(x - radius*normal.normalized()) < -radius*(1 - 1e-4);
}

TEST_CASE("the spheres of a thin body do not get between those of a thick one")
{
    BodiesScene s;
    const std::vector<std::string> thick{"type box; size (0.3 0.1 0.12);", "type cylinder; end1 (-0.15 0 0); end2 (0.15 0 0); radius 0.05;",
        "type union; parts { a { type box; size (0.3 0.1 0.1); } b { type box; size (0.1 0.25 0.1); } }",
        "type union; parts { trunk { type cylinder; end1 (0 0 0); end2 (0.4 0 0); radius 0.05; } wad { type cylinder; end1 (0 0 0); end2 (0.1 0 0); radius 0.15; } }"};
    for (const std::string& shape : thick)
        for (const double thinner : {1.0, 1.5, 2.0, 4.0, 7.0, 12.0, 25.0})
        {
            CAPTURE(shape);
            CAPTURE(thinner);
            if (thinner > 20 && shape.find("union") != std::string::npos) continue;     // would need more than 4000
            const BodiesInput input = s.read("bodies { thick { shape { " + shape + " } density 600; position (1 0.5 0.2); } thin { shape { type box; size (0.2 "
                + std::to_string(0.1/thinner) + " 0.1); } density 600; position (0.3 0.5 0.2); } }");
            const BodyDefinition& body = input.bodies[0];
            const double radius = input.bodies[1].spheres[0].radius;
            double farthest = 0; // from a point of the surface, where the centre of a sphere would enter, to the nearest sphere of the thick body; over both radii
            for (const Vec3& x : pointsOnSurface(body.shape->surface(0.01), 0.003))
            {
                if (!isFlat(*body.shape, x, body.spheres[0].radius)) continue;
                double nearest = 1e300;
                for (const SurfaceSphere& b : body.spheres) nearest = std::min(nearest, (x - b.centre).norm()/(b.radius + radius));
                farthest = std::max(farthest, nearest);
            }
            CHECK(farthest < 1);
        }
}

TEST_CASE("bodies that a stored state knows keep their spheres when thinner ones join them, structures that move as well")
{
    BodiesScene s;
    const std::string structures = "structures { arm { shape { type cylinder; end1 (0 0 0.1); end2 (0 0 0.3); radius 0.1; } position (1.5 0.5 0); motion { type linear; velocity (0.1 0 0); } } } ";
    const std::string thick = "log { shape { type box; size (0.3 0.1 0.12); } density 600; array { count (1 1 2); spacing (0 0 0.15); } position (1 0.5 0.1); } "
                              "pile { shape { type sphere; radius 0.06; } density 600; position (0.7 0.3 0.2); } ";
    const std::string thin = "stick { shape { type box; size (0.2 0.01 0.01); } density 600; position (0.3 0.5 0.2); } ";
    const BodiesInput before = s.read(structures + "bodies { " + thick + "}");
    StoredFinest stored;
    for (const BodyDefinition& body : before.bodies) stored["body " + body.name] = body.finest;
    stored["structure arm"] = before.movers[0].finest;
    const auto read = [&](const StoredFinest& known)
    { return readBodies(parse(structures + "bodies { " + thin + thick + "}"), s.foam.mesh(), s.adapter.mesh, s.halo, Vec3(0, -9.81, 0), known); };
    const BodiesInput anew = read({}), goesOn = read(stored);
    REQUIRE(anew.bodies[1].spheres.size() > before.bodies[0].spheres.size());
    for (const std::size_t k : {0, 1, 2})
    {
        CHECK(goesOn.bodies[k + 1].name == before.bodies[k].name);
        CHECK(goesOn.bodies[k + 1].spheres.size() == before.bodies[k].spheres.size());
    }
    CHECK(goesOn.movers[0].spheres.size() == before.movers[0].spheres.size());
    CHECK(goesOn.bodies[0].spheres.size() == anew.bodies[0].spheres.size());
    CHECK(goesOn.bodies[0].finest < goesOn.bodies[1].finest);
}

TEST_CASE("spheres of a union are as fine as its thinnest part demands")
{
    BodiesScene s;
    const auto finest = [&](const std::string& shape)
    {
        const BodiesInput input = s.read(bodies("shape { " + shape + " } density 600; position (1 0.5 0.2);"));
        double radius = 1e300;
        for (const SurfaceSphere& sphere : input.bodies[0].spheres) radius = std::min(radius, sphere.radius);
        return radius;
    };
    const std::string trunk = "type cylinder; end1 (0 0 0); end2 (0.3 0 0); radius 0.02;", wad = "type cylinder; end1 (-0.1 0 0); end2 (0.1 0 0); radius 0.1;";
    CHECK(finest(trunk) == near(0.01, 1e-14));
    CHECK(finest(wad) == near(0.05, 1e-14));
    CHECK(finest("type union; parts { a { " + trunk + " } b { " + wad + " } }") == near(0.01, 1e-14));
    // a root that points aslant: its bounding box is no measure of its thickness
    CHECK(finest("type union; parts { a { type cylinder; end1 (0 0 0); end2 (0.1 0.1 0.1); radius 0.02; } b { " + wad + " } }") == near(0.01, 1e-14));
    CHECK(has(s.message(bodies("shape { type union; parts { a { " + trunk + " } b { " + wad + " } } } density 600; spheres { radius 0.03; }")), "smallest extent is 0.04 m"));
}

TEST_CASE("contact spheres that would fill the memory are refused before they are made")
{
    BodiesScene s;
    const std::string cube = "shape { type box; size (0.1 0.1 0.1); } density 600; position (1 0.5 0.2); ";
    CHECK(has(s.message(bodies(cube + "spheres { radius 0.00001; spacing 0.00001; }")), "Body bar would have some 6e+08 contact spheres of radius 1e-05 m, 1e-05 m apart; allowed: 1e+06"));
    CHECK(s.message(bodies(cube + "spheres { radius 0.002; spacing 0.001; }")).empty());
}
