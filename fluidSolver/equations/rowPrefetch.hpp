// SPDX-License-Identifier: GPL-3.0-or-later
/// Brings rows of the matrix into the second cache before elements add to them. A sweep over the elements comes back to a row, some 2 kB in 3D, after a whole layer of
/// the mesh: the row has left that cache then, and its lines lie in five arrays, too short for the processor to foresee them.
#pragma once

#include "algebra/flowSystem.hpp"
#include "core/simplexMesh.hpp"

#include <vector>

namespace flotsam
{

class RowPrefetch
{
public:
    /// Before a sweep over the elements below n.
    void start(const SimplexMesh& mesh, int n)
    {
        n_ = n;
        lastUse_.assign(mesh.nNodes, -kept);
    }

    /// Fetches the rows that the element `ahead` elements after e uses.
    void fetch(int e, const SimplexMesh& mesh, const NodeGraph& graph, const FlowSystem& system)
    {
        const int later = e + ahead, n = mesh.dim + 1;
        if (later >= n_) return;
        for (int a = 0; a < n; ++a)
        {
            const int i = mesh.elements[std::size_t(later)*n + a];
            const bool isCached = later - lastUse_[i] < kept;
            lastUse_[i] = later;
            if (!isCached && i < mesh.nOwned) fetchRow(graph.rowStart[i], graph.rowStart[i + 1], system);
        }
    }

private:
    static constexpr int ahead = 40;    // elements: the time that memory takes
    static constexpr int kept = 1000;   // elements whose rows the second cache surely holds

    // without the attribute gcc takes it for a function without effect and drops the call
    [[gnu::always_inline]] static void fetchRow(std::size_t begin, std::size_t end, const FlowSystem& system)
    {
        constexpr int line = 8, secondCache = 2;
        const auto fetchPart = [&](const std::vector<double>& values, std::size_t width) __attribute__((always_inline))
        {
            const double* last = &values[end*width - 1];
            for (const double* v = &values[begin*width]; v < last; v += line) __builtin_prefetch(v, 0, secondCache);
            __builtin_prefetch(last, 0, secondCache);
        };
        fetchPart(system.matrix.velocity, std::size_t(system.dim)*system.dim);
        fetchPart(system.matrix.gradient, system.dim);
        fetchPart(system.matrix.divergence, system.dim);
        fetchPart(system.matrix.pressure, 1);
        fetchPart(system.schur, 1);
    }

    int n_ = 0;
    std::vector<int> lastUse_;  // nNodes: last element that used the row
};

} // namespace flotsam
