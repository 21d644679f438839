// SPDX-License-Identifier: GPL-3.0-or-later
/// Properties every distributed SimplexMesh must have, and integrals that must not depend on the number of ranks.
#pragma once

#include "algebra/halo.hpp"
#include "core/nodeGraph.hpp"
#include "core/simplexMesh.hpp"

#include <array>
#include <string>

namespace flotsam
{

/// Numbers of a mesh that are the same on any number of ranks.
struct MeshSummary
{
    double volume = 0;              ///< of the owned elements [m^dim]
    long elements = 0, nodes = 0;
    long splitDigest = 0;           ///< order-independent hash of the elements' original node numbers
    std::vector<double> patchArea;  ///< of the owned faces [m^(dim-1)]
    std::vector<std::array<double, 3>> patchNormal; ///< integral of the outward normal over the owned faces
    std::vector<double> nodalPatchArea; ///< the same area, summed over owned nodes from all local faces
    double laplacian = 0;           ///< sum over owned rows of (L q)_i^2, q = sum x_d^2, L the P1 stiffness matrix
};

MeshSummary summarise(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

/// Empty when all holds, else what is wrong on this rank: numbering, rings, ownership, orientation of the faces.
/// Collective.
std::string checkDistribution(const SimplexMesh& mesh, const Halo& halo);

} // namespace flotsam
