// SPDX-License-Identifier: GPL-3.0-or-later
/// Elements computed several at once are to give what the general way gives for each of them.
#include "equations/elementAssembly.hpp"
#include "equations/elementLanes.hpp"
#include "equations/surfaceRings.hpp"
#include "support/transportScene.hpp"

#include <cmath>
#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

/// Fluids in motion, everything that the loaders read. A disc of liquid that turns in gas; with one fluid liquid everywhere.
struct Scene
{
    TransportScene carried;
    const SimplexMesh& mesh;
    const NodeGraph& graph;
    FlowState state;
    FluidProperties fluid;
    NumericsControls controls;
    NodalData nodal;
    MassFluxes massFluxes;
    std::vector<double> fineScale, force, viscousForce, solution;
    FlowStepData step;

    explicit Scene(int dim, bool hasTwoFluids)
    :   carried(MPI_COMM_SELF, dim, 8, 0.5, rotationField()), mesh(carried.mesh), graph(carried.graph), massFluxes(mesh, fluid, controls)
    {
        const std::size_t nodes = mesh.nNodes, n = nodes*dim;
        state.u = wave(n, 1.7);
        state.uOld = wave(n, 1.3);
        fineScale = wave(std::size_t(mesh.nElements)*dim, 0.9);
        force = wave(std::size_t(mesh.nElements)*dim, 0.4);
        viscousForce = wave(std::size_t(mesh.nElements)*dim, 0.5);
        solution = wave(nodes*(dim + 1), 0.6);
        step.time = TimeScheme::bdf(2, 0.01, 0.013);
        step.state = &state;
        step.fineScale = &fineScale;
        step.elementForce = &force;
        step.viscousForce = &viscousForce;
        carried.alpha.assign(nodes, 1);
        if (hasTwoFluids) carried.fill(disc({0.5, 0.7, 0.5}, 0.25, dim));
        carry(hasTwoFluids);
        nodal.advection = wave(n, 1.1);
        nodal.history.resize(n);
        for (std::size_t k = 0; k < n; ++k) nodal.history[k] = -(step.time.c1*state.u[k] + step.time.c2*state.uOld[k]);
        setNodeInertia(mesh, step, nodal);
        findSurfaceRings(mesh, carried.halo, nodal);
    }

    /// Three time levels of the densities; with two fluids what the last two steps have carried.
    void carry(bool hasTwoFluids)
    {
        std::vector<double> older = carried.alpha, old = older;
        if (hasTwoFluids)
        {
            carried.advance(0.013, 1);
            old = carried.alpha;
            massFluxes.keep(carried.transport, older, old);
            carried.advance(0.01, 1);
            step.transport = &carried.transport;
            step.massFluxes = &massFluxes;
        }
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            nodal.rho.push_back(density(fluid, controls, carried.alpha[i]));
            nodal.rhoOld.push_back(density(fluid, controls, old[i]));
            nodal.rhoOlder.push_back(density(fluid, controls, older[i]));
            nodal.mu.push_back(viscosity(fluid, controls, carried.alpha[i]));
            const auto isAlways = [&](double rho) { return nodal.rho[i] == rho && nodal.rhoOld[i] == rho && nodal.rhoOlder[i] == rho; };
            nodal.fluid.push_back(isAlways(fluid.rhoLiquid) ? NodalData::Liquid : isAlways(fluid.rhoGas) ? NodalData::Gas : NodalData::Mixed);
        }
    }

    template<int D> ElementKind kind(int e) const { return kindOf<D>(e, mesh, step, controls, nodal); }

    static std::vector<double> wave(std::size_t n, double factor)
    {
        std::vector<double> values(n);
        for (std::size_t k = 0; k < n; ++k) values[k] = std::sin(factor*double(k) + 0.3);
        return values;
    }

    FlowSystem emptySystem() const
    {
        FlowSystem s;
        s.dim = mesh.dim;
        s.matrix.resize(graph.column.size(), mesh.dim);
        s.schur.resize(graph.column.size());
        s.rhs.resize(std::size_t(mesh.nNodes)*(mesh.dim + 1));
        return s;
    }
};

/// Matrix and right-hand side of loaded elements, and their u' behind each other in `fine`.
template<int D, class Real>
void add(const Scene& scene, const int* elements, const ElementData<D, Real>& data, FlowSystem& system, std::vector<double>& fine)
{
    constexpr int N = D + 1, B = D + 1, width = widthOf<Real>;
    const ElementHistory<D, Real> history(data);
    int slot[N*N][width];
    Real x[N*B], r[D];
    double* numbers = reinterpret_cast<double*>(x);
    for (int l = 0; l < width; ++l)
    {
        const int* nodes = &scene.mesh.elements[std::size_t(elements[l])*N];
        for (int a = 0; a < N; ++a)
        {
            const NodeSource<D, Real> source(data, a, history);
            double* rhs = &system.rhs[std::size_t(nodes[a])*B];
            for (int d = 0; d < D; ++d) rhs[d] += lane(source.momentum[d], l);
            rhs[D] += lane(source.continuity, l) + lane(massDefect(data, a), l);
            for (int k = 0; k < B; ++k) numbers[(a*B + k)*width + l] = scene.solution[std::size_t(nodes[a])*B + k];
            for (int b = 0; b < N; ++b) slot[a*N + b][l] = scene.graph.find(nodes[a], nodes[b]);
        }
    }
    addElement(data, slot, system);
    fineScaleVelocity(data, x, r);
    for (int l = 0; l < width; ++l)
        for (int d = 0; d < D; ++d) fine.push_back(lane(r[d], l));
}

void compare(const std::vector<double>& a, const std::vector<double>& b)
{
    REQUIRE(a.size() == b.size());
    double largest = 0, difference = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
    {
        largest = std::max(largest, std::abs(a[k]));
        difference = std::max(difference, std::abs(a[k] - b[k]));
    }
    CHECK(largest > 0);
    CHECK(difference < 1e-13*largest);
}

/// All elements of one kind but the few that fill no lanes. Returns how many.
template<int D, class Real>
std::size_t check(const Scene& s, ElementKind kind)
{
    constexpr std::size_t width = widthOf<Real>;
    FlowSystem alone = s.emptySystem(), together = s.emptySystem();
    std::vector<double> fineAlone, fineTogether;
    ElementData<D> data;
    ElementLanes<D, Real> lanes(s.mesh, s.step, s.fluid, s.controls, s.nodal);
    std::vector<int> elements;
    for (int e = 0; e < s.mesh.nElements; ++e)
        if (s.kind<D>(e) == kind) elements.push_back(e);
    for (std::size_t k = 0; k + width <= elements.size(); k += width)
    {
        for (std::size_t l = 0; l < width; ++l)
        {
            REQUIRE(loadElementData<D>(elements[k + l], s.mesh, s.step, s.fluid, s.controls, s.nodal, data));
            CHECK(data.isVarying == (kind != ElementKind::Plain));
            add<D, double>(s, &elements[k + l], data, alone, fineAlone);
        }
        lanes.loadResidual(&elements[k], kind);
        lanes.loadInertia();
        add<D, Real>(s, &elements[k], lanes.data, together, fineTogether);
    }
    compare(alone.matrix.velocity, together.matrix.velocity);
    compare(alone.matrix.gradient, together.matrix.gradient);
    compare(alone.matrix.divergence, together.matrix.divergence);
    compare(alone.matrix.pressure, together.matrix.pressure);
    compare(alone.schur, together.schur);
    compare(alone.rhs, together.rhs);
    compare(fineAlone, fineTogether);
    return elements.size();
}

template<int D, class Real>
void checkAll()
{
    const Scene one(D, false), two(D, true);
    CHECK(check<D, Real>(one, ElementKind::Plain) == std::size_t(one.mesh.nElements));
    std::size_t nPlain = 0;     // far from the density's changes, though alpha varies: few
    for (int e = 0; e < two.mesh.nElements; ++e) nPlain += two.kind<D>(e) == ElementKind::Plain;
    CHECK(check<D, Real>(two, ElementKind::Carried) + check<D, Real>(two, ElementKind::Varying) == two.mesh.nElements - nPlain);
    CHECK(nPlain > 0);
    CHECK(nPlain < 0.05*two.mesh.nElements);
}

} // namespace

TEST_CASE("elements in lanes")
{
    SUBCASE("2D, two lanes") { checkAll<2, Lanes2>(); }
    SUBCASE("2D, four lanes") { checkAll<2, Lanes4>(); }
    SUBCASE("3D, two lanes") { checkAll<3, Lanes2>(); }
    SUBCASE("3D, four lanes") { checkAll<3, Lanes4>(); }
}

TEST_CASE("elements alone")
{
    Scene s(3, false);
    s.nodal.fluid[s.mesh.elements[0]] = NodalData::Gas;
    CHECK(s.kind<3>(0) == ElementKind::Alone);
    s.nodal.fluid.assign(s.mesh.nNodes, NodalData::Mixed);
    CHECK(s.kind<3>(0) == ElementKind::Alone);
    s.nodal.fluid.assign(s.mesh.nNodes, NodalData::Gas);
    CHECK(s.kind<3>(0) == ElementKind::Plain);
    Cover cover;
    cover.state.assign(s.mesh.nElements, ElementState::Cut);
    s.step.cover = &cover;
    CHECK(s.kind<3>(0) == ElementKind::Alone);
}
