// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/meshHalo.hpp"

#include "algebra/elementRings.hpp"
#include "algebra/exchange.hpp"
#include "algebra/halo.hpp"
#include "core/simplexFaces.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace flotsam
{
namespace
{

/// Old number -> new number: those with class 0 first, then class 1, ...; order kept within a class.
std::vector<int> orderByClass(const std::vector<char>& classOf, int nClasses)
{
    std::vector<int> newNumber(classOf.size());
    int next = 0;
    for (int c = 0; c < nClasses; ++c)
    {
        for (std::size_t i = 0; i < classOf.size(); ++i)
        {
            if (classOf[i] == c)
            {
                newNumber[i] = next++;
            }
        }
    }
    return newNumber;
}

/// 0: has an owned node, 1: shares a node with such an element, 2: neither.
std::vector<char> ringOfElements(const ElementRings& rings)
{
    const int n = rings.dim + 1;
    std::vector<char> ring(rings.elements.size(), 2), isFirstRingNode(rings.nodes.size(), 0);
    for (std::size_t e = 0; e < ring.size(); ++e)
    {
        if (rings.hasOwnedNode(static_cast<int>(e)))
        {
            ring[e] = 0;
            for (int a = 0; a < n; ++a)
            {
                isFirstRingNode[rings.elementNodes[e * n + a]] = 1;
            }
        }
    }
    for (std::size_t e = 0; e < ring.size(); ++e)
    {
        const auto first = rings.elementNodes.begin() + static_cast<std::ptrdiff_t>(e) * n;
        if (ring[e] == 2 && std::any_of(first, first + n, [&](int node) { return isFirstRingNode[node] != 0; }))
        {
            ring[e] = 1;
        }
    }
    return ring;
}

std::vector<int> placeNodes(const ElementRings& rings, SimplexMesh& mesh)
{
    std::vector<char> isHalo(rings.nodes.size());
    for (std::size_t i = 0; i < isHalo.size(); ++i)
    {
        isHalo[i] = rings.nodes[i].owner != rings.rank;
    }
    const std::vector<int> newNode = orderByClass(isHalo, 2);
    mesh.nNodes = static_cast<int>(isHalo.size());
    mesh.nOwned = static_cast<int>(std::count(isHalo.begin(), isHalo.end(), 0));
    mesh.nodeOwner.resize(mesh.nNodes);
    mesh.originalNode.resize(mesh.nNodes);
    mesh.x.resize(rings.x.size());
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        mesh.nodeOwner[newNode[i]] = rings.nodes[i].owner;
        mesh.originalNode[newNode[i]] = rings.nodes[i].key;
        std::copy_n(rings.x.begin() + static_cast<std::ptrdiff_t>(i) * mesh.dim, mesh.dim,
            mesh.x.begin() + static_cast<std::ptrdiff_t>(newNode[i]) * mesh.dim);
    }
    return newNode;
}

/// Whose sums an element counts in: the rank's that brought it, where that owns one of its nodes; else (a rank may have brought few cells and own none of their
/// nodes) the lowest that does. Whoever owns no node of an element lacks what is found for elements of owned nodes alone, fluxes of the phase field for one.
int ownerOfElement(const ElementRings& rings, std::size_t element)
{
    const int* nodes = &rings.elementNodes[element * (rings.dim + 1)];
    const int home = rings.elements[element].home;
    int lowest = rings.nodes[nodes[0]].owner;
    for (int a = 0; a <= rings.dim; ++a)
    {
        const int owner = rings.nodes[nodes[a]].owner;
        if (owner == home) return home;
        lowest = std::min(lowest, owner);
    }
    return lowest;
}

/// facePatch: reordered like the elements.
std::vector<int> placeElements(const ElementRings& rings, const std::vector<int>& newNode, SimplexMesh& mesh, std::vector<int>& facePatch)
{
    const int n = mesh.dim + 1;
    const std::vector<char> ring = ringOfElements(rings);
    const std::vector<int> newElement = orderByClass(ring, 3);
    mesh.nElements = static_cast<int>(ring.size());
    mesh.nInnerElements = static_cast<int>(std::count(ring.begin(), ring.end(), 0));
    mesh.elements.resize(rings.elementNodes.size());
    mesh.isOwnedElement.resize(mesh.nElements);
    facePatch.resize(rings.facePatch.size());
    for (int e = 0; e < mesh.nElements; ++e)
    {
        mesh.isOwnedElement[newElement[e]] = ownerOfElement(rings, e) == rings.rank;
        for (int a = 0; a < n; ++a)
        {
            const std::size_t from = static_cast<std::size_t>(e) * n + a, to = static_cast<std::size_t>(newElement[e]) * n + a;
            mesh.elements[to] = newNode[rings.elementNodes[from]];
            facePatch[to] = rings.facePatch[from];
        }
    }
    return newElement;
}

/// globalNode of all nodes: owned ones from a running count, the others from their owners.
void numberNodes(SimplexMesh& mesh, MPI_Comm comm, int size)
{
    std::int64_t nOwned = mesh.nOwned, end = 0;
    MPI_Scan(&nOwned, &end, 1, MPI_INT64_T, MPI_SUM, comm);
    MPI_Allreduce(&nOwned, &mesh.nGlobal, 1, MPI_INT64_T, MPI_SUM, comm);
    mesh.firstGlobal = end - nOwned;

    KeyTable owned;
    owned.append({mesh.originalNode.begin(), mesh.originalNode.begin() + mesh.nOwned}, 0);
    std::vector<std::vector<std::int64_t>> questions(size);
    for (int i = mesh.nOwned; i < mesh.nNodes; ++i)
    {
        questions[mesh.nodeOwner[i]].push_back(mesh.originalNode[i]);
    }
    std::vector<std::vector<std::int64_t>> numbers = exchangeLists(questions, comm);
    for (std::vector<std::int64_t>& list : numbers)
    {
        for (std::int64_t& entry : list)
        {
            entry = mesh.firstGlobal + owned.find(entry);
        }
    }
    numbers = exchangeLists(numbers, comm);

    mesh.globalNode.resize(mesh.nNodes);
    std::vector<int> next(size, 0);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const int owner = mesh.nodeOwner[i];
        mesh.globalNode[i] = i < mesh.nOwned ? mesh.firstGlobal + i : numbers[owner][next[owner]++];
    }
}

/// Two elements with the same boundary face close a fold of the boundary between them: the face lies inside.
void removeFoldedFaces(const SimplexMesh& mesh, std::vector<int>& facePatch)
{
    const int n = mesh.dim + 1;
    std::vector<std::pair<std::array<int, 3>, std::size_t>> faces;
    for (std::size_t k = 0; k < facePatch.size(); ++k)
    {
        if (facePatch[k] >= 0)
        {
            const int* face = outwardFace(mesh.dim, static_cast<int>(k % n));
            std::array<int, 3> nodes{-1, -1, -1};
            for (int b = 0; b < mesh.dim; ++b)
            {
                nodes[b] = mesh.elements[k / n * n + face[b]];
            }
            std::sort(nodes.begin(), nodes.end());
            faces.emplace_back(nodes, k);
        }
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 1; i < faces.size(); ++i)
    {
        if (faces[i].first == faces[i - 1].first)
        {
            facePatch[faces[i].second] = facePatch[faces[i - 1].second] = -1;
        }
    }
}

void addPatches(const LocalSimplices& local, const std::vector<int>& facePatch, SimplexMesh& mesh)
{
    const int n = mesh.dim + 1;
    mesh.patches.resize(local.patchNames.size());
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    {
        mesh.patches[p].name = local.patchNames[p];
        mesh.patches[p].type = local.patchTypes[p];
    }
    for (std::size_t k = 0; k < facePatch.size(); ++k)
    {
        if (facePatch[k] < 0)
        {
            continue;
        }
        const int element = static_cast<int>(k / n);
        const int* face = outwardFace(mesh.dim, static_cast<int>(k % n));
        MeshPatch& patch = mesh.patches[facePatch[k]];
        for (int b = 0; b < mesh.dim; ++b)
        {
            patch.faceNodes.push_back(mesh.elements[static_cast<std::size_t>(element) * n + face[b]]);
        }
        patch.faceElement.push_back(element);
        patch.isOwnedFace.push_back(mesh.isOwnedElement[element]);
    }
}

} // namespace

DistributedSimplices distributeSimplices(const LocalSimplices& local, MPI_Comm comm)
{
    ElementRings rings(local, comm);
    rings.addFirstRing();
    rings.addSecondRing();

    DistributedSimplices result;
    SimplexMesh& mesh = result.mesh;
    mesh.dim = local.dim;
    std::vector<int> facePatch;
    result.nodeOfInput = placeNodes(rings, mesh);
    result.elementOfInput = placeElements(rings, result.nodeOfInput, mesh, facePatch);
    result.nodeOfInput.resize(local.nodeKey.size());
    result.elementOfInput.resize(local.elements.size() / (local.dim + 1));

    numberNodes(mesh, comm, rings.size);
    const std::vector<std::int64_t> ownKeys(mesh.originalNode.begin(), mesh.originalNode.begin() + mesh.nOwned);
    compactKeys(ownKeys, mesh.originalNode, comm);
    Halo(mesh, comm).update(mesh.x, mesh.dim); // the same bits on every rank, whatever was read
    removeFoldedFaces(mesh, facePatch);
    addPatches(local, facePatch, mesh);
    mesh.computeGeometry();
    return result;
}

} // namespace flotsam
