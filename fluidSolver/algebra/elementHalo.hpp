// SPDX-License-Identifier: GPL-3.0-or-later
/// Exchange of values of elements between ranks, once a step at most.
#pragma once

#include "algebra/halo.hpp"
#include "core/nodeGraph.hpp"

namespace flotsam
{

/// To elements of which a rank owns no node (the second ring) from one that owns some: what is found for inner elements alone, from data that only they have, counts in
/// the faces between the rings, too.
class ElementHalo
{
public:
    /// Collective.
    ElementHalo(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo);

    /// Collective. Overwrites the entries of all but the inner elements. values: nElements*width, interleaved.
    void update(std::vector<double>& values, int width) const;

private:
    MPI_Comm comm_;
    std::vector<std::vector<int>> send_, receive_;  // per rank: local elements, in the same order on both sides
};

} // namespace flotsam
