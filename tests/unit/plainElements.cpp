// SPDX-License-Identifier: GPL-3.0-or-later
/// Plain elements, computed several at once, are to give what the general way gives for each of them.
#include "equations/elementAssembly.hpp"
#include "equations/plainElements.hpp"
#include "support/flowCases.hpp"

#include <cmath>
#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

/// One fluid in motion, everything that the loaders read.
struct Scene
{
    SimplexMesh mesh;
    NodeGraph graph;
    FlowState state;
    FluidProperties fluid;
    NumericsControls controls;
    NodalData nodal;
    std::vector<double> fineScale, force, viscousForce, solution;
    FlowStepData step;

    explicit Scene(int dim) : mesh(makeBoxMesh(MPI_COMM_SELF, dim, {3, 3, 3}, {0, 0, 0}, {1, 1.2, 0.9}, 0.15)), graph(mesh), state(restState(mesh))
    {
        constexpr double rho = 998, mu = 0.7;
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
        nodal.rho = nodal.rhoOld = nodal.rhoOlder = std::vector<double>(nodes, rho);
        nodal.mu.assign(nodes, mu);
        nodal.fluid.assign(nodes, NodalData::Liquid);
        nodal.advection = wave(n, 1.1);
        nodal.history.resize(n);
        for (std::size_t k = 0; k < n; ++k) nodal.history[k] = -(step.time.c1*state.u[k] + step.time.c2*state.uOld[k]);
    }

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

template<int D, class Real>
void check()
{
    constexpr int width = widthOf<Real>;
    const Scene s(D);
    FlowSystem alone = s.emptySystem(), together = s.emptySystem();
    std::vector<double> fineAlone, fineTogether;
    ElementData<D> data;
    PlainElements<D, Real> plain;
    for (int e = 0; e + width <= s.mesh.nElements; e += width)
    {
        int elements[width];
        for (int l = 0; l < width; ++l)
        {
            elements[l] = e + l;
            REQUIRE(isPlain<D>(e + l, s.mesh, s.step, s.nodal));
            REQUIRE(loadElementData<D>(e + l, s.mesh, s.step, s.fluid, s.controls, s.nodal, data));
            add<D, double>(s, elements + l, data, alone, fineAlone);
        }
        plain.loadResidual(elements, s.mesh, s.step, s.controls, s.nodal);
        plain.loadInertia(s.controls);
        add<D, Real>(s, elements, plain.data, together, fineTogether);
    }
    compare(alone.matrix.velocity, together.matrix.velocity);
    compare(alone.matrix.gradient, together.matrix.gradient);
    compare(alone.matrix.divergence, together.matrix.divergence);
    compare(alone.matrix.pressure, together.matrix.pressure);
    compare(alone.schur, together.schur);
    compare(alone.rhs, together.rhs);
    compare(fineAlone, fineTogether);
}

} // namespace

TEST_CASE("plain elements in lanes")
{
    SUBCASE("2D, two lanes") { check<2, Lanes2>(); }
    SUBCASE("2D, four lanes") { check<2, Lanes4>(); }
    SUBCASE("3D, two lanes") { check<3, Lanes2>(); }
    SUBCASE("3D, four lanes") { check<3, Lanes4>(); }
}

TEST_CASE("elements that are not plain")
{
    Scene s(3);
    const int node = s.mesh.elements[0];
    s.nodal.fluid[node] = NodalData::Gas;
    CHECK_FALSE(isPlain<3>(0, s.mesh, s.step, s.nodal));
    s.nodal.fluid.assign(s.mesh.nNodes, NodalData::Mixed);
    CHECK_FALSE(isPlain<3>(0, s.mesh, s.step, s.nodal));
    s.nodal.fluid.assign(s.mesh.nNodes, NodalData::Gas);
    CHECK(isPlain<3>(0, s.mesh, s.step, s.nodal));
    Cover cover;
    cover.state.assign(s.mesh.nElements, ElementState::Cut);
    s.step.cover = &cover;
    CHECK_FALSE(isPlain<3>(0, s.mesh, s.step, s.nodal));
}
