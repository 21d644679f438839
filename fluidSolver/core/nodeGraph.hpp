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
    std::vector<std::int16_t> offset;   ///< nInnerElements*(dim+1)^2: place of corner b in the row of corner a, -1 if a is not owned

    // all local nodes
    std::vector<int> nodeElementStart, nodeElement; ///< elements of each local node (complete for owned and first-ring nodes)
    std::vector<InteriorFace> faces;                ///< faces shared by two local elements

    explicit NodeGraph(const SimplexMesh& mesh);

    /// Position in `column` of offset k = (e*(dim+1) + a)*(dim+1) + b, i the node of corner a; -1 if i is not owned.
    int slot(int i, std::size_t k) const { return offset[k] < 0 ? -1 : rowStart[i] + offset[k]; }

    /// slot() of all pairs of the n corners of element e.
    template<int n> void slots(int e, const int* nodes, int nOwned, int* slot) const
    {
        const std::int16_t* at = &offset[std::size_t(e)*n*n];
        for (int a = 0; a < n; ++a)
        {
            const int start = nodes[a] < nOwned ? rowStart[nodes[a]] : 0;
            for (int b = 0; b < n; ++b) slot[a*n + b] = start + at[a*n + b];   // not owned: -1
        }
    }

    /// Position in `column` of the neighbour j of owned node i, -1 if they share no element.
    int find(int i, int j) const;
};

} // namespace flotsam
