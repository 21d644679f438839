// SPDX-License-Identifier: GPL-3.0-or-later
/// The physical cover: which part of every element of the mathematical mesh is fluid, at one time.
/// Marking (states, active nodes, ghost faces), integrating (moments, facet points) and assembling are kept apart;
/// this file is the result of the first two.
#pragma once

#include "algebra/halo.hpp"
#include "core/nodeGraph.hpp"
#include "geometry/solid.hpp"

namespace flotsam
{

enum class ElementState : unsigned char { Fluid, Cut, Solid };

/// Exact integrals of products of P1 functions over the fluid part of a cut element (linear distance).
struct CutElement
{
    int element;
    double volume;      ///< fluid volume [m^dim], > 0
    double first[4];    ///< int N_a
    double second[16];  ///< int N_a N_b at [a*(dim+1)+b]
    int facetStart, facetEnd;   ///< its facets
};

/// A planar piece of a solid's surface inside one element, with its quadrature points (exact for degree 2).
struct CutFacet
{
    int element;
    int solid;          ///< index in the list of solids: nearest at the facet's centroid
    double area;        ///< [m^(dim-1)]
    double normal[3];   ///< unit, OUT of the fluid (into the solid), in-plane components
    int nPoints;        ///< 2 (edge in 2D, Gauss) or 3 (triangle in 3D)
    double weight[3];   ///< sum = area
    double shape[3][4]; ///< shape functions of the element at the points
};

/// A piece of a moving solid's surface in an element that other solids share, where what they leave of it is not what it is alone: bodies that lie on each other or
/// on structures leave no element between. Pieces of the solid alone have their area, those that the cover has (CutFacet) the opposite: what is left of the sum is covered.
struct CoveredFacet
{
    int element;
    int solid;          ///< moving: free, prescribed
    int nPoints;        ///< as CutFacet, of equal weights
    double area[3];     ///< of each point: vector into the solid, in-plane components [m^(dim-1)]
    double shape[3][4]; ///< shape functions of the element at the points
};

/// Of an element with such pieces, or inside of one of their solids: what the moving solids cut out of it alone, less its solid part. Positive where they
/// overlap, negative where the cover leaves no fluid between them.
struct CoveredVolume
{
    int element;
    double second[16];  ///< int N_a N_b, as in CutElement
};

/// Face on the mesh's boundary, opposite to `corner`, of an element that is cut solid by solid.
struct CutPatchFace
{
    int element, corner;
    double second[16];  ///< int N_a N_b over its fluid part, over the area of the whole face; by the element's corners
};

/// Interior face of two active elements of which at least one is cut.
struct GhostFace { int face; double area; double normal[3]; /* from element[0] to element[1] */ };

/// Node of a wall; share: 1 where a solid touches it, 0 from a gap of one element on.
struct FilmNode { int node; double share; };

/// Distance at nodes that no solid is near to [m].
constexpr double farDistance = 1e30;

struct Cover
{
    /// nNodes: signed distance to the nearest solid [m], negative inside, never 0; farDistance far away. Of a solid that is cut by its faces
    /// (SolidPart::faceDistances) the largest of the distances from them.
    std::vector<double> distance;
    std::vector<int> nearestSolid;      ///< nNodes: index of that solid, -1 far away
    std::vector<ElementState> state;    ///< nElements
    std::vector<int> cutIndex;          ///< nElements: position in `cuts`, -1 if not cut
    std::vector<CutElement> cuts;
    std::vector<CutFacet> facets;       ///< a 3D quadrilateral cut is two facets
    std::vector<CutPatchFace> patchFaces;       ///< sorted by element; others are cut by the distances at their nodes
    std::vector<GhostFace> ghostFaces;
    std::vector<CoveredFacet> coveredFacets;    ///< of owned and of inner elements
    std::vector<CoveredVolume> coveredVolumes;  ///< likewise
    bool areSolidsClose = false;        ///< an element here has nodes or parts of a moving solid and of another one
    std::vector<char> isActiveNode;     ///< nNodes: some element with a fluid part holds the node
    std::vector<FilmNode> filmNodes;    ///< on walls, a loose solid less than an element over them: see WallFilm
    std::vector<double> solidVolume;    ///< per solid: sum over owned elements of the part it cuts out, all ranks [m^dim]
    std::vector<double> solidArea;      ///< per solid: wetted surface of the cut, all ranks [m^(dim-1)]
    const Cover *start = nullptr, *end = nullptr;   ///< of a mean (setMeanCover): what it is the mean of
    long nSharedElements = 0;           ///< cut elements with nodes in two different solids (gap below the mesh), owned, all ranks
};

/// Null: cut by the distances at its nodes, or not at all. cover null: no solids.
const CutPatchFace* patchFaceOf(const Cover* cover, int element, int corner);

/// Of element e [m^dim]. cover null: no solids.
inline double fluidVolume(const SimplexMesh& mesh, const Cover* cover, int e)
{
    if (!cover || cover->state[e] == ElementState::Fluid) return mesh.volume[e];
    return cover->state[e] == ElementState::Cut ? cover->cuts[cover->cutIndex[e]].volume : 0;
}

/// Cuts the mesh with the solids once, see CoverBuilder. Collective.
Cover cutMesh(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, const std::vector<Solid>& solids);

/// CoverBuilder::buildExactVolume once: one Newton step on the offsets of every free solid.
Cover cutMeshWithExactVolume(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, std::vector<Solid>& solids);

} // namespace flotsam
