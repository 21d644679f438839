// SPDX-License-Identifier: GPL-3.0-or-later
/// Fluid that must stay at rest does, around a fixed solid; a released light cylinder starts with its added-mass acceleration.
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

double largestSpeed(const Fluid& fluid)
{
    double largest = 0;
    for (double v : fluid.state().u) largest = std::max(largest, std::abs(v));
    return fluid.halo().max(largest);
}

void makeSteps(Fluid& fluid)
{
    for (int step = 0; step < 3; ++step)
    {
        fluid.beginStep(0.01);
        fluid.assemble();
        CHECK(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
}

FluidProperties singleFluid(int gravityAxis)
{
    FluidProperties f;
    f.isTwoPhase = false;
    f.rhoLiquid = 1;
    f.muLiquid = 1e-3;
    f.gravity[gravityAxis] = -1;
    return f;
}

} // namespace

TEST_CASE("water at rest around a fixed cut cylinder stays at rest and carries its discrete weight")
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {32, 32, 1}, {-1, -1, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = 1e-10;
    Fluid fluid(mesh, halo, singleFluid(1), controls, allPatches(mesh, BoundaryPatch::Velocity::Fixed));
    fluid.start(restState(mesh), true);
    std::vector<Solid> solids(1);
    solids[0].shape = makeCylinder(Vec3(0, 0, -1), Vec3(0, 0, 2), 0.5);
    solids[0].pose.position = Vec3(0.013, 0.02, 0);
    CoverBuilder builder(mesh, fluid.graph(), halo);
    const Cover& cover = builder.build(solids);
    fluid.setGeometry(&cover, &solids, true);
    makeSteps(fluid);
    CHECK(largestSpeed(fluid) < 1e-8);
    const Vec3 force = fluid.solidLoads()[0].force;
    CHECK(force[1] == near(cover.solidVolume[0], 3e-10));
    CHECK(std::abs(force[0]) < 1e-6);
}

TEST_CASE("water at rest around boxes that touch stays at rest, carries what each displaces and presses none of them sideways")
{
    usePetsc();
    for (const int dim : {2, 3})
        for (const double by : {0.0, 0.013, 0.029})
        {
            const int n = dim == 2 ? 32 : 12;
            const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {-1, -1, -1}, {1, 1, 1}, 0.1);
            const Halo halo(mesh, MPI_COMM_WORLD);
            NumericsControls controls;
            controls.tolerance = 1e-11;
            Fluid fluid(mesh, halo, singleFluid(1), controls, allPatches(mesh, BoundaryPatch::Velocity::Fixed));
            fluid.start(restState(mesh), true);
            // two side by side on a fixed one, a fourth on both; 2D: by their section
            const double depth = dim == 2 ? 1 : 0.7;
            const Vec3 size(0.5, 0.4, depth), base(1.4, 0.4, dim == 2 ? depth : 0.8), places[] = {{0.02, -0.4, 0}, {-0.25, 0, 0}, {0.25, 0, 0}, {0.05, 0.4, 0}};
            std::vector<Solid> solids(4);
            for (int s = 0; s < 4; ++s)
            {
                solids[s].kind = s == 0 ? Solid::Kind::Fixed : Solid::Kind::Prescribed;
                solids[s].shape = makeBox(Vec3::Zero(), s == 0 ? base : size);
                solids[s].pose.position = places[s] + Vec3(by, by + (s == 3 ? 0.002 : 0), 0);
            }
            CoverBuilder builder(mesh, fluid.graph(), halo);
            const Cover& cover = builder.build(solids);
            fluid.setGeometry(&cover, &solids, true);
            makeSteps(fluid);
            for (int s = 0; s < 4; ++s)
            {
                const Vec3 force = fluid.solidLoads()[s].force;
                std::printf("%dD, by %.3f, solid %d: force of the water %.6f %.6f, volume %.6f, speed %.1e\n", dim, by, s, force[0], force[1], mesh.thickness*(s == 0 ? base : size).prod(), largestSpeed(fluid));
                CHECK(std::abs(force[0]) < 1e-6*size.prod());
                if (s > 0) CHECK(force[1] == near(mesh.thickness*size.prod(), 1e-9));
                else CHECK(force[1] == near(mesh.thickness*base.prod(), 0.035));   // what the cut leaves no fluid between them is the structure's
            }
            CHECK(largestSpeed(fluid) < 1e-8);
        }
}

TEST_CASE("water that is left in a solid at an open boundary drives nothing")
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {20, 20, 1}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = 1e-10;
    FluidProperties properties = singleFluid(1);
    properties.isTwoPhase = true;
    properties.gravity[1] = 0;
    std::vector<BoundaryPatch> patches = allPatches(mesh, BoundaryPatch::Velocity::Slip);
    patches[3] = makePatch(mesh, 3, BoundaryPatch::Velocity::Open);
    const auto ofPatch = patches[3].evaluate;
    patches[3].evaluate = [&](const BoundaryState& state, PatchValues& values)
    {
        ofPatch(state, values);
        for (std::size_t k = 0; k < patches[3].nodes.size(); ++k) values.pressure[k] = -500*state.alpha[patches[3].nodes[k]]; // as of p_rgh
    };
    std::vector<Solid> solids(1); // a cylinder that sticks out through the top, in gas
    const double centre = 0.51, radius = 0.22;
    solids[0].shape = makeCylinder(Vec3(0, 0, -1), Vec3(0, 0, 2), radius);
    solids[0].pose.position = Vec3(centre, 1, 0);
    FlowState start = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i) start.alpha[i] = std::hypot(mesh.x[2*std::size_t(i)] - centre, mesh.x[2*std::size_t(i) + 1] - 1) < radius;
    Fluid fluid(mesh, halo, properties, controls, patches);
    fluid.start(start, false);
    CoverBuilder builder(mesh, fluid.graph(), halo);
    const Cover& cover = builder.build(solids);
    fluid.setGeometry(&cover, &solids, false);
    makeSteps(fluid);
    std::printf("fastest fluid %.1e m/s\n", largestSpeed(fluid));
    CHECK(largestSpeed(fluid) < 1e-6);
}

TEST_CASE("a released cylinder starts with the added-mass acceleration at any density")
{
    // Over the displaced mass, in the middle of a square box of W = 6 diameters D. Its images at (m + i n) W, turned round at odd n, send back
    // k = (D/2W)^2 sum (-1)^n/(m + i n)^2 of what it moves relative to them: C_a = (1 + k)/(1 - k), the next term is (D/2W)^8.
    double sum = M_PI*M_PI/3; // the row n = 0; each row has pi^2/sin^2(i pi n)
    for (int n = 1; n <= 5; ++n) sum -= (n % 2 ? -2 : 2)*std::pow(M_PI/std::sinh(M_PI*n), 2);
    const double k = sum/144, ofConfined = (1 + k)/(1 - k); // 1.0489
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {96, 96, 1}, {-3, -3, 0}, {3, 3, 1}, 0);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = 1e-8;
    for (double density : {0.01, 0.1, 0.59, 3.0})
    {
        FluidProperties properties = singleFluid(1);
        properties.muLiquid = 1e-4;
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Fixed));
        fluid.start(restState(mesh), true);
        std::vector<Solid> solids(1);
        solids[0].kind = Solid::Kind::Free;
        solids[0].shape = makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), 0.5);
        CoverBuilder builder(mesh, fluid.graph(), halo);
        for (int k = 0; k < 4; ++k) builder.buildExactVolume(solids);
        const Cover& cover = builder.cover();
        fluid.setGeometry(&cover, &solids, true);
        FreeBody body;
        body.mass = density*M_PI/4;
        body.inertia = Eigen::Matrix3d::Identity()*body.mass/8;
        body.force = Vec3(0, -body.mass, 0);
        const double dt = 0.01;
        fluid.beginStep(dt);
        fluid.assemble();
        const SolveReport report = fluid.solve({body});
        const double acceleration = fluid.solidMotions()[0].velocity[1]/dt;
        const double addedMass = (1 - density)/acceleration - density;
        std::printf("density %.2f: acceleration %.5f, added mass %.5f exact %.5f, %d iterations\n", density, acceleration, addedMass, ofConfined, report.iterations);
        CHECK(addedMass == near(ofConfined, 1e-3)); // measured 0.03 %
        const Vec3 load = fluid.solidLoads()[0].force;
        CHECK(body.mass*acceleration == near(load[1] - body.mass, 5e-8));
    }
}

TEST_CASE("two fluids of the same density and other viscosities: round-off of the phase does not change the flow")
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {24, 24, 1}, {-1, -1, 0}, {1, 1, 1}, 0.1);
    const Halo halo(mesh, MPI_COMM_WORLD);
    NumericsControls controls;
    controls.tolerance = 1e-12;
    std::vector<std::vector<double>> u;
    for (const double change : {0.0, 1e-12})
    {
        FluidProperties f = singleFluid(1);
        f.isTwoPhase = true;
        f.rhoLiquid = f.rhoGas = 998.2;
        f.muLiquid = 0.5;
        f.muGas = 60*f.muLiquid;
        FlowState state = restState(mesh);
        for (std::size_t i = 0; i < std::size_t(mesh.nNodes); ++i)
        {
            // a vortex that ends at the walls, across the level
            const double x = 0.5*M_PI*mesh.x[2*i], y = 0.5*M_PI*mesh.x[2*i + 1];
            state.u[2*i] = -std::pow(std::cos(x), 2)*std::sin(2*y);
            state.u[2*i + 1] = std::sin(2*x)*std::pow(std::cos(y), 2);
            state.alpha[i] = std::clamp(0.5 + (0.01 - mesh.x[2*i + 1])/0.3, 0.0, 1.0)*(1 - change*double(i % 7));
        }
        Fluid fluid(mesh, halo, f, controls, allPatches(mesh, BoundaryPatch::Velocity::Fixed));
        fluid.start(state, true);
        makeSteps(fluid);
        u.push_back(fluid.state().u);
    }
    for (std::size_t k = 0; k < 2*std::size_t(mesh.nOwned); ++k) CHECK(u[1][k] == within(u[0][k], 1e-9));
}
