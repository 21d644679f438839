// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/boxMesh.hpp"
#include "support/meshChecks.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace flotsam;

namespace
{

SimplexMesh makeMesh(MPI_Comm comm, int dim)
{
    return makeBoxMesh(comm, dim, {7, 4, 3}, {0, 0, 0}, {1.4, 1, 0.6}, 0.15);
}

/// A value that only the node itself decides.
double valueOf(const SimplexMesh& mesh, int i, int component)
{
    return std::sin(0.1 * static_cast<double>(mesh.originalNode[i])) + component;
}

} // namespace

TEST_CASE("box mesh: numbering, rings, ownership and faces are right")
{
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeMesh(MPI_COMM_WORLD, dim);
        const Halo halo(mesh, MPI_COMM_WORLD);
        CHECK(checkDistribution(mesh, halo) == "");
    }
}

TEST_CASE("box mesh: integrals and the assembled Laplacian equal those of one rank")
{
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeMesh(MPI_COMM_WORLD, dim), whole = makeMesh(MPI_COMM_SELF, dim);
        const MeshSummary shared = summarise(mesh, NodeGraph(mesh), Halo(mesh, MPI_COMM_WORLD));
        const MeshSummary serial = summarise(whole, NodeGraph(whole), Halo(whole, MPI_COMM_SELF));
        CHECK(shared.volume == near(serial.volume, 1e-14));
        CHECK(shared.elements == serial.elements);
        CHECK(shared.nodes == serial.nodes);
        CHECK(shared.splitDigest == serial.splitDigest);
        CHECK(shared.laplacian == near(serial.laplacian, 1e-14));
        for (std::size_t p = 0; p < serial.patchArea.size(); ++p)
        {
            CHECK(shared.patchArea[p] == near(serial.patchArea[p], 1e-14));
            CHECK(shared.nodalPatchArea[p] == near(serial.patchArea[p], 1e-14));
        }
        CHECK(serial.patchNormal[0][0] == near(-serial.patchArea[0], 1e-14));
        CHECK(serial.patchNormal[3][1] == near(serial.patchArea[3], 1e-14));
    }
}

TEST_CASE("update carries the owners' values, sumToOwners the copies' contributions")
{
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = makeMesh(MPI_COMM_WORLD, dim);
        const Halo halo(mesh, MPI_COMM_WORLD);
        std::vector<double> values(2 * mesh.nNodes, 0);
        std::vector<int> owners(mesh.nNodes, -1);
        for (int k = 0; k < 2 * mesh.nOwned; ++k)
        {
            values[k] = valueOf(mesh, k / 2, k % 2);
            owners[k / 2] = halo.rank();
        }
        halo.update(values, 2);
        halo.update(owners, 1);
        CHECK(owners == mesh.nodeOwner);
        bool allRight = true;
        for (int k = 0; k < 2 * mesh.nNodes; ++k)
        {
            allRight = allRight && values[k] == valueOf(mesh, k / 2, k % 2);
        }
        CHECK(allRight);

        // volumes of the owned elements, lumped to the nodes: the owners' sums are the dual volumes of all elements
        const int n = dim + 1;
        std::vector<double> lumped(mesh.nNodes, 0), complete(mesh.nNodes, 0);
        for (int k = 0; k < mesh.nElements * n; ++k)
        {
            complete[mesh.elements[k]] += mesh.volume[k / n];
            lumped[mesh.elements[k]] += mesh.isOwnedElement[k / n] ? mesh.volume[k / n] : 0;
        }
        halo.sumToOwners(lumped, 1);
        double worst = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            worst = std::max(worst, std::abs(lumped[i] - complete[i]) / complete[i]);
        }
        CHECK(worst < 1e-13);
    }
}

TEST_CASE("reductions give the same on every rank")
{
    const SimplexMesh mesh = makeMesh(MPI_COMM_WORLD, 2);
    const Halo halo(mesh, MPI_COMM_WORLD);
    const int rank = halo.rank(), size = halo.size();
    CHECK(halo.sum(1.0) == size);
    CHECK(halo.sum(2L) == 2 * size);
    CHECK(halo.max(static_cast<double>(rank)) == size - 1);
    CHECK(halo.min(static_cast<double>(rank)) == 0);
    CHECK(halo.any(rank == size - 1));
    CHECK_FALSE(halo.any(false));
    CHECK(halo.counters().reductions == 6);
}
