// SPDX-License-Identifier: GPL-3.0-or-later
/// Boxes that lie flush beside and on each other on the bed of a tank: hardly any pressure moves them apart, and solves that took the bodies for fixed would answer every
/// pressure far too strongly. At rest they weigh on the bed what they weigh in water, and a step needs no second solve.
#include "core/bodyWalls.hpp"
#include "support/coupledRig.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

const Vec3 boxSize(0.1, 0.1, 0.04);
constexpr double boxDensity = 1400, gravity = 9.81;

/// 3.3 cells over a box, 1.6 over its height.
struct Tank : CoupledRig
{
    Tank() : CoupledRig(makeBoxMesh(MPI_COMM_WORLD, 3, {44, 15, 8}, {0, 0, 0}, {1.32, 0.44, 0.2}))
    {
        fluid.gravity[2] = -gravity;
        for (int p = 0; p < 5; ++p) patches.push_back(makePatch(mesh, p, BoundaryPatch::Velocity::Slip));
        patches.push_back(makePatch(mesh, 5, BoundaryPatch::Velocity::Open));
        for (BoundaryPatch& patch : patches) patch.stopsBodies = patch.isWall();
        takeBodyWalls(mesh, patches);
    }
};

BodyDefinition makeBoxBody(const Vec3& position)
{
    BodyDefinition body;
    body.name = "box";
    body.shape = makeBox(Vec3::Zero(), boxSize);
    body.volume = boxSize.prod();
    body.mass = boxDensity*body.volume;
    const Vec3 square = boxSize.cwiseAbs2();
    body.principalInertia = body.mass/12*(Vec3::Constant(square.sum()) - square);
    body.pose.position = position;
    body.spheres = surfaceSpheres(*body.shape, 0.25*boxSize.minCoeff(), 0.5*boxSize.minCoeff());
    return body;
}

/// In two layers.
DemSetup pile(int along, int across)
{
    DemSetup dem;
    for (int layer = 0; layer < 2; ++layer)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < along; ++i)
                dem.bodies.push_back(makeBoxBody(Vec3(0.66 + (i - 0.5*(along - 1))*boxSize[0], 0.22 + (j - 0.5*(across - 1))*boxSize[1], (layer + 0.5)*boxSize[2])));
    dem.laws = {ContactLaw()};
    dem.box = {Vec3(0, 0, 0), Vec3(1.32, 0.44, 0.2)};
    WallDefinition bed;
    bed.name = "bed";
    bed.normal = Vec3(0, 0, 1);
    dem.walls = {bed};
    return dem;
}

} // namespace

TEST_CASE("96 boxes without gaps between them: a solve takes few iterations, and at rest a step has one")
{
    Tank tank;
    const DemSetup dem = pile(12, 4);
    CoupledStep run(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches, Scene({}, dem.bodies, Vec3(0, 0, -gravity)), &dem, tank.timers);
    run.start(restState(tank.mesh), true);
    const int settling = 11, atRest = 10;
    int iterations = 0, solves = 0, solvesAtRest = 0;
    for (int k = 0; k <= settling + atRest; ++k)
    {
        const StepResult result = run.step(std::min(0.005*(k + 1), 0.0125));
        REQUIRE(result.isAccepted);
        REQUIRE(result.hasConverged);
        if (k == 0) continue;   // its solves go on to 3e-4 of the tolerance
        iterations += result.linearIterations;
        solves += result.solves;
        if (k > settling) solvesAtRest += result.solves;
    }
    double buoyancy = 0;
    for (const BodyRecord& r : run.records()) buoyancy += r.fluidForce[2];
    const double weight = int(dem.bodies.size())*boxDensity*boxSize.prod()*gravity, onBed = -run.coupling()->wallLoads()[0].force[2];
    std::printf("%d solves, %.1f iterations a solve; at rest %d solves in %d steps, on the bed %.4f of weight less buoyancy, %.4f of the displaced weight\n",
        solves, double(iterations)/solves, solvesAtRest, atRest, onBed/(weight - buoyancy), buoyancy*boxDensity/(weight*tank.fluid.rhoLiquid));
    CHECK(iterations < 20*solves);
    CHECK(solvesAtRest <= atRest + 1);
    CHECK(onBed == near(weight - buoyancy, 0.002));
    // the film under the lower layer takes 0.05 of a cell's height from it
    CHECK(buoyancy == near(weight*tank.fluid.rhoLiquid/boxDensity*(1 - 0.05*0.025/(2*boxSize[2])), 0.005));
}
