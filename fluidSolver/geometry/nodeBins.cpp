// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/nodeBins.hpp"

#include <cmath>

namespace flotsam
{
namespace
{

Vec3 positionOf(const SimplexMesh& mesh, int node)
{
    const auto x = mesh.spacePoint(node);
    return {x[0], x[1], x[2]};
}

} // namespace

NodeBins::NodeBins(const SimplexMesh& mesh, std::vector<double> reach) : reach_(std::move(reach))
{
    if (mesh.nNodes == 0) return;
    const double least = *std::min_element(reach_.begin(), reach_.end());
    std::vector<std::vector<int>> classes; // factor 2 of the reach
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const std::size_t c = static_cast<std::size_t>(std::log2(reach_[i] / least));
        if (c >= classes.size()) classes.resize(c + 1);
        classes[c].push_back(i);
    }
    for (const std::vector<int>& nodes : classes)
    {
        if (nodes.empty()) continue;
        double largest = 0;
        for (int i : nodes) largest = std::max(largest, reach_[i]);
        levels_.push_back(makeLevel(mesh, nodes, largest));
    }
}

NodeBins::Level NodeBins::makeLevel(const SimplexMesh& mesh, const std::vector<int>& nodes, double reach)
{
    Level level;
    level.reach = reach;
    level.lower = Vec3::Constant(1e300);
    level.upper = Vec3::Constant(-1e300);
    for (int i : nodes)
    {
        const Vec3 x = positionOf(mesh, i);
        level.lower = level.lower.cwiseMin(x);
        level.upper = level.upper.cwiseMax(x);
    }
    // bins about as large as an element; never many more bins than nodes
    const double bound = std::cbrt(2.0 * nodes.size()) + 1;
    double cell = reach;
    const Vec3 extent = level.upper - level.lower;
    auto binsAt = [&](double size) { return (extent.array() / size + 1).prod(); };
    while (binsAt(cell) > bound * bound * bound) cell *= 1.26;
    for (int d = 0; d < 3; ++d)
    {
        level.n[d] = static_cast<int>(extent[d] / cell) + 1;
        level.cell[d] = extent[d] > 0 ? extent[d] / level.n[d] : 1;
    }

    const int nBins = level.n[0] * level.n[1] * level.n[2];
    auto bin = [&](const Vec3& x)
    { return (binOf(level, 2, x[2]) * level.n[1] + binOf(level, 1, x[1])) * level.n[0] + binOf(level, 0, x[0]); };
    level.start.assign(nBins + 1, 0);
    for (int i : nodes) ++level.start[bin(positionOf(mesh, i)) + 1];
    for (int b = 0; b < nBins; ++b) level.start[b + 1] += level.start[b];
    level.node.resize(nodes.size());
    level.x.resize(nodes.size());
    std::vector<int> next(level.start.begin(), level.start.end() - 1);
    for (int i : nodes)
    {
        const Vec3 x = positionOf(mesh, i);
        const int position = next[bin(x)]++;
        level.node[position] = i;
        level.x[position] = x;
    }
    return level;
}

} // namespace flotsam
