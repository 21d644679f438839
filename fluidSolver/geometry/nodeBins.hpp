// SPDX-License-Identifier: GPL-3.0-or-later
/// Finds the nodes near a box without walking through the mesh. Nodes of similar reach (length of their elements) share a
/// grid of bins, so that a box in a refined region is not enlarged by the far coarse elements.
#pragma once

#include "core/simplexMesh.hpp"
#include "geometry/shape.hpp"

#include <algorithm>

namespace flotsam
{

class NodeBins
{
public:
    /// reach: nNodes, how far from a box a node still counts as near [m], > 0.
    NodeBins(const SimplexMesh& mesh, std::vector<double> reach);

    double reach(int node) const { return reach_[node]; }

    /// Calls visit(node, position in space) for every node within its reach of the box (and for some outside).
    template <class Visit>
    void forEachNear(const std::array<Vec3, 2>& box, Visit visit) const
    {
        for (const Level& level : levels_) forEachOfLevel(level, box, visit);
    }

private:
    struct Level
    {
        double reach = 0;               // largest of its nodes
        Vec3 lower, upper, cell;
        std::array<int, 3> n{1, 1, 1};
        std::vector<int> start, node;   // per bin, x fastest: bins of a row are contiguous
        std::vector<Vec3> x;            // beside `node`
    };

    static Level makeLevel(const SimplexMesh& mesh, const std::vector<int>& nodes, double reach);

    static int binOf(const Level& level, int d, double x)
    {
        return std::clamp(static_cast<int>((x - level.lower[d]) / level.cell[d]), 0, level.n[d] - 1);
    }

    template <class Visit>
    static void forEachOfLevel(const Level& level, const std::array<Vec3, 2>& box, Visit& visit)
    {
        const Vec3 a = (box[0].array() - level.reach).matrix().cwiseMax(level.lower);
        const Vec3 b = (box[1].array() + level.reach).matrix().cwiseMin(level.upper);
        if ((a.array() > b.array()).any()) return;
        int first[3], last[3];
        for (int d = 0; d < 3; ++d)
        {
            first[d] = binOf(level, d, a[d]);
            last[d] = binOf(level, d, b[d]);
        }
        for (int k = first[2]; k <= last[2]; ++k)
            for (int j = first[1]; j <= last[1]; ++j)
            {
                const int row = (k * level.n[1] + j) * level.n[0];
                for (int i = level.start[row + first[0]]; i < level.start[row + last[0] + 1]; ++i)
                    if ((level.x[i].array() >= a.array()).all() && (level.x[i].array() <= b.array()).all())
                        visit(level.node[i], level.x[i]);
            }
    }

    std::vector<double> reach_;
    std::vector<Level> levels_;
};

} // namespace flotsam
