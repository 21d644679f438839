// SPDX-License-Identifier: GPL-3.0-or-later
/// constant/bodies: one message for every mistake.
#include "demCoupling/foam/repeatedGroups.hpp"
#include "demCoupling/foam/bodyChecks.H"
#include "demCoupling/foam/continuedMotion.H"
#include "geometry/thinTriangles.hpp"
#include "support/bodiesScene.H"
#include "support/near.hpp"
#include "support/polyhedra.hpp"
#include "support/prism.hpp"

#include <doctest/doctest.h>

#include <mpi.h>

#include <fstream>
#include <functional>

using namespace flotsam;

TEST_CASE("one message for every mistake")
{
    BodiesScene s;
    const std::string at = "position (0.5 0.5 0.2); ";
    CHECK(has(s.message(bodies("shape { type cubiod; } density 1;" + at)), "Unknown shape type 'cubiod'"));
    CHECK(has(s.message(bodies("shape { type sphere; raidus 1; } density 1;" + at)), "Did you mean: radius"));
    CHECK(has(s.message("boddies {}"), "Did you mean: bodies"));
    CHECK(has(s.message(bodies(bar + at + "orientation (0 0 1 30);")), "Entry 'orientation' is '( 0 0 1 30 )', but must be a group of entries in braces: orientation { .. }"));
    CHECK(has(s.message(bodies("shape sphere; density 1;" + at)), "Entry 'shape' is 'sphere', but must be a group"));
    CHECK(has(s.message(bodies("density 1;" + at)), "Entry 'shape { .. }' is missing"));
    CHECK(has(s.message("bodies 3;"), "Entry 'bodies' is '3', but must be a group"));
    CHECK(has(s.message(bodies("shape { type sphere; radius 0.1; } density -5;" + at)), "density' is -5: it must be larger than 0"));
    CHECK(has(s.message(bodies("shape { type sphere; radius 0.1; }" + at)), "either 'density' [kg/m^3] or 'mass'"));
    CHECK(has(s.message(bodies(bar + at + "array { count (0 1 1); spacing (1 1 1); }")), "at least 1"));
    CHECK(has(s.message(bodies(bar + at + "material wod; ") + "materials (wood steel); wallMaterial wood;"), "Did you mean: wood"));
    CHECK(has(s.message(bodies(bar + at) + "materials (wood steel); wallMaterial wood;"), "'material' is missing"));
    CHECK(has(s.message(bodies(bar + at) + "contact { wood-steel {} }"), "Unknown keyword 'wood-steel'"));
    CHECK(has(s.message(bodies(bar + at + "material wood;") + "materials (wood steel); wallMaterial wood; contact { steel-wood {} wood-steel {} }"), "'wood-steel' and 'steel-wood' are the same pair"));
    CHECK(has(s.message(bodies(bar + at) + "wallPatches (flor);"), "Did you mean: floor"));
    CHECK(has(s.message(bodies(bar + at + "spheres { radius 0.5; }")), "smallest extent is 0.02"));
    CHECK(has(s.message(bodies(bar + at + "random {} poses ();")), "only one of"));
    const std::string outside = s.message(bodies(bar + "position (1.95 0.5 0.2);"));
    CHECK(has(outside, "Body bar reaches 50 mm into the outside of the mesh"));
    CHECK(outside.find("STL") == std::string::npos);
    CHECK(has(s.message(bodies("shape { type box; size (200 20 40); } density 600; position (1 0.5 0.2);")),
        "It is 200 m x 20 m x 40 m, the mesh 2 m x 1 m x 0.4 m. Lengths are in m: an STL file in mm needs 'scale 0.001'."));
    CHECK(has(s.message(bodies(bar + "position (0.5 0.005 0.2);")), "wall floor"));
    const std::string overlap = s.message(bodies(bar + "poses ( { position (0.5 0.5 0.2); } { position (0.5 0.515 0.2); } );"));
    CHECK(has(overlap, "Body bar.1 reaches 5 mm into body bar.0"));
    CHECK(has(s.message("structures { post { shape { type cylinder; end1 (0.5 0 0.2); end2 (0.5 1 0.2); radius 0.05; } } }" + bodies(bar + at)), "into structure post"));
    CHECK(has(s.message("structures { post { shape { type box; size (0.1 0.1 0.1); } wall noslip; } }"), "Did you mean: noSlip"));
    const std::string millimetres = "structures { post { shape { type cylinder; end1 (500 500 -200); end2 (500 500 2000); radius 900; } } }";
    CHECK(has(s.message(millimetres), "Structure 'post' covers the whole mesh: it is 1800 m x 1800 m x 2200 m"));
    CHECK(has(s.message(millimetres + bodies(bar + at)), "covers the whole mesh"));   // not the place of the body
    CHECK(s.message("structures { drum { shape { type cylinder; end1 (1 0.5 -1); end2 (1 0.5 1); radius 1.05; } } }").empty());   // the mesh's corners are left
    const std::string gate = "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.5 0.5 0.2); ", moves = "motion { type linear; velocity (1 0 0); } ";
    CHECK(has(s.message(gate + "spheres { radius 0.02; } } }" + bodies(bar + at)), "structures with 'motion'"));
    CHECK(has(s.message(gate + moves + "spheres { radius 0.06; } } }" + bodies(bar + at)), "smallest extent is 0.1"));
    CHECK(has(s.message(gate + moves + "spheres { radius 0.0005; } } }" + bodies(bar + at)), "allowed: 50000"));
    CHECK(has(s.message(bodies(bar + "random { count 50; box ((0 0 0) (0.3 0.05 0.05)); tries 20; }")), "of 50 bodies 'bar' found a place within 20 tries"));
    CHECK(has(s.message(bodies(bar + "random { count 50; box ((0 0 0) (0.3 0.05 0.05)); tries 20; }")), " lay in other bodies."));
    CHECK(has(s.message(bodies(bar + "random { count 1; box ((0.2 0 0.1) (1.2 0.03 0.3)); orientation fixed; minGap 0.02; tries 20; }")),
        "Of 200 more tries 200 lay in wall floor or nearer than minGap, 0.02 m, to it"));
    const std::string post = "structures { post { shape { type box; size (0.4 0.4 0.3); } position (0.5 0.5 0.2); } } ";
    CHECK(has(s.message(post + bodies(bar + "random { count 1; box ((0.35 0.35 0.1) (0.65 0.65 0.3)); tries 20; }")), "lay in structure post."));
    const std::string narrow = "random { count 5; box ((0.2 0 0) (1.2 0.03 0.1)); orientation ";
    CHECK(has(s.message(bodies(bar + narrow + "fixed; }" + " orientation { axis (0 0 1); angleDeg 90; }")), "'box', which must hold the whole of them: it is 0.03 m long along y, a body 0.2 m."));
    CHECK(has(s.message(bodies(bar + narrow + "random; tries 3; }")), "along y, a body in the best of all orientations that were tried 0."));
    CHECK(has(s.message(bodies(bar + "array { count (100000 100000 1); spacing (1 1 1); }")), "makes 1e+10 members: at most 1e+06"));
    CHECK(has(s.message(bodies("shape { type cylinder; end1 (1 1 1); end2 (1 1 1); radius 1; } density 1;")), "no length"));
    CHECK(s.message(bodies(bar + "position (0.5 0.01 0.2);")).empty()); // lies on the floor
    const std::string two = "poses ( { position (0.5 0.5 0.2); } { position (0.5 0.7 0.2); } ); } ";
    CHECK(has(s.message("bodies { bar.1 { " + bar + "position (1 0.5 0.2); } bar { " + bar + two + "}"), "Two bodies are called 'bar.1'"));
    CHECK(s.message("bodies { bar.2 { " + bar + "position (1 0.5 0.2); } bar { " + bar + two + "}").empty());
    CHECK(has(s.message("structures { p.0 { shape { type sphere; radius 0.1; } } p { shape { type sphere; radius 0.1; } array { count (2 1 1); spacing (1 0 0); } } }"), "Two structures are called 'p.0'"));
}

TEST_CASE("a value of the wrong kind: what it is and what it must be, not which token could not be read")
{
    BodiesScene s;
    const std::string at = "position (0.5 0.5 0.2); ", box = "shape { type box; size (0.2 0.02 0.04); } ";
    CHECK(has(s.message(bodies(box + "density wood; " + at)), "Entry 'density' is 'wood', but must be a number larger than 0."));
    CHECK(has(s.message(bodies(box + "density 600 kg; " + at)), "Entry 'density' is '600 kg', but must be a number larger than 0.\n    Values have no unit behind them"));
    CHECK(has(s.message(bodies(box + "density 600 " + at)), "Entry 'density' is '600 position ( 0.5 0.5 0.2 )'"));
    CHECK(has(s.message(bodies(box + "density { wood 600; } " + at)), "Entry 'density' is a group of entries in braces, but must be a number"));
    CHECK(has(s.message(bodies(bar + "position 0.5;")), "Entry 'position' is '0.5', but must be three numbers in round brackets: (x y z)."));
    CHECK(has(s.message(bodies(bar + "position (0.5 0.5);")), "Entry 'position' is '( 0.5 0.5 )', but must be three numbers"));
    CHECK(has(s.message(bodies("shape { size (1 1 1); } density 1;")), "Entry 'type' is missing: it must be one of: box, sphere"));
    CHECK(has(s.message(bodies("shape { type (box); } density 1;")), "Entry 'type' is '( box )', but must be one of: box, sphere"));
    CHECK(has(s.message("materials wood;" + bodies(bar + at)), "Entry 'materials' is 'wood', but must be a list of words"));
    CHECK(has(s.message("materials (wood wood);" + bodies(bar + at)), "'materials' has 'wood' twice"));
    CHECK(has(s.message("wallPatches floor;" + bodies(bar + at)), "Unknown wallPatches 'floor'"));
    CHECK(has(s.message("wallPatches { floor; }" + bodies(bar + at)), "Entry 'wallPatches' is a group of entries in braces"));
    CHECK(has(s.message("contact { default { perBody maybe; } }" + bodies(bar + at)), "Entry 'perBody' is 'maybe', but must be on or off"));
    CHECK(has(s.message(bodies(bar + "random { count few; box ((0 0 0) (1 1 1)); }")), "Entry 'count' is 'few', but must be a whole number from 1 to"));
    CHECK(has(s.message(bodies(bar + "random { count 2.5; box ((0 0 0) (1 1 1)); }")), "Entry 'count' is '2.5', but must be a whole number"));
    CHECK(has(s.message(bodies(bar + "random { count 2; box (0 0 0 1 1 1); }")), "Entry 'box' is '( 0 0 0 1 1 1 )', but must be two corners"));
}

TEST_CASE("poses that are no list of groups are shown with how they are written")
{
    BodiesScene s;
    const std::string wanted = "but must be a list of groups in round brackets, with ';' after every value: ( { position (x y z); } { .. } )";
    for (const char* wrong : {"poses ( (0.5 0.5 0.2) (0.8 0.5 0.2) );", "poses ( { position (0.5 0.5 0.2) } );", "poses { a { position (0.5 0.5 0.2); } }", "poses (0.5 0.5 0.2);"})
    {
        const std::string message = s.message(bodies(bar + wrong));
        CHECK(has(message, "Entry 'poses' is "));
        CHECK(has(message, wanted));
    }
    CHECK(has(s.message(bodies(bar + "poses ( );")), "'poses' is empty: list at least one { position (..); }"));
    CHECK(has(s.message(bodies(bar + "poses ( { position (0.5 0.5); } );")), "Entry 'position' is '( 0.5 0.5 )', but must be three numbers"));
    CHECK(has(s.message(bodies(bar + "poses ( { positon (0.5 0.5 0.2); } );")), "Did you mean: position"));
    CHECK(s.message(bodies(bar + "poses ( { position (0.5 0.5 0.2); } );")).empty());
}

TEST_CASE("a start after 0: releases that are over, and motions that have gone on, are told")
{
    BodiesScene s;
    const std::string gate = "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.5 0.5 0.2); motion { type ";
    const BodiesInput lifted = s.read(gate + "linear; velocity (0 0.01 0); } } }" + bodies(bar + "releaseTime 3; poses ( { position (0.5 0.5 0.2); } { position (0.5 0.7 0.2); } );"));
    CHECK(doubtfulStart(lifted, 0).empty());
    const std::vector<std::string> late = doubtfulStart(lifted, 10);
    REQUIRE(late.size() == 2);
    CHECK(has(late[0], "body bar.0 (and 1 more) is let go at once: its release, at 3 s, is before the start, at 10 s"));
    CHECK(has(late[1], "structure gate begins where 10 s of its motion have brought it, at (1.5 0.6 0.2)"));
    CHECK(doubtfulStart(lifted, 2).size() == 1);    // the gate
    CHECK(doubtfulStart(s.read(bodies(bar + "position (0.5 0.5 0.2);")), 10).empty());      // free from 0 on
    CHECK(doubtfulStart(s.read(gate + "oscillating; direction (0 1 0); amplitude 0.1; period 2; } } }"), 10).empty());      // back where it was
}

TEST_CASE("times of a motion that leave no time to move, or none before the end of the run, are told")
{
    BodiesScene s;
    const auto text = [](const std::string& times)
    { return "structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.5 0.5 0.2); motion { type linear; velocity (0 0.01 0); " + times + " } } }"; };
    CHECK(has(s.message(text("timeStart 2; timeEnd 2;")), "The motion ends at timeEnd 2 s, but begins at timeStart 2 s: timeEnd must be later"));
    CHECK(has(s.message(text("timeStart 2; timeEnd 3; rampTime 0.6;")), "Give a rampTime of 0.5 s at most"));
    CHECK(has(s.message(text("timeStrat 2;")), "Did you mean: timeStart"));
    CHECK(s.message(text("timeStart 2; timeEnd 3; rampTime 0.5;")).empty());
    const auto doubts = [&](const std::string& times) { return doubtfulBodies(s.read(text(times)), FluidProperties(), 5); };
    CHECK(doubts("timeStart 4.9;").empty());
    REQUIRE(doubts("timeStart 5;").size() == 1);
    CHECK(has(doubts("timeStart 5;")[0], "structure gate does not move: the timeStart of its motion, 5 s, is not before endTime, 5 s"));
    CHECK(motionJumps(s.read(text("timeStart 2; timeEnd 3;"))) == std::vector<double>{2, 3});
    CHECK(motionJumps(s.read(text("timeStart 2; timeEnd 3; rampTime 0.2;"))).empty());
    CHECK(doubtfulStart(s.read(text("timeStart 20;")), 10).empty());    // has not moved yet
}

TEST_CASE("structures with needles that the contact engine does not take are divided; those with too many are refused with name, number, place and size, before it is there")
{
    BodiesScene s;
    const auto write = [&](const TriSurface& surface)
    {
        if (s.halo.rank() == 0)
        {
            Foam::mkDir(s.foam.folder() + "/constant/triSurface");
            writeStl(s.foam.folder() + "/constant/triSurface/sill.stl", surface);
        }
        MPI_Barrier(MPI_COMM_WORLD);
    };
    const auto scene = [&](const std::string& entry = "")
    { return "structures { sill { shape { type stl; file \"sill.stl\"; } position (0.3 0.3 0.3); " + entry + " } } " + bodies(bar + "position (0.5 0.8 0.2);"); };
    const auto refused = [](const TriSurface& surface)
    {
        int count = 0;
        for (const auto& t : surface.triangles) count += ThinTriangle(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]).isRefused;
        return count;
    };
    for (const double width : {5e-4, 2e-3})
    {
        // a wedge of two triangles and two sides, as thin as wide
        TriSurface wedge;
        wedge.points = {{0, 0, 0}, {1, 0, 0}, {1, width, 0}, {1, 0, 0.5}};
        wedge.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        write(wedge);
        const BodiesInput input = s.read(scene());
        CHECK((refused(wedge) > 0) == (width < 1e-3));
        CHECK(refused(input.walls.back().surface) == 0);
        CHECK((input.walls.back().surface.triangles.size() > 4) == (width < 1e-3));
        CHECK(input.structures[0].solid.shape->surface(1).triangles.size() == 4); // the flow's
    }
    write(prism(circle(1000, 1.1e-5*1000/(2*M_PI)), Vec3(0, 0, 1)));
    const std::string message = s.message(scene());
    CHECK(has(message, "The surface of sill has 2000 triangles with angles below 0.001001 rad, which the contact engine does not take, the widest 1 m long and 1.1"));
    CHECK(has(message, "m wide at (0.3"));
    CHECK(has(message, "more than 100000"));
    CHECK(s.message(scene("contact off;")).empty());
}

TEST_CASE("tables of a motion need two rows of rising times")
{
    BodiesScene s;
    const auto message = [&](const std::string& entries)
    { return s.message("structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.5 0.5 0.2); motion { type tabulated; " + entries + " } } }"); };
    CHECK(has(message("displacement ((0 (0 0 0)));"), "'displacement' has 1 row: give two at least"));
    CHECK(has(message("displacement ((0 (0 0 0)) (1 (0 0 0.1)) (1 (0 0 0.2)));"), "Times in 'displacement' must rise: 1 s follows 1 s"));
    CHECK(has(message("displacement ((0 0) (1 0.1));"), "a list of times [s] and displacements [m]"));
    CHECK(has(message("displacement ((0 (0 0 0)) (1 (0 0 0.1))); rampTime 1;"), "rampTime"));
    CHECK(message("displacement ((0 (0 0 0)) (1 (0 0 0.1))); timeStart 1;").empty());
    CHECK(has(message("axis (0 0 1);"), "or 'angleDeg ( (time angle) .. );' about 'axis'"));
    CHECK(has(message("axis (0 0 1); angleDeg ((0 0) (1 30) (1 40));"), "Times in 'angleDeg' must rise: 1 s follows 1 s"));
    CHECK(has(message("angleDeg ((0 0) (1 30));"), "axis"));
    CHECK(has(message("axis (0 0 1); angleDeg ((0 (0 0 0)) (1 (0 0 0.1)));"), "a list of times [s] and angles [degrees]"));
    CHECK(has(message("axis (0 0 1); displacement ((0 (0 0 0)) (1 (0 0 0.1)));"), "'axis' and 'origin' go with 'angleDeg"));
    CHECK(message("axis (0 0 1); angleDeg ((0 0) (1 30));").empty());
}

TEST_CASE("an oscillation is along a direction or about an axis")
{
    BodiesScene s;
    const auto message = [&](const std::string& entries)
    { return s.message("structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.5 0.5 0.2); motion { type oscillating; period 1; " + entries + " } } }"); };
    CHECK(has(message("amplitude 0.1; amplitudeDeg 3; axis (0 0 1);"), "Give either 'amplitude' [m] along 'direction', or 'amplitudeDeg' about 'axis'"));
    CHECK(has(message("amplitude 0.1; axis (0 0 1);"), "'amplitude' goes with 'direction'"));
    CHECK(has(message("amplitudeDeg 3; direction (0 0 1);"), "'amplitudeDeg' goes with 'axis'"));
    CHECK(message("amplitudeDeg 3; axis (0 0 1);").empty());
    CHECK(message("amplitude 0.1; direction (0 1 0);").empty());
}

TEST_CASE("2D: a structure moves in the plane of the mesh and turns across it, and nothing touches front and back")
{
    BodiesScene s(false);
    const std::string cube = "bodies { cube { shape { type box; size (0.1 0.1 0.1); } density 600; position (0.5 0.5 0.05); } } ";
    CHECK(has(s.message("wallPatches (floor frontAndBack); " + cube), "'wallPatches' names frontAndBack, of type empty"));
    CHECK(s.message("wallPatches (floor outlet); " + cube).empty());
    const auto message = [&](const std::string& motion)
    { return s.message("structures { gate { shape { type box; size (0.1 0.1 0.1); } position (1.5 0.5 0.05); motion { " + motion + " } } }"); };
    CHECK(has(message("type linear; velocity (1 0 0.5);"), "velocity of structure gate along z is 0.5; allowed: 0"));
    CHECK(has(message("type oscillating; direction (0 0 1); amplitude 0.1; period 1; phaseDeg 90;"), "velocity of structure gate along z"));
    CHECK(has(message("type rotating; axis (1 0 0); omega 2;"), "angularVelocity of structure gate along x is 2; allowed: 0"));
    CHECK(has(message("type linear; velocity (1 0 0.5); timeStart 7; timeEnd 9; rampTime 1;"), "velocity of structure gate along z is 0.5; allowed: 0"));
    CHECK(has(message("type tabulated; displacement ((3 (0 0 0)) (4 (0.1 0 0)) (5 (0.1 0 0.1)));"), "velocity of structure gate along z"));
    CHECK(message("type tabulated; displacement ((3 (0 0 0)) (4 (0.1 0.2 0)));").empty());
    CHECK(message("type linear; velocity (1 -2 0);").empty());
    CHECK(message("type oscillating; direction (1 1 0); amplitude 0.1; period 1;").empty());
    CHECK(message("type rotating; axis (0 0 -3); rpm 20; origin (1.4 0.5 0);").empty());
}

TEST_CASE("a group that stands twice in its file is found, and nothing else")
{
    const auto found = [](const std::string& contents)
    {
        std::string result;
        for (const RepeatedGroup& g : repeatedGroups(contents, {"structures", "bodies"}))
            result += g.section + "/" + g.name + ":" + std::to_string(g.firstLine) + ":" + std::to_string(g.line) + " ";
        return result;
    };
    const std::string box = " { shape { type box; size (1 1 1); } density 600; }\n";
    CHECK(found("bodies\n{\n bar" + box + " log" + box + " bar // again\n" + box + "}") == "bodies/bar:3:5 ");
    CHECK(found("bodies { bar" + box + "}\nbodies { bar" + box + "}") == "bodies/bar:1:3 ");      // merged as well
    CHECK(found("structures { \"p.*\"" + box + "\"p.*\"" + box + "}") == "structures/\"p.*\":1:2 ");
    CHECK(found("#ifeq a b\nbodies { a" + box + " a" + box + "}\n#endif") == "bodies/a:2:3 ");
    CHECK(found("bodies { bar { shape #calc #{ } } } #}; a \"}}\"; /* } */ b (0 (1)); } // }\n bar {} }") == "bodies/bar:1:2 ");

    CHECK(found("bodies { a" + box + " b" + box + "} structures { a" + box + " c" + box + "}") == "");
    CHECK(found("materials { a {} a {} } bodies { a { array {} array {} } b { array {} poses ( { a {} } { a {} } ); } }") == "");
    CHECK(found("bodies { // bar {}\n /* bar {} */ bar { note \"bar {\"; code #{ bar { #}; } }") == "");
    CHECK(found("#ifeq $x 1\nbodies { a" + box + "}\n#else\nbodies { a" + box + "}\n#endif\n#ifeq $x 3\nbodies { a" + box + "}\n#endif") == "");
    CHECK(found("#include \"base\"\nbodies { a" + box + "#if 1\n a { density 700; }\n#elif 0\n a { density 800; }\n#endif\n b { $a; } }") == "");
    CHECK(found("bodies { $a { } $a { } ${b} { } ${b} { } x #eval{ 1 + 2 }; y #eval{ 2 }; }") == "");
    CHECK(found("} } ) #endif bodies { \"a") == "");  // never fails
}

TEST_CASE("two groups of one name in constant/bodies are refused, those of an included file are changed")
{
    BodiesScene s;
    const auto write = [&](const std::string& file, const std::string& contents)
    {
        MPI_Barrier(MPI_COMM_WORLD); // others may still read
        if (s.halo.rank() == 0) std::ofstream(s.foam.folder() + "/constant/" + file) << "FoamFile { version 2.0; format ascii; class dictionary; object bodies; }\n" << contents;
        MPI_Barrier(MPI_COMM_WORLD);
    };
    BodiesInput input;
    const auto message = [&] { return messageOf([&] { input = readBodies(s.foam.mesh(), s.adapter.mesh, s.halo, Vec3(0, -9.81, 0)); }); };
    const std::string first = "bar { " + bar + "position (0.5 0.5 0.2); }\n", second = "bar { " + bar + "position (0.5 0.7 0.2); }\n";
    write("bodies", "bodies\n{\n" + first + second + "}\n");
    const std::string refused = message();
    CHECK(has(refused, "'bar' stands twice in 'bodies', in lines 4 and 5"));
    CHECK(has(refused, "a name of its own"));
    write("base", "bodies\n{\n" + first + "}\n");
    write("bodies", "#include \"base\"\nbodies\n{\nbar { density 700; }\n}\n");
    CHECK(message().empty());
    REQUIRE(input.bodies.size() == 1);
    CHECK(input.bodies[0].mass == near(700*input.bodies[0].volume, 1e-14));
    MPI_Barrier(MPI_COMM_WORLD);
}

TEST_CASE("an open STL is refused with its file")
{
    BodiesScene s;
    if (s.halo.rank() == 0) std::filesystem::create_directories(s.foam.folder() + "/constant/triSurface");
    if (s.halo.rank() == 0) std::ofstream(s.foam.folder() + "/constant/triSurface/open.stl")
        << "solid open\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid open\n";
    MPI_Barrier(MPI_COMM_WORLD);
    const std::string message = s.message(bodies("shape { type stl; file \"open.stl\"; } density 500;"));
    CHECK(has(message, "open.stl"));
    CHECK(has(message, "the surface is open")); // so it was found and read, on every rank
    const std::string absent = s.message(bodies("shape { type stl; file \"absent.stl\"; } density 500;"));
    CHECK(has(absent, "absent.stl is missing; its folder has "));
    CHECK(has(absent, "open.stl"));
    CHECK(has(s.message(bodies("shape { type stl; file \"no/absent.stl\"; } density 500;")), "its folder is missing, too, or empty."));
}

TEST_CASE("a body that is let go at rest in a stream that is there from the start is told")
{
    BodiesScene s;
    const SimplexMesh& mesh = s.adapter.mesh;
    FlowState state;
    FluidProperties fluid;
    fluid.gravity = {0, -9.81, 0};
    std::string restraints;
    const auto doubt = [&](const std::string& rest, double speed, const std::function<double(double y)>& alpha = [](double) { return 1.0; }, double time = 0)
    {
        state.u.assign(3*std::size_t(mesh.nNodes), 0.0);
        state.alpha.resize(mesh.nNodes);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            state.alpha[i] = alpha(mesh.spacePoint(i)[1]);
            state.u[3*std::size_t(i)] = speed;
        }
        const BodiesInput input = s.read("bodies { crate { shape { type box; size (0.3 0.3 0.3); } density 600; position (0.5 0.5 0.2); " + rest + " } } " + restraints);
        return bodyInStream(input, mesh, s.halo, fluid, state, time);
    };
    CHECK(has(doubt("", 1), "body crate is let go at rest in a stream of 1 m/s"));
    CHECK(has(doubt("", 1), "`velocity (1 0 0);`"));
    CHECK(doubt("", 0).empty());
    CHECK(doubt("", 0.1).empty());                      // slow: 0.06 of sqrt(g 0.3 m)
    CHECK(doubt("velocity (0.8 0 0);", 1).empty());
    CHECK(doubt("releaseTime 0.1;", 1).empty());
    CHECK(has(doubt("releaseTime 0.1;", 1, [](double) { return 1.0; }, 0.1), "body crate"));
    CHECK(doubt("beforeRelease absent;", 1).empty());
    const auto pool = [](double y) { return y < 0.2 ? 1.0 : 0.0; };
    CHECK(doubt("", 1, pool).empty());                  // wind
    CHECK(has(doubt("", 1, [](double y) { return y < 0.5 ? 1.0 : 0.0; }), "stream of 1 m/s"));
    restraints = "restraints { mooring { type tether; body crate; refAttachmentPt (0.35 0.5 0.2); anchor (0 0.5 0.2); stiffness 1e4; damping 100; } }";
    CHECK(has(doubt("", 1), "its restraints stop it with a jerk. Hold it until"));
    CHECK_FALSE(has(doubt("", 1), "`velocity"));        // a moored body that moves with the stream is stopped as well
    fluid.gravity = {0, 0, 0};
    CHECK(doubt("", 1).empty());
}

TEST_CASE("bodies lighter than the gas, those that their weight presses deep into what they lie on, those never released, and friction coefficients for angles, are told")
{
    BodiesScene s;
    FluidProperties fluid;
    fluid.gravity = {0, -9.81, 0};
    const std::string cube = "shape { type box; size (0.1 0.1 0.1); } ";
    const auto doubts = [&](const std::string& stiffness, const std::string& rest) // two cubes
    {
        const BodiesInput input = s.read("materials (wood steel); wallMaterial steel; contact { default { stiffness 100; } wood-steel { " + stiffness + " } } bodies { cube { " + cube + rest
            + " material wood; poses ( { position (0.5 0.5 0.2); } { position (0.8 0.5 0.2); } ); } }");
        return doubtfulBodies(input, fluid, 5);
    };
    CHECK(doubts("stiffness 1e4;", "density 600;").empty());
    const auto light = doubts("stiffness 1e4;", "density 0.6;");
    REQUIRE(light.size() == 1);
    CHECK(has(light[0], "body cube.0 (and 1 more) is lighter than the gas (density 0.6, gas 1 kg/m^3)"));
    fluid.isTwoPhase = false;
    CHECK(doubts("stiffness 1e4;", "density 0.6;").empty());
    const auto soft = doubts("stiffness 1000;", "mass 1;");     // 9.81 mm of 100 mm
    REQUIRE(soft.size() == 1);
    CHECK(has(soft[0], "its weight alone (9.81 N) presses it 0.00981 m, 10 % of its thickness"));
    CHECK(has(soft[0], "19620 N/m"));
    CHECK(doubts("stiffness 2000;", "mass 1;").empty());        // 4.9 %
    CHECK(doubts("stiffness 1e4;", "density 600; releaseTime 4.9;").empty());
    const auto held = doubts("stiffness 1e4;", "density 600; releaseTime 50;");
    REQUIRE(held.size() == 1);
    CHECK(has(held[0], "body cube.0 (and 1 more) is held all the time: its release, at 50 s, is not before endTime, 5 s"));
    const auto absent = doubts("stiffness 1e4;", "density 600; releaseTime 50; beforeRelease absent;");
    REQUIRE(absent.size() == 1);
    CHECK(has(absent[0], "body cube.0 (and 1 more) does not enter"));
    CHECK(doubts("stiffness 1000; perBody off;", "mass 1;").empty());
    CHECK(doubts("stiffness 1e8;", "density 19300;").empty());
    CHECK(doubts("stiffness 1e4; frictionAngle 0;", "density 600;").empty());
    CHECK(doubts("stiffness 1e4; frictionAngle 2;", "density 600;").empty());
    const std::string stick = " stick { shape { type box; size (0.2 0.02 0.02); } density 600; position (0.5 0.8 0.2); } ";
    const auto beside = [&](const std::string& spheres) { return doubtfulBodies(s.read("bodies { block { shape { type box; size (0.2 0.2 0.2); } density 600; position (0.5 0.5 0.2); " + spheres + " }" + stick + "}"), fluid, 5); };
    REQUIRE(beside("").size() == 1);
    CHECK(has(beside("")[0], "body block is thick beside others, of 0.02 m: in contact its edges are rounded by the radius of its spheres, 0.05 m"));
    CHECK(beside("spheres { radius 0.02; }").empty());
    const auto coefficient = doubts("stiffness 1e4; frictionAngle 0.577;", "density 600;");
    REQUIRE(coefficient.size() == 1);
    CHECK(has(coefficient[0], "frictionAngle 0.577 of constant/bodies is in degrees, a friction coefficient of 0.0100709: for a coefficient of 0.577 give 29.98"));
    const auto heavy = doubts("stiffness 1e8;", "mass 590;");
    REQUIRE(heavy.size() == 1);
    CHECK(has(heavy[0], "body cube.0 (and 1 more) has density 590000 kg/m^3, more than any matter: mass 590 kg in 0.001 m^3"));
}
