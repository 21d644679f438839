// SPDX-License-Identifier: GPL-3.0-or-later
/// Gas far from the water left out: a column of water collapses as it does with all of the gas, and the same on any number of ranks.
#include "equations/fluid.hpp"
#include "equations/materials.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>

using namespace flotsam;

namespace
{

struct Collapse
{
    SimplexMesh mesh;
    Halo halo;
    NumericsControls controls;
    FluidProperties properties;
    std::unique_ptr<Fluid> fluid;
    double worstLoss = 0;       // of liquid volume in a step, relative

    Collapse(MPI_Comm comm, int dim, int gasDepth)
    :   mesh(makeBoxMesh(comm, dim, {24, dim == 2 ? 24 : 3, dim == 2 ? 1 : 24}, {0, 0, 0}, {1, dim == 2 ? 1. : 0.125, 1}, 0.1)), halo(mesh, comm)
    {
        controls.tolerance = 1e-8;
        controls.gasDepth = gasDepth;
        properties.gravity[dim - 1] = -9.81;
        fluid = std::make_unique<Fluid>(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Slip));
        FlowState state = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[std::size_t(i)*dim];
            state.alpha[i] = x[0] < 0.3 && x[dim - 1] < 0.4;
        }
        fluid->start(state, true);
        const double volume = fluid->liquidVolume();
        for (int k = 0; k < 25; ++k)
        {
            fluid->beginStep(4e-3);
            fluid->assemble();
            REQUIRE(fluid->solve({}).hasConverged);
            fluid->endStep();
            worstLoss = std::max(worstLoss, std::abs(fluid->liquidVolume()/volume - 1));
        }
    }

    /// Mean position of the water [m].
    std::array<double, 2> centre() const
    {
        std::vector<double> sums(3, 0.0);
        const int n = mesh.dim + 1;
        for (int e = 0; e < mesh.nElements; ++e)
            for (int a = 0; a < n && mesh.isOwnedElement[e]; ++a)
            {
                const int i = mesh.elements[std::size_t(e)*n + a];
                const double liquid = mesh.volume[e]/n*fluid->state().alpha[i];
                sums[0] += liquid;
                sums[1] += liquid*mesh.x[std::size_t(i)*mesh.dim];
                sums[2] += liquid*mesh.x[std::size_t(i)*mesh.dim + mesh.dim - 1];
            }
        halo.sum(sums.data(), 3);
        return {sums[1]/sums[0], sums[2]/sums[0]};
    }

    double shareAtRest() const
    {
        long nAtRest = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double* u = &fluid->state().u[std::size_t(i)*mesh.dim];
            nAtRest += std::all_of(u, u + mesh.dim, [](double v) { return v == 0; });
        }
        return double(halo.sum(nAtRest))/double(mesh.nGlobal);
    }
};

} // namespace

TEST_CASE("a column of water collapses in the gas around it as in all of the gas")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        const Collapse all(MPI_COMM_WORLD, dim, 0), around(MPI_COMM_WORLD, dim, 4), alone(MPI_COMM_SELF, dim, 4);
        CHECK(around.worstLoss < 1e-11);
        MESSAGE(dim, "D: ", around.shareAtRest(), " of the nodes left out; water at ", around.centre()[0], " ", around.centre()[1], ", all gas ", all.centre()[0],
            " ", all.centre()[1]);
        CHECK(around.shareAtRest() > 0.2);
        for (int d = 0; d < 2; ++d) CHECK(around.centre()[d] == near(all.centre()[d], 1e-3));
        double difference = 0;
        for (int i = 0; i < around.mesh.nOwned; ++i)
            difference = std::max(difference, std::abs(around.fluid->state().alpha[i] - alone.fluid->state().alpha[around.mesh.originalNode[i]]));
        CHECK(around.halo.max(difference) < 1e-4);
    }
}

TEST_CASE("water that reaches the top leaves the pressure of the gas alone")
{
    usePetsc();
    const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, 2, {20, 20, 1}, {0, 0, 0}, {1, 1, 1});
    const Halo halo(mesh, MPI_COMM_WORLD);
    FluidProperties properties;
    properties.gravity[1] = -9.81;
    NumericsControls controls;
    controls.gasDepth = 2;
    std::vector<BoundaryPatch> patches;
    for (int p : {0, 1, 2}) patches.push_back(makePatch(mesh, p, BoundaryPatch::Velocity::Slip));
    patches.push_back(makePatch(mesh, 3, BoundaryPatch::Velocity::Open));
    const auto evaluate = patches[3].evaluate;
    patches[3].evaluate = [&, nodes = patches[3].nodes](const BoundaryState& state, PatchValues& values)
    {
        evaluate(state, values);    // p_rgh 0
        for (std::size_t k = 0; k < nodes.size(); ++k) values.pressure[k] = -9.81*density(properties, controls, state.alpha[nodes[k]]);
    };
    Fluid fluid(mesh, halo, properties, controls, patches);
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i) state.alpha[i] = mesh.x[2*std::size_t(i)] < 0.3;
    fluid.start(state, true);
    fluid.beginStep(1e-3);
    fluid.assemble();
    REQUIRE(fluid.solve({}).hasConverged);
    fluid.endStep();
    for (int i = 0; i < mesh.nOwned; ++i)
        if (mesh.x[2*std::size_t(i)] > 0.9) CHECK(fluid.state().p[i] == near(-9.81*mesh.x[2*std::size_t(i) + 1], 1e-14));
}
