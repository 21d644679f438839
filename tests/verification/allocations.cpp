// SPDX-License-Identifier: GPL-3.0-or-later
/// What the program's own code takes from the heap in a step, without PETSc, hypre, MPI and the DEM engine: nothing but what grows, however fine the mesh and however many
/// iterations the solve takes; with bodies what Eigen takes for sparse factors, too.
#include "support/bodyTank.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace
{

struct Heap
{
    long calls = 0;
    std::size_t bytes = 0;
    bool counts = false;

    void count(std::size_t size)
    {
        if (!counts) return;
        ++calls;
        bytes += size;
    }
    void restart() { *this = Heap{0, 0, true}; }
} heap;

extern "C" char __executable_start, etext;  // the linker's: code of this program, not of shared libraries
bool isOwn(const void* caller) { return caller >= static_cast<const void*>(&__executable_start) && caller < static_cast<const void*>(&etext); }

} // namespace

extern "C"
{
void* __real_malloc(std::size_t size);
void* __wrap_malloc(std::size_t size)       // Eigen's: of all objects that are linked here (--wrap)
{
    heap.count(size);
    return __real_malloc(size);
}
}

[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    if (isOwn(__builtin_return_address(0))) heap.count(size);
    return __real_malloc(std::max(size, std::size_t(1)));
}
[[gnu::noinline]] void* operator new(std::size_t size)
{
    if (isOwn(__builtin_return_address(0))) heap.count(size);
    if (void* p = __real_malloc(std::max(size, std::size_t(1)))) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size)
{
    if (isOwn(__builtin_return_address(0))) heap.count(size);
    if (void* p = __real_malloc(std::max(size, std::size_t(1)))) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

using namespace bodyTank;

namespace
{

constexpr int nSteps = 24, first = 8;   // steps that do not count: work vectors grow

/// Median over the steps of a run.
struct Counts
{
    std::vector<long> begin, assemble, solve, end, all;
    std::vector<double> bytes;

    static double median(std::vector<double> v)
    {
        std::nth_element(v.begin(), v.begin() + v.size()/2, v.end());
        return v[v.size()/2];
    }
    static long median(const std::vector<long>& v) { return long(median(std::vector<double>(v.begin(), v.end()))); }
};

/// A dam break, n cells over the sides of a closed box.
Counts withoutBodies(int dim, int n)
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1});
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.gravity[dim - 1] = -g;
    Fluid fluid(mesh, halo, properties, NumericsControls(), allPatches(mesh, BoundaryPatch::Velocity::Slip));
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i) state.alpha[i] = mesh.x[std::size_t(i)*dim] < 0.4 && mesh.x[std::size_t(i)*dim + dim - 1] < 0.6;
    fluid.start(state, true);
    Counts counts;
    for (int k = 0; k < nSteps; ++k)
    {
        long before = 0;
        const auto take = [&](std::vector<long>& part)
        {
            if (k >= first) part.push_back(heap.calls - before);
            before = heap.calls;
        };
        heap.restart();
        fluid.beginStep(0.2/n);
        take(counts.begin);
        fluid.assemble();
        take(counts.assemble);
        const SolveReport report = fluid.solve({});
        take(counts.solve);
        fluid.endStep();
        take(counts.end);
        heap.counts = false;
        REQUIRE(report.hasConverged);
        if (k < first || report.rebuiltPreconditioner) continue;    // a new hierarchy has its own
        counts.all.push_back(heap.calls);
        counts.bytes.push_back(double(heap.bytes)/mesh.nNodes);
    }
    std::printf("%dD n=%-3d: %ld allocations a step (phase field %ld, assembly %ld, solve %ld, end %ld), %.0f bytes a node\n", dim, n, Counts::median(counts.all),
        Counts::median(counts.begin), Counts::median(counts.assemble), Counts::median(counts.solve), Counts::median(counts.end), Counts::median(counts.bytes));
    return counts;
}

/// Bars that float beside each other, moving freely.
long withBodies(int nBars)
{
    Tank tank;
    std::vector<BodyDefinition> bars;
    for (int b = 0; b < nBars; ++b) bars.push_back(makeBar("bar" + std::to_string(b), 0, {0.2 + 0.2*b, level + 0.01*b, 0.5}));
    const DemSetup dem = makeDem(bars);
    const auto run = makeRun(tank, dem);
    run->start(tank.rest(), true);
    std::vector<long> calls;
    for (int k = 0; k < nSteps; ++k)
    {
        heap.restart();
        const StepResult result = run->step(0.004);
        heap.counts = false;
        REQUIRE(result.isAccepted);
        if (k >= first) calls.push_back(heap.calls);
    }
    std::printf("%d bodies: %ld allocations a step\n", nBars, Counts::median(calls));
    return Counts::median(calls);
}

} // namespace

TEST_CASE("a step takes next to nothing from the heap")
{
    for (const int dim : {2, 3})
        for (const int n : {16, 32})
        {
            CAPTURE(dim);
            CAPTURE(n);
            const Counts counts = withoutBodies(dim, n);
            REQUIRE(counts.all.size() >= (nSteps - first)/2); // the others have a new hierarchy
            CHECK(Counts::median(counts.all) <= 5); // lists of what is near the surface, as they grow
            for (const auto* part : {&counts.begin, &counts.assemble, &counts.solve, &counts.end}) CHECK(Counts::median(*part) <= 1);
            CHECK(Counts::median(counts.bytes) < 10);
        }
}

TEST_CASE("with bodies it takes a few more, most of them for sparse factors, however many there are")
{
    CHECK(withBodies(1) <= 18);
    CHECK(withBodies(3) <= 18);
}
