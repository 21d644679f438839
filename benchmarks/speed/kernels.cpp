// SPDX-License-Identifier: GPL-3.0-or-later
/// The solver's kernels alone: seconds per element, node or sub-step (column with that name).
///   build/bin/speedKernels [--benchmark_filter=..] [--benchmark_format=csv]
#include "demCoupling/coupling/scene.hpp"
#include "equations/basins.hpp"
#include "equations/flowEquation.hpp"
#include "geometry/coverBuilder.hpp"
#include "geometry/cutSimplex.hpp"
#include "support/flowCases.hpp"
#include "support/transportScene.hpp"
#include "unit/demSupport.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numeric>

using namespace flotsam;

namespace
{

constexpr int cells2D = 192, cells3D = 28;  // a direction: 37,000 and 24,000 nodes, larger than the caches

void countPer(benchmark::State& state, const char* what, double number)
{
    state.counters[what] = benchmark::Counter(number, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

int cellsOf(int dim) { return dim == 2 ? cells2D : cells3D; }

/// A box full or half full of water, sheared surface, swirling flow: everything FlowEquation::assemble reads.
struct FlowScene
{
    int cells;      // a direction
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;
    FluidProperties fluid;
    NumericsControls controls;
    std::vector<BoundaryPatch> patches;
    std::vector<PatchValues> values;
    FlowState state;
    DualCellTransport transport;
    FlowEquation equation;
    Basins basins;
    std::vector<double> force;

    FlowScene(int dim, int nCells, bool isFull)
    :   cells(nCells), mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {cells, cells, dim == 2 ? 1 : cells}, {0, 0, 0}, {1, 1, 1}, 0.1)),
        graph(mesh), halo(mesh, MPI_COMM_WORLD), patches(allPatches(mesh, BoundaryPatch::Velocity::Fixed)), values(patches.size()),
        state(restState(mesh)), transport(mesh, graph, halo, controls), equation(mesh, graph, halo, fluid, controls, patches), basins(mesh, halo),
        force(std::size_t(mesh.nElements)*dim, 0.0)
    {
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double *x = &mesh.x[std::size_t(i)*dim], s = M_PI*x[0], t = M_PI*x[1];
            double* u = &state.u[std::size_t(i)*dim];
            u[0] = std::sin(s)*std::sin(s)*std::sin(2*t);
            u[1] = -std::sin(t)*std::sin(t)*std::sin(2*s);
            state.alpha[i] = isFull ? 1 : 1/(1 + std::exp((x[1] - 0.5 - 0.1*std::cos(s))/transport.width()[i]));
        }
        state.uOld = state.u;
        state.alphaOld = state.alphaOlder = state.alpha;
        const BoundaryState boundary{0, state.u.data(), state.alpha.data()};
        for (std::size_t p = 0; p < patches.size(); ++p) patches[p].evaluate(boundary, values[p]);
        basins.find(nullptr);
        transport.advance(state.alpha, timeStep(), state.u, {}, nullptr, patches, values, std::vector<char>(mesh.nNodes, 0));
    }

    double timeStep() const { return 0.5/cells; }

    void assemble()
    {
        FlowStepData step;
        step.time = TimeScheme::bdf(2, timeStep(), timeStep());
        step.state = &state;
        step.patchValues = &values;
        step.basins = &basins;
        step.transport = &transport;
        step.elementForce = &force;
        equation.assemble(step);
    }
};

void elementAssembly(benchmark::State& state)
{
    FlowScene scene(int(state.range(0)), cellsOf(int(state.range(0))), false);
    for (auto _ : state) scene.assemble();
    countPer(state, "element", scene.mesh.nElements);
    countPer(state, "node", scene.mesh.nNodes);
}
BENCHMARK(elementAssembly)->ArgName("dim")->Arg(2)->Arg(3)->Unit(benchmark::kMillisecond);

/// Only water, 3D. Argument: cells a direction; 6 fit into the second cache.
void plainAssembly(benchmark::State& state)
{
    FlowScene scene(3, int(state.range(0)), true);
    for (auto _ : state) scene.assemble();
    countPer(state, "element", scene.mesh.nElements);
    countPer(state, "node", scene.mesh.nNodes);
}
BENCHMARK(plainAssembly)->ArgName("cells")->Arg(6)->Arg(28)->Arg(40)->Unit(benchmark::kMillisecond);

void operatorProduct(benchmark::State& state)
{
    FlowScene scene(int(state.range(0)), cellsOf(int(state.range(0))), false);
    scene.assemble();
    const FlowOperator product(scene.graph, scene.halo, scene.equation.system(), scene.mesh.nOwned);
    const std::size_t n = std::size_t(scene.mesh.nNodes)*(scene.mesh.dim + 1);
    std::vector<double> x(n), y(n);
    for (std::size_t k = 0; k < n; ++k) x[k] = std::sin(double(k));
    for (auto _ : state)
    {
        product.fluidRows(x.data(), nullptr, y.data());
        benchmark::DoNotOptimize(y.data());
    }
    countPer(state, "node", scene.mesh.nNodes);
    countPer(state, "entry", double(scene.graph.column.size()));
}
BENCHMARK(operatorProduct)->ArgName("dim")->Arg(2)->Arg(3)->Unit(benchmark::kMillisecond);

/// One step to and one back, so that the surface stays what it is. Second argument: Courant number in percent.
void transportStep(benchmark::State& state)
{
    const int dim = int(state.range(0)), n = cellsOf(dim);
    TransportScene scene(MPI_COMM_WORLD, dim, n, NumericsControls().interfaceWidth, dim == 2 ? vortexField() : deformationField());
    scene.fill(disc({0.5, dim == 2 ? 0.75 : 0.5, 0.5}, dim == 2 ? 0.15 : 0.25, dim));
    const double dt = 0.01*double(state.range(1))/(n*scene.fastest);
    double amplitude = 1;
    for (auto _ : state)
    {
        scene.advance(dt, amplitude);
        amplitude = -amplitude;
    }
    countPer(state, "node", scene.mesh.nNodes);
}
BENCHMARK(transportStep)->ArgNames({"dim", "Co%"})->Args({2, 50})->Args({2, 200})->Args({3, 50})->Args({3, 200})->Unit(benchmark::kMillisecond);

template<int dim> void cutOneSimplex(benchmark::State& state)
{
    double vertices[(dim + 1)*dim] = {}, gradN[(dim + 1)*dim] = {};     // the unit simplex: origin and unit vectors
    for (int d = 0; d < dim; ++d)
    {
        vertices[(d + 1)*dim + d] = 1;
        gradN[(d + 1)*dim + d] = 1;
        gradN[d] = -1;
    }
    constexpr int variants = 1024;
    std::vector<double> distance(variants*(dim + 1));
    for (int k = 0; k < variants; ++k)
    {
        for (int a = 0; a <= dim; ++a) distance[k*(dim + 1) + a] = 0.1 + 0.9*std::abs(std::sin(1.0 + 7*k + 3*a));
        for (int a = 0; a <= k % dim; ++a) distance[k*(dim + 1) + (k/4 + a) % (dim + 1)] *= -1;
    }
    int k = 0;
    for (auto _ : state)
    {
        benchmark::DoNotOptimize(cutSimplex<dim>(&distance[k*(dim + 1)], dim == 2 ? 1./2 : 1./6, vertices, gradN));
        k = (k + 1) % variants;
    }
}
BENCHMARK_TEMPLATE(cutOneSimplex, 2);
BENCHMARK_TEMPLATE(cutOneSimplex, 3);

/// Twenty bars of the slit dam moving in a box with elements of the tutorial's size: distances, exact volume, cut, ghost faces.
/// First argument: length of the box in bars' lengths, most of it without bars (only elements near them are cut again). Second: 1 forgets the
/// last cut, so that everything is marked anew.
void cutTwentyBars(benchmark::State& state)
{
    const int length = int(state.range(0));
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 3, {10*length, 28, 20}, {0, 0, 0}, {0.2*length, 0.28, 0.25}, 0.1);
    const NodeGraph graph(mesh);
    const Halo halo(mesh, MPI_COMM_WORLD);
    auto builder = std::make_unique<CoverBuilder>(mesh, graph, halo);
    std::vector<Solid> bars(20);
    for (int b = 0; b < 20; ++b)
    {
        bars[b].name = "bar" + std::to_string(b);
        bars[b].kind = Solid::Kind::Free;
        bars[b].shape = makeBox(Vec3::Zero(), Vec3(0.02, 0.2, 0.02));
        bars[b].pose.position = Vec3(0.1 + 0.05*b, 0.14, b % 2 ? 0.16 : 0.08);
        bars[b].pose.orientation = Eigen::AngleAxisd(0.1*(b - 10), Vec3::UnitZ());
    }
    double move = 0.002;
    for (auto _ : state)
    {
        for (Solid& bar : bars) bar.pose.position.x() += move;
        move = -move;
        if (state.range(1) == 1) builder = std::make_unique<CoverBuilder>(mesh, graph, halo);
        benchmark::DoNotOptimize(builder->buildExactVolume(bars));
    }
    for (int k = 0; k < 4; ++k)     // at one place, whatever the number of iterations
    {
        for (Solid& bar : bars) bar.pose.position.x() += std::min(move, 0.0);
        move = std::abs(move);
        builder->buildExactVolume(bars);
    }
    countPer(state, "cut element", double(builder->cover().cuts.size()));
    state.counters["nodes"] = mesh.nNodes;
    const Cover& cover = builder->cover();
    state.counters["volume"] = std::accumulate(cover.solidVolume.begin(), cover.solidVolume.end(), 0.0);
    state.counters["area"] = std::accumulate(cover.solidArea.begin(), cover.solidArea.end(), 0.0);
}
BENCHMARK(cutTwentyBars)->ArgNames({"length", "anew"})->Args({6, 0})->Args({24, 0})->Args({6, 1})->Args({24, 1})->Unit(benchmark::kMillisecond);

/// Twenty bars that do not come near each other: one call of the coupling's length. Argument: 0 lets the engine take its large steps, 1
/// forces the contact sub-steps. Counters: sub-steps of a call; place of the last bar after 0.1 s, which must not depend on the argument.
void demFreeFlight(benchmark::State& state)
{
    std::vector<BodyDefinition> bodies;
    for (int b = 0; b < 20; ++b)
    {
        bodies.push_back(demTest::debris(Vec3(0, 0.05*b, 0.4)));
        bodies.back().name += std::to_string(b);
        bodies.back().motion.velocity = Vec3(0.1, 0, 0.4);
        bodies.back().motion.angularVelocity = Vec3(0.5, 0, 0);
    }
    DemSetup setup = demTest::scene(bodies, {demTest::plane(Vec3::Zero(), Vec3::UnitZ())});
    setup.box = {Vec3(-1, -1, -0.1), Vec3(1, 2, 1)};
    LiggghtsEngine engine(setup);
    engine.setLoads(demTest::weights(setup));
    const double largest = state.range(0) == 1 ? engine.timeStep() : 1e-4;
    const DemState start = engine.save();
    for (auto _ : state)
    {
        state.PauseTiming();
        engine.restore(start);
        state.ResumeTiming();
        engine.advance(0.005, largest);
    }
    state.counters["sub-steps"] = double(engine.subSteps());
    engine.restore(start);
    for (int k = 0; k < 20; ++k) engine.advance(0.005, largest);
    state.counters["z"] = engine.states().back().pose.position.z();
    state.counters["turn"] = engine.states().back().pose.orientation.x();
}
BENCHMARK(demFreeFlight)->ArgName("contactSteps")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// A heap of bars in contact. Argument: 1 with mesh walls and pipes, 0 with planes.
void demSubSteps(benchmark::State& state)
{
    const DemSetup setup = demTest::heap(20, state.range(0) == 1);
    LiggghtsEngine engine(setup);
    engine.setLoads(demTest::weights(setup));
    engine.advance(0.3);
    double subSteps = 0;
    for (auto _ : state)
    {
        engine.advance(0.002);
        subSteps += double(engine.subSteps());
    }
    state.counters["sub-step"] = benchmark::Counter(subSteps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["contacts"] = double(engine.contacts().size());
}
BENCHMARK(demSubSteps)->ArgName("meshWalls")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// Bars piled against the pipes of the slit dam, at rest: one call is one step of the flow, from the state of its start as in the coupling.
void demPile(benchmark::State& state)
{
    const DemSetup setup = demTest::pile();
    LiggghtsEngine engine(setup);
    engine.setLoads(demTest::pressing(setup));
    for (int k = 0; k < 8; ++k) engine.advance(0.0125);
    const DemState start = engine.save();
    double subSteps = 0;
    for (auto _ : state)
    {
        engine.restore(start);
        engine.advance(0.0125);
        subSteps += double(engine.subSteps());
    }
    state.counters["sub-step"] = benchmark::Counter(subSteps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["contacts"] = double(engine.contacts().size());
}
BENCHMARK(demPile)->Unit(benchmark::kMillisecond);

} // namespace

int main(int argc, char** argv)
{
    MPI_Init(&argc, &argv);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    MPI_Finalize();
    return 0;
}
