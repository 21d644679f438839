// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cover.hpp"

#include "geometry/coverBuilder.hpp"

#include <algorithm>

namespace flotsam
{

const CutPatchFace* patchFaceOf(const Cover* cover, int element, int corner)
{
    if (!cover || cover->patchFaces.empty()) return nullptr;
    const auto isBefore = [](const CutPatchFace& face, int e) { return face.element < e; };
    auto face = std::lower_bound(cover->patchFaces.begin(), cover->patchFaces.end(), element, isBefore);
    while (face != cover->patchFaces.end() && face->element == element && face->corner != corner) ++face;
    return face != cover->patchFaces.end() && face->element == element ? &*face : nullptr;
}

Cover cutMesh(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<Solid>& solids)
{
    return CoverBuilder(mesh, graph, halo).build(solids);
}

Cover cutMeshWithExactVolume(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, std::vector<Solid>& solids)
{
    return CoverBuilder(mesh, graph, halo).buildExactVolume(solids);
}

} // namespace flotsam
