// SPDX-License-Identifier: GPL-3.0-or-later
/// Adjacency of a SimplexMesh as plain compressed arrays, made once.
#pragma once

#include "core/simplexMesh.hpp"

namespace flotsam
{

/// An interior face between two local elements.
struct InteriorFace
{
    int element[2];
    int opposite[2]; ///< local NODE NUMBER (not the corner 0..dim) of element[s] that is not on the face
};

struct NodeGraph
{
    // rows of the owned nodes only: the columns are the nodes sharing an element, ascending, with the diagonal
    std::vector<int> rowStart;      ///< nOwned+1
    std::vector<int> column;        ///< local node numbers
    std::vector<int> diagonal;      ///< nOwned: position of (i,i) in column
    std::vector<int> slot;          ///< nInnerElements*(dim+1)^2: position of (a,b) in column, -1 if node a is not owned

    // all local nodes
    std::vector<int> nodeElementStart, nodeElement; ///< elements of each local node (complete for owned and first-ring nodes)
    std::vector<InteriorFace> faces;                ///< faces shared by two local elements

    explicit NodeGraph(const SimplexMesh& mesh);

    /// Position in `column` of the neighbour j of owned node i, -1 if they share no element.
    int find(int i, int j) const;
};

} // namespace flotsam
