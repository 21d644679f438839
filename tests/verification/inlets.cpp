// SPDX-License-Identifier: GPL-3.0-or-later
/// Patches of prescribed velocity beside no-slip walls: what passes them (docs/numerics/2-momentum.md, 2.15).
#include "core/patchFaces.hpp"
#include "equations/fluid.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace flotsam;

namespace
{

constexpr double speed = 2;     // [m/s]
using Kind = BoundaryPatch::Velocity;

/// A no-slip wall, held weakly or at its nodes.
BoundaryPatch noSlipWall(const SimplexMesh& mesh, int patch, Kind kind)
{
    BoundaryPatch wall = makePatch(mesh, patch, kind);
    wall.isNoSlipWall = true;
    return wall;
}

BoundaryPatch moving(const SimplexMesh& mesh, int patch, const std::array<double, 3>& velocity)
{
    return makePatch(mesh, patch, Kind::Fixed, [velocity](const double*, double) { return velocity; });
}

/// Volume that the P1 velocity takes into the mesh through a patch [m^dim/s].
double discharge(const Fluid& fluid, int patch)
{
    const SimplexMesh& mesh = fluid.mesh();
    const MeshPatch& faces = mesh.patches[patch];
    double sum = 0, v[3];
    for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
    {
        if (!faces.isOwnedFace[f]) continue;
        outwardVector(mesh, faces, f, v);
        for (int k = 0; k < mesh.dim; ++k)
            for (int d = 0; d < mesh.dim; ++d) sum -= v[d]*fluid.state().u[std::size_t(faces.faceNodes[f*mesh.dim + k])*mesh.dim + d]/mesh.dim;
    }
    return fluid.halo().sum(sum);
}

void advance(Fluid& fluid, double dt, int steps)
{
    for (int step = 0; step < steps; ++step)
    {
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve({}).hasConverged);
        fluid.endStep();
    }
}

} // namespace

TEST_CASE("a uniform inlet between no-slip walls brings its velocity times its area")
{
    usePetsc();
    for (const int dim : {2, 3})
        for (const Kind walls : {Kind::NoSlip, Kind::Fixed})
        {
            const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {12, 6, 4}, {0, 0, 0}, {2, 1, 0.7}, 0.1);
            const Halo halo(mesh, MPI_COMM_WORLD);
            std::vector<BoundaryPatch> patches{moving(mesh, 0, {speed, 0, 0}), makePatch(mesh, 1, Kind::Open)};
            for (int p = 2; p < 2*dim; ++p) patches.push_back(noSlipWall(mesh, p, walls));
            Fluid fluid(mesh, halo, oneFluid(1000, 1e-3), NumericsControls(), patches);
            FlowState start = restState(mesh);
            for (int i = 0; i < mesh.nNodes; ++i) start.u[std::size_t(i)*dim] = speed;
            start.uOld = start.u;
            fluid.start(start, false);
            advance(fluid, 0.05, 10);
            CHECK(discharge(fluid, 0) == near(speed*(dim == 2 ? 1 : 0.7), 1e-14));
            if (walls == Kind::Fixed) continue;
            double slowest = speed;     // the walls' layer is far thinner than the elements
            for (int i = 0; i < mesh.nOwned; ++i) slowest = std::min(slowest, fluid.state().u[std::size_t(i)*dim]);
            slowest = halo.min(slowest);
            MESSAGE(dim, "D: slowest ", slowest, " m/s");
            CHECK(slowest > 0.9*speed);
        }
}

TEST_CASE("a lid that moves along itself does not move the walls beside it")
{
    usePetsc();
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {4, 4, 4}, {0, 0, 0}, {1, 1, 1}, 0.1);
        const Halo halo(mesh, MPI_COMM_WORLD);
        std::vector<BoundaryPatch> patches;
        for (int p = 0; p < 2*dim; ++p) patches.push_back(p == 3 ? moving(mesh, 3, {speed, 0, 0}) : noSlipWall(mesh, p, Kind::NoSlip));
        Fluid fluid(mesh, halo, oneFluid(1, 1e-2), NumericsControls(), patches);
        fluid.start(restState(mesh), false);
        advance(fluid, 0.1, 2);
        std::set<int> walls;
        for (int p = 0; p < 2*dim; ++p)
            if (p != 3) walls.insert(patches[p].nodes.begin(), patches[p].nodes.end());
        for (int i : patches[3].nodes) CHECK(fluid.state().u[std::size_t(i)*dim] == (walls.count(i) ? 0 : speed));
    }
}
