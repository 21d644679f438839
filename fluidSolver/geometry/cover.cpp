// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cover.hpp"

#include "geometry/coverBuilder.hpp"

namespace flotsam
{

Cover cutMesh(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<Solid>& solids)
{
    return CoverBuilder(mesh, graph, halo).build(solids);
}

Cover cutMeshWithExactVolume(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, std::vector<Solid>& solids)
{
    return CoverBuilder(mesh, graph, halo).buildExactVolume(solids);
}

} // namespace flotsam
