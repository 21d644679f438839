// SPDX-License-Identifier: GPL-3.0-or-later
/// Round bodies at the surface of water at rest do not start to turn about their axes, however coarse the mesh: pressure has no moment about them.
#include "equations/fluid.hpp"
#include "equations/initialProfile.hpp"
#include "equations/surfaceLevel.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/cutFlows.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr double gravity = 10; // [m/s^2]
constexpr int n = 10, nPlaces = 6;

/// Largest angular acceleration about the axes of symmetry in the first step, of what the weight at the arm of a radius gives. Half immersed, density half of water's.
double spinUp(int dim, std::shared_ptr<const Shape> shape, double radius)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.12);
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.gravity[dim - 1] = -gravity;
    NumericsControls controls;
    controls.tolerance = 1e-10;
    controls.maxIterations = 500;
    const double mass = 500*shape->moments().volume, inertia = mass*radius*radius/2, dt = 0.002;
    const DualCells cells(mesh);
    double largest = 0;
    for (int k = 0; k < nPlaces; ++k)
    {
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
        std::vector<Solid> solids(1);
        solids[0].kind = Solid::Kind::Free;
        solids[0].shape = shape;
        solids[0].pose.position = Vec3(0.5, 0.5, 0.5) + (haltonPoint(k) - Vec3::Constant(0.5))/n;
        const double level = solids[0].pose.position[dim - 1];
        FlowState state = restState(mesh);
        double up[3] = {};
        up[dim - 1] = -1;
        const std::vector<double> width = interfaceWidth(mesh, fluid.graph(), halo, controls.interfaceWidth);
        for (int i = 0; i < mesh.nNodes; ++i)
            state.alpha[i] = profileSlab(&cells, i, up, level - mesh.x[std::size_t(i)*dim + dim - 1], width[i]).mean();
        halo.update(state.alpha, 1);
        state.alphaOld = state.alphaOlder = state.alpha;
        fluid.start(std::move(state), false);
        CoverBuilder builder(mesh, fluid.graph(), halo);
        for (int pass = 0; pass < 6; ++pass) builder.buildExactVolume(solids);
        fluid.setGeometry(&builder.cover(), &solids, true);
        FreeBody body;
        body.mass = mass;
        body.inertia = Eigen::Matrix3d::Identity()*inertia;
        body.force[dim - 1] = -gravity*mass;
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({body}).hasConverged);
        const Vec3 spin = solids[0].turning()*fluid.solidMotions()[0].angularVelocity;
        largest = std::max(largest, spin.norm()*inertia/(dt*mass*gravity*radius));
    }
    std::printf("%dD, %.1f elements a diameter: %.1e\n", dim, 2*radius*n, largest);
    return largest;
}

} // namespace

TEST_CASE("round bodies that float do not set themselves spinning")
{
    for (const double radius : {0.06, 0.075, 0.1, 0.15})    // with the moment of the pressure 0.08 to 0.15, 0.04 to 0.13, 0.03 to 0.06, 0.015 to 0.02
    {
        CHECK(spinUp(2, makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 0.5), radius), radius) < 5e-3);
        CHECK(spinUp(3, makeCylinder(Vec3(-0.3, 0, 0), Vec3(0.3, 0, 0), radius), radius) < 5e-3);
        CHECK(spinUp(3, makeCapsule(Vec3(0, -0.2, 0), Vec3(0, 0.2, 0), radius), radius) < 5e-3);
        CHECK(spinUp(3, makeSphere(Vec3::Zero(), radius), radius) < 5e-3);
    }
}

TEST_CASE("rotations that turn a solid into itself")
{
    Solid log;
    log.shape = makePlaced(makeCylinder(Vec3(1, 0, 0), Vec3(1, 0, 2), 0.1), Eigen::Quaterniond(Eigen::AngleAxisd(M_PI/2, Vec3::UnitX())), Vec3(-1, 1, 0));
    log.pose.orientation = Eigen::AngleAxisd(0.3, Vec3::UnitZ());
    const Vec3 axis(std::sin(0.3), -std::cos(0.3), 0);
    CHECK((log.turning() - axis*axis.transpose()).norm() < 1e-12);
    log.shape = makeCylinder(Vec3(0.1, 0, 0), Vec3(0.1, 0, 2), 0.1);     // not about the origin
    CHECK(log.turning().norm() == 0);
    log.shape = makeSphere(Vec3::Zero(), 0.1);
    CHECK((log.turning() - Eigen::Matrix3d::Identity()).norm() == 0);
    log.shape = makeBox(Vec3::Zero(), Vec3(1, 1, 1));
    CHECK(log.turning().norm() == 0);
}
