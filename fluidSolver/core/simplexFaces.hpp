// SPDX-License-Identifier: GPL-3.0-or-later
/// Local numbering of the faces of a simplex: face a is opposite to node a.
#pragma once

namespace flotsam
{

/// Local nodes of face a (dim of them), in the order whose right-hand normal points out of a simplex of positive
/// volume. 2D: the normal of an edge (p, q) is (dy, -dx), that is, the element lies on the left.
inline const int* outwardFace(int dim, int a)
{
    static constexpr int triangle[3][2] = {{1, 2}, {2, 0}, {0, 1}};
    static constexpr int tetrahedron[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    return dim == 2 ? triangle[a] : tetrahedron[a];
}

} // namespace flotsam
