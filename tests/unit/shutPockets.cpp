// SPDX-License-Identifier: GPL-3.0-or-later
/// Pressures in fluid that solids shut in. On 1 and 2 ranks.
#include "equations/shutPockets.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/boxMesh.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

TEST_CASE("a pocket has the hydrostatic pressure of the fluid outside, however thick the solids around it are, whatever it had before")
{
    constexpr double g = 9.81, rho = 1000;
    for (const double wall : {0.05, 0.1, 0.3})  // 2, 4 and 12 elements
        for (const double before : {0.0, 2e4, -7.0})
        {
            CAPTURE(wall);
            const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {40, 40, 0}, {0, 0, 0}, {1, 1, 0});
            const NodeGraph graph(mesh);
            const Halo halo(mesh, MPI_COMM_WORLD);
            // a slit of 0.8 elements by three between two columns and their joints below and above
            const double width = 0.02, length = 0.075;
            const Vec3 column(wall, 2*wall + length, 1), joint(2*wall, wall, 1);
            std::vector<Solid> solids;
            const auto add = [&](const Vec3& size, const Vec3& place)
            {
                solids.emplace_back();
                solids.back().shape = makeBox(Vec3::Zero(), size);
                solids.back().pose.position = place;
            };
            for (const double side : {-0.5, 0.5})
            {
                add(column, {0.5 + side*(wall + width), 0.5, 0});
                add(joint, {0.5, 0.5 + side*(wall + length), 0});
            }
            CoverBuilder builder(mesh, graph, halo);
            const Cover& cover = builder.build(solids);
            ShutPockets pockets(mesh, graph, halo);
            pockets.find(cover, std::vector<char>(mesh.nNodes, 0));
            REQUIRE(pockets.areAny());
            const auto hydrostatic = [&](int i) { return rho*g*(1 - mesh.x[2*std::size_t(i) + 1]); };
            std::vector<double> p(mesh.nNodes);
            for (int i = 0; i < mesh.nNodes; ++i) p[i] = pockets.isNode(i) || cover.distance[i] < 0 ? before : hydrostatic(i);
            pockets.setPressures(p, std::vector<double>(mesh.nNodes, rho), {0, -g, 0});
            long nFluid = 0;
            double worst = 0;
            for (int i = 0; i < mesh.nOwned; ++i)
            {
                if (!pockets.isNode(i)) continue;
                nFluid += cover.distance[i] > 0;
                worst = std::max(worst, std::abs(pockets.pressure(i) - hydrostatic(i)));
            }
            CHECK(halo.sum(nFluid) > 0);
            CHECK(halo.max(worst) < 1e-8);
        }
}
