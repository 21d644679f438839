// SPDX-License-Identifier: GPL-3.0-or-later
/// Solids that squeeze fluid out of less than an element: at any step the system has a solution, and what is no number is no step.
#include "support/coupledRig.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

using namespace flotsam;

namespace
{

/// A plate 0.33 m wide that sinks onto and through the floor of a tank of 20 x 20 elements.
struct Press : CoupledRig
{
    Press() : CoupledRig(makeBoxMesh(MPI_COMM_WORLD, 2, {20, 20, 1}, {0, 0, 0}, {1, 1, 1}))
    {
        for (int p : {0, 1, 2}) patches.push_back(makePatch(mesh, p, BoundaryPatch::Velocity::Slip));
        patches.push_back(makePatch(mesh, 3, BoundaryPatch::Velocity::Open));
    }

    std::unique_ptr<CoupledStep> plate(double height, double speed, Solid::Wall wall)
    {
        SceneStructure plate;
        plate.solid.kind = Solid::Kind::Prescribed;
        plate.solid.wall = wall;
        plate.solid.shape = makeBox(Vec3::Zero(), Vec3(0.33, 0.17, 1));
        plate.motion = [height, speed](double time, Pose& pose, Motion& motion)
        {
            pose.position = Vec3(0.51, height - speed*time, 0.5);
            motion.velocity = Vec3(0, -speed, 0);
        };
        auto run = std::make_unique<CoupledStep>(mesh, halo, fluid, controls, patches, Scene({plate}, {}, Vec3::Zero()), nullptr, timers);
        run->start(restState(mesh), true);
        return run;
    }
};

} // namespace

TEST_CASE("a plate presses the water out under it, in steps of any part of an element")
{
    const double speed = 0.8;
    for (const Solid::Wall wall : {Solid::Wall::NoSlip, Solid::Wall::Slip})
        for (const double elements : {0.3, 1.0, 2.0})
        {
            double fastest = 0;
            int steps = 0, unsolved = 0;
            for (int place = 0; place < 10; ++place)
            {
                Press press;
                const auto run = press.plate(0.285 + 0.005*place, speed, wall);
                for (; run->fluid().state().time < 0.4; ++steps)
                {
                    const StepResult result = run->step(elements/20/speed);
                    unsolved += !result.isAccepted || !result.hasConverged;
                    if (!result.isAccepted) break;
                    fastest = std::max(fastest, largestSpeed(press.mesh, press.halo, run->fluid().state().u));
                }
            }
            std::printf("%.1f elements a step: fastest %.2f times the plate, %d of %d steps not solved\n", elements, fastest/speed, unsolved, steps);
            CHECK(unsolved == 0);
            CHECK(fastest < 0.165/0.005*speed); // half of the width swept, out through a tenth of an element
        }
}

TEST_CASE("a plate that nears a no-slip floor drives the water out under it as one over a slip floor does, down to a gap of an element")
{
    const double speed = 0.8, start = 0.2, end = 0.06;    // gaps: 4 and 1.2 elements
    double outward[2];
    for (const bool isNoSlip : {false, true})
    {
        Press press;
        if (isNoSlip) press.patches[2] = makePatch(press.mesh, 2, BoundaryPatch::Velocity::NoSlip);
        press.patches[2].isNoSlipWall = isNoSlip;
        const auto run = press.plate(start + 0.085, speed, Solid::Wall::NoSlip);
        for (int k = 0; k < 50; ++k) REQUIRE(run->step((start - end)/50/speed).isAccepted);
        double sum = 0, n = 0;
        const SimplexMesh& mesh = press.mesh;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            if (std::abs(mesh.x[2*std::size_t(i)] - 0.65) > 1e-6 || mesh.x[2*std::size_t(i) + 1] > end) continue;
            sum += run->fluid().state().u[2*std::size_t(i)];
            ++n;
        }
        outward[isNoSlip] = press.halo.sum(sum)/press.halo.sum(n);
        std::printf("%s floor: %.3f of speed times distance over gap\n", isNoSlip ? "no-slip" : "slip", outward[isNoSlip]/(speed*(0.65 - 0.51)/end));
    }
    CHECK(outward[0] == near(speed*(0.65 - 0.51)/end, 0.05));
    CHECK(outward[1] == near(outward[0], 0.02));
}

TEST_CASE("fluid shut in a hole of an element or two: open to the pressure around")
{
    struct Hole { double centre, width; }; // around one node; around four nodes with two whole elements between them
    for (const Hole& hole : {Hole{0.5, 0.06}, Hole{0.485, 0.09}})
    {
        CAPTURE(hole.width);
        Press press;
        press.fluid.gravity[1] = -9.81;
        const double c = hole.centre, w = hole.width, side = 0.5*w + 0.05;
        SceneStructure cup, lid;
        cup.solid.shape = makeUnion({makeBox(Vec3(-side, 0, 0), Vec3(0.1, w + 0.1, 1)), makeBox(Vec3(side, 0, 0), Vec3(0.1, w + 0.1, 1)), makeBox(Vec3(0, -side, 0), Vec3(w + 0.2, 0.1, 1))});
        cup.solid.pose.position = Vec3(c, c, 0.5);
        lid.solid.kind = Solid::Kind::Prescribed;
        lid.solid.shape = makeBox(Vec3::Zero(), Vec3(w + 0.2, 0.1, 1));
        lid.motion = [c, side](double time, Pose& pose, Motion& motion)
        {
            pose.position = Vec3(c, c + side - 0.1*std::min(time, 0.1), 0.5); // the hole is smaller with every step, then it stays
            motion.velocity = Vec3(0, time < 0.1 ? -0.1 : 0, 0);
        };
        CoupledStep run(press.mesh, press.halo, press.fluid, press.controls, press.patches, Scene({cup, lid}, {}, Vec3::Zero()), nullptr, press.timers);
        run.start(restState(press.mesh), true);
        for (int k = 0; k < 20; ++k)
        {
            const StepResult result = run.step(0.01);
            REQUIRE(result.isAccepted);
            CHECK(result.hasConverged);
            if (k > 0) CHECK(result.linearIterations < 100);
        }
        for (int i = 0; i < press.mesh.nOwned; ++i)
        {
            const double x = press.mesh.x[2*std::size_t(i)], y = press.mesh.x[2*std::size_t(i) + 1];
            if (std::abs(x - 0.5) > 1e-6 || std::abs(y - 0.5) > 1e-6) continue;
            std::printf("pressure in the hole %.0f Pa, around %.0f Pa\n", run.fluid().state().p[i], 1000*9.81*0.5);
            CHECK(run.fluid().state().p[i] == near(1000*9.81*0.5, 0.01));
        }
    }
}

TEST_CASE("fluid shut in a wall between two pressures: nothing drives it")
{
    Press press;
    const double head = 2000;   // [Pa] on the left; the hole's nodes are open to one side or the other
    press.patches.clear();
    for (int p : {0, 1}) press.patches.push_back(makePatch(press.mesh, p, BoundaryPatch::Velocity::Open));
    for (int p : {2, 3}) press.patches.push_back(makePatch(press.mesh, p, BoundaryPatch::Velocity::Slip));
    const auto atRest = press.patches[0].evaluate;
    press.patches[0].evaluate = [&](const BoundaryState& state, PatchValues& values)
    {
        atRest(state, values);
        std::fill(values.pressure.begin(), values.pressure.end(), head);
    };
    const auto brick = [](double width, double height, double x, double y) { return makeBox(Vec3(x, y, 0), Vec3(width, height, 1)); };
    SceneStructure wall;        // 0.3 wide; a hole of 0.06 around the node (0.5, 0.5)
    wall.solid.shape = makeUnion({brick(0.12, 1.2, -0.09, 0), brick(0.12, 1.2, 0.09, 0), brick(0.3, 0.57, 0, -0.315), brick(0.3, 0.57, 0, 0.315)});
    wall.solid.pose.position = Vec3(0.5, 0.5, 0.5);
    CoupledStep run(press.mesh, press.halo, press.fluid, press.controls, press.patches, Scene({wall}, {}, Vec3::Zero()), nullptr, press.timers);
    FlowState start = restState(press.mesh);
    for (int i = 0; i < press.mesh.nNodes; ++i) start.p[i] = press.mesh.x[2*std::size_t(i)] < 0.5 ? head : 0;
    run.start(start, true);
    double fastest = 0;
    for (int k = 0; k < 20; ++k)
    {
        REQUIRE(run.step(0.005).isAccepted);
        fastest = std::max(fastest, largestSpeed(press.mesh, press.halo, run.fluid().state().u));
    }
    std::printf("fastest fluid %.1e m/s, at rest at first\n", fastest);
    CHECK(fastest < 1e-4);
}

TEST_CASE("a gap of a hundredth of an element that closes: its fluid does not leave as a jet")
{
    Press press;
    const double speed = 0.05, dt = 1e-3, gap = 7.5e-4, row = 0.5; // around a row of nodes, open at both ends
    SceneStructure anvil, hammer;
    anvil.solid.shape = makeBox(Vec3::Zero(), Vec3(0.33, 0.17, 1));
    anvil.solid.pose.position = Vec3(0.51, row - 0.5*gap - 0.085, 0.5);
    hammer.solid.kind = Solid::Kind::Prescribed;
    hammer.solid.shape = anvil.solid.shape;
    hammer.motion = [&](double time, Pose& pose, Motion& motion)
    {
        pose.position = Vec3(0.51, row + 0.5*gap + 0.085 - speed*time, 0.5);
        motion.velocity = Vec3(0, -speed, 0);
    };
    CoupledStep run(press.mesh, press.halo, press.fluid, press.controls, press.patches, Scene({anvil, hammer}, {}, Vec3::Zero()), nullptr, press.timers);
    run.start(restState(press.mesh), true);
    double fastest = 0;
    for (int k = 0; k < 6; ++k) // the first one is an impulse, of which the pressures of the step before know nothing
    {
        REQUIRE(run.step(dt).isAccepted);
        if (k > 0) fastest = std::max(fastest, largestSpeed(press.mesh, press.halo, run.fluid().state().u));
    }
    std::printf("fastest %.1f times the hammer\n", fastest/speed);
    CHECK(fastest < 0.5*press.mesh.h[0]/gap*speed); // half an element at either end is not thin
}

TEST_CASE("a plate that comes down on a wall gets there in steps of the Courant number, and what it presses out has a bound")
{
    constexpr double speed = 0.8, maxCo = 0.7, start = 0.02, least = 0.01/20; // gaps: 0.4 and a hundredth of an element
    for (const Solid::Wall wall : {Solid::Wall::NoSlip, Solid::Wall::Slip})
    {
        Press press;
        press.mesh.patches[2].type = "wall";
        const auto run = press.plate(start + 0.085, speed, wall);
        double fastest = 0, last = 0;
        int steps = 0;
        for (double dt = 1e-3; run->fluid().state().time < 2*start/speed && steps < 400; ++steps)
        {
            REQUIRE(run->step(dt).isAccepted);
            last = largestSpeed(press.mesh, press.halo, run->fluid().state().u);
            fastest = std::max(fastest, last);
            const double rate = courantRates(press.mesh, press.halo, run->cover(), run->fluid().state()).largest;
            dt = std::min({1e-3, 1.2*dt, maxCo/rate});
        }
        std::printf("plate on the floor after %d steps, fastest %.0f, at the end %.1f times the plate\n", steps, fastest/speed, last/speed);
        CHECK(steps < 200);
        CHECK(fastest < 1.5*0.165/least*speed);
        CHECK(last < 0.165/start*speed); // no faster than what the first gap let out
    }
}

TEST_CASE("a piston with less than a hundredth of an element beside it shuts in what is under it")
{
    Press press;
    for (int p : {0, 1, 2}) press.mesh.patches[p].type = "wall";
    const double speed = 0.8;
    for (const double slit : {0.0, 1e-5, 4e-4})
    {
        SceneStructure piston;
        piston.solid.name = "piston";
        piston.solid.kind = Solid::Kind::Prescribed;
        piston.solid.wall = Solid::Wall::Slip;
        piston.solid.shape = makeBox(Vec3::Zero(), Vec3(1 - 2*slit, 1, 1));
        piston.motion = [&](double time, Pose& pose, Motion& motion)
        {
            pose.position = Vec3(0.5, 1.1 - speed*time, 0.5);
            motion.velocity = Vec3(0, -speed, 0);
        };
        CoupledStep run(press.mesh, press.halo, press.fluid, press.controls, press.patches, Scene({piston}, {}, Vec3::Zero()), nullptr, press.timers);
        run.start(restState(press.mesh), true);
        double fastest = 0;
        for (int k = 0; k < 40; ++k)
        {
            const StepResult result = run.step(0.01);
            REQUIRE(result.isAccepted);
            CHECK(result.hasConverged);
            fastest = std::max(fastest, largestSpeed(press.mesh, press.halo, run.fluid().state().u));
        }
        std::printf("slit of %g: fastest %.1f times the piston\n", slit, fastest/speed);
        CHECK(fastest < 5*speed);
        CHECK(run.fluid().describeSqueezed().find("'piston' about (0.5 0.2") == 0);     // its lower side
        CHECK(run.fluid().describeFastest().find("piston'") != std::string::npos);
    }
}

TEST_CASE("a step whose equations are not a number is not accepted")
{
    Press press;
    press.fluid.gravity[1] = std::numeric_limits<double>::quiet_NaN();
    const auto run = press.plate(0.3, 0.8, Solid::Wall::NoSlip);
    const StepResult result = run->step(0.01);
    CHECK(!result.isAccepted);
    CHECK(result.failure == "the linear solver did not converge");
    CHECK(run->fluid().state().time == 0);
}
