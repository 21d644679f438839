// SPDX-License-Identifier: GPL-3.0-or-later
/// Geometry of the faces of patches, from the elements behind them.
#pragma once

#include "core/simplexMesh.hpp"

#include <algorithm>

namespace flotsam
{

/// Corner of the element behind face f that is not on the face.
inline int oppositeCorner(const SimplexMesh& mesh, const MeshPatch& patch, std::size_t f)
{
    const int* face = &patch.faceNodes[f*mesh.dim];
    const int* nodes = &mesh.elements[std::size_t(patch.faceElement[f])*(mesh.dim + 1)];
    int corner = 0;
    while (std::find(face, face + mesh.dim, nodes[corner]) != face + mesh.dim) ++corner;
    return corner;
}

/// Area vector of face f, out of the domain [m^(dim-1)]: -dim V grad N of the opposite corner. v: dim values.
inline void outwardVector(const SimplexMesh& mesh, const MeshPatch& patch, std::size_t f, double* v)
{
    const std::size_t e = patch.faceElement[f];
    const double* g = &mesh.gradN[(e*(mesh.dim + 1) + oppositeCorner(mesh, patch, f))*mesh.dim];
    for (int d = 0; d < mesh.dim; ++d) v[d] = -mesh.dim*mesh.volume[e]*g[d];
}

} // namespace flotsam
