// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/meshChecks.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

std::uint64_t mix(std::uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

long elementHash(const SimplexMesh& mesh, int e)
{
    std::array<std::int64_t, 4> key{-1, -1, -1, -1};
    for (int a = 0; a <= mesh.dim; ++a)
    {
        key[a] = mesh.originalNode[mesh.elements[e * (mesh.dim + 1) + a]];
    }
    std::sort(key.begin(), key.end());
    std::uint64_t hash = 0;
    for (const std::int64_t k : key)
    {
        hash = mix(hash + 0x9e3779b97f4a7c15ull + static_cast<std::uint64_t>(k));
    }
    return static_cast<long>(hash >> 32); // sums of these do not overflow
}

/// Outward normal times area of a boundary face.
std::array<double, 3> faceNormal(const SimplexMesh& mesh, const int* nodes)
{
    const double* p = &mesh.x[nodes[0] * mesh.dim];
    const double* q = &mesh.x[nodes[1] * mesh.dim];
    if (mesh.dim == 2)
    {
        return {q[1] - p[1], -(q[0] - p[0]), 0};
    }
    const double* r = &mesh.x[nodes[2] * mesh.dim];
    const double a[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, b[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    return {0.5 * (a[1] * b[2] - a[2] * b[1]), 0.5 * (a[2] * b[0] - a[0] * b[2]), 0.5 * (a[0] * b[1] - a[1] * b[0])};
}

double norm(const std::array<double, 3>& v)
{
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The element behind the face holds its nodes, and its remaining node lies inside.
bool isFaceRight(const SimplexMesh& mesh, const int* faceNodes, int element)
{
    const int* nodes = &mesh.elements[element * (mesh.dim + 1)];
    int opposite = -1, found = 0;
    for (int a = 0; a <= mesh.dim; ++a)
    {
        const bool isOnFace = std::find(faceNodes, faceNodes + mesh.dim, nodes[a]) != faceNodes + mesh.dim;
        found += isOnFace;
        opposite = isOnFace ? opposite : nodes[a];
    }
    if (found != mesh.dim)
    {
        return false;
    }
    const auto normal = faceNormal(mesh, faceNodes);
    double height = 0;
    for (int d = 0; d < mesh.dim; ++d)
    {
        height += normal[d] * (mesh.x[opposite * mesh.dim + d] - mesh.x[faceNodes[0] * mesh.dim + d]);
    }
    return height < 0;
}

std::string checkNumbers(const SimplexMesh& mesh, const Halo& halo)
{
    std::vector<double> number(mesh.nNodes, -1);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        number[i] = static_cast<double>(mesh.globalNode[i]);
        if (mesh.globalNode[i] != mesh.firstGlobal + i || mesh.nodeOwner[i] != halo.rank())
        {
            return "owned nodes are not numbered contiguously";
        }
    }
    halo.update(number, 1);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        if (number[i] != static_cast<double>(mesh.globalNode[i]))
        {
            return "a halo node has another number than its owner's";
        }
    }
    return {};
}

std::string checkPositions(const SimplexMesh& mesh, const Halo& halo)
{
    std::vector<double> x(mesh.x);
    std::fill(x.begin() + mesh.nOwned * mesh.dim, x.end(), 1e300);
    halo.update(x, mesh.dim);
    return x == mesh.x ? "" : "a halo node lies elsewhere than its owner's";
}

/// Every rank must hold, around an owned node, all elements that all ranks own there; the same for the first ring.
std::string checkRings(const SimplexMesh& mesh, const Halo& halo)
{
    std::vector<double> owned(mesh.nNodes, 0), held(mesh.nNodes, 0);
    std::vector<char> isFirstRing(mesh.nNodes, 0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        bool isInner = false;
        for (int a = 0; a <= mesh.dim; ++a)
        {
            const int node = mesh.elements[e * (mesh.dim + 1) + a];
            owned[node] += mesh.isOwnedElement[e];
            held[node] += 1;
            isInner = isInner || node < mesh.nOwned;
        }
        if (mesh.isOwnedElement[e] && !isInner)
        {
            return "an element is counted where none of its nodes is owned";
        }
        if (isInner != (e < mesh.nInnerElements))
        {
            return "the inner elements do not come first";
        }
        for (int a = 0; a <= mesh.dim && isInner; ++a)
        {
            isFirstRing[mesh.elements[e * (mesh.dim + 1) + a]] = 1;
        }
    }
    halo.sumToOwners(owned, 1);
    halo.update(owned, 1);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        if ((i < mesh.nOwned || isFirstRing[i]) && held[i] != owned[i])
        {
            return "not all elements of an owned or first-ring node are held";
        }
        if (held[i] == 0 || held[i] > owned[i])
        {
            return "a node has no element, or an element is held twice";
        }
    }
    return {};
}

std::string checkFaces(const SimplexMesh& mesh)
{
    for (const MeshPatch& patch : mesh.patches)
    {
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            if (!isFaceRight(mesh, &patch.faceNodes[f * mesh.dim], patch.faceElement[f]))
            {
                return "a face of patch " + patch.name + " is not a face of its element or points inwards";
            }
            if (patch.isOwnedFace[f] != mesh.isOwnedElement[patch.faceElement[f]])
            {
                return "a face of patch " + patch.name + " is not owned by the owner of its element";
            }
        }
    }
    return {};
}

double laplacianOfSquares(const SimplexMesh& mesh, const NodeGraph& graph)
{
    const int n = mesh.dim + 1;
    std::vector<double> matrix(graph.column.size(), 0), q(mesh.nNodes, 0);
    for (int i = 0; i < mesh.nNodes * mesh.dim; ++i)
    {
        q[i / mesh.dim] += mesh.x[i] * mesh.x[i];
    }
    for (int e = 0; e < mesh.nInnerElements; ++e)
    {
        const double* grad = &mesh.gradN[e * n * mesh.dim];
        for (int k = 0; k < n * n; ++k)
        {
            const int slot = graph.slot(mesh.elements[e * n + k / n], e * n * n + k);
            for (int d = 0; d < mesh.dim && slot >= 0; ++d)
            {
                matrix[slot] += mesh.volume[e] * grad[k / n * mesh.dim + d] * grad[k % n * mesh.dim + d];
            }
        }
    }
    double total = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        double row = 0;
        for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
        {
            row += matrix[k] * q[graph.column[k]];
        }
        total += row * row;
    }
    return total;
}

void summarisePatch(const SimplexMesh& mesh, const MeshPatch& patch, const Halo& halo, MeshSummary& summary)
{
    double sums[5] = {0, 0, 0, 0, 0};
    for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
    {
        const auto normal = faceNormal(mesh, &patch.faceNodes[f * mesh.dim]);
        const double area = norm(normal);
        for (int b = 0; b < mesh.dim; ++b)
        {
            sums[4] += patch.faceNodes[f * mesh.dim + b] < mesh.nOwned ? area / mesh.dim : 0;
        }
        sums[3] += patch.isOwnedFace[f] ? area : 0;
        for (int d = 0; d < 3; ++d)
        {
            sums[d] += patch.isOwnedFace[f] ? normal[d] : 0;
        }
    }
    halo.sum(sums, 5);
    summary.patchNormal.push_back({sums[0], sums[1], sums[2]});
    summary.patchArea.push_back(sums[3]);
    summary.nodalPatchArea.push_back(sums[4]);
}

} // namespace

MeshSummary summarise(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo)
{
    MeshSummary summary;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (mesh.isOwnedElement[e])
        {
            summary.volume += mesh.volume[e];
            summary.splitDigest += elementHash(mesh, e);
            ++summary.elements;
        }
    }
    summary.volume = halo.sum(summary.volume);
    summary.elements = halo.sum(summary.elements);
    summary.splitDigest = halo.sum(summary.splitDigest);
    summary.nodes = halo.sum(static_cast<long>(mesh.nOwned));
    for (const MeshPatch& patch : mesh.patches)
    {
        summarisePatch(mesh, patch, halo, summary);
    }
    summary.laplacian = halo.sum(laplacianOfSquares(mesh, graph));
    return summary;
}

std::string checkDistribution(const SimplexMesh& mesh, const Halo& halo)
{
    for (const std::string& problem :
        {checkNumbers(mesh, halo), checkPositions(mesh, halo), checkRings(mesh, halo), checkFaces(mesh)})
    {
        if (!problem.empty())
        {
            return problem;
        }
    }
    return {};
}

} // namespace flotsam
