// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/surfaceRings.hpp"

#include <algorithm>

namespace flotsam
{

void findSurfaceRings(const SimplexMesh& mesh, const Halo& halo, NodalData& nodal)
{
    std::vector<int>& ring = nodal.surfaceRing;
    ring.assign(mesh.nNodes, NodalData::Far);
    const int n = mesh.dim + 1;
    const auto raise = [&](NodalData::SurfaceRing value, const auto& isChosen)
    {
        for (int e = 0; e < mesh.nElements; ++e)
        {
            const int* nodes = &mesh.elements[std::size_t(e)*n];
            if (!isChosen(nodes)) continue;
            for (int a = 0; a < n; ++a) ring[nodes[a]] = std::max(ring[nodes[a]], int(value));
        }
        halo.update(ring, 1);
    };
    raise(NodalData::At, [&](const int* nodes) { return variesAtNodes(nodes, n, nodal); });
    raise(NodalData::Beside, [&](const int* nodes) { return isCarried(nodes, n, nodal); });
}

} // namespace flotsam
