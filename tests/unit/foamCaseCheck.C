// SPDX-License-Identifier: GPL-3.0-or-later
/// The report of a dry run: counts, what is skipped, an estimate.
#include "foam/boundaryReader.H"
#include "foam/caseCheck.H"
#include "foam/startReport.H"
#include "support/foamCase.H"

#include <doctest/doctest.h>

#include <iostream>
#include <mpi.h>
#include <sstream>

using namespace flotsam;

TEST_CASE("prescribed velocities must let out what they let in, unless a patch is open")
{
    const auto message = [](const std::string& outlet, const std::string& top)
    {
        FoamCase foam("foamChannel", {{"0/U", "flowRateInletVelocity; volumetricFlowRate constant 0.05; value uniform (0 0 0);", "fixedValue; value uniform (1 0 0);"},
            {"0/U", "outlet { type zeroGradient; }", "outlet { type fixedValue; value uniform (" + outlet + " 0 0); }"}, {"0/U", "top { type pressureInletOutletVelocity; value uniform (0 0 0); }", top},
            {"0/p_rgh", "outlet { type fixedValue; value uniform 7; }", "outlet { type fixedFluxPressure; value uniform 0; }"},
            {"0/p_rgh", "top { type totalPressure; p0 uniform 3; }", top.find("slip") == std::string::npos ? "top { type totalPressure; p0 uniform 3; }" : "top { type slip; }"},
            {"0/alpha.water", "inlet { type variableHeightFlowRate; lowerBound 0.1; upperBound 0.9; value uniform 0; }", "inlet { type fixedValue; value uniform 1; }"}});
        const CaseControls controls = readCaseControls(foam.time());
        const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
        const Halo halo(adapter.mesh, MPI_COMM_WORLD);
        FlowState state;
        state.u.assign(std::size_t(adapter.mesh.nNodes)*2, 0.0);
        state.alpha.assign(adapter.mesh.nNodes, 1.0);
        try { checkInflow(adapter, halo, readBoundary(foam.mesh(), adapter, halo, controls), state, nullptr, 0); }
        catch (const std::invalid_argument& e) { return std::string(e.what()); }
        return std::string();
    };
    const std::string shut = "top { type slip; }", open = "top { type pressureInletOutletVelocity; value uniform (0 0 0); }";
    CHECK(message("1", shut).empty());
    CHECK(message("1.005", shut).empty());
    CHECK(message("0.5", open).empty());
    CHECK(message("0.5", shut).find("0.1") != std::string::npos);     // m^3/s that come in through 1 m x 0.1 m
    CHECK(!message("0", shut).empty());
}

TEST_CASE("gravity along the empty direction of a 2D mesh is refused for two fluids")
{
    SimplexMesh mesh;
    mesh.dim = 2;
    const auto message = [&](const std::array<double, 3>& g, bool isTwoPhase)
    {
        FluidProperties fluid;
        fluid.gravity = g;
        fluid.isTwoPhase = isTwoPhase;
        return messageOf([&] { checkGravity(fluid, mesh); });
    };
    CHECK(message({0, 0, -9.81}, true).find("constant/g is (0 0 -9.81), along z, the empty direction of this 2D mesh") != std::string::npos);
    CHECK(message({0, 0, -9.81}, true).find("for instance (0 -9.81 0)") != std::string::npos);
    CHECK(message({0, 0, -9.81}, false).empty());   // does nothing
    CHECK(message({0, -9.81, 0}, true).empty());
    CHECK(message({0, -9.7, -1}, true).empty());
    CHECK(message({0, 0, 0}, true).empty());
    mesh.axes = {2, 0, 1};
    CHECK(message({0, -9.81, 0}, true).find("along y") != std::string::npos);
    CHECK(message({0, -9.81, 0}, true).find("for instance (0 0 -9.81)") != std::string::npos);
    CHECK(message({0, 0, -9.81}, true).empty());
    mesh.dim = 3;
    CHECK(message({0, -9.81, 0}, true).empty());
}

TEST_CASE("densities in other units, fluids of one density, viscosities")
{
    const auto doubts = [](double liquid, double gas, bool isTwoPhase, double nuLiquid = 1e-6, double nuGas = 1.5e-5)
    {
        CaseControls controls;
        controls.liquidName = "water";
        controls.fluid.rhoLiquid = liquid;
        controls.fluid.rhoGas = gas;
        controls.fluid.muLiquid = liquid*nuLiquid;
        controls.fluid.muGas = gas*nuGas;
        controls.fluid.isTwoPhase = isTwoPhase;
        std::string all;
        for (const std::string& doubt : doubtfulFluids(controls)) all += doubt + "|";
        return all;
    };
    CHECK(doubts(1000, 1.2, true).empty());
    CHECK(doubts(500, 100, true).empty());
    CHECK(doubts(1, 0.0012, true).find("rho of water is 1 kg/m^3, less than that of any liquid") == 0);
    CHECK(doubts(1, 1, true).find("both fluids have the density 1 kg/m^3") == 0);
    CHECK(doubts(1.2, 1.2, false).empty());         // air
    CHECK(doubts(1000, 1.2, true, 1e-6, 1.5e5).find("the gas is far more viscous than water: rho nu is 180000 and 0.001 Pa s") == 0);
    CHECK(doubts(1000, 1.2, true, 1e-3, 1.5e-5).empty());   // a thick oil, or a dynamic viscosity
    CHECK(doubts(1000, 1.2, true, 1e-9, 1e-8).find("rho nu of water is 1e-06 Pa s, less than that of any liquid") == 0);
}

TEST_CASE("steps beyond sense, a reference level far from the mesh, a gravity that is not the earth's")
{
    TimeControls time;
    time.adjustTimeStep = true;
    time.maxCo = 5;
    time.maxBodyCo = 1;
    CHECK(doubtfulSteps(time).empty());
    time.maxCo = 500;
    time.maxBodyCo = 20;
    const auto doubts = doubtfulSteps(time);
    REQUIRE(doubts.size() == 2);
    CHECK(doubts[0].find("maxCo 500 of system/controlDict lets the water cross 500 elements in a step") == 0);
    CHECK(doubts[1].find("maxBodyCo 20 of system/controlDict lets a body cross 20 elements") == 0);
    time.adjustTimeStep = false;    // they are not used
    CHECK(doubtfulSteps(time).empty());

    FoamCase foam("foamChannel");
    CaseControls controls = readCaseControls(foam.time());
    const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
    const Halo halo(adapter.mesh, MPI_COMM_WORLD);
    const auto level = [&](double hRef) { controls.gravityPotentialRef = controls.fluid.gravity[1]*hRef; return doubtfulLevel(controls, adapter.mesh, halo); };
    CHECK(level(0).empty());
    CHECK(level(0.7).empty());      // the mesh is 1 m high
    CHECK(level(300).find("constant/hRef is 300 m, and the mesh reaches from 0 to 1 m in height") == 0);

    const auto boundary = readBoundary(foam.mesh(), adapter, halo, controls);
    const auto report = [&](double g)
    {
        controls.fluid.gravity = {0, -g, 0};
        std::ostringstream said;
        auto* screen = std::cout.rdbuf(said.rdbuf());
        printCaseCheck(controls, adapter, halo, boundary, SceneCounts());
        std::cout.rdbuf(screen);
        return said.str();
    };
    CHECK(report(9.81).find("times the earth's") == std::string::npos);
    CHECK(report(1.62).find("times the earth's") == std::string::npos);     // the moon's
    CHECK(report(98.1).find("constant/g has 98.1 m/s^2, 10 times the earth's") != std::string::npos);
    CHECK(report(0.981).find("constant/g has 0.981 m/s^2, 0.1 times the earth's") != std::string::npos);
}

TEST_CASE("patches of type patch that are walls to the fluid alone")
{
    FoamCase foam("foamChannel", {{"system/blockMeshDict", "floor { type wall;", "floor { type patch;"}});
    const CaseControls controls = readCaseControls(foam.time());
    const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
    const Halo halo(adapter.mesh, MPI_COMM_WORLD);
    auto boundary = readBoundary(foam.mesh(), adapter, halo, controls);
    const auto says = [&](int bodies, bool areWallsChosen)
    {
        SceneCounts scene;
        scene.bodies = bodies;
        scene.thinnestBody = 1;
        scene.areWallsChosen = areWallsChosen;
        std::ostringstream report;
        auto* screen = std::cout.rdbuf(report.rdbuf());
        printCaseCheck(controls, adapter, halo, boundary, scene);
        std::cout.rdbuf(screen);
        const std::string all = report.str();
        CHECK(all.find("bodies pass through patch top") == std::string::npos);     // open
        return all.find("bodies pass through patch floor, which lets no fluid through: it is of type patch") != std::string::npos;
    };
    CHECK(says(1, false));
    CHECK_FALSE(says(0, false));
    CHECK_FALSE(says(1, true));     // wallPatches names others
    for (BoundaryPatch& patch : boundary) patch.stopsBodies = true;
    CHECK_FALSE(says(1, false));
}

TEST_CASE("report of a channel with and without bodies")
{
    FoamCase foam("foamChannel");
    CaseControls controls = readCaseControls(foam.time());
    const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
    const Halo halo(adapter.mesh, MPI_COMM_WORLD);
    auto boundary = readBoundary(foam.mesh(), adapter, halo, controls);
    SceneCounts scene;

    std::ostringstream report;
    const auto capture = [&](const SceneCounts& counts)
    {
        report.str("");
        auto* screen = std::cout.rdbuf(report.rdbuf());
        printCaseCheck(controls, adapter, halo, boundary, counts);
        std::cout.rdbuf(screen);
        return report.str();
    };
    const std::string empty = capture(scene);
    CHECK(empty.find("2D triangles, 231 nodes, 400 elements") != std::string::npos);
    CHECK(empty.find("DEM engine not opened") != std::string::npos);
    CHECK(empty.find("floor: velocity no-slip") != std::string::npos);
    CHECK(empty.find("; 0.2 m^2 from (0 0 0.05) to (2 0 0.05)\n") != std::string::npos);     // floor
    CHECK(empty.find("; 0.1 m^2 from (2 0 0.05) to (2 1 0.05)\n") != std::string::npos);     // outlet
    CHECK(empty.find("memory") != std::string::npos);
    CHECK(empty.find("warning") == std::string::npos);
    const auto g = controls.fluid.gravity;
    controls.fluid.gravity = {0, -9.81, -1};
    CHECK(capture(scene).find("gravity acts along z, across this 2D mesh") != std::string::npos);
    controls.fluid.gravity = {0, -981, 0};
    CHECK(capture(scene).find("constant/g has 981 m/s^2, which is the earth's gravity in cm/s^2") != std::string::npos);
    controls.fluid.gravity = {0, -50*9.81, 0};      // a centrifuge
    CHECK(capture(scene).find("warning") == std::string::npos);
    controls.fluid.gravity = {0, 0, 0};
    CHECK(capture(scene).find("constant/g is (0 0 0)") != std::string::npos);
    controls.fluid.isTwoPhase = false;
    CHECK(capture(scene).find("warning") == std::string::npos);
    controls.fluid.isTwoPhase = true;
    controls.fluid.gravity = g;
    controls.numerics.wallRoughness = 0.05;
    CHECK(capture(scene).find("wallRoughness 0.05 m does nothing") != std::string::npos);
    controls.numerics.wallLaw = true;
    CHECK(capture(scene).find("warning") == std::string::npos);     // the floor is no-slip
    auto slippery = boundary;
    for (BoundaryPatch& patch : slippery) if (patch.isWall()) patch.velocity = BoundaryPatch::Velocity::Slip;
    std::swap(boundary, slippery);
    CHECK(capture(scene).find("wallLaw on does nothing: it is that of no-slip patches, and there are none") != std::string::npos);
    std::swap(boundary, slippery);
    controls.numerics = NumericsControls();
    scene.bodies = 20;
    scene.thinnestBody = scene.thinnestLinearBody = 0.02;
    CHECK(capture(scene).find("the fluid does not see it") != std::string::npos);
    scene.thinnestLinearBody = 0;   // cylinders and boxes float however thin they are
    CHECK(capture(scene).find("the fluid does not see it") == std::string::npos);
    CHECK(capture(scene).find("refine around the bodies") != std::string::npos);
    scene.thinnestBody = 0.2;
    CHECK(capture(scene).find("refine around the bodies") != std::string::npos);
}
