// SPDX-License-Identifier: GPL-3.0-or-later
/// Patches of OpenFOAM's type `patch` that let nothing through and stop bodies are walls: of what lies flat on them the mesh's geometry keeps a film of fluid (WallFilm) by the type alone.
/// Mirror planes are none: bodies may be cut by them.
#pragma once

#include "core/boundary.hpp"
#include "core/simplexMesh.hpp"

#include <vector>

namespace flotsam
{

/// To be called before anything is made of the mesh.
inline void takeBodyWalls(SimplexMesh& mesh, const std::vector<BoundaryPatch>& patches)
{
    for (const BoundaryPatch& patch : patches)
    {
        std::string& type = mesh.patches[patch.meshPatch].type;
        if (patch.stopsBodies && (patch.isWall() || patch.isNoSlipWall) && type == "patch") type = "wall";
    }
}

} // namespace flotsam
