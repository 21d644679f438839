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
    const auto obstacle = [&](const Vec3& other, double yaw = 0, bool isAway = false) { return check.obstacle(0, alpha, {at(place), at(other, yaw)}, {0, isAway}, {}).name; };
    const Vec3 away(0.4, 0.4, 1.5);

    fill(1.01);
    CHECK(obstacle(away) == "");
    fill(1.26); // into the elements that hold the log
    CHECK(obstacle(away) == "liquid (alpha up to 1) in the elements");
    fill(0.5);
    for (int i = 0; i < mesh.nNodes; ++i) // a drop in one node beside it
        if ((Vec3(mesh.spacePoint(i).data()) - Vec3(1.75, 1, 1.5)).norm() < 1e-9) alpha[i] = 0.5;
    CHECK(obstacle(away) == "liquid (alpha up to 0.5) in the elements");

    fill(0.5);
    CHECK(obstacle(place) == "body 'old'");
    CHECK(obstacle(place, 0, true) == "");
    CHECK(obstacle(place + Vec3(0, 0, thickness + 0.004)) == "body 'old'"); // would touch at once
    CHECK(obstacle(place + Vec3(0, 0, thickness + 0.006)) == "");
    CHECK(obstacle(place + Vec3(0, 0, thickness - 0.01), 0.5*M_PI) == "body 'old'"); // across
    CHECK(obstacle(place + Vec3(length + 0.01, 0, 0)) == "");
    CHECK(obstacle(place + Vec3(0, 0.5*length, 0), 0.5*M_PI) == "body 'old'");  // its end in the middle
}

TEST_CASE("nodes beside the elements of the body count up to half an element from it")
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {12, 8, 8}, {0, 0, 0}, {3, 2, 2}); // cubes of 0.25 m
    const Halo halo(mesh, MPI_COMM_WORLD);
    std::vector<double> alpha(mesh.nNodes);
    for (int i = 0; i < mesh.nNodes; ++i) alpha[i] = mesh.spacePoint(i)[2] < 1.6;
    const auto obstacle = [&](double bottom) // between 1.75 m and 2 m
    {
        const Vec3 place(1.5, 1, bottom + 0.5*thickness);
        return EntryCheck(mesh, halo, {makeLog("log", place)}).obstacle(0, alpha, {at(place)}, {0}, {}).name;
    };
    CHECK(obstacle(1.75 + 0.12) == "liquid (alpha up to 1) in the elements");
    CHECK(obstacle(1.75 + 0.13) == "");
}

TEST_CASE("a body in another whose surface is far is seen, whichever of the two comes in")
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {2, 2, 2}, {0, 0, 0}, {3, 2, 2});
    const Halo halo(mesh, MPI_COMM_WORLD);
    const Vec3 place(1.5, 1, 1);
    BodyDefinition crumb = makeLog("crumb", place);
    crumb.shape = makeSphere(Vec3::Zero(), 0.005);
    crumb.thinnest = 0.01;
    crumb.spheres = {{Vec3::Zero(), 0.005}};
    const std::vector<double> alpha(mesh.nNodes, 0.0);
    EntryCheck check(mesh, halo, {makeLog("log", place), crumb});
    CHECK(check.obstacle(0, alpha, {at(place), at(place)}, {1, 0}, {}).name == "body 'crumb'");
    CHECK(check.obstacle(1, alpha, {at(place), at(place)}, {0, 1}, {}).name == "body 'log'");
}

TEST_CASE("a structure that moves is in the way where it is now, fixed ones are the reader's matter")
{
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {6, 4, 4}, {0, 0, 0}, {3, 2, 2});
    const Halo halo(mesh, MPI_COMM_WORLD);
    const Vec3 place(1.5, 1, 1.5);
    const std::vector<double> alpha(mesh.nNodes, 0.0);
    EntryCheck check(mesh, halo, {makeLog("log", place)});
    Solid gate;
    gate.name = "gate";
    gate.kind = Solid::Kind::Prescribed;
    gate.shape = makeBox(Vec3::Zero(), {0.01, 2, 2}); // thinner than the log's spheres
    const auto obstacle = [&](double x)
    {
        gate.pose.position = {x, 1, 1};
        return check.obstacle(0, alpha, {at(place)}, {0}, {gate}).name;
    };
    for (double x = 1.205; x < 1.8; x += 0.01) CHECK(obstacle(x) == "structure 'gate'");
    CHECK(obstacle(1.19 - gate.shape->bounds()[1][0]) == "");
    CHECK(obstacle(1.81 + gate.shape->bounds()[1][0]) == "");
    gate.kind = Solid::Kind::Fixed;
    CHECK(obstacle(1.5) == "");
}

TEST_CASE("liquid around a body that is thinner than the elements, and far from their nodes, is seen")
{
    const std::array<int, 3> cells{2, 8, 8}; // 1 m x 0.25 m x 0.25 m
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, cells, {0, 0, 0}, {2, 2, 2});
    const Halo halo(mesh, MPI_COMM_WORLD);
    for (double y : {1.1, 1.125, 1.14})
        for (double x : {0.4, 0.5, 0.6})
        {
            BodyDefinition stick = makeLog("stick", Vec3(x, y, 1.125));
            stick.shape = makeBox(Vec3::Zero(), Vec3(0.02, 0.02, 0.02));
            stick.thinnest = 0.02;
            stick.spheres = {{Vec3::Zero(), 0.01}};
            EntryCheck check(mesh, halo, {stick});
            std::vector<double> alpha(mesh.nNodes, 1.0);
            const std::vector<BodyState> states{at(stick.pose.position)};
            CHECK(check.obstacle(0, alpha, states, {0}, {}).name == "liquid (alpha up to 1) in the elements");
            for (int i = 0; i < mesh.nNodes; ++i) alpha[i] = mesh.spacePoint(i)[2] < 0.99;
            CHECK(check.obstacle(0, alpha, states, {0}, {}).name == "");
        }
}
