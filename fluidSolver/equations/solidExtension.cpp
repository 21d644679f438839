// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/solidExtension.hpp"

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

} // namespace flotsam
