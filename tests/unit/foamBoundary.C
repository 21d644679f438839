// SPDX-License-Identifier: GPL-3.0-or-later
/// Boundary conditions: kinds, nodal values, and what is refused. On 1 and 2 ranks.
#include "support/boundaryScene.H"
#include "support/near.hpp"

using namespace flotsam;

TEST_CASE("kinds of an interFoam channel, patches in the mesh's order")
{
    const BoundaryScene s;
    using V = BoundaryPatch::Velocity;
    using P = BoundaryPatch::Pressure;
    using A = BoundaryPatch::Phase;
    REQUIRE(s.patches.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(s.patches[i].name == s.adapter.mesh.patches[i].name);
    CHECK(s.patch("inlet").velocity == V::Fixed);
    CHECK(s.patch("inlet").pressure == P::Natural);
    CHECK(s.patch("inlet").phase == A::Inflow);
    CHECK(s.patch("outlet").velocity == V::Open);
    CHECK(s.patch("outlet").pressure == P::Fixed);
    CHECK(s.patch("floor").isNoSlipWall);
    CHECK(s.patch("floor").velocity == V::NoSlip);
    CHECK(s.patch("floor").pressure == P::Natural);
    CHECK(s.patch("top").velocity == V::Open);
    CHECK(s.patch("top").pressure == P::Total);
}

TEST_CASE("p_rgh becomes the full pressure with the local density")
{
    BoundaryScene s;
    for (int i = 0; i < s.adapter.mesh.nNodes; ++i) s.alpha[i] = s.adapter.mesh.x[2*i + 1] < 0.55 ? 1 : 0;
    const auto& outlet = s.patch("outlet");
    const PatchValues v = s.values("outlet");
    REQUIRE(v.pressure.size() == outlet.nodes.size());
    for (std::size_t i = 0; i < outlet.nodes.size(); ++i)
    {
        const double y = s.adapter.mesh.x[2*outlet.nodes[i] + 1];
        CHECK(v.pressure[i] == near(7 - (y < 0.55 ? 1000 : 1)*10*y, 1e-14));
    }
    for (double p : s.values("top").pressure) CHECK(p == near(3 - 10, 1e-14));
}

TEST_CASE("uniform values come back unchanged; a list of face values is continued to the nodes")
{
    BoundaryScene s(Edits{{"0/U", inletU, "type fixedValue; value uniform (0.3 0.1 0);"}});
    const PatchValues v = s.values("inlet");
    for (std::size_t i = 0; i < v.velocity.size(); i += 2) { CHECK(v.velocity[i] == 0.3); CHECK(v.velocity[i + 1] == 0.1); }
    if (!isSerial()) return; // lists are per rank
    BoundaryScene list(Edits{{"0/U", inletU, "type fixedValue; value nonuniform List<vector> 10((1 0 0)(3 0 0)(5 0 0)(7 0 0)(9 0 0)(11 0 0)(13 0 0)(15 0 0)(17 0 0)(19 0 0));"}});
    const auto& inlet = list.patch("inlet");
    const PatchValues w = list.values("inlet");
    for (std::size_t i = 0; i < inlet.nodes.size(); ++i)
    {
        const double y = list.adapter.mesh.x[2*inlet.nodes[i] + 1]; // faces 0.1 high hold 20 y at their centres
        CHECK(w.velocity[2*i] == within(20*y, 1e-12));
    }
}

// Linear profiles are exact on any mesh, a parabola that vanishes at walls nearly does at the nodes there, a jet beside a wall does not come back out. What passes is what
// the faces say, of a parabola to second order.
TEST_CASE("velocities of faces at the nodes of the patch")
{
    for (const std::string mesh : {"blockMeshDict", "blockMeshDict3d"})
    {
        if (mesh == "blockMeshDict3d" && !isSerial()) continue;
        FaceScene s(mesh);
        const std::size_t dim = s.adapter.mesh.dim;
        const double h = dim == 2 ? 0.1 : 1/6.;
        const auto linear = [](const Foam::vector& x) { return Foam::vector(1 + 3*x.y() + 2*x.z(), -2*x.y(), 5*x.z()); };
        const std::vector<double> u = s.atNodes(linear);
        for (std::size_t k = 0; k < s.nodes.nodes.size(); ++k)
        {
            const auto x = s.adapter.mesh.spacePoint(s.nodes.nodes[k]);
            const Foam::vector expected = linear(Foam::vector(x[0], x[1], x[2]));
            for (std::size_t d = 0; d < dim; ++d) CHECK(u[k*dim + d] == within(expected[d], 1e-12));
        }
        const auto parabola = [](const Foam::vector& x) { return Foam::vector(4*x.y()*(1 - x.y()), 0, 0); };
        const auto jet = [](const Foam::vector& x) { return Foam::vector(x.y() < 0.15 && x.y() > 0.1 ? 9 : 1, 0, 0); };
        const std::vector<double> v = s.atNodes(parabola), w = s.atNodes(jet);
        CHECK(s.outflow(u) == near(s.facesOutflow(linear), 1e-13));
        CHECK(s.outflow(v) == near(s.facesOutflow(parabola), 3*h*h));
        for (std::size_t k = 0; k < s.nodes.nodes.size(); ++k)
        {
            const double y = s.adapter.mesh.spacePoint(s.nodes.nodes[k])[1];
            if (y < 1e-9 || y > 1 - 1e-9) CHECK(v[k*dim] == within(3*h*h, 0.2*h*h));    // 2 h at the centre of the face
            CHECK(w[k*dim] >= 0);
        }
    }
}

TEST_CASE("above a step in the velocities of an inlet's faces nodes rest as all of their faces do, whichever way round-off has it")
{
    const FaceScene s(Edits{inletOnTwoRanks, {"system/blockMeshDict", "simpleGrading (1 1 1)", "simpleGrading (1 4 1)"}}, "blockMeshDict");
    for (const double speed : {9., 0.3895345, 1/3.})
    {
        const std::vector<double> u = s.atNodes([&](const Foam::vector& x) { return Foam::vector(x.y() < 0.4 ? speed : 0, 0, 0); });
        double lowest = 1e300;  // point of a face at rest
        for (const Foam::face& f : s.faces)
            if (f.centre(s.faces.points()).y() > 0.4)
                for (const Foam::label i : f) lowest = std::min(lowest, s.faces.points()[i].y());
        lowest = -s.halo.max(-lowest);
        for (std::size_t k = 0; k < s.nodes.nodes.size(); ++k)
            if (s.adapter.mesh.spacePoint(s.nodes.nodes[k])[1] > lowest + 1e-9) CHECK(u[2*k] == within(0, 1e-14));
    }
}

TEST_CASE("a list of phase values; walls given as fixedValue zero")
{
    if (!isSerial()) return;
    BoundaryScene s(Edits{{"0/alpha.water", "type variableHeightFlowRate; lowerBound 0.1; upperBound 0.9;", "type fixedValue; value nonuniform List<scalar> 10(1 1 1 1 1 0 0 0 0 0); //"},
        {"0/alpha.water", "// value uniform 0; }", "\n}"}, {"0/U", "floor { type noSlip; }", "floor { type fixedValue; value uniform (0 0 0); }"}});
    CHECK(s.patch("floor").isNoSlipWall);
    CHECK_FALSE(s.patch("inlet").isNoSlipWall);
    const auto& inlet = s.patch("inlet");
    const PatchValues v = s.values("inlet");
    for (std::size_t i = 0; i < inlet.nodes.size(); ++i)
    {
        const double y = s.adapter.mesh.x[2*inlet.nodes[i] + 1];
        CHECK(v.alpha[i] == near(y < 0.45 ? 1 : y > 0.55 ? 0 : 0.5, 1e-14));
    }
}

TEST_CASE("time functions")
{
    BoundaryScene s(Edits{{"0/U", inletU, "type uniformFixedValue; uniformValue table ((0 (0 0 0)) (2 (4 0 0))); value uniform (0 0 0);"}});
    const auto u = s.values("inlet", 0.5).velocity;
    for (std::size_t i = 0; i < u.size(); i += 2) CHECK(u[i] == near(1, 1e-14));
    if (!isSerial()) return;
    const std::string unordered = refused("0/U", inletU, "type uniformFixedValue; uniformValue table ((0 (0 0 0)) (2 (4 0 0)) (1 (0 0 0))); value uniform (0 0 0);");
    CHECK(has(unordered, "Entry 'uniformValue' is no function of time: out-of-order value: 1"));
}

TEST_CASE("prghPressure and prghTotalPressure give the full pressure")
{
    BoundaryScene s(Edits{{"0/p_rgh", "type fixedValue; value uniform 7;", "type prghPressure; p uniform 11; value uniform 0;"}, {"0/p_rgh", "type totalPressure; p0 uniform 3;", "type prghTotalPressure; p0 uniform 4; value uniform 0;"}});
    for (double p : s.values("outlet").pressure) CHECK(p == 11);
    for (double p : s.values("top").pressure) CHECK(p == 4);
}

TEST_CASE("one fluid with a kinematic pressure: values become Pa")
{
    if (!isSerial()) return;
    BoundaryScene s(Edits{{"constant/transportProperties", "phases (water air);", "nu 1e-6; rho 500;"}, {"0/p_rgh", "[1 -1 -2 0 0 0 0]", "[0 2 -2 0 0 0 0]"}});
    const auto& outlet = s.patch("outlet");
    const PatchValues v = s.values("outlet");
    for (std::size_t i = 0; i < outlet.nodes.size(); ++i)
        CHECK(v.pressure[i] == near(500*(7 - 10*s.adapter.mesh.x[2*outlet.nodes[i] + 1]), 1e-14));
    CHECK(v.alpha.empty());
}

TEST_CASE("what is not available is refused, with what could be used instead")
{
    if (!isSerial()) return;
    const std::string unknown = refused("0/U", "type zeroGradient", "type waveVelocity");
    CHECK(has(unknown, "Field U, patch outlet: condition 'waveVelocity' is not available"));
    CHECK(has(unknown, "variableHeightFlowRateInletVelocity"));
    CHECK(has(refused("0/p_rgh", "type fixedValue", "type fixedMean"), "fixedMean"));
    CHECK(has(refused("0/alpha.water", "type inletOutlet", "type inletOutletX"), "Nearest: inletOutlet"));
    CHECK(has(refused("0/U", inletU, "type flowRateInletVelocity; massFlowRate 5;"), "volumetricFlowRate"));
    for (const std::string litres : {"10 l/s", "constant 10 l/s", "uniform 10 litres"})
        CHECK(has(refused("0/U", inletU, "type flowRateInletVelocity; volumetricFlowRate " + litres + ";"), "Values have no unit behind them"));
    CHECK(has(refused("0/U", "type pressureInletOutletVelocity;", "type pressureInletOutletVelocity; tangentialVelocity uniform (1 0 0);"), "tangentialVelocity"));
    CHECK(has(refused("0/U", "type zeroGradient", "type inletOutlet; inletValue uniform (1 0 0); value uniform (1 0 0)"), "inletValue"));
    CHECK(has(refused("0/alpha.water", "inletValue uniform 0", "inletValue uniform 1.5"), "from 0 to 1"));
    CHECK(has(refused("0/alpha.water", "type zeroGradient; }\n    floor", "type constantAlphaContactAngle; theta0 30; limit none; value uniform 0; }\n    floor"), "theta0 30 is not modelled"));
    CHECK(has(refused("0/p_rgh", "[1 -1 -2 0 0 0 0]", "[0 2 -2 0 0 0 0]"), "The pressure has dimensions [0 2 -2 0 0 0 0]; allowed: [1 -1 -2 0 0 0 0]"));
    CHECK(has(refused("0/U", "[0 1 -1 0 0 0 0]", "[0 1 -2 0 0 0 0]"), "U has dimensions [0 1 -2 0 0 0 0]; allowed: [0 1 -1 0 0 0 0]"));
    CHECK(has(refused("0/alpha.water", "[0 0 0 0 0 0 0]", "[1 0 0 0 0 0 0]"), "alpha.water has dimensions [1 0 0 0 0 0 0]; allowed: [0 0 0 0 0 0 0]"));
    CHECK(has(refused("constant/g", "[0 1 -2 0 0 0 0]", "[0 1 -1 0 0 0 0]"), "[0 1 -1 0 0 0 0]; allowed: [0 1 -2 0 0 0 0]"));
}

TEST_CASE("values of another kind or number: what the entry is, and what it must be")
{
    if (!isSerial()) return;
    const std::string velocity = "internalField   uniform (0.3 -0.1 0)", top = "type pressureInletOutletVelocity; value uniform (0 0 0)";
    CHECK(has(refused("0/U", velocity, "internalField uniform 0.3"), "Entry 'internalField' is 'uniform 0.3', but must be 'uniform (0 0 0)', or 'nonuniform List<vector> ..' of one value for each of the 200 cells of the mesh."));
    CHECK(has(refused("0/U", velocity, "internalField unifrom (0 0 0)"), "Entry 'internalField' is 'unifrom"));
    CHECK(has(refused("0/U", velocity, "internalField nonuniform List<vector> 2((0 0 0) (1 0 0))"), "has 2 values for the 200 cells of the mesh: the field is of another mesh"));
    CHECK(has(refused("0/U", velocity + ";", ""), "Entry 'internalField' is missing"));
    CHECK(has(refused("0/U", "dimensions      [0 1 -1 0 0 0 0];", ""), "Entry 'dimensions' is missing"));
    CHECK(has(refused("0/U", top, "type fixedValue; value uniform 3"), "Entry 'value' is 'uniform 3', but must be 'uniform (0 0 0)'"));
    CHECK(has(refused("0/U", top, "type fixedValue"), "Entry 'value' is missing"));
    CHECK(has(refused("0/U", top, "value uniform (0 0 0)"), "Entry 'type' is missing: it must be one of: fixedValue"));
    CHECK(has(refused("0/U", top, "type uniformFixedValue; uniformValue table ((0 1) (1 2))"), "Entry 'uniformValue' is 'table ( ( 0 1 ) ( 1 2 ) )', but must be a vector, or a function of time"));
    CHECK(has(refused("0/p_rgh", "p0 uniform 3", "p0 uniform (0 0 0)"), "Entry 'p0' is 'uniform ( 0 0 0 )', but must be 'uniform 0'"));
    CHECK(has(refused("constant/g", "[0 1 -2 0 0 0 0]", "ms"), "Entry 'dimensions' is 'ms'"));
    CHECK(has(refused("constant/g", "value", "valu"), "Entry 'value' is missing: it must be a vector in m/s^2"));
}

TEST_CASE("combinations: prescribed velocity and prescribed pressure do not go together, everything else does")
{
    if (!isSerial()) return;
    CHECK(has(refused("0/U", "outlet { type zeroGradient; }", "outlet { type fixedValue; value uniform (1 0 0); }"), "both are prescribed"));
    CHECK(has(refused("0/U", "outlet { type zeroGradient; }", "outlet { type slip; }"), "both are prescribed"));
    CHECK(refused("0/p_rgh", "type fixedValue; value uniform 7;", "type zeroGradient;").empty()); // interFoam's weir outlet
    CHECK(refused("0/p_rgh", "type totalPressure; p0 uniform 3;", "type zeroGradient;").empty());
}
