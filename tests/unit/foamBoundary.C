// SPDX-License-Identifier: GPL-3.0-or-later
/// Boundary conditions: kinds, nodal values, flow rates, and what is refused. On 1 and 2 ranks.
#include "foam/boundaryReader.H"
#include "foam/faceValues.H"
#include "support/foamCase.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <mpi.h>

#include <cmath>

using namespace flotsam;

namespace
{

using Edits = std::vector<FoamCase::Edit>;

/// A case with its mesh and conditions.
struct Scene
{
    FoamCase foam;
    CaseControls controls;
    MeshAdapter adapter;
    Halo halo;
    std::vector<BoundaryPatch> patches;
    std::vector<double> velocity, alpha, distance;  // distance: empty without solids

    explicit Scene(const Edits& edits = {}, const std::string& blockMeshDict = "blockMeshDict")
    :
        foam("foamChannel", edits, blockMeshDict), controls(readCaseControls(foam.time())),
        adapter(makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD)), halo(adapter.mesh, MPI_COMM_WORLD),
        velocity(adapter.mesh.nNodes*adapter.mesh.dim, 0.0), alpha(adapter.mesh.nNodes, 1.0)
    {
        patches = readBoundary(foam.mesh(), adapter, halo, controls);
    }
    const BoundaryPatch& patch(const std::string& name) const
    {
        for (const auto& p : patches) if (p.name == name) return p;
        throw std::runtime_error("no patch " + name);
    }
    PatchValues values(const std::string& name, double time = 0) const
    {
        PatchValues v;
        patch(name).evaluate({time, velocity.data(), alpha.data(), distance.empty() ? nullptr : distance.data()}, v);
        return v;
    }
    /// Of liquid through the plane channel's inlet, what enters and its velocity linear between the nodes, by Simpson's rule [m^3/s].
    double liquidInflow(const PatchValues& v) const
    {
        const BoundaryPatch& p = patch("inlet");
        const MeshPatch& m = adapter.mesh.patches[p.meshPatch];
        double sum = 0;
        for (std::size_t f = 0; f < m.faceElement.size(); ++f)
        {
            if (!m.isOwnedFace[f]) continue;
            double y[2], a[2], u[2];
            for (int k = 0; k < 2; ++k)
            {
                const int i = m.faceNodes[2*f + k];
                y[k] = adapter.mesh.x[2*i + 1];
                const std::size_t at = std::lower_bound(p.nodes.begin(), p.nodes.end(), i) - p.nodes.begin();
                a[k] = v.alpha[at];
                u[k] = v.velocity[2*at];
            }
            sum += adapter.mesh.thickness*std::abs(y[1] - y[0])*(a[0]*u[0] + (a[0] + a[1])*(u[0] + u[1]) + a[1]*u[1])/6;
        }
        return halo.sum(sum);
    }
    /// Flow of the P1 velocity out of the patch, all ranks [m^3/s].
    double outflow(const std::string& name, const PatchValues& v) const
    {
        const BoundaryPatch& p = patch(name);
        const SimplexMesh& mesh = adapter.mesh;
        const MeshPatch& m = mesh.patches[p.meshPatch];
        std::vector<double> u(velocity.size(), 0.0);
        for (std::size_t i = 0; i < p.nodes.size(); ++i)
            for (int d = 0; d < mesh.dim; ++d) u[p.nodes[i]*mesh.dim + d] = v.velocity[i*mesh.dim + d];
        double sum = 0;
        for (std::size_t f = 0; f < m.faceElement.size(); ++f)
        {
            if (!m.isOwnedFace[f]) continue;
            double area = 0, mean = 0; // patches of the channel are normal to x
            const double* x[3];
            for (int k = 0; k < mesh.dim; ++k)
            {
                x[k] = &mesh.x[m.faceNodes[f*mesh.dim + k]*mesh.dim];
                mean += u[m.faceNodes[f*mesh.dim + k]*mesh.dim]/mesh.dim;
            }
            if (mesh.dim == 2) area = std::abs(x[1][1] - x[0][1])*mesh.thickness;
            else area = 0.5*std::abs((x[1][1] - x[0][1])*(x[2][2] - x[0][2]) - (x[2][1] - x[0][1])*(x[1][2] - x[0][2]));
            sum += area*mean*(name == "inlet" ? -1 : 1);
        }
        return halo.sum(sum);
    }
};

bool has(const std::string& s, const std::string& part)
{
    const bool found = s.find(part) != std::string::npos;
    if (!found) MESSAGE("message was: " << s);
    return found;
}

/// Components along x, plane channel.
std::vector<double> inflow(const PatchValues& v)
{
    std::vector<double> u;
    for (std::size_t k = 0; k < v.velocity.size(); k += 2) u.push_back(v.velocity[k]);
    return u;
}

bool isSerial() { int n; MPI_Comm_size(MPI_COMM_WORLD, &n); return n == 1; }

/// Message when the inlet's (or other) entry is replaced.
std::string refused(const std::string& file, const std::string& from, const std::string& to)
{
    return messageOf([&] { Scene scene(Edits{{file, from, to}}); });
}

const FoamCase::Edit inletOnTwoRanks{"system/decomposeParDict", "n (2 1 1)", "n (1 2 1)"};

/// The inlet of the channel, with velocities on its faces.
struct FaceScene : Scene
{
    using Profile = std::function<Foam::vector(const Foam::vector&)>;
    const Foam::polyPatch& faces;
    PatchNodes nodes;

    /// In the plane two ranks share the inlet.
    explicit FaceScene(const std::string& blockMeshDict)
    :   Scene(blockMeshDict == "blockMeshDict3d" ? inSpace() : Edits{inletOnTwoRanks}, blockMeshDict), faces(foam.mesh().boundaryMesh()["inlet"]),
        nodes(makePatchNodes(adapter.mesh, halo, adapter.mesh.patches[patch("inlet").meshPatch]))
    {}

    static Edits inSpace()
    {
        return {{"0/U", "frontAndBack { type empty; }", "frontAndBack { type slip; }"}, {"0/p_rgh", "frontAndBack { type empty; }", "frontAndBack { type zeroGradient; }"},
            {"0/alpha.water", "frontAndBack { type empty; }", "frontAndBack { type zeroGradient; }"}};
    }

    std::vector<double> atNodes(const Profile& profile) const
    {
        std::vector<double> values;
        for (const Foam::vector& x : faces.faceCentres())
            for (int d = 0; d < adapter.mesh.dim; ++d) values.push_back(profile(x)[adapter.mesh.axes[d]]);
        return velocityAtNodes(faces, adapter, halo, nodes, values);
    }
    double outflow(const std::vector<double>& velocity) const { return halo.sum(nodes.outflow(velocity, std::vector<double>(nodes.nodes.size(), 1.0), nullptr)); }
    double facesOutflow(const Profile& profile) const
    {
        double sum = 0;
        for (Foam::label f = 0; f < faces.size(); ++f) sum += profile(faces.faceCentres()[f]) & faces.faceAreas()[f];
        return halo.sum(sum);
    }
};

const std::string inletU = "type flowRateInletVelocity; volumetricFlowRate constant 0.05; value uniform (0 0 0);";

} // namespace

TEST_CASE("kinds of an interFoam channel, patches in the mesh's order")
{
    const Scene s;
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
    Scene s;
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

TEST_CASE("flow rate: the P1 flux is the given one to round-off, the velocity uniform, beside walls too")
{
    for (const std::string mesh : {"blockMeshDict", "blockMeshDict3d"})
    {
        if (mesh == "blockMeshDict3d" && !isSerial()) continue;
        Scene s(mesh == "blockMeshDict3d" ? FaceScene::inSpace() : Edits(), mesh);
        const PatchValues v = s.values("inlet");
        CHECK(s.outflow("inlet", v) == near(-0.05, 1e-14));
        const auto& inlet = s.patch("inlet");
        const int dim = s.adapter.mesh.dim;
        for (std::size_t i = 0; i < inlet.nodes.size(); ++i) CHECK(v.velocity[i*dim] == near(0.05/(dim == 2 ? 0.1 : 0.4), 1e-14));
    }
}

TEST_CASE("flow rate of the liquid that enters; one layer above it moves with it, whatever is further up rests")
{
    Scene s(Edits{{"0/U", inletU, "type variableHeightFlowRateInletVelocity; flowRate table ((0 0.01) (10 0.03)); alpha alpha.water; value uniform (0 0 0);"}, inletOnTwoRanks});
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
    Scene dry(Edits{{"0/U", inletU, "type variableHeightFlowRateInletVelocity; flowRate 0.01;"}, {"0/alpha.water", "type variableHeightFlowRate; lowerBound 0.1; upperBound 0.9;", "type fixedValue;"}});
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
                Scene s(edits, mesh);
                const int dim = s.adapter.mesh.dim;
                std::fill(s.alpha.begin(), s.alpha.end(), 0.0);
                for (int i = 0; bed > 0 && i < s.adapter.mesh.nNodes; ++i) s.distance.push_back(s.adapter.mesh.x[dim*i + 1] - bed);
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

TEST_CASE("a flow rate enters above what covers the lower part of the patch")
{
    for (const double height : {0.37, 0.4, 0.02, 0.999})
    {
        Scene s;
        for (int i = 0; i < s.adapter.mesh.nNodes; ++i)
        {
            const double distance = s.adapter.mesh.x[2*i + 1] - height;
            s.distance.push_back(std::abs(distance) < 1e-12 ? -1e-12 : distance);
        }
        for (double u : inflow(s.values("inlet"))) CHECK(u == near(0.05/(0.1*(1 - height)), 1e-11));
    }
    Scene covered;
    covered.distance.assign(covered.adapter.mesh.nNodes, -1);
    if (isSerial()) CHECK(has(messageOf([&] { covered.values("inlet"); }), "solids cover it"));
}

TEST_CASE("variableHeightFlowRate lets in what is an element inside the patch, cut off at its bounds")
{
    for (const std::string mesh : {"blockMeshDict", "blockMeshDict3d"})
    {
        if (mesh == "blockMeshDict3d" && !isSerial()) continue;
        Scene s(mesh == "blockMeshDict3d" ? FaceScene::inSpace() : Edits{inletOnTwoRanks}, mesh);
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

TEST_CASE("uniform values come back unchanged; a list of face values is continued to the nodes")
{
    Scene s(Edits{{"0/U", inletU, "type fixedValue; value uniform (0.3 0.1 0);"}});
    const PatchValues v = s.values("inlet");
    for (std::size_t i = 0; i < v.velocity.size(); i += 2) { CHECK(v.velocity[i] == 0.3); CHECK(v.velocity[i + 1] == 0.1); }
    if (!isSerial()) return; // lists are per rank
    Scene list(Edits{{"0/U", inletU, "type fixedValue; value nonuniform List<vector> 10((1 0 0)(3 0 0)(5 0 0)(7 0 0)(9 0 0)(11 0 0)(13 0 0)(15 0 0)(17 0 0)(19 0 0));"}});
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

TEST_CASE("a list of phase values; walls given as fixedValue zero")
{
    if (!isSerial()) return;
    Scene s(Edits{{"0/alpha.water", "type variableHeightFlowRate; lowerBound 0.1; upperBound 0.9;", "type fixedValue; value nonuniform List<scalar> 10(1 1 1 1 1 0 0 0 0 0); //"},
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
    Scene s(Edits{{"0/U", inletU, "type uniformFixedValue; uniformValue table ((0 (0 0 0)) (2 (4 0 0))); value uniform (0 0 0);"}});
    const auto u = s.values("inlet", 0.5).velocity;
    for (std::size_t i = 0; i < u.size(); i += 2) CHECK(u[i] == near(1, 1e-14));
}

TEST_CASE("prghPressure and prghTotalPressure give the full pressure")
{
    Scene s(Edits{{"0/p_rgh", "type fixedValue; value uniform 7;", "type prghPressure; p uniform 11; value uniform 0;"}, {"0/p_rgh", "type totalPressure; p0 uniform 3;", "type prghTotalPressure; p0 uniform 4; value uniform 0;"}});
    for (double p : s.values("outlet").pressure) CHECK(p == 11);
    for (double p : s.values("top").pressure) CHECK(p == 4);
}

TEST_CASE("one fluid with a kinematic pressure: values become Pa")
{
    if (!isSerial()) return;
    Scene s(Edits{{"constant/transportProperties", "phases (water air);", "nu 1e-6; rho 500;"}, {"0/p_rgh", "[1 -1 -2 0 0 0 0]", "[0 2 -2 0 0 0 0]"}});
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
    CHECK(has(refused("0/U", "type pressureInletOutletVelocity;", "type pressureInletOutletVelocity; tangentialVelocity uniform (1 0 0);"), "tangentialVelocity"));
    CHECK(has(refused("0/U", "type zeroGradient", "type inletOutlet; inletValue uniform (1 0 0); value uniform (1 0 0)"), "inletValue"));
    CHECK(has(refused("0/alpha.water", "inletValue uniform 0", "inletValue uniform 1.5"), "from 0 to 1"));
    CHECK(has(refused("0/alpha.water", "type zeroGradient; }\n    floor", "type constantAlphaContactAngle; theta0 30; limit none; value uniform 0; }\n    floor"), "theta0 30 is not modelled"));
    CHECK(has(refused("0/p_rgh", "[1 -1 -2 0 0 0 0]", "[0 2 -2 0 0 0 0]"), "The pressure has dimensions [0 2 -2 0 0 0 0]; allowed: [1 -1 -2 0 0 0 0]"));
    CHECK(has(refused("0/U", "[0 1 -1 0 0 0 0]", "[0 1 -2 0 0 0 0]"), "U has dimensions [0 1 -2 0 0 0 0]; allowed: [0 1 -1 0 0 0 0]"));
    CHECK(has(refused("0/alpha.water", "[0 0 0 0 0 0 0]", "[1 0 0 0 0 0 0]"), "alpha.water has dimensions [1 0 0 0 0 0 0]; allowed: [0 0 0 0 0 0 0]"));
    CHECK(has(refused("constant/g", "[0 1 -2 0 0 0 0]", "[0 1 -1 0 0 0 0]"), "[0 1 -1 0 0 0 0]; allowed: [0 1 -2 0 0 0 0]"));
}

TEST_CASE("combinations: prescribed velocity and prescribed pressure do not go together, everything else does")
{
    if (!isSerial()) return;
    CHECK(has(refused("0/U", "outlet { type zeroGradient; }", "outlet { type fixedValue; value uniform (1 0 0); }"), "both are prescribed"));
    CHECK(has(refused("0/U", "outlet { type zeroGradient; }", "outlet { type slip; }"), "both are prescribed"));
    CHECK(refused("0/p_rgh", "type fixedValue; value uniform 7;", "type zeroGradient;").empty()); // interFoam's weir outlet
    CHECK(refused("0/p_rgh", "type totalPressure; p0 uniform 3;", "type zeroGradient;").empty());
}
