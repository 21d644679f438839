// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/coupling/entryCheck.hpp"
#include "geometry/primitives.hpp"
#include "geometry/shape.hpp"
#include "support/boxMesh.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double length = 0.6, thickness = 0.1;

BodyDefinition makeLog(const std::string& name, const Vec3& place)
{
    BodyDefinition log;
    log.name = name;
    log.shape = makeBox(Vec3::Zero(), Vec3(length, thickness, thickness));
    log.spheres = surfaceSpheres(*log.shape, 0.025, 0.05);
    log.thinnest = thickness;
    log.pose.position = place;
    return log;
}

BodyState at(const Vec3& place, double yaw = 0)
{
    BodyState state;
    state.pose.position = place;
    state.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vec3::UnitZ()));
    return state;
}

} // namespace

TEST_CASE("a place is free where there is neither liquid nor a body that is there")
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {12, 8, 8}, {0, 0, 0}, {3, 2, 2});
    const Halo halo(mesh, MPI_COMM_WORLD);
    const Vec3 place(1.5, 1, 1.5);
    EntryCheck check(mesh, halo, {makeLog("new", place), makeLog("old", Vec3(9, 9, 9))});
    std::vector<double> alpha(mesh.nNodes);
    const auto fill = [&](double level) { for (int i = 0; i < mesh.nNodes; ++i) alpha[i] = mesh.spacePoint(i)[2] <= level; };
    const auto obstacle = [&](const Vec3& other, double yaw = 0, bool isThere = true) { return check.obstacle(0, alpha, {at(place), at(other, yaw)}, {0, isThere}); };
    const Vec3 away(0.4, 0.4, 1.5);

    fill(1.01);
    CHECK(obstacle(away) == "");
    fill(1.26); // into the elements that hold the log
    CHECK(obstacle(away) == "liquid");
    fill(0.5);
    for (int i = 0; i < mesh.nNodes; ++i) // a drop in one node beside it
        if ((Vec3(mesh.spacePoint(i).data()) - Vec3(1.75, 1, 1.5)).norm() < 1e-9) alpha[i] = 0.5;
    CHECK(obstacle(away) == "liquid");

    fill(0.5);
    CHECK(obstacle(place) == "body 'old'");
    CHECK(obstacle(place, 0, false) == "");
    CHECK(obstacle(place + Vec3(0, 0, thickness + 0.004)) == "body 'old'"); // would touch at once
    CHECK(obstacle(place + Vec3(0, 0, thickness + 0.006)) == "");
    CHECK(obstacle(place + Vec3(0, 0, thickness - 0.01), 0.5*M_PI) == "body 'old'"); // across
    CHECK(obstacle(place + Vec3(length + 0.01, 0, 0)) == "");
    CHECK(obstacle(place + Vec3(0, 0.5*length, 0), 0.5*M_PI) == "body 'old'");  // its end in the middle
}
