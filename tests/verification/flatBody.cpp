// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies that lie flat on the bed of a tank: water under them carries them as it carries any other, air does not.
#include "demCoupling/coupling/coupledStep.hpp"
#include "support/budgets.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <memory>

using namespace flotsam;

namespace
{

constexpr double g = 9.81, rhoWater = 1000;

/// A tank 1 m long (3D: 0.5 m, 0.5 m wide), its walls and bed rough or smooth, water up to the open top or none.
struct Tank
{
    SimplexMesh mesh;
    Halo halo;
    FluidProperties fluid;
    NumericsControls controls;
    std::vector<BoundaryPatch> patches;
    PhaseTimers timers;
    double depth;

    Tank(int dim, double h, double depth, bool isRough = true)
    :   mesh(makeMesh(dim, h, depth)), halo(mesh, MPI_COMM_WORLD), depth(depth)
    {
        usePetsc();
        fluid.isTwoPhase = false;
        fluid.rhoLiquid = rhoWater;
        fluid.muLiquid = 1e-3;
        fluid.gravity[1] = -g;
        controls.contactTolerance = 1e-4;
        controls.maxContactRepeats = 50;
        for (int p = 0; p < 2*dim; ++p)
        {
            const bool isTop = p == 3;
            patches.push_back(makePatch(mesh, p, isTop ? BoundaryPatch::Velocity::Open : isRough ? BoundaryPatch::Velocity::Fixed : BoundaryPatch::Velocity::Slip));
            patches.back().isNoSlipWall = isRough && !isTop;
            if (!isTop) mesh.patches[p].type = "wall";
        }
    }

    static SimplexMesh makeMesh(int dim, double h, double depth)
    {
        const double length = dim == 2 ? 1 : 0.5;
        const auto cells = [h](double l) { return int(std::lround(l/h)); };
        return makeBoxMesh(MPI_COMM_WORLD, dim, {cells(length), cells(depth), cells(0.5)}, {0, 0, 0}, {length, depth, dim == 2 ? 1 : 0.5}, 0, true);
    }

    FlowState start() const
    {
        FlowState s = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i) s.p[i] = s.alpha[i]*rhoWater*g*(depth - mesh.x[std::size_t(i)*mesh.dim + 1]);
        return s;
    }
};

/// On the bed. Spheres at the corners and between, on the surface of the two ends.
BodyDefinition makeBody(int dim, const Vec3& size, double density, const Vec3& position)
{
    BodyDefinition body;
    body.name = "body";
    body.shape = makeBox(Vec3::Zero(), size);
    body.volume = size.prod();
    body.mass = density*body.volume;
    const Vec3 s = size.cwiseProduct(size);
    body.principalInertia = body.mass/12*Vec3(s[1] + s[2], s[0] + s[2], s[0] + s[1]);
    body.pose.position = position;
    body.isPlanar = dim == 2;
    body.spheres = surfaceSpheres(*body.shape, 0.25*size.minCoeff(), 0.5*size.minCoeff());
    return body;
}

BodyDefinition makeRound(double radius, double density, const Vec3& position)
{
    BodyDefinition body = makeBody(2, Vec3(2*radius, 2*radius, 1), density, position);
    body.shape = makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), radius);
    body.volume = M_PI*radius*radius;
    body.mass = density*body.volume;
    const double across = body.mass*(radius*radius/4 + 1.0/12);
    body.principalInertia = Vec3(across, across, 0.5*body.mass*radius*radius);
    body.spheres = {{Vec3::Zero(), radius}};
    return body;
}

/// height: of what carries the lowest body.
DemSetup makeDem(const Tank& tank, const std::vector<BodyDefinition>& bodies, double height = 0)
{
    DemSetup dem;
    dem.bodies = bodies;
    dem.laws = {ContactLaw()};
    dem.box = {Vec3::Zero(), Vec3(1, tank.depth, 1)};
    WallDefinition bed;
    bed.name = "bed";
    bed.point = Vec3(0, height, 0);
    bed.normal = Vec3(0, 1, 0);
    dem.walls = {bed};
    return dem;
}

DemSetup makeDem(const Tank& tank, const BodyDefinition& body, double height = 0) { return makeDem(tank, std::vector<BodyDefinition>(1, body), height); }

std::unique_ptr<CoupledStep> makeRun(Tank& tank, const DemSetup& dem, std::vector<SceneStructure> structures = {})
{
    auto run = std::make_unique<CoupledStep>(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches,
        Scene(std::move(structures), dem.bodies, Vec3(0, -g, 0)), &dem, tank.timers);
    run->start(tank.start(), true);
    return run;
}

} // namespace

TEST_CASE("a box heavier than water stays on the bed with its weight less its buoyancy")
{
    struct Size { int dim; double h; Vec3 box; };
    for (const Size& s : {Size{2, 0.02, Vec3(0.2, 0.1, 1)}, Size{2, 0.025, Vec3(0.3, 0.06, 1)}, Size{3, 0.0625, Vec3(0.25, 0.125, 0.2)}})
        for (const bool isRough : {true, false})
        {
            Tank tank(s.dim, s.h, s.dim == 2 ? 0.3 : 0.375, isRough);
            const double middle = s.dim == 2 ? 0.5 : 0.25;
            const BodyDefinition body = makeBody(s.dim, s.box, 1500, Vec3(middle + 0.003, 0.5*s.box[1], s.dim == 2 ? 0.5 : 0.25));
            const DemSetup dem = makeDem(tank, body);
            const auto run = makeRun(tank, dem);
            for (int k = 0; k < 100; ++k) REQUIRE(run->step(0.005).isAccepted);
            const BodyRecord record = run->records()[0];
            // the film is no part of the body in the water
            const double film = filmThickness/(1 + filmThickness)*s.h, buoyancy = rhoWater*g*body.volume, left = buoyancy*(1 - film/s.box[1]);
            std::printf("%dD, bed %s: force of the water %.4f N, buoyancy %.4f N, above the film %.4f N, of the bed %.4f N\n", s.dim, isRough ? "rough" : "smooth",
                record.fluidForce[1], buoyancy, left, record.contactForce[1]);
            CHECK(record.fluidForce[1] == near(left, 5e-3));
            CHECK(record.contactForce[1] == near(body.mass*g - left, 0.01));
            CHECK(std::abs(record.motion.velocity[1]) < 5e-5);
            // the bed carries the water and, through it, what lifts the body
            const FluidBudget budget = fluidBudget(run->fluid(), tank.fluid, tank.controls, run->cover());
            CHECK(wallReaction(run->fluid())[1] == near(record.fluidForce[1] - budget.weight[1], 5e-6));
        }
}

TEST_CASE("a round body on the bed has its whole buoyancy")
{
    Tank tank(2, 0.02, 0.3);
    const BodyDefinition body = makeRound(0.05, 1500, Vec3(0.503, 0.05, 0.5));
    const DemSetup dem = makeDem(tank, body);
    const auto run = makeRun(tank, dem);
    for (int k = 0; k < 100; ++k) REQUIRE(run->step(0.005).isAccepted);
    const double force = run->records()[0].fluidForce[1], buoyancy = rhoWater*g*body.volume;
    std::printf("cylinder: force of the water %.4f N, buoyancy %.4f N\n", force, buoyancy);
    CHECK(force == near(buoyancy, 2e-5)); // 0.71 of it where no water is between
}

TEST_CASE("a box lighter than water lifts off, slower than without water to move, and its loads do not jump as the gap opens")
{
    for (const int dim : {2, 3})
        for (const double density : {600.0, 100.0})
        {
            const double h = dim == 2 ? 0.02 : 0.0625, dt = 0.005;
            const Vec3 size = dim == 2 ? Vec3(0.2, 0.1, 1) : Vec3(0.25, 0.125, 0.2);
            Tank tank(dim, h, dim == 2 ? 0.5 : 0.625);
            tank.controls.contactTolerance = NumericsControls().contactTolerance;
            const BodyDefinition body = makeBody(dim, size, density, Vec3(dim == 2 ? 0.5 : 0.25, 0.5*size[1], dim == 2 ? 0.5 : 0.25));
            const DemSetup dem = makeDem(tank, body);
            const auto run = makeRun(tank, dem);
            const double net = (rhoWater - density)*body.volume*g; // force if nothing moved
            double fastest = 0, largestJump = 0, before = 0, rise = 0;
            for (int k = 0; k < 400 && rise < 2.5*h; ++k)
            {
                REQUIRE(run->step(dt).isAccepted);
                const BodyRecord record = run->records()[0];
                rise = record.pose.position[1] - body.pose.position[1];
                const double load = record.fluidForce[1] - body.mass*g, speed = record.motion.velocity[1];
                if (k > 2) largestJump = std::max(largestJump, std::abs(load - before)/net);
                before = load;
                fastest = std::max(fastest, speed);
                CHECK(load < net);
                CHECK(speed < net/body.mass*run->fluid().state().time);
                CHECK(rise > -1e-5);
            }
            std::printf("%dD, density %.0f: %.3f elements higher after %.3f s, fastest %.4f m/s, largest jump of the load %.3f of the net buoyancy\n", dim, density, rise/h,
                run->fluid().state().time, fastest, largestJump);
            CHECK(rise > 2.5*h);
            CHECK(largestJump < 0.3);
        }
}

TEST_CASE("in air a box stays on the bed with its weight")
{
    Tank tank(2, 0.02, 0.3);
    tank.fluid.isTwoPhase = true;
    const BodyDefinition body = makeBody(2, Vec3(0.2, 0.1, 1), 600, Vec3(0.5, 0.05, 0.5));
    const DemSetup dem = makeDem(tank, body);
    CoupledStep run(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches, Scene({}, dem.bodies, Vec3(0, -g, 0)), &dem, tank.timers);
    FlowState start = restState(tank.mesh);
    start.alpha.assign(tank.mesh.nNodes, 0.0);
    run.start(std::move(start), true);
    for (int k = 0; k < 100; ++k) REQUIRE(run.step(0.005).isAccepted);
    const BodyRecord record = run.records()[0];
    std::printf("in air: force %.4f N, of the bed %.4f N, weight %.4f N\n", record.fluidForce[1], record.contactForce[1], body.mass*g);
    CHECK(record.contactForce[1] == near(body.mass*g, 5e-3));
    CHECK(std::abs(record.motion.velocity[1]) < 5e-5);
}

namespace
{

/// Of 0.6 m x 0.1 m (3D: on the whole bed but a rim) on the bed.
SceneStructure makeSill(int dim)
{
    SceneStructure sill;
    sill.solid.name = "sill";
    sill.solid.wall = Solid::Wall::NoSlip;
    const Vec3 size = dim == 2 ? Vec3(0.6, 0.1, 1) : Vec3(0.375, 0.125, 0.375);
    sill.solid.shape = makeBox(Vec3::Zero(), size);
    sill.solid.pose.position = dim == 2 ? Vec3(0.5, 0.5*size[1], 0.5) : Vec3(0.25, 0.5*size[1], 0.25);
    return sill;
}

} // namespace

TEST_CASE("a box on a structure has its buoyancy, though no element is between")
{
    for (const int dim : {2, 3})
    {
        const double h = dim == 2 ? 0.023 : 0.0625, middle = dim == 2 ? 0.5 : 0.25;
        Tank tank(dim, h, dim == 2 ? 0.46 : 0.5);
        const SceneStructure sill = makeSill(dim);
        const double top = 2*sill.solid.pose.position[1];
        const Vec3 size = dim == 2 ? Vec3(0.2, 0.1, 1) : Vec3(0.25, 0.125, 0.2);
        const BodyDefinition body = makeBody(dim, size, 1500, Vec3(middle + 0.003, top + 0.5*size[1], dim == 2 ? 0.5 : 0.25));
        const DemSetup dem = makeDem(tank, body, top);
        const auto run = makeRun(tank, dem, {sill});
        for (int k = 0; k < 160; ++k) REQUIRE(run->step(0.005).isAccepted);
        const BodyRecord record = run->records().back();
        const double buoyancy = rhoWater*g*body.volume;
        std::printf("%dD, on a structure: force of the water %.4f N, buoyancy %.4f N, of the structure %.4f N, speed %.1e m/s\n", dim, record.fluidForce[1], buoyancy,
            record.contactForce[1], record.motion.velocity.norm());
        CHECK(record.fluidForce[1] == near(buoyancy, 5e-5)); // without the layer -545 and -169 N
        CHECK(record.contactForce[1] == near(body.mass*g - record.fluidForce[1], 5e-7));
        CHECK(record.motion.velocity.norm() < 5e-5);
    }
}

TEST_CASE("boxes that lie on each other and stand side by side are not pressed together by the water")
{
    Tank tank(2, 0.023, 0.46);
    const Vec3 size(0.2, 0.1, 1);
    std::vector<BodyDefinition> bodies;
    for (const Vec3& place : {Vec3(0.4, 0.05, 0.5), Vec3(0.6, 0.05, 0.5), Vec3(0.51, 0.15, 0.5)}) bodies.push_back(makeBody(2, size, 1500, place));
    const DemSetup dem = makeDem(tank, bodies);
    const auto run = makeRun(tank, dem);
    for (int k = 0; k < 100; ++k) REQUIRE(run->step(0.005).isAccepted);
    const double buoyancy = rhoWater*g*bodies[0].volume;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const BodyRecord record = run->records()[b];
        std::printf("box %zu: force of the water %.4f %.4f N, buoyancy %.4f N, contact %.4f %.4f N, speed %.1e m/s\n", b, record.fluidForce[0], record.fluidForce[1], buoyancy,
            record.contactForce[0], record.contactForce[1], record.motion.velocity.norm());
        CHECK(std::abs(record.fluidForce[0]) < 1e-3*buoyancy); // without the layers 400, -399, -1 N
        // without the layers 541, 538, -523 N; the lower two less the film on the bed
        const double film = b == 2 ? 0 : filmThickness/(1 + filmThickness)/std::lround(1/0.023);
        CHECK(record.fluidForce[1] == near(buoyancy*(1 - film/size[1]), 0.01));
    }
    // water at rest: 104 Pa off, and 3 m/s in what is left of an element at the joint, where the fluid's surface is not closed
    const FlowState& state = run->fluid().state();
    double largest = 0;
    for (int i = 0; i < tank.mesh.nOwned; ++i)
        if (run->cover()->isActiveNode[i]) largest = std::max(largest, std::abs(state.p[i] - rhoWater*g*(tank.depth - tank.mesh.x[2*std::size_t(i) + 1])));
    largest = tank.halo.max(largest);
    std::printf("pressure off by %.3f Pa\n", largest);
    CHECK(largest < 3);
}

TEST_CASE("a box lighter than water floats up from a structure and from another box")
{
    for (const bool isOnBox : {false, true})
    {
        Tank tank(2, 0.02, 0.5);
        tank.controls.contactTolerance = NumericsControls().contactTolerance;
        const Vec3 size(0.2, 0.1, 1);
        std::vector<BodyDefinition> bodies;
        bodies.push_back(makeBody(2, size, 600, Vec3(0.5, 0.15, 0.5)));
        if (isOnBox) bodies.push_back(makeBody(2, size, 2500, Vec3(0.5, 0.05, 0.5)));
        const DemSetup dem = makeDem(tank, bodies, isOnBox ? 0 : 0.1);
        const auto run = makeRun(tank, dem, isOnBox ? std::vector<SceneStructure>{} : std::vector<SceneStructure>{makeSill(2)});
        double rise = 0, fastest = 0;
        for (int k = 0; k < 400 && rise < 0.05; ++k)
        {
            REQUIRE(run->step(0.005).isAccepted);
            const BodyRecord record = run->records()[isOnBox ? 0 : 1];
            rise = record.pose.position[1] - bodies[0].pose.position[1];
            fastest = std::max(fastest, record.motion.velocity.norm());
        }
        std::printf("from a %s: %.4f m higher after %.3f s, fastest %.4f m/s\n", isOnBox ? "box" : "structure", rise, run->fluid().state().time, fastest);
        CHECK(rise > 0.05);     // never without the layer
        CHECK(fastest < std::sqrt(2*g*rise*(rhoWater/600 - 1)));    // without water to move
    }
}
