// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/elementHalo.hpp"
#include "algebra/meshHalo.hpp"
#include "support/boxMesh.hpp"
#include "support/meshChecks.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace flotsam;

namespace
{

using RankOfElement = std::function<int(const SimplexMesh&, int)>;

/// The part of a whole mesh that a partition gives to this rank; keys with gaps, as points of a plane have.
LocalSimplices takeShare(const SimplexMesh& whole, const RankOfElement& rankOf, int rank)
{
    const int n = whole.dim + 1;
    std::vector<int> facePatch(whole.elements.size(), -1);
    LocalSimplices share;
    share.dim = whole.dim;
    for (std::size_t p = 0; p < whole.patches.size(); ++p)
    {
        const MeshPatch& patch = whole.patches[p];
        share.patchNames.push_back(patch.name);
        share.patchTypes.push_back(patch.type);
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            const auto face = patch.faceNodes.begin() + f * whole.dim;
            for (int a = 0; a < n; ++a)
            {
                const std::size_t k = patch.faceElement[f] * n + a;
                if (std::find(face, face + whole.dim, whole.elements[k]) == face + whole.dim)
                {
                    facePatch[k] = static_cast<int>(p);
                }
            }
        }
    }
    std::vector<int> local(whole.nNodes, -1);
    for (int e = 0; e < whole.nElements; ++e)
    {
        for (int a = 0; a < n && rankOf(whole, e) == rank; ++a)
        {
            const int node = whole.elements[e * n + a];
            if (local[node] < 0)
            {
                local[node] = static_cast<int>(share.nodeKey.size());
                share.nodeKey.push_back(3 * whole.originalNode[node] + 5);
                share.x.insert(share.x.end(), &whole.x[node * whole.dim], &whole.x[node * whole.dim] + whole.dim);
            }
            share.elements.push_back(local[node]);
            share.facePatch.push_back(facePatch[e * n + a]);
        }
    }
    return share;
}

double centre(const SimplexMesh& mesh, int e, int direction)
{
    double sum = 0;
    for (int a = 0; a <= mesh.dim; ++a)
    {
        sum += mesh.x[mesh.elements[e * (mesh.dim + 1) + a] * mesh.dim + direction];
    }
    return sum / (mesh.dim + 1);
}

void checkPartition(int dim, const RankOfElement& rankOf)
{
    const SimplexMesh whole = makeBoxMesh(MPI_COMM_SELF, dim, {9, 5, 4}, {0, 0, 0}, {1.8, 1, 0.6}, 0.15);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const LocalSimplices share = takeShare(whole, rankOf, rank);
    const DistributedSimplices distributed = distributeSimplices(share, MPI_COMM_WORLD);
    const SimplexMesh& mesh = distributed.mesh;
    const Halo halo(mesh, MPI_COMM_WORLD);
    CHECK(checkDistribution(mesh, halo) == "");

    const MeshSummary shared = summarise(mesh, NodeGraph(mesh), halo);
    const MeshSummary serial = summarise(whole, NodeGraph(whole), Halo(whole, MPI_COMM_SELF));
    CHECK(shared.volume == near(serial.volume, 1e-14));
    CHECK(shared.elements == serial.elements);
    CHECK(shared.nodes == serial.nodes);
    CHECK(shared.splitDigest == serial.splitDigest); // originalNode has no gaps and keeps the order of the keys
    CHECK(shared.laplacian == near(serial.laplacian, 1e-14));
    for (std::size_t p = 0; p < serial.patchArea.size(); ++p)
    {
        CHECK(shared.patchArea[p] == near(serial.patchArea[p], 1e-14));
        CHECK(shared.nodalPatchArea[p] == near(serial.patchArea[p], 2e-14));
    }

    std::vector<double> values(2*std::size_t(mesh.nElements), 0.0);
    for (int e = 0; e < mesh.nInnerElements; ++e)
        for (int d = 0; d < 2; ++d) values[2*std::size_t(e) + d] = centre(mesh, e, d);
    ElementHalo(mesh, NodeGraph(mesh), halo).update(values, 2);
    double worst = 0;
    for (int e = 0; e < mesh.nElements; ++e)
        for (int d = 0; d < 2; ++d) worst = std::max(worst, std::abs(values[2*std::size_t(e) + d] - centre(mesh, e, d)));
    CHECK(worst < 1e-14);   // also of elements of which this rank owns no node

    bool inputFound = true;
    for (std::size_t k = 0; k < share.elements.size(); ++k)
    {
        const int element = distributed.elementOfInput[k / (dim + 1)];
        const int node = distributed.nodeOfInput[share.elements[k]];
        const auto first = mesh.elements.begin() + element * (dim + 1);
        inputFound = inputFound && std::count(first, first + dim + 1, node) == 1
            && mesh.x[node * dim] == share.x[share.elements[k] * dim];
    }
    CHECK(inputFound);
}

int rankCount()
{
    int size = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
}

} // namespace

TEST_CASE("elements in quarters: nodes shared by up to four ranks")
{
    const auto quarters = [](const SimplexMesh& mesh, int e)
    { return ((centre(mesh, e, 0) > 0.9 ? 1 : 0) + (centre(mesh, e, 1) > 0.5 ? 2 : 0)) % rankCount(); };
    checkPartition(2, quarters);
    checkPartition(3, quarters);
}

TEST_CASE("elements scattered at random over the ranks")
{
    const auto scattered = [](const SimplexMesh&, int e) { return static_cast<int>((e * 2654435761u >> 16) % rankCount()); };
    checkPartition(2, scattered);
    checkPartition(3, scattered);
}

TEST_CASE("layers so thin that a rank owns no node, and a rank without elements")
{
    const auto layers = [](const SimplexMesh& mesh, int e)
    { return centre(mesh, e, 0) > 0.8 && centre(mesh, e, 0) < 1.0 ? rankCount() - 1 : 0; };
    checkPartition(2, layers);
    checkPartition(3, layers);
}
