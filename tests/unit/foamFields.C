// SPDX-License-Identifier: GPL-3.0-or-later
/// Fields: cell values -> nodes, nodes -> cells, patches and points, and what is written. On 1 and 2 ranks.
#include "core/nodeGraph.hpp"
#include "foam/boundaryConditions.H"
#include "equations/interfaceWidth.hpp"
#include "foam/fieldIO.H"
#include "foam/surfaceFromCells.H"
#include "geometry/cutSimplex.hpp"
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

TEST_CASE("a plane comes back from the cells' fractions as that plane, also where it goes through nodes")
{
    Scene s;
    const SimplexMesh& mesh = s.adapter.mesh;
    const std::size_t n = mesh.dim + 1;
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
    for (int i = 0; i < mesh.nNodes; ++i)
        for (int d = 0; d < 2; ++d)
        {
            low[d] = std::min(low[d], mesh.x[2*i + d]);
            high[d] = std::max(high[d], mesh.x[2*i + d]);
        }
    double centre[2];
    for (int d = 0; d < 2; ++d) centre[d] = 0.5*(-s.halo.max(-low[d]) + s.halo.max(high[d]));
    for (const double slope : {0.0, 0.1, -0.37})
        for (const double shift : {0.0, 0.013})
        {
            const auto depth = [&](int i) { return (centre[1] + shift + slope*(mesh.x[2*i] - centre[0]) - mesh.x[2*i + 1])/std::hypot(1, slope); };
            std::vector<double> fraction(s.adapter.cellStart.size() - 1), alpha(mesh.nNodes);
            double nPartly = 0;
            for (std::size_t c = 0; c < fraction.size(); ++c)
            {
                double wet = 0, all = 0;
                for (int k = s.adapter.cellStart[c]; k < s.adapter.cellStart[c + 1]; ++k)
                {
                    const std::size_t e = s.adapter.cellElements[k];
                    double d[3];
                    for (std::size_t a = 0; a < n; ++a) d[a] = std::abs(depth(mesh.elements[e*n + a])) < 1e-12 ? -1e-300 : depth(mesh.elements[e*n + a]);
                    const int nWet = (d[0] > 0) + (d[1] > 0) + (d[2] > 0);
                    all += mesh.volume[e];
                    wet += mesh.volume[e]*(nWet == 0 ? 0 : nWet == 3 ? 1 : fluidFraction<2>(d).value);
                }
                fraction[c] = wet/all;
                nPartly += fraction[c] > 0 && fraction[c] < 1;
            }
            for (int i = 0; i < mesh.nNodes; ++i) alpha[i] = std::abs(depth(i)) < 1e-12 ? 0.5 : depth(i) > 0 ? 1 : 0;
            // where the surface lies on faces programs leave traces of the other fluid in some of the cells
            constexpr double trace = 5e-5;
            const bool isOnFaces = s.halo.sum(nPartly) == 0;
            for (std::size_t c = 0; isOnFaces && c < fraction.size(); c += 3) fraction[c] = std::clamp(fraction[c], trace, 1 - trace);
            reconstructSurface(s.foam.mesh(), s.adapter, s.halo, fraction, alpha);
            double length = 0; // of the level's unit
            for (int i = 0; i < mesh.nNodes; ++i)
                if (alpha[i] > 0 && alpha[i] < 1 && std::abs(depth(i)) > 1e-3) length = std::max(length, depth(i)/(alpha[i] - 0.5));
            length = s.halo.max(length);
            for (int e = 0; e < mesh.nElements; ++e)
            {
                // the P1 level of every element that the plane cuts
                double lowest = 1e300, highest = -1e300;
                for (std::size_t a = 0; a < n; ++a)
                {
                    lowest = std::min(lowest, depth(mesh.elements[e*n + a]));
                    highest = std::max(highest, depth(mesh.elements[e*n + a]));
                }
                if (!mesh.isOwnedElement[e] || lowest*highest > 0) continue;
                for (std::size_t a = 0; a < n; ++a)
                {
                    const int i = mesh.elements[e*n + a];
                    CHECK(std::abs(length*(alpha[i] - 0.5) - depth(i)) < (isOnFaces ? 3e-5 : 1e-10));
                }
            }
        }
}

TEST_CASE("a smooth profile over several cells comes back as the plane it was made of")
{
    Scene s;
    const SimplexMesh& mesh = s.adapter.mesh;
    const std::size_t n = mesh.dim + 1;
    const Foam::vectorField& centres = s.foam.mesh().cellCentres();
    constexpr double h = 0.1; // of the channel's cells
    for (const double slope : {0.0, 0.1, -0.37})
        for (const double thickness : {0.35*h, 0.7*h, 2*h})
        {
            const auto depth = [&](double x, double y) { return (0.513 + slope*(x - 1) - y)/std::hypot(1, slope); };
            std::vector<double> fraction, alpha(mesh.nNodes);
            for (const Foam::vector& x : centres) fraction.push_back(0.5*(1 + std::tanh(depth(x.x(), x.y())/thickness)));
            for (int i = 0; i < mesh.nNodes; ++i) alpha[i] = 0.5*(1 + std::tanh(depth(mesh.x[2*i], mesh.x[2*i + 1])/thickness));
            reconstructSurface(s.foam.mesh(), s.adapter, s.halo, fraction, alpha);
            double worst = 0;
            for (int e = 0; e < mesh.nElements; ++e)
            {
                // where the P1 level is zero on the edges of the elements that the plane cuts
                const int* nodes = &mesh.elements[e*n];
                for (std::size_t a = 0; mesh.isOwnedElement[e] && a < n; ++a)
                {
                    const int i = nodes[a], j = nodes[(a + 1) % n];
                    const double di = depth(mesh.x[2*i], mesh.x[2*i + 1]), dj = depth(mesh.x[2*j], mesh.x[2*j + 1]);
                    if (di*dj >= 0) continue;
                    const double at = (alpha[i] - 0.5)/(alpha[i] - alpha[j]);
                    worst = std::max(worst, std::abs(di + at*(dj - di)));
                }
            }
            CAPTURE(slope);
            CAPTURE(thickness);
            CHECK(s.halo.max(worst) < 1e-3*h);
        }
}

TEST_CASE("smooth levels keep to both sides of an upright side, which stays where it is")
{
    Scene s;
    const SimplexMesh& mesh = s.adapter.mesh;
    const std::size_t n = mesh.dim + 1;
    constexpr double h = 0.1, side = 1, thickness = 0.7*h, left = 0.613; // of the channel's cells
    for (const double right : {-10., 0.213, 0.413})
    {
        const auto level = [&](double x) { return x < side ? left : right; };
        const auto fill = [&](double x, double y) { return 0.5*(1 + std::tanh((level(x) - y)/thickness)); };
        std::vector<double> fraction, alpha(mesh.nNodes);
        for (const Foam::vector& x : s.foam.mesh().cellCentres()) fraction.push_back(fill(x.x(), x.y()));
        for (int i = 0; i < mesh.nNodes; ++i) alpha[i] = 0.5*(fill(mesh.x[2*i] - h/2, mesh.x[2*i + 1]) + fill(mesh.x[2*i] + h/2, mesh.x[2*i + 1]));
        reconstructSurface(s.foam.mesh(), s.adapter, s.halo, fraction, alpha);
        double worst = 0, worstSide = 0, nSide = 0;
        for (int e = 0; e < mesh.nElements; ++e)
        {
            const int* nodes = &mesh.elements[e*n];
            for (std::size_t a = 0; mesh.isOwnedElement[e] && a < n; ++a)
            {
                const int i = nodes[a], j = nodes[(a + 1) % n];
                if ((alpha[i] >= 0.5) == (alpha[j] >= 0.5)) continue;
                const double at = (alpha[i] - 0.5)/(alpha[i] - alpha[j]);
                const double x = mesh.x[2*i] + at*(mesh.x[2*j] - mesh.x[2*i]), y = mesh.x[2*i + 1] + at*(mesh.x[2*j + 1] - mesh.x[2*i + 1]);
                const double nearest = std::min(mesh.x[2*i], mesh.x[2*j]), farthest = std::max(mesh.x[2*i], mesh.x[2*j]);
                if (farthest < side - 1e-9 || nearest > side + 1e-9) worst = std::max(worst, std::abs(y - level(x)));
                if (y > left - h || y < right + h) continue;
                worstSide = std::max(worstSide, std::abs(x - side));
                ++nSide;
            }
        }
        CAPTURE(right);
        CHECK(s.halo.max(worst) < 1e-3*h);
        CHECK(s.halo.max(worstSide) < 0.1*h);  // exactly, but where the profile meets full cells
        CHECK((right > left - 3*h || s.halo.sum(nSide) > 0));
    }
}

TEST_CASE("no surface comes near nodes whose cells are all empty, as above a column little wider than a cell")
{
    Scene s;
    const SimplexMesh& mesh = s.adapter.mesh;
    const std::size_t n = mesh.dim + 1;
    constexpr double h = 0.1, length = 4*std::sqrt(2.)*h;   // of the channel's cells; of the level's unit
    for (const double left : {0.62, 0.68})
        for (const double width : {0.8*h, 1.2*h, 1.7*h})
            for (const double top : {0.43, 0.48})
            {
                const auto overlap = [&](double at, double low, double high) { return std::clamp(std::min(at + 0.5*h, high) - std::max(at - 0.5*h, low), 0., h)/h; };
                std::vector<double> fraction, wet(mesh.nNodes, 0.0), alpha(mesh.nNodes);
                for (const Foam::vector& x : s.foam.mesh().cellCentres()) fraction.push_back(overlap(x.x(), left, left + width)*overlap(x.y(), -1, top));
                for (std::size_t c = 0; c < fraction.size(); ++c)
                    for (int k = s.adapter.cellStart[c]; k < s.adapter.cellStart[c + 1]; ++k)
                        for (std::size_t a = 0; a < n && fraction[c] > 1e-9; ++a) wet[mesh.elements[s.adapter.cellElements[k]*n + a]] = 1;
                s.halo.sumToOwners(wet, 1);
                for (int i = 0; i < mesh.nNodes; ++i)
                {
                    const double x = mesh.x[2*i], y = mesh.x[2*i + 1];
                    alpha[i] = 0.25*(overlap(x - h/2, left, left + width) + overlap(x + h/2, left, left + width))*(overlap(y - h/2, -1, top) + overlap(y + h/2, -1, top));
                }
                reconstructSurface(s.foam.mesh(), s.adapter, s.halo, fraction, alpha);
                double nearest = 1e300;
                for (int i = 0; i < mesh.nOwned; ++i)
                    if (wet[i] == 0) nearest = std::min(nearest, length*(0.5 - alpha[i]));
                CAPTURE(width);
                CHECK(-s.halo.max(-nearest) > 0.6*h);
            }
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
