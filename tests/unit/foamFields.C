// SPDX-License-Identifier: GPL-3.0-or-later
/// Fields: cell values -> nodes, nodes -> cells, patches and points, and what is written. On 1 and 2 ranks.
#include "core/nodeGraph.hpp"
#include "foam/boundaryConditions.H"
#include "equations/interfaceWidth.hpp"
#include "foam/fieldIO.H"
#include "support/foamCase.H"
#include "support/near.hpp"

#include "surfaceFields.H"

#include <doctest/doctest.h>

#include <cfenv>
#include <limits>
#include <mpi.h>

using namespace flotsam;

namespace
{

struct Scene
{
    FoamCase foam{"foamChannel"};
    CaseControls controls = readCaseControls(foam.time());
    MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
    Halo halo{adapter.mesh, MPI_COMM_WORLD};
    FoamFields fields{foam.mesh(), adapter, halo, controls};
    std::vector<double> width = interfaceWidth(adapter.mesh, NodeGraph(adapter.mesh), halo, controls.numerics.interfaceWidth);
    FlowState state;

    const Foam::volScalarField& scalar(const char* name) { return foam.mesh().lookupObject<Foam::volScalarField>(name); }
    const Foam::volVectorField& velocity() { return foam.mesh().lookupObject<Foam::volVectorField>("U"); }

    /// u = (1+2x, 3y), p linear, alpha = 1
    void setLinear()
    {
        const SimplexMesh& mesh = adapter.mesh;
        fields.readStart(state);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double x = mesh.x[2*i], y = mesh.x[2*i + 1];
            state.u[2*i] = 1 + 2*x;
            state.u[2*i + 1] = 3*y;
            state.p[i] = 5 - 10000*y + x;
        }
    }
};

bool isSerial() { int n; MPI_Comm_size(MPI_COMM_WORLD, &n); return n == 1; }

}

TEST_CASE("uniform start fields arrive at the nodes exactly; p = p_rgh + rho g.x")
{
    Scene s;
    s.fields.readStart(s.state);
    const SimplexMesh& mesh = s.adapter.mesh;
    REQUIRE(s.state.u.size() == static_cast<std::size_t>(2*mesh.nNodes));
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        CHECK(s.state.u[2*i] == 0.3);
        CHECK(s.state.u[2*i + 1] == -0.1);
        CHECK(s.state.alpha[i] == 1);
        CHECK(s.state.p[i] == near(2 - 10000*mesh.x[2*i + 1], 1e-14));
    }
}

TEST_CASE("linear nodal fields give the linear field's value at cell and face centres, and at the points of both planes")
{
    Scene s;
    s.setLinear();
    s.fields.update(s.state, s.width, nullptr, {});
    const Foam::fvMesh& mesh = s.foam.mesh();
    forAll(mesh.C(), c)
    {
        const Foam::point x = mesh.C()[c];
        CHECK(s.velocity()[c].x() == near(1 + 2*x.x(), 1e-14));
        CHECK(s.velocity()[c].y() == near(3*x.y(), 1e-14));
        CHECK(s.scalar("p")[c] == near(5 - 10000*x.y() + x.x(), 1e-14));
        CHECK(s.scalar("p_rgh")[c] == near(5 + x.x(), 5e-13));
        CHECK(s.scalar("alpha.water")[c] == near(1, 1e-14));
    }
    forAll(mesh.boundary(), i)
    {
        const auto& patch = s.scalar("p").boundaryField()[i];
        if (patch.coupled())
        {
            const Foam::scalarField inside(patch.patchInternalField()), outside(patch.patchNeighbourField());
            forAll(inside, f) CHECK(std::abs(outside[f] - inside[f]) == near(0.1, 1e-10));
            continue;
        }
        forAll(patch, f)
        {
            const Foam::point x = mesh.Cf().boundaryField()[i][f];
            CHECK(patch[f] == near(5 - 10000*x.y() + x.x(), 1e-14));
        }
    }
    const auto& points = mesh.lookupObject<Foam::pointVectorField>("pointU");
    forAll(mesh.points(), p) CHECK(points[p].x() == near(1 + 2*mesh.points()[p].x(), 1e-14));
    CHECK(mesh.foundObject<Foam::pointScalarField>("pointAlpha"));
}

TEST_CASE("written fields keep their boundary dictionaries")
{
    Scene s;
    s.setLinear();
    s.foam.time().setTime(0.1, 10);
    s.fields.update(s.state, s.width, nullptr, {});
    s.foam.time().writeNow();
    const std::string pressure = s.foam.read("0.1/p_rgh"), velocity = s.foam.read("0.1/U");
    CHECK(pressure.find("totalPressure") != std::string::npos);
    CHECK(pressure.find("p0") != std::string::npos);
    CHECK(pressure.find("fixedFluxPressure") != std::string::npos);
    CHECK(velocity.find("volumetricFlowRate") != std::string::npos);
    CHECK(velocity.find("pressureInletOutletVelocity") != std::string::npos);
    for (const char* name : {"p", "alpha.water", "pointU", "pointP", "pointAlpha"}) CHECK_FALSE(s.foam.read(std::string("0.1/") + name).empty());
    // and they can be read again
    CHECK(messageOf([&]
    {
        s.foam.time().setTime(0.1, 10);
        const Foam::volVectorField again(Foam::IOobject("U", "0.1", s.foam.mesh(), Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false), s.foam.mesh());
        CHECK(again[0].x() == near(s.velocity()[0].x(), 1e-14));
    }).empty());
}

TEST_CASE("nodal unknowns come back from the written point fields, unless the cells were changed since")
{
    Scene s;
    FlowState read;
    CHECK_FALSE(s.fields.readNodes(read)); // not written yet
    s.setLinear();
    s.foam.time().setTime(0.1, 10);
    s.fields.update(s.state, s.width, nullptr, {});
    s.foam.time().writeNow();
    REQUIRE(s.fields.readNodes(read));
    CHECK(read.time == 0.1);
    const SimplexMesh& mesh = s.adapter.mesh;
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        for (int d = 0; d < 2; ++d) CHECK(read.u[2*i + d] == near(s.state.u[2*i + d], 1e-14));
        CHECK(std::abs(read.p[i] - s.state.p[i]) < 0.1);
        CHECK(read.alpha[i] == 1);
    }
    auto& alpha = const_cast<Foam::volScalarField&>(s.scalar("alpha.water"));
    if (s.halo.rank() == 0) alpha[0] = 0;
    CHECK_FALSE(s.fields.readNodes(read));
}

TEST_CASE("what a patch prescribes by its values stays: a run that goes on reads it")
{
    Scene s;
    s.fields.readStart(s.state); // p_rgh = 2
    s.fields.update(s.state, s.width, nullptr, {});
    const Foam::label outlet = s.foam.mesh().boundaryMesh().findPatchID("outlet");
    for (const double p : s.scalar("p_rgh").boundaryField()[outlet]) CHECK(p == 7);
}

TEST_CASE("solid fraction is the covered volume; inside a solid the velocity is the solid's")
{
    Scene s;
    s.setLinear();
    Solid box;
    box.kind = Solid::Kind::Prescribed;
    box.shape = makeBox(Vec3::Zero(), Vec3(0.4, 0.3, 1));
    box.pose.position = Vec3(1.03, 0.52, 0.05);
    box.motion.velocity = Vec3(7, 8, 9);
    const NodeGraph graph(s.adapter.mesh);
    const Cover cover = cutMesh(s.adapter.mesh, graph, s.halo, {box});
    s.fields.update(s.state, s.width, &cover, {box});
    double volume = 0;
    const auto& solid = s.scalar("solid");
    forAll(solid, c)
    {
        volume += solid[c]*s.foam.mesh().V()[c];
        const Foam::point x = s.foam.mesh().C()[c];
        if (solid[c] < 1) continue;
        CHECK(s.velocity()[c].x() == near(7, 1e-14));
        CHECK(s.velocity()[c].z() == 0); // 2D
        CHECK(std::abs(x.x() - 1.03) < 0.2);
    }
    CHECK(s.halo.sum(volume) == near(cover.solidVolume[0]*0.1, 1e-14));
    CHECK(s.halo.sum(volume) == near(0.4*0.3*0.1, 1e-14));
}

TEST_CASE("written pressures go on linearly into solids: what viewers interpolate in a cell with fluid is the fluid's, whatever stands in the solid's nodes")
{
    Scene s;
    s.setLinear();
    Solid disc;
    disc.kind = Solid::Kind::Fixed;
    disc.shape = makeCylinder(Vec3(0, 0, -2), Vec3(0, 0, 2), 0.33);
    disc.pose.position = Vec3(1.03, 0.52, 0.05);
    const NodeGraph graph(s.adapter.mesh);
    const Cover cover = cutMesh(s.adapter.mesh, graph, s.halo, {disc});
    for (int i = 0; i < s.adapter.mesh.nNodes; ++i)
        if (!cover.isActiveNode[i]) s.state.p[i] = 1e9;
    s.fields.update(s.state, s.width, &cover, {disc});
    const Foam::fvMesh& mesh = s.foam.mesh();
    const auto& points = mesh.lookupObject<Foam::pointScalarField>("pointP");
    double nInside = 0;
    forAll(mesh.cells(), c)
    {
        if (s.scalar("solid")[c] >= 1) continue;
        for (const Foam::label p : mesh.cellPoints()[c])
        {
            const Foam::point x = mesh.points()[p];
            nInside += !cover.isActiveNode[s.adapter.pointNode[p]];
            CHECK(points[p] == near(5 - 10000*x.y() + x.x(), 1e-11));
        }
    }
    CHECK(s.halo.sum(nInside) > 0);
}

TEST_CASE("work is skipped when nobody looks")
{
    if (!isSerial()) return;
    Scene s;
    s.foam.time().setTime(0.01, 1);
    CHECK_FALSE(s.fields.isNeeded());
}

TEST_CASE("start fields with what is no number are refused, in cells of one rank and on faces that prescribe it")
{
    FoamCase foam("foamChannel", {{"0/U", "inlet { type flowRateInletVelocity; volumetricFlowRate constant 0.05; value uniform (0 0 0); }", "inlet { type fixedValue; value uniform (1 0 0); }"}});
    const CaseControls controls = readCaseControls(foam.time());
    const MeshAdapter adapter = makeSimplexMesh(foam.mesh(), MPI_COMM_WORLD);
    const Halo halo(adapter.mesh, MPI_COMM_WORLD);
    const auto message = [&] { return messageOf([&] { FoamFields fields(foam.mesh(), adapter, halo, controls); }); };
    /// Message about the field that `how` has spoilt; the file is then as before.
    const auto spoilt = [&](auto& field, const auto& how)
    {
        const std::string file = "0/" + field.name(), good = foam.read(file);
        how(field);
        std::fenv_t trapping;   // in parallel, and writing compares values
        std::feholdexcept(&trapping);
        field.writeObject(Foam::IOstream::BINARY, Foam::IOstream::currentVersion, Foam::IOstream::UNCOMPRESSED, true);
        std::fesetenv(&trapping);
        const std::string said = message();
        foam.edit({file, foam.read(file), good});
        return said;
    };
    const auto io = [&](const char* name) { return Foam::IOobject(name, "0", foam.mesh(), Foam::IOobject::MUST_READ, Foam::IOobject::NO_WRITE, false); };
    Foam::volVectorField u(io("U"), foam.mesh());
    Foam::volScalarField p(io("p_rgh"), foam.mesh()), alpha(io("alpha.water"), foam.mesh());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const bool isLast = halo.rank() == halo.size() - 1;
    CHECK(message().empty());
    const auto inLastCell = [&](auto& field) { if (isLast) field.primitiveFieldRef().last() = nan; };
    for (const std::string& said : {spoilt(p, inLastCell), spoilt(alpha, inLastCell), spoilt(u, [&](auto& field) { if (isLast) field.primitiveFieldRef().last().y() = nan; })})
        CHECK(said.find("of time 0 has values that are no numbers (nan, inf), in 1 cells") != std::string::npos);
    const auto atInlet = [&](auto& field) { for (auto& patch : field.boundaryFieldRef()) if (patch.patch().name() == "inlet") patch == Foam::vector(nan, 0, 0); };
    Foam::volVectorField inflow(io("U"), foam.mesh());
    const std::string atFaces = spoilt(inflow, atInlet);
    CAPTURE(atFaces);
    CHECK(atFaces.find("Field U of time 0 has values that are no numbers (nan, inf), in 10 faces of the boundary") != std::string::npos);
    CHECK(message().empty());
}
