// SPDX-License-Identifier: GPL-3.0-or-later
/// Solids that the mesh is too coarse for.
#pragma once

#include "geometry/cover.hpp"

namespace flotsam
{

/// Nodes in a solid whose elements have fluid on two of its sides: they share the node's velocity and pressure, so that fluid passes through the solid. A plate has
/// none from two elements of thickness on.
struct SharedNodes
{
    long count = 0;
    std::array<double, 3> middle{}; ///< mean of their places [m]
};

/// Per solid, the same on all ranks. Collective.
std::vector<SharedNodes> findSharedNodes(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover, std::size_t nSolids);

} // namespace flotsam
