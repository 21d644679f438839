// SPDX-License-Identifier: GPL-3.0-or-later
/// Sharp edges of structures that cut the mesh: boxes, ends of cylinders.
///
/// A node inside a structure at its edge belongs to elements over two faces. Water comes along one of them and leaves the edge, gas or water at rest lies over the other:
/// as at the edge of walls of the mesh (flowEdges.cpp) the velocity has no single value there, and the elements over a face see of the node's velocity the part
/// along this face.
#pragma once

#include "algebra/halo.hpp"
#include "equations/facetGroups.hpp"
#include "geometry/solid.hpp"

#include <algorithm>
#include <vector>

namespace flotsam
{

/// Element over a wall that ends in a re-entrant edge: of a velocity u at corner a it sees u - Q_a u, along the wall.
struct EdgeElement
{
    int element;
    double across[4][9] = {};   ///< Q, dim*dim: n n of the wall by the element's share over it, at the corners on the edge; elsewhere zero

    /// The first of n corners that is on the edge.
    int cornerOfEdge(int n) const
    {
        int corner = 0;
        while (corner + 1 < n && std::all_of(across[corner], across[corner] + 9, [](double value) { return value == 0; })) ++corner;
        return corner;
    }
};

/// The edges of solids whose motion is given, from the facets of the cut.
class SolidEdges
{
public:
    /// Collective. groups: of all inner elements, ordered by solids.
    template<int D>
    void find(const std::vector<FacetGroup<D>>& groups, const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<Solid>& solids);

    /// Whether there may be any, the same on all ranks.
    bool isAny() const { return isAny_; }
    struct Element : EdgeElement
    {
        int solid;
        double normal[3];   ///< of the face, out of the fluid
    };
    /// Of the inner elements those over one face alone, ordered by solids.
    const std::vector<Element>& elements() const { return elements_; }

private:
    bool isAny_ = false;
    std::vector<Element> elements_;
    // work of find()
    std::vector<char> has_;             // of solids
    std::vector<int> faceOfGroup_;      // a bit; 0: none
    std::vector<int> facesAt_;          // nNodes: bits of the faces around a node inside their solid
    std::vector<int> groupsOf_;         // nElements: number of facet groups
};

} // namespace flotsam
