// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/nodeGraph.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

namespace flotsam
{
namespace
{

void listElementsOfNodes(const SimplexMesh& mesh, std::vector<int>& start, std::vector<int>& element)
{
    const int nodesPerElement = mesh.dim + 1;
    start.assign(mesh.nNodes + 1, 0);
    for (const int node : mesh.elements)
    {
        ++start[node + 1];
    }
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        start[i + 1] += start[i];
    }
    element.resize(mesh.elements.size());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (std::size_t k = 0; k < mesh.elements.size(); ++k)
    {
        element[next[mesh.elements[k]]++] = static_cast<int>(k / nodesPerElement);
    }
}

void listNeighbours(const SimplexMesh& mesh, NodeGraph& graph)
{
    const int nodesPerElement = mesh.dim + 1;
    std::vector<int> lastRow(mesh.nNodes, -1);
    graph.rowStart.assign(1, 0);
    graph.rowStart.reserve(mesh.nOwned + 1);
    graph.diagonal.resize(mesh.nOwned);
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const std::size_t begin = graph.column.size();
        for (int k = graph.nodeElementStart[i]; k < graph.nodeElementStart[i + 1]; ++k)
        {
            const int* nodes = &mesh.elements[static_cast<std::size_t>(graph.nodeElement[k]) * nodesPerElement];
            for (int a = 0; a < nodesPerElement; ++a)
            {
                if (lastRow[nodes[a]] != i)
                {
                    lastRow[nodes[a]] = i;
                    graph.column.push_back(nodes[a]);
                }
            }
        }
        const auto first = graph.column.begin() + begin;
        std::sort(first, graph.column.end());
        graph.diagonal[i] = static_cast<int>(std::lower_bound(first, graph.column.end(), i) - graph.column.begin());
        graph.rowStart.push_back(static_cast<int>(graph.column.size()));
    }
}

void listOffsets(const SimplexMesh& mesh, NodeGraph& graph)
{
    const int n = mesh.dim + 1;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (graph.rowStart[i + 1] - graph.rowStart[i] > std::numeric_limits<std::int16_t>::max())
        {
            throw std::runtime_error("a mesh point has more neighbours than fit into 16 bits");
        }
    }
    graph.offset.assign(static_cast<std::size_t>(mesh.nInnerElements) * n * n, -1);
    for (int e = 0; e < mesh.nInnerElements; ++e)
    {
        const int* nodes = &mesh.elements[static_cast<std::size_t>(e) * n];
        std::int16_t* offset = &graph.offset[static_cast<std::size_t>(e) * n * n];
        for (int a = 0; a < n; ++a)
        {
            if (nodes[a] >= mesh.nOwned)
            {
                continue;
            }
            const auto first = graph.column.begin() + graph.rowStart[nodes[a]];
            const auto last = graph.column.begin() + graph.rowStart[nodes[a] + 1];
            for (int b = 0; b < n; ++b)
            {
                offset[a * n + b] = static_cast<std::int16_t>(std::lower_bound(first, last, nodes[b]) - first);
            }
        }
    }
}

/// One side of a face: its nodes ascending (the lowest one is the bucket it lies in).
struct HalfFace
{
    int second, third; // third: -1 in 2D
    int element, opposite;
};

HalfFace makeHalfFace(const SimplexMesh& mesh, int element, int a, int& lowest)
{
    const int n = mesh.dim + 1;
    const int* nodes = &mesh.elements[static_cast<std::size_t>(element) * n];
    std::array<int, 3> key{-1, -1, -1};
    for (int b = 0, k = 0; b < n; ++b)
    {
        if (b != a)
        {
            key[k++] = nodes[b];
        }
    }
    // a sorting network: std::sort of three entries costs more than the rest of this function
    if (key[1] < key[0])
    {
        std::swap(key[0], key[1]);
    }
    if (mesh.dim == 3)
    {
        if (key[2] < key[1])
        {
            std::swap(key[1], key[2]);
        }
        if (key[1] < key[0])
        {
            std::swap(key[0], key[1]);
        }
    }
    lowest = key[0];
    return {key[1], key[2], element, nodes[a]};
}

/// Half faces in buckets of their lowest node: cheaper than sorting all of them.
void bucketHalfFaces(const SimplexMesh& mesh, std::vector<int>& start, std::vector<HalfFace>& halfFaces)
{
    const int n = mesh.dim + 1;
    int lowest = 0;
    start.assign(mesh.nNodes + 1, 0);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        for (int a = 0; a < n; ++a)
        {
            makeHalfFace(mesh, e, a, lowest);
            ++start[lowest + 1];
        }
    }
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        start[i + 1] += start[i];
    }
    halfFaces.resize(static_cast<std::size_t>(mesh.nElements) * n);
    std::vector<int> next(start.begin(), start.end() - 1);
    for (int e = 0; e < mesh.nElements; ++e)
    {
        for (int a = 0; a < n; ++a)
        {
            const HalfFace half = makeHalfFace(mesh, e, a, lowest);
            halfFaces[next[lowest]++] = half;
        }
    }
}

void listFaces(const SimplexMesh& mesh, std::vector<InteriorFace>& faces)
{
    std::vector<int> start;
    std::vector<HalfFace> halfFaces;
    bucketHalfFaces(mesh, start, halfFaces);
    const auto before = [](const HalfFace& p, const HalfFace& q)
    {
        return p.second != q.second ? p.second < q.second : p.third != q.third ? p.third < q.third : p.element < q.element;
    };
    faces.clear();
    faces.reserve(halfFaces.size() / 2);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        std::sort(halfFaces.begin() + start[i], halfFaces.begin() + start[i + 1], before);
        for (int k = start[i]; k + 1 < start[i + 1]; ++k)
        {
            const HalfFace& p = halfFaces[k];
            const HalfFace& q = halfFaces[k + 1];
            if (p.second == q.second && p.third == q.third)
            {
                faces.push_back({{p.element, q.element}, {p.opposite, q.opposite}});
                ++k;
            }
        }
    }
}

} // namespace

NodeGraph::NodeGraph(const SimplexMesh& mesh)
{
    listElementsOfNodes(mesh, nodeElementStart, nodeElement);
    listNeighbours(mesh, *this);
    listOffsets(mesh, *this);
    listFaces(mesh, faces);
}

int NodeGraph::find(int i, int j) const
{
    const auto begin = column.begin() + rowStart[i], end = column.begin() + rowStart[i + 1];
    const auto at = std::lower_bound(begin, end, j);
    return at != end && *at == j ? static_cast<int>(at - column.begin()) : -1;
}

} // namespace flotsam
