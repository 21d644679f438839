// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/meshExit.hpp"
#include "support/boxMesh.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

/// Two spheres of radius 0.1, 0.6 apart along x.
BodyDefinition makeDumbbell()
{
    BodyDefinition body;
    body.spheres = {{Vec3(-0.3, 0, 0), 0.1}, {Vec3(0.3, 0, 0), 0.1}};
    return body;
}

BodyState at(double x, double y, double z, double yaw = 0)
{
    BodyState state;
    state.pose.position = Vec3(x, y, z);
    state.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vec3::UnitZ()));
    return state;
}

bool isOutside(const MeshExit& exit, const BodyState& state) { return exit.findOutside({state}, {1})[0]; }

} // namespace

TEST_CASE("a body is outside when no part of it is in the mesh nor above it")
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {6, 4, 3}, {0, 0, 0}, {3, 2, 1});
    const Halo halo(mesh, MPI_COMM_WORLD);
    const MeshExit exit(mesh, halo, {makeDumbbell()}, Vec3(-1, 0, -9.81));
    CHECK_FALSE(isOutside(exit, at(1.5, 1, 0.5)));
    CHECK_FALSE(isOutside(exit, at(3.39, 1, 0.5)));
    CHECK(isOutside(exit, at(3.41, 1, 0.5)));
    CHECK(isOutside(exit, at(3.11, 1, 0.5, 0.5*M_PI))); // across: its own surface, not a sphere around it
    CHECK_FALSE(isOutside(exit, at(3.09, 1, 0.5, 0.5*M_PI)));
    CHECK_FALSE(isOutside(exit, at(1.5, 1, 1.5)));      // thrown up: comes back
    CHECK_FALSE(isOutside(exit, at(1.5, 1, 50)));
    CHECK(isOutside(exit, at(3.41, 1, 1.5)));
    CHECK(isOutside(exit, at(1.5, 1, -0.11)));          // through a hole in the bed
    CHECK(exit.findOutside({at(9, 9, 9)}, {0}) == std::vector<char>{0});    // not asked for
    const MeshExit weightless(mesh, halo, {makeDumbbell()}, Vec3::Zero());
    CHECK(isOutside(weightless, at(1.5, 1, 1.5)));
}

TEST_CASE("2D: what counts is the plane of the mesh")
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {6, 4, 1}, {0, 0, 0}, {3, 2, 0.1});
    const Halo halo(mesh, MPI_COMM_WORLD);
    const MeshExit exit(mesh, halo, {makeDumbbell()}, Vec3(0, -9.81, 0));
    CHECK_FALSE(isOutside(exit, at(1.5, 1, 7)));
    CHECK_FALSE(isOutside(exit, at(1.5, 7, 0.05)));
    CHECK(isOutside(exit, at(1.5, -0.11, 0.05)));
    CHECK(isOutside(exit, at(-0.41, 1, 0.05)));
}
