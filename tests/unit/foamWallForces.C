// SPDX-License-Identifier: GPL-3.0-or-later
/// wallForces of controlDict: which patches are meant, what is refused; the files. On 1 and 2 ranks.
#include "foam/wallForces.H"
#include "support/boundaryScene.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

using namespace flotsam;

namespace
{

struct Channel : BoundaryScene
{
    Channel(const Edits& edits = {}) : BoundaryScene(edits) {}

    std::vector<WallForceGroup> read(const std::string& controlDict) { return readWallForces(parse(controlDict), foam.mesh().boundaryMesh(), adapter.mesh, patches); }
    std::string message(const std::string& group) { return messageOf([&] { read("wallForces { " + group + " }"); }); }
    std::vector<std::string> names(const std::string& entry) { return read("wallForces { bed { patches " + entry + "; } }").at(0).patchNames; }
};

/// Numbers of the last line.
std::vector<double> lastLine(const std::string& file)
{
    std::ifstream in(file);
    std::string line, last;
    while (std::getline(in, line)) last = line;
    std::istringstream numbers(last);
    return {std::istream_iterator<double>(numbers), {}};
}

} // namespace

TEST_CASE("patches by name, pattern and group; each once; nothing without the entry")
{
    Channel channel;
    CHECK(channel.read("deltaT 1;").empty());
    CHECK(channel.read("wallForces {}").empty());
    for (const char* entry : {"(floor)", "(\"fl.*\")", "(wall)", "(floor \"f.*r\" wall)"}) CHECK(channel.names(entry) == std::vector<std::string>{"floor"});
    const auto groups = channel.read("wallForces { bed { patches (floor); origin (1 2 3); } again { patches (floor); } }");
    REQUIRE(groups.size() == 2);
    CHECK(groups[0].origin == Vec3(1, 2, 3));
    CHECK(groups[1].origin == Vec3(0, 0, 0));
    REQUIRE(watchedPatches(groups).size() == 1);
    CHECK(channel.patches[watchedPatches(groups)[0]].name == "floor");
    Channel slip({{"0/U", "top { type pressureInletOutletVelocity; value uniform (0 0 0); }", "top { type slip; }"}, {"0/p_rgh", "top { type", "top { type fixedFluxPressure; } other { type"}});
    CHECK(slip.names("(top)") == std::vector<std::string>{"top"});  // of type patch, but a wall to the fluid
}

TEST_CASE("what is no wall, no patch or no list is refused with what there is")
{
    Channel channel;
    CHECK(has(channel.message("bed { patches (flor); }"), "'flor' is no patch, pattern or group of patches of the mesh. Walls of the mesh: floor."));
    CHECK(has(channel.message("bed { patches (flor); }"), "Did you mean: floor ?"));
    CHECK(has(channel.message("bed { patches (floor \"b.*\"); }"), "'b.*' is no patch, pattern"));
    CHECK(has(channel.message("bed { patches (inlet); }"), "inlet is no wall (fluid passes through it). Walls of the mesh: floor."));
    CHECK(has(channel.message("bed { patches (\".*\"); }"), "is no wall"));
    CHECK(has(channel.message("bed { patches (frontAndBack); }"), "frontAndBack is no wall (front or back of a 2D mesh)"));
    CHECK(has(channel.message("bed { patches (); }"), "a list of at least one patch; walls of the mesh: floor"));
    CHECK(has(channel.message("bed { patches floor; }"), "a list of patches, for instance (dam \"pier.*\")"));
    CHECK(has(channel.message("bed { origin (0 0 0); }"), "patches"));
    CHECK(has(channel.message("bed { patches (floor); origin 3; }"), "a point (x y z) [m]"));
    CHECK(has(channel.message("bed { patches (floor); CofR (0 0 0); }"), "origin"));
    CHECK(has(channel.message("patches (floor);"), "'patches' is no group of patches"));
    CHECK(has(messageOf([&] { channel.read("wallForces on;"); }), "wallForces { .. }"));
}

TEST_CASE("files: columns, moments about the origin, total; none is written over")
{
    Channel channel;
    const auto groups = channel.read("wallForces { bed { patches (floor); origin (1 0 0); } }");
    std::vector<PatchForce> forces(channel.patches.size());
    PatchForce& f = forces[groups[0].patches[0]];
    f.pressure = Vec3(1, 2, 0);
    f.friction = Vec3(10, 20, 0);
    f.pressureMoment = Vec3(0, 0, 5);
    f.frictionMoment = Vec3(0, 0, 50);
    const std::vector<ContactForce> contact{{Vec3(100, 200, 300), Vec3(7, 8, 500), Vec3(400, 500, 600)}};
    const std::string folder = channel.foam.time().globalPath() + "/postProcessing/bed/0/";
    for (const char* number : {"", "_1", "_2"})
    {
        {
            WallForceFiles files(channel.foam.time(), channel.adapter.mesh, groups);
            files.write(0.25, 0.1, forces, contact);
        }
        MPI_Barrier(MPI_COMM_WORLD);
        CHECK(lastLine(folder + "force" + number + ".dat") == std::vector<double>{0.25, 111, 222, 300, 1, 2, 0, 10, 20, 0, 100, 200, 300, 400, 500, 600});
        // less (1 0 0) x force; the parts out of the plane are not those of one layer of cells
        CHECK(lastLine(folder + "moment" + number + ".dat") == std::vector<double>{0.25, 0, 0, 333, 0, 0, 3, 0, 0, 30, 0, 0, 300});
        MPI_Barrier(MPI_COMM_WORLD);
    }
}

TEST_CASE("summary: means over the time of the steps, largest forces")
{
    Channel channel;
    const auto groups = channel.read("wallForces { bed { patches (floor); } }");
    std::vector<PatchForce> forces(channel.patches.size());
    WallForceFiles files(channel.foam.time(), channel.adapter.mesh, groups);
    forces[groups[0].patches[0]].pressure = Vec3(4, 0, 0);
    files.write(0.1, 0.1, forces, {ContactForce()});
    forces[groups[0].patches[0]].pressure = Vec3(0, 3, 0);
    files.write(0.4, 0.3, forces, {{Vec3(0, 1, 0), Vec3::Zero(), Vec3(0, 0, 9)}});
    if (Foam::Pstream::master()) CHECK(has(files.summary(), "bed                              1        2.25           0           0        0.75           0               4         1          4         9\n"));
}
