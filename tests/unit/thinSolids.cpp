// SPDX-License-Identifier: GPL-3.0-or-later
/// Which structures are too thin for their elements.
#include "geometry/thinSolids.hpp"
#include "support/coverScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

TEST_CASE("nodes in a plate see both of its sides if it is thinner than the elements around them")
{
    for (const int dim : {2, 3})
    {
        const CoverScene scene(dim, 10);    // elements of 0.2
        const auto find = [&](double thickness)
        {
            std::vector<Solid> solids{makeSolid(makeBox(Vec3::Zero(), {thickness, 4, 4}), Vec3::Zero(), Solid::Kind::Fixed),
                makeSolid(makeSphere(Vec3::Zero(), 0.3), {3, 0, 0}, Solid::Kind::Fixed)};
            return findSharedNodes(scene.mesh, scene.graph, scene.halo, cutMesh(scene.mesh, scene.graph, scene.halo, solids), solids.size());
        };
        const std::vector<SharedNodes> thin = find(0.24);
        REQUIRE(thin.size() == 2);
        CHECK(thin[0].count >= 8);      // one in every row at least
        CHECK(std::abs(thin[0].middle[0]*std::cos(0.4) + thin[0].middle[1]*std::sin(0.4)) < 0.03);     // in the plate's plane
        CHECK(thin[1].count == 0);
        CHECK(find(0.7)[0].count == 0);
    }
}

TEST_CASE("edges on the mesh's nodes do not make a post thin")
{
    for (const int dim : {2, 3})
        for (const double shift : {0.0, 1e-16, -1e-16, 1e-9, -1e-9, 1e-4, 0.003})
        {
            const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {10, 10, 10}, {0, 0, 0}, {1, 1, 1});
            const NodeGraph graph(mesh);
            const Halo halo(mesh, MPI_COMM_WORLD);
            std::vector<Solid> solids(1);
            solids[0].shape = makeBox(Vec3::Zero(), dim == 2 ? Vec3(0.6, 1.4, 1) : Vec3(0.6, 0.6, 1.4));  // through the bottom
            for (const Vec3& offset : {Vec3(shift, shift, 0), Vec3(shift, -shift, 0), Vec3(-shift, shift, 0)})
            {
                solids[0].pose.position = Vec3(0.5, dim == 2 ? 0.2 : 0.5, 0.2) + offset;
                CHECK(findSharedNodes(mesh, graph, halo, cutMesh(mesh, graph, halo, solids), 1)[0].count == 0);
            }
        }
}

TEST_CASE("a body within an element of a structure does not make it thin")
{
    for (const int dim : {2, 3})
        for (const double gap : {0.02, 0.05, 0.1, 0.15})
        {
            const CoverScene scene(dim, 10);    // elements of 0.2
            std::vector<Solid> solids{makeSolid(makeBox(Vec3::Zero(), {0.8, 4, 4}), Vec3(-0.4, 0, 0), Solid::Kind::Fixed), makeSolid(makeSphere(Vec3::Zero(), 0.3), {0.3 + gap, 0, 0}, Solid::Kind::Fixed)};
            for (Solid& solid : solids) solid.pose.orientation = Eigen::Quaterniond::Identity();
            CHECK(findSharedNodes(scene.mesh, scene.graph, scene.halo, cutMesh(scene.mesh, scene.graph, scene.halo, solids), solids.size())[0].count == 0);
        }
}
