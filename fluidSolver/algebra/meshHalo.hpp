// SPDX-License-Identifier: GPL-3.0-or-later
/// From simplices scattered over ranks to the distributed SimplexMesh: owners, two rings of halo elements, numbers.
#pragma once

#include "core/simplexMesh.hpp"

#include <mpi.h>

namespace flotsam
{

/// The simplices a rank brings: each simplex on exactly one rank, nodes repeated on every rank that uses them.
struct LocalSimplices
{
    int dim = 3;
    std::vector<std::int64_t> nodeKey;  ///< means the same node on every rank; not negative; every node is used by an element
    std::vector<double> x;              ///< nodes*dim [m]
    std::vector<int> elements;          ///< n*(dim+1) nodes, positive volume
    std::vector<int> facePatch;         ///< n*(dim+1): patch of the face opposite to node a, -1 for none;
                                        ///< a face that two elements share is taken off its patch
    std::vector<std::string> patchNames, patchTypes; ///< same on every rank
};

struct DistributedSimplices
{
    SimplexMesh mesh;               ///< complete with geometry; axes, planeOffset and thickness are the caller's
    std::vector<int> nodeOfInput;   ///< local node of each node brought
    std::vector<int> elementOfInput; ///< local element of each simplex brought
};

/// Collective. A node belongs to the lowest rank that brings it. Local order: owned nodes in the order brought, then the
/// halo; elements with an owned node (own ones in the order brought, then received ones), then the second ring, then own
/// elements that lie in neither ring (a rank keeps what it brings). originalNode: position of the key among all keys.
DistributedSimplices distributeSimplices(const LocalSimplices& local, MPI_Comm comm);

} // namespace flotsam
