// SPDX-License-Identifier: GPL-3.0-or-later
/// constant/bodies: shapes, mass and inertia, members, structures, walls. Spheres: foamContactSpheres.C; places: foamPlacement.C.
#include "demCoupling/foam/meshWalls.H"
#include "demCoupling/foam/structureChecks.H"
#include "support/bodiesScene.H"
#include "support/near.hpp"
#include "support/polyhedra.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace flotsam;

TEST_CASE("no file: an empty scene")
{
    BodiesScene s;
    const BodiesInput input = readBodies(s.foam.mesh(), s.adapter.mesh, s.halo, Vec3(0, -9.81, 0));
    CHECK(input.bodies.empty());
    CHECK(input.structures.empty());
    CHECK(makeSolids(input).empty());
}

TEST_CASE("walls and mirror planes stop bodies where nothing else is said")
{
    const auto walls = [](const std::vector<FoamCase::Edit>& edits)
    {
        FoamCase foam("foamChannel", edits);
        const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
        const Halo halo(adapter.mesh, MPI_COMM_WORLD);
        const char* body = "bodies { bar { shape { type box; size (0.1 0.1 0.1); } density 500; position (1 0.5 0.05); } }";
        const BodiesInput input = readBodies(parse(body), foam.mesh(), adapter.mesh, halo, Vec3(0, -9.81, 0));
        for (const WallDefinition& wall : input.walls) CHECK(wall.isMirror == (wall.name != "floor"));
        return input.wallPatches;
    };
    const std::vector<std::string> floor{"floor"}, both{"outlet", "floor"};
    CHECK(walls({}) == floor);
    for (const std::string type : {"symmetryPlane", "symmetry"})
    {
        const std::string mirror = "outlet { type " + type + "; }";
        CHECK(walls({{"system/blockMeshDict", "outlet { type patch;", "outlet { type " + type + ";"}, {"0/U", "outlet { type zeroGradient; }", mirror},
            {"0/alpha.water", "outlet { type zeroGradient; }", mirror}, {"0/p_rgh", "outlet { type fixedValue; value uniform 7; }", mirror}}) == both);
    }
}

TEST_CASE("a patch of type wall without faces, as subsetMesh and snappyHexMesh leave them, is no wall")
{
    FoamCase foam("foamChannel", {{"system/blockMeshDict", "outlet { type patch;", "unused { type wall; faces (); } outlet { type patch;"},
        {"0/U", "outlet {", "unused { type slip; } outlet {"}, {"0/p_rgh", "outlet {", "unused { type slip; } outlet {"}, {"0/alpha.water", "outlet {", "unused { type slip; } outlet {"}});
    const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
    const Halo halo(adapter.mesh, MPI_COMM_WORLD);
    const char* body = "bodies { bar { shape { type box; size (0.1 0.1 0.1); } density 500; position (1 0.5 0.05); } }";
    const BodiesInput input = readBodies(parse(body), foam.mesh(), adapter.mesh, halo, Vec3(0, -9.81, 0));
    REQUIRE(input.walls.size() == 1);
    CHECK(input.walls[0].name == "floor");
}

TEST_CASE("a triangle that a patch folds on itself is none of its wall, the others are joined where it was")
{
    TriSurface surface;     // (0 1 2) from both sides, between two others
    surface.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0, 1, 1}, {0, -1, 0}};
    surface.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {2, 0, 4}};
    const std::vector<std::array<int, 3>> rest{{0, 2, 3}, {2, 0, 4}};
    CHECK(withoutFolds(surface).triangles == rest);
}

TEST_CASE("the thinnest body, and the thinnest of those that the cut does not see between the nodes")
{
    BodiesScene s;
    const std::string log = "type cylinder; end1 (0 0 0); end2 (0.3 0 0); radius 0.02;";
    const auto thinnest = [&](const std::string& shape)
    {
        const BodiesInput input = s.read(bodies("shape { " + shape + " } density 600; position (1 0.5 0.2);"));
        return std::pair(thinnestBody(input), thinnestLinearBody(input));
    };
    CHECK(thinnest(log) == std::pair(0.04, 0.0));
    CHECK(thinnest("type box; size (0.3 0.03 0.1);") == std::pair(0.03, 0.0));
    const auto [tree, treeLinear] = thinnest("type union; parts { a { " + log + " } b { type sphere; radius 0.05; } }");
    CHECK(tree == near(0.04, 1e-14));
    CHECK(treeLinear == 0);
    const std::string folder = s.foam.folder() + "/constant/triSurface/";   // round, of a hundred faces
    if (s.halo.rank() == 0)
    {
        std::filesystem::create_directories(folder);
        writeStl(folder + "log.stl", makeCylinder({0, 0, 0}, {0.3, 0, 0}, 0.05)->surface(0.01));
    }
    MPI_Barrier(MPI_COMM_WORLD);
    const std::string stl = "type stl; file \"log.stl\";";
    for (const std::string& shape : {stl, "type union; parts { a { " + stl + " } b { type sphere; radius 0.06; } }"})
    {
        const auto [whole, linear] = thinnest(shape);
        CHECK(whole > 0.05);
        CHECK(linear == whole);
    }
}

TEST_CASE("one body: mass, inertia, spheres, pose")
{
    BodiesScene s;
    const BodiesInput input = s.read(bodies(bar + "position (0.5 0.5 0.2); orientation { axis (0 1 0); angleDeg 90; } velocity (1 0 0); releaseTime 2; spheres { radius 0.005; spacing 0.01; }"));
    REQUIRE(input.bodies.size() == 1);
    const BodyDefinition& b = input.bodies[0];
    CHECK(b.name == "bar");
    CHECK(b.volume == near(0.2*0.02*0.04, 1e-14));
    CHECK(b.mass == near(600*b.volume, 1e-14));
    CHECK(b.principalInertia[0] == near(b.mass/12*(0.02*0.02 + 0.04*0.04), 1e-14));
    CHECK(b.principalInertia[1] == near(b.mass/12*(0.2*0.2 + 0.04*0.04), 1e-14));
    CHECK((b.pose.position - Vec3(0.5, 0.5, 0.2)).norm() < 1e-15);
    CHECK((b.pose.orientation*Vec3::UnitX() - Vec3(0, 0, -1)).norm() < 1e-14);
    CHECK(b.motion.velocity == Vec3(1, 0, 0));
    CHECK(b.releaseTime == 2);
    CHECK(b.spheres.size() > 100);
    CHECK_FALSE(b.isPlanar);
}

TEST_CASE("a shape off its centroid and axes: the geometry stays where the user put it, the body frame is principal")
{
    BodiesScene s;
    const std::string shape = "shape { type cylinder; end1 (0.1 0.2 0.1); end2 (0.3 0.4 0.1); radius 0.03; } mass 2; ";
    const BodiesInput input = s.read(bodies(shape + "position (0.4 0.1 0); orientation { axis (0 0 1); angleDeg 30; }"));
    const BodyDefinition& b = input.bodies[0];
    CHECK(b.mass == 2);
    const auto moments = b.shape->moments();
    CHECK(moments.centroid.norm() < 1e-12);
    CHECK((moments.inertia - Eigen::Matrix3d(moments.inertia.diagonal().asDiagonal())).norm() < 1e-9*moments.inertia.norm());
    CHECK((b.principalInertia - moments.inertia.diagonal()*(b.mass/moments.volume)).norm() < 1e-9*b.principalInertia.norm());
    // the user's shape at the user's place
    const auto user = makeCylinder(Vec3(0.1, 0.2, 0.1), Vec3(0.3, 0.4, 0.1), 0.03);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(M_PI/6, Vec3::UnitZ()));
    const Solid solid = makeSolids(input)[0];
    for (const Vec3& x : {Vec3(0.2, 0.5, 0.1), Vec3(0.5, 0.5, 0.1), Vec3(0.4, 0.37, 0.12), Vec3(1.5, 0.5, 0.3)})
        CHECK(solid.distance(x) == near(user->distance(turn.conjugate()*(x - Vec3(0.4, 0.1, 0))), 1e-14));
}

TEST_CASE("arrays of structures and bodies, and their walls")
{
    BodiesScene s;
    const BodiesInput input = s.read(
        "materials (wood steel); wallMaterial steel; contact { default { stiffness 5e5; } wood-steel { restitution 0.5; frictionAngle 20; } }"
        "parameters { gap 0.1; } structures { pipes { shape { type cylinder; end1 (1.5 0 0.05); end2 (1.5 1 0.05); radius 0.01; } material steel; wall slip;"
        " array { count (1 1 4); spacing (0 0 $:parameters.gap); } } }"
        + bodies(bar + "material wood; position (0.3 0.3 0.1); array { count (2 3 1); spacing (0.4 0.1 0); }"));
    REQUIRE(input.structures.size() == 4);
    CHECK(input.structures[3].solid.name == "pipes.3");
    CHECK(input.structures[3].solid.distance(Vec3(1.5, 0.5, 0.35)) == near(-0.01, 3e-14));
    CHECK(input.structures[0].solid.wall == Solid::Wall::Slip);
    REQUIRE(input.bodies.size() == 6);
    CHECK(input.bodies[1].name == "bar.1");
    CHECK((input.bodies[5].pose.position - Vec3(0.7, 0.5, 0.1)).norm() < 1e-14);
    CHECK(input.bodyGroups[5] == "bar");
    CHECK(makeSolids(input).size() == 10);
    CHECK(makeSolids(input)[4].kind == Solid::Kind::Free);

    // patches floor (a plane), frontAndBack (two planes in one patch), then the pipes
    REQUIRE(input.walls.size() == 7);
    CHECK(input.walls[0].name == "floor");
    CHECK(input.walls[0].kind == WallDefinition::Kind::Plane);
    CHECK((input.walls[0].normal - Vec3::UnitY()).norm() < 1e-12);
    for (int k : {1, 2})
    {
        CHECK(input.walls[k].kind == WallDefinition::Kind::Plane);
        CHECK(std::abs(std::abs(input.walls[k].normal.z()) - 1) < 1e-12);
        CHECK(input.walls[k].normal.z()*(input.walls[k].point.z() < 0.2 ? 1 : -1) > 0); // towards the fluid
    }
    CHECK(input.structures[2].wall == 5);
    CHECK(input.walls[5].kind == WallDefinition::Kind::Surface);
    CHECK(input.walls[5].material == 1);
    REQUIRE(input.laws.size() == 4);
    CHECK(input.laws[1].restitution == 0.5);
    CHECK(input.laws[2].frictionAngleDeg == 20);
    CHECK(input.laws[1].stiffness == 5e5);
    CHECK(input.laws[0].restitution == ContactLaw().restitution);
}

TEST_CASE("poses: what one does not give is the group's")
{
    BodiesScene s;
    const BodiesInput input = s.read(bodies(bar + "velocity (1 0 0); poses ( { position (0.5 0.5 0.2); } { position (0.5 0.7 0.2); velocity (0 2 0); releaseTime 3; } );"));
    REQUIRE(input.bodies.size() == 2);
    CHECK(input.bodies[0].motion.velocity == Vec3(1, 0, 0));
    CHECK(input.bodies[1].motion.velocity == Vec3(0, 2, 0));
    CHECK(input.bodies[1].releaseTime == 3);
    CHECK(input.bodies[1].name == "bar.1");
}

TEST_CASE("structures that overlap, touch, or lie in others")
{
    BodiesScene s;
    const auto overlaps = [&](const std::string& contents) { return findOverlaps(s.read("structures { " + contents + " }").structures, SceneFrame()); };
    const std::string pier = "pier { shape { type cylinder; end1 (1 0 0.2); end2 (1 1 0.2); radius 0.05; } } ";
    const auto box = [](const std::string& name, double x, double size)
    {
        const std::string a = std::to_string(x), b = std::to_string(size);
        return name + " { shape { type box; size (" + b + " " + b + " " + b + "); } position (" + a + " 0.5 0.2); } ";
    };
    const StructureOverlaps footing = overlaps(pier + box("footing", 1.06, 0.1));
    CHECK(footing.overlapping == std::vector<std::pair<int, int>>{{0, 1}});
    CHECK(footing.inside.empty());
    CHECK(overlaps(pier + box("core", 1, 0.06)).inside == std::vector<std::pair<int, int>>{{1, 0}});
    CHECK(overlaps(box("twin", 1, 0.06) + box("other", 1, 0.06)).inside == std::vector<std::pair<int, int>>{{1, 0}});
    const StructureOverlaps wall = overlaps(box("a", 1, 0.25) + box("b", 1.25, 0.25) + box("far", 1.9, 0.1));
    CHECK(wall.overlapping.empty()); // they touch
    CHECK(wall.inside.empty());
}

TEST_CASE("2D: structures that do not reach through the mesh, or not with the same section, are found")
{
    BodiesScene s(false);       // 0.1 m thick, from z = 0
    SceneFrame frame;
    frame.isPlanar = true;
    frame.midPlane = 0.05;
    frame.thickness = 0.1;
    const auto isSame = [&](const std::string& contents) { return isSameAcross(s.read("structures { post { shape { " + contents + " } }").structures[0].solid, frame); };
    CHECK(isSame("type box; size (0.1 0.1 0.1); } position (1 0.5 0.05);"));
    CHECK(isSame("type box; size (0.1 0.1 3); } position (1 0.5 0); orientation { axis (0 0 1); angleDeg 20; }"));
    CHECK(isSame("type cylinder; end1 (1 0.5 -1); end2 (1 0.5 1); radius 0.1; }"));
    CHECK_FALSE(isSame("type box; size (0.1 0.1 0.1); } position (1 0.5 0);"));         // z of a body does not count, of a structure it does
    CHECK_FALSE(isSame("type box; size (0.1 0.1 0.02); } position (1 0.5 0.02);"));     // misses the mid-plane
    CHECK_FALSE(isSame("type sphere; radius 0.1; } position (1 0.5 0.05);"));
    CHECK_FALSE(isSame("type box; size (0.1 0.1 0.1); } position (1 0.5 0.05); orientation { axis (1 0 0); angleDeg 20; }"));
    frame.isPlanar = false;
    CHECK(isSame("type sphere; radius 0.1; } position (1 0.5 0.05);"));
}

TEST_CASE("prescribed motions: the velocity is the derivative of the pose")
{
    BodiesScene s;
    const std::string shape = "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1 0.5 0.2); motion { ";
    for (const std::string motion : {"type linear; velocity (1 2 0);", "type oscillating; direction (0 2 0); amplitude 0.1; period 2; phaseDeg 40;",
        "type rotating; origin (1.2 0.5 0.2); axis (0 0 1); rpm 30;", "type rotating; axis (0 0 1); rpm 30; timeStart 0.2; timeEnd 0.9; rampTime 0.25;",
        "type tabulated; displacement ((0 (0 0 0)) (0.2 (0.1 0 0.1)) (0.5 (0.1 0 0.3)));", "type tabulated; timeStart 0.1; displacement ((0 (0 0 0)) (0.8 (0.1 0 0.1)));",
        "type oscillating; axis (0 0 1); origin (1.2 0.4 0.2); amplitudeDeg 20; period 1.5; phaseDeg 40;", "type tabulated; axis (0 0 -1); origin (0.8 0.5 0); angleDeg ((0 0) (0.2 20) (0.5 90));",
        "type tabulated; timeStart 0.1; axis (0 0 1); angleDeg ((0 0) (0.5 90)); displacement ((0 (0 0 0)) (0.8 (0.1 0 0.1)));"})
    {
        const auto input = s.read(shape + motion + " } } }");
        const auto& gate = input.structures[0];
        CHECK(gate.solid.kind == Solid::Kind::Prescribed);
        CHECK((gate.solid.pose.position - Vec3(1, 0.5, 0.2)).norm() < 1e-14);
        Pose a, b, c;
        Motion m, unused;
        const double t = 0.3, h = 1e-5;
        gate.motion(t - h, a, unused);
        gate.motion(t + h, c, unused);
        gate.motion(t, b, m);
        CHECK(((c.position - a.position)/(2*h) - m.velocity).norm() < 1e-7);
        const Eigen::AngleAxisd turned(c.orientation*a.orientation.conjugate());
        CHECK((turned.axis()*turned.angle()/(2*h) - m.angularVelocity).norm() < 1e-6);
    }
}

TEST_CASE("a gate that turns by a table is where its angle says, about its hinge, and stays there")
{
    BodiesScene s;
    const auto input = s.read("structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1 0.5 0.2);"
        " motion { type tabulated; axis (0 0 1); origin (1.2 0.5 0.2); angleDeg ((1 0) (2 30) (4 90)); displacement ((4 (0 0 0)) (5 (0 0.3 0))); } } }");
    for (const auto& [time, place] : {std::pair(0.5, Vec3(1, 0.5, 0.2)), std::pair(2.0, Vec3(1.2 - 0.2*std::cos(M_PI/6), 0.4, 0.2)), std::pair(4.0, Vec3(1.2, 0.3, 0.2)), std::pair(9.0, Vec3(1.2, 0.6, 0.2))})
    {
        Pose pose;
        Motion motion;
        input.structures[0].motion(time, pose, motion);
        CHECK((pose.position - place).norm() < 1e-14);
        if (time > 4) CHECK((pose.orientation*Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-14);
    }
}

TEST_CASE("a round log with a root wad keeps the axes it is given in: its box is no larger than it is")
{
    const auto tree = makeUnion({makeCylinder(Vec3::Zero(), Vec3(1, 0, 0), 0.1), makeCylinder(Vec3::Zero(), Vec3(0.1, 0, 0), 0.3)});
    CHECK(toPrincipalFrame(tree).inUserFrame.orientation.coeffs() == Eigen::Quaterniond::Identity().coeffs());
}

TEST_CASE("bodies feel structures that move by their spheres, behind the walls")
{
    BodiesScene s;
    const std::string post = "post { shape { type box; size (0.1 0.1 0.1); } position (0.3 0.5 0.2); } ", gate = "gate { shape { type box; size (0.1 0.02 0.1); } position (1.5 0.5 0.2); motion { type linear; velocity (1 0 0); } ";
    const BodiesInput input = s.read("structures { " + gate + "spheres { radius 0.01; spacing 0.02; } } " + post + "}" + bodies(bar + "position (0.5 0.5 0.2);"));
    REQUIRE(input.movers.size() == 1);
    CHECK(input.structures[0].wall == static_cast<int>(input.walls.size()));
    CHECK(input.structures[1].wall == static_cast<int>(input.walls.size()) - 1);
    for (const SurfaceSphere& sphere : input.movers[0].spheres)
    {
        CHECK(sphere.radius == 0.01);
        CHECK((sphere.centre.cwiseAbs() - Vec3(0.04, 0, 0.04)).maxCoeff() < 1e-14);
    }
    CHECK(s.read("structures { " + gate + "contact off; } }" + bodies(bar + "position (0.5 0.5 0.2);")).movers.empty());
    CHECK(s.read("structures { " + gate + "} }").movers.empty()); // no bodies

    BodiesScene plane(false); // 0.1 m thick
    const std::string log = bodies("shape { type box; size (0.2 0.1 0.1); } density 500; position (0.5 0.5 0);");
    const auto spheres = [&](const std::string& shape)
    {
        return plane.read("structures { gate { shape { type " + shape + " } position (1.5 0.5 0); motion { type linear; velocity (1 0 0); } } }" + log).movers[0].spheres;
    };
    for (const SurfaceSphere& sphere : spheres("box; size (0.1 0.2 3);")) CHECK(std::abs(sphere.centre.z() - 0.05) < 1e-14);   // one layer
    for (const SurfaceSphere& sphere : spheres("union; parts { flap { type box; size (0.1 0.2 3); } lip { type box; centre (0.1 -0.05 0); size (0.2 0.1 3); } }"))
        CHECK(std::abs(sphere.centre.z() - 0.05) < 1e-14);
    const auto plate = spheres("box; size (0.1 0.2 3);");
    for (const SurfaceSphere& a : plate)    // grooves of an eighth of their radius
        CHECK(std::any_of(plate.begin(), plate.end(), [&](const SurfaceSphere& b) { return &a != &b && (a.centre - b.centre).norm() <= 0.125*a.radius*(1 + 1e-9); }));
    const auto disc = spheres("cylinder; end1 (0 0 -1); end2 (0 0 1); radius 0.2;");
    REQUIRE(disc.size() == 1);
    CHECK(disc[0].radius == 0.2);
    CHECK((disc[0].centre - Vec3(0, 0, 0.05)).norm() < 1e-14);
    CHECK(has(plane.message("structures { gate { shape { type sphere; radius 0.1; } position (1.5 0.5 0); motion { type linear; velocity (1 0 0); } } }" + log), "contact off"));
}

TEST_CASE("boxes have corners of a sixteenth of their thickness, where their other spheres are larger")
{
    BodiesScene s;
    const auto read = [&](const std::string& shape, const std::string& spheres) { return s.read(bodies("shape { type " + shape + " } density 500; position (0.5 0.5 0.3); " + spheres)).bodies[0]; };
    const std::string box = "box; size (0.3 0.08 0.2);";
    const BodyDefinition body = read(box, "");
    REQUIRE(body.corners.size() == 8);
    for (const SurfaceSphere& corner : body.corners)
    {
        CHECK(corner.radius == near(0.005, 1e-14));
        Vec3 inside = corner.centre.cwiseAbs();     // along the axes of inertia
        std::sort(inside.data(), inside.data() + 3);
        CHECK((inside - Vec3(0.035, 0.095, 0.145)).norm() < 1e-13);
    }
    CHECK(read(box, "spheres { radius 0.01; }").corners.size() == 8);
    CHECK(read(box, "spheres { radius 0.005; }").corners.empty());
    CHECK(read("cylinder; end1 (0 0 0); end2 (0.3 0 0); radius 0.04;", "").corners.empty());
    BodiesScene plane(false);
    const BodyDefinition flat = plane.read(bodies("shape { type box; size (0.2 0.08 0.1); } density 500; position (0.5 0.5 0); orientation { axis (0 0 1); angleDeg 20; }")).bodies[0];
    REQUIRE(flat.corners.size() == 4);
    for (const SurfaceSphere& corner : flat.corners) CHECK(corner.centre.cwiseAbs().sum() == near(0.095 + 0.035, 1e-13));
}

TEST_CASE("2D: a body reaches through the mesh, moved to its mid-plane")
{
    BodiesScene s(false);
    const BodiesInput input = s.read(bodies("shape { type box; size (0.2 0.1 0.1); } density 500; position (0.5 0.5 0); orientation { axis (0 0 1); angleDeg 20; }"));
    CHECK(input.bodies[0].isPlanar);
    CHECK(input.bodies[0].planeAxis == 2);
    CHECK(input.bodies[0].pose.position.z() == near(0.05, 1e-14));
    CHECK(input.bodies[0].mass == near(500*0.2*0.1*0.1, 1e-14));
    CHECK(input.bodies[0].spheres.size() == 8);     // of one layer, radius 0.025, whatever the thickness
    for (const SurfaceSphere& sphere : input.bodies[0].spheres)
    {
        CHECK(std::abs(sphere.centre.z()) < 1e-16);
        CHECK(std::max(std::abs(sphere.centre.x()) - 0.075, std::abs(sphere.centre.y()) - 0.025) == within(0, 1e-14));
    }
    const auto thick = s.read(bodies("shape { type box; size (0.6 0.5 0.1); } density 500; position (0.5 0.5 0);")).bodies[0].spheres;
    CHECK(thick.size() == 6);
    for (const SurfaceSphere& sphere : thick) CHECK(sphere.radius == 0.125); // larger than half of the mesh's thickness
    const std::string cross = "union; parts { a { type box; size (0.4 0.1 0.1); } b { type box; size (0.1 0.4 0.1); } }";
    for (const SurfaceSphere& sphere : s.read(bodies("shape { type " + cross + " } density 500; position (0.5 0.5 0);")).bodies[0].spheres) CHECK(std::abs(sphere.centre.z()) < 1e-16);
    CHECK(has(s.message(bodies("shape { type box; size (0.2 0.1 0.2); } density 500; position (0.5 0.5 0);")), "must reach through the mesh"));
}
