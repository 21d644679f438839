// SPDX-License-Identifier: GPL-3.0-or-later
/// Values of alpha inside solids, for the nodes that come out of a body later and for gradients beside its surface.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

/// Memory of the search, to be kept from one to the next.
struct RingWork
{
    std::vector<double> state, means;
    std::vector<int> left, found;
};

/// Gives the other nodes within `nRings` rings of known ones (solids: of active nodes) the mean of their neighbours nearer to the fluid, ring
/// by ring; deeper nodes keep what they have. alpha: nNodes, halo up to date before and after. Collective; the result does
/// not depend on the number of ranks.
void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover,
    std::vector<double>& alpha, RingWork& work, int nRings = 3);
void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const Cover& cover,
    std::vector<double>& alpha, int nRings = 3);
void extendIntoSolids(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown,
    std::vector<double>& values, int nRings = 3);

/// Likewise ring by ring until all wanted nodes (nNodes) have values, through nodes that are not known, whoever wants them. values: nNodes*width.
void extendTo(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<char>& isKnown, const std::vector<int>& isWanted,
    std::vector<double>& values, int width);

/// Gives wanted nodes (nNodes) inside solids the mean of `values` over the fluid nodes of the cut elements around, weighted by their parts of the fluid; where
/// there is none they keep theirs. values: nNodes, halo up to date before and after. Collective.
void takeFromFluidBeside(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<char>& isWanted,
    std::vector<double>& values);

} // namespace flotsam
