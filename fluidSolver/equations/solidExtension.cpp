// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/solidExtension.hpp"

#include <array>
#include <map>

namespace flotsam
{

void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover,
    std::vector<double>& alpha, int nRings)
{
    extendIntoSolids(mesh, graph, halo, cover.isActiveNode, alpha, nRings);
}

void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown,
    std::vector<double>& values, int nRings)
{
    std::vector<int> inside;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        if (!isKnown[i])
        {
            inside.push_back(i);
        }
    }
    if (!halo.any(!inside.empty()))
    {
        return;
    }
    // {value, 1 if known}: one exchange a ring keeps both right on the copies
    std::vector<double> state(2*std::size_t(mesh.nNodes));
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        state[2*std::size_t(i)] = values[i];
        state[2*std::size_t(i) + 1] = isKnown[i] ? 1 : 0;
    }
    halo.update(state, 2);  // a second-ring copy may not see the fluid element that makes it active

    std::vector<std::pair<int, double>> found;
    for (int ring = 0; ring < nRings; ++ring)
    {
        found.clear();
        for (int i : inside)
        {
            double sum = 0, count = 0;
            for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
            {
                const double* neighbour = &state[2*std::size_t(graph.column[k])];
                sum += neighbour[1]*neighbour[0];
                count += neighbour[1];
            }
            if (state[2*std::size_t(i) + 1] == 0 && count > 0)
            {
                found.emplace_back(i, sum/count);
            }
        }
        for (const auto& [i, value] : found)
        {
            state[2*std::size_t(i)] = value;
            state[2*std::size_t(i) + 1] = 1;
        }
        halo.update(state, 2);
    }
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        if (state[2*std::size_t(i) + 1] != 0)
        {
            values[i] = state[2*std::size_t(i)];
        }
    }
}

void takeFromFluidBeside(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<char>& isWanted,
    std::vector<double>& values)
{
    const int n = mesh.dim + 1;
    std::map<int, std::array<double, 2>> found; // sums of values and of weights
    for (const CutElement& cut : cover.cuts)
    {
        const int* nodes = &mesh.elements[std::size_t(cut.element)*n];
        const auto isFluid = [&](int a) { return cover.distance[nodes[a]] > 0; };
        for (int a = 0; a < n; ++a)
        {
            if (nodes[a] >= mesh.nOwned || isFluid(a) || !isWanted[nodes[a]]) continue;
            std::array<double, 2>& sums = found[nodes[a]];
            for (int b = 0; b < n; ++b)
            {
                if (!isFluid(b)) continue;
                sums[0] += cut.first[b]*values[nodes[b]];
                sums[1] += cut.first[b];
            }
        }
    }
    if (!halo.any(!found.empty())) return;
    for (const auto& [node, sums] : found)
        if (sums[1] > 0) values[node] = sums[0]/sums[1];
    halo.update(values, 1);
}

} // namespace flotsam
