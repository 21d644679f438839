// SPDX-License-Identifier: GPL-3.0-or-later
/// A body of the fluid's density, released in fluid at rest under gravity, stays where it is, wherever it lies in the mesh: the volume that it
/// cuts out and its centre are its own, and the pressure of the fluid at rest is reproduced exactly.
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/cutFlows.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr double gravity = 10; // [m/s^2]

/// Size over g times the angular acceleration: rms and largest; largest linear acceleration over g.
struct Drift { double linear = 0, angular = 0, angularRms = 0; };

struct Body
{
    const char* name;
    int dim;
    std::shared_ptr<const Shape> shape;
    double volume, size;
};

/// First step after the release at nPositions places and attitudes. canTurn false: with so large an inertia that the attitude is held.
Drift release(const Body& definition, int n, int nPositions, bool canTurn)
{
    usePetsc();
    const int dim = definition.dim;
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.12);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.isTwoPhase = false;
    properties.rhoLiquid = 1000;
    properties.muLiquid = 1e-3;
    properties.gravity[dim - 1] = -gravity;
    NumericsControls controls;
    controls.tolerance = 1e-10;
    controls.maxIterations = 500;
    Drift drift;
    for (int k = 0; k < nPositions; ++k)
    {
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Fixed));
        fluid.start(restState(mesh), true);
        std::vector<Solid> solids(1);
        solids[0].kind = Solid::Kind::Free;
        solids[0].shape = definition.shape;
        const Vec3 place = haltonPoint(k);
        solids[0].pose.position = Vec3(0.5, 0.5, 0.5) + (place - Vec3::Constant(0.5))/n;
        solids[0].pose.orientation = Eigen::AngleAxisd(2*place[2], Vec3::UnitZ());
        CoverBuilder builder(mesh, fluid.graph(), halo);
        for (int pass = 0; pass < 6; ++pass) builder.buildExactVolume(solids);
        fluid.setGeometry(&builder.cover(), &solids, true);
        const double size = definition.size, dt = 0.01;
        FreeBody body;
        body.mass = properties.rhoLiquid*definition.volume;
        body.inertia = Eigen::Matrix3d::Identity()*body.mass*size*size/6*(canTurn ? 1 : 1e6);
        body.force[dim - 1] = -gravity*body.mass;
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({body}).hasConverged);
        const Motion motion = fluid.solidMotions()[0];
        const double angular = motion.angularVelocity.norm()*size/(dt*gravity);
        drift.linear = std::max(drift.linear, motion.velocity.norm()/(dt*gravity));
        drift.angular = std::max(drift.angular, angular);
        drift.angularRms += angular*angular/nPositions;
    }
    drift.angularRms = std::sqrt(drift.angularRms);
    return drift;
}

bool isRootRank()
{
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
}

const auto disc = makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), 0.15);
const auto bar = makeBox(Vec3::Zero(), Vec3(0.3, 0.3, 1));
const auto plank = makeBox(Vec3::Zero(), Vec3(0.5, 0.12, 1));

} // namespace

TEST_CASE("neutral bodies neither sink nor rise nor turn, anywhere in the mesh")
{
    const Body bodies[] = {{"cylinder", 2, disc, M_PI*0.0225, 0.3}, {"square bar, any angle", 2, bar, 0.09, 0.3},
        {"plank 4:1, any angle", 2, plank, 0.06, 0.5}, {"sphere", 3, makeSphere(Vec3::Zero(), 0.25), 4*M_PI/3*0.015625, 0.5},
        {"cube, any angle", 3, makeBox(Vec3::Zero(), Vec3::Constant(0.4)), 0.064, 0.4},
        {"log, any angle", 3, makeCylinder(Vec3(-0.3, 0, 0), Vec3(0.3, 0, 0), 0.15), 0.6*M_PI*0.0225, 0.6},
        {"capsule, any angle", 3, makeCapsule(Vec3(-0.15, 0, 0), Vec3(0.15, 0, 0), 0.15), M_PI*0.0225*0.5, 0.6}};
    if (isRootRank())
        std::printf("\n| body | size/h | positions | largest acceleration / g | turning x size / g: rms | largest |\n|---|---|---|---|---|---|\n");
    for (const Body& body : bodies)
    {
        const int n = body.dim == 2 ? 24 : 12, nPositions = body.dim == 2 ? 200 : 10;
        const double linear = release(body, n, nPositions, false).linear;
        const Drift turning = release(body, n, nPositions, true);
        if (isRootRank())
            std::printf("| %s | %.1f | %d | %.1e | %.1e | %.1e |\n", body.name, body.size*n, nPositions, linear, turning.angularRms, turning.angular);
        CHECK(linear < 1e-8);
        CHECK(turning.linear < 1e-8);
        CHECK(turning.angular < 1e-8);
    }
}
