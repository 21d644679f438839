// SPDX-License-Identifier: GPL-3.0-or-later
/// Inlets with a flow rate, and those whose level floats. On 1 and 2 ranks.
#include "support/boundaryScene.H"
#include "support/near.hpp"

using namespace flotsam;

TEST_CASE("flow rate: the P1 flux is the given one to round-off, the velocity uniform, beside walls too")
{
    for (const std::string mesh : {"blockMeshDict", "blockMeshDict3d"})
    {
        if (mesh == "blockMeshDict3d" && !isSerial()) continue;
        BoundaryScene s(mesh == "blockMeshDict3d" ? FaceScene::inSpace() : Edits(), mesh);
        const PatchValues v = s.values("inlet");
        CHECK(s.outflow("inlet", v) == near(-0.05, 1e-14));
        const auto& inlet = s.patch("inlet");
        const int dim = s.adapter.mesh.dim;
        for (std::size_t i = 0; i < inlet.nodes.size(); ++i) CHECK(v.velocity[i*dim] == near(0.05/(dim == 2 ? 0.1 : 0.4), 1e-14));
    }
}

TEST_CASE("flow rate of the liquid that enters; one layer above it moves with it, whatever is further up rests")
{
    BoundaryScene s(Edits{{"0/U", inletU, "type variableHeightFlowRateInletVelocity; flowRate table ((0 0.01) (10 0.03)); alpha alpha.water; value uniform (0 0 0);"}, inletOnTwoRanks});
    const auto& inlet = s.patch("inlet");
    for (int i = 0; i < s.adapter.mesh.nNodes; ++i) s.alpha[i] = s.adapter.mesh.x[2*i + 1] < 0.55 ? 1.02 : -0.01;
    const PatchValues v = s.values("inlet", 5);
    CHECK(s.liquidInflow(v) == near(0.02, 1e-14));
    for (std::size_t i = 0; i < inlet.nodes.size(); ++i)
    {
        const double y = s.adapter.mesh.x[2*inlet.nodes[i] + 1];
        CHECK(v.velocity[2*i] == near(y < 0.65 ? 0.02/(0.1*0.55) : 0, 1e-13));   // alpha linear from 0.5 to 0.6
    }
    for (int i = 0; i < s.adapter.mesh.nNodes; ++i) s.alpha[i] = std::clamp(5.2*(0.6 - s.adapter.mesh.x[2*i + 1]), 0.0, 1.0);
    CHECK(s.liquidInflow(s.values("inlet", 5)) == near(0.02, 1e-14));    // whatever gas the surface's nodes let in
    if (!isSerial()) return;
    BoundaryScene dry(Edits{{"0/U", inletU, "type variableHeightFlowRateInletVelocity; flowRate 0.01;"}, {"0/alpha.water", "type variableHeightFlowRate; lowerBound 0.1; upperBound 0.9;", "type fixedValue;"}});
    CHECK(has(messageOf([&] { dry.values("inlet"); }), "hold no liquid"));
}

// Of a rectangle with its bed at 0 or 0.35 m: depth (q^2/g)^(1/3), speed (q g)^(1/3); 6 or 10 elements over the patch.
TEST_CASE("an inlet whose level floats does not fall below the critical one")
{
    for (const std::string mesh : {"blockMeshDict", "blockMeshDict3d"})
        for (const double depth : {0.21, 0.3, 0.56})
            for (const double bed : {0.0, 0.35})
            {
                if (mesh == "blockMeshDict3d" && !isSerial()) continue;
                constexpr double gravity = 10;
                const double width = mesh == "blockMeshDict3d" ? 0.4 : 0.1, speed = std::sqrt(gravity*depth);
                Edits edits = mesh == "blockMeshDict3d" ? FaceScene::inSpace() : Edits{inletOnTwoRanks};
                edits.push_back({"0/U", inletU, "type variableHeightFlowRateInletVelocity; alpha alpha.water; flowRate " + std::to_string(speed*depth*width) + "; value uniform (0 0 0);"});
                BoundaryScene s(edits, mesh);
                const int dim = s.adapter.mesh.dim;
                std::fill(s.alpha.begin(), s.alpha.end(), 0.0);
                for (int i = 0; bed > 0 && i < s.adapter.mesh.nNodes; ++i) s.cover.distance.push_back(s.adapter.mesh.x[dim*i + 1] - bed);
                const PatchValues v = s.values("inlet");
                double fastest = 0;
                for (std::size_t k = 0; k < v.velocity.size(); k += dim) fastest = std::max(fastest, v.velocity[k]);
                CHECK(s.halo.max(fastest) == near(speed, bed > 0 ? 0.03 : 0.005));
                for (int i = 0; i < s.adapter.mesh.nNodes; ++i) s.alpha[i] = s.adapter.mesh.x[dim*i + 1] < bed + depth + 0.15;
                const PatchValues deep = s.values("inlet");
                const auto& inlet = s.patch("inlet");
                for (std::size_t k = 0; k < inlet.nodes.size(); ++k) CHECK(deep.alpha[k] == within(s.adapter.mesh.x[dim*inlet.nodes[k] + 1] < bed + depth + 0.15, 1e-12));
            }
}

TEST_CASE("an inlet at both ends of a channel, whose normals cancel, has the critical level of half of the flow at each")
{
    for (const double depth : {0.21, 0.3})
    {
        constexpr double gravity = 10, width = 0.1;
        const double speed = std::sqrt(gravity*depth);
        BoundaryScene s(Edits{inletOnTwoRanks, {"system/blockMeshDict", "faces ((0 4 7 3)); }", "faces ((0 4 7 3) (1 2 6 5)); }"}, {"system/blockMeshDict", "outlet { type patch; faces ((1 2 6 5)); }", ""},
            {"0/U", inletU, "type variableHeightFlowRateInletVelocity; alpha alpha.water; flowRate " + std::to_string(speed*depth*2*width) + "; value uniform (0 0 0);"}});
        std::fill(s.alpha.begin(), s.alpha.end(), 0.0);
        double fastest = 0;
        for (const double u : inflow(s.values("inlet"))) fastest = std::max(fastest, std::abs(u));
        CHECK(s.halo.max(fastest) == near(speed, 0.005));
    }
}

TEST_CASE("a flow rate enters above what covers the lower part of the patch")
{
    for (const double height : {0.37, 0.4, 0.02, 0.999})
    {
        BoundaryScene s;
        for (int i = 0; i < s.adapter.mesh.nNodes; ++i)
        {
            const double distance = s.adapter.mesh.x[2*i + 1] - height;
            s.cover.distance.push_back(std::abs(distance) < 1e-12 ? -1e-12 : distance);
        }
        for (double u : inflow(s.values("inlet"))) CHECK(u == near(0.05/(0.1*(1 - height)), 1e-11));
    }
    BoundaryScene covered;
    covered.cover.distance.assign(covered.adapter.mesh.nNodes, -1);
    if (isSerial()) CHECK(has(messageOf([&] { covered.values("inlet"); }), "solids cover it"));
}

TEST_CASE("variableHeightFlowRate lets in what is an element inside the patch, cut off at its bounds")
{
    for (const std::string mesh : {"blockMeshDict", "blockMeshDict3d"})
    {
        if (mesh == "blockMeshDict3d" && !isSerial()) continue;
        BoundaryScene s(mesh == "blockMeshDict3d" ? FaceScene::inSpace() : Edits{inletOnTwoRanks}, mesh);
        const int dim = s.adapter.mesh.dim;
        const auto inside = [](double x, double y) { return y + (x > 1e-9 ? 0.03 : -7); };    // nothing of the patch's own nodes enters
        for (int i = 0; i < s.adapter.mesh.nNodes; ++i) s.alpha[i] = inside(s.adapter.mesh.x[dim*i], s.adapter.mesh.x[dim*i + 1]);
        const auto& inlet = s.patch("inlet");
        const PatchValues v = s.values("inlet");
        REQUIRE(v.alpha.size() == inlet.nodes.size());
        for (std::size_t k = 0; k < inlet.nodes.size(); ++k)
        {
            const double a = inside(1, s.adapter.mesh.x[dim*inlet.nodes[k] + 1]);
            CHECK(v.alpha[k] == within(a < 0.1 ? 0.0 : a > 0.9 ? 1.0 : a, 1e-12));
        }
    }
}
