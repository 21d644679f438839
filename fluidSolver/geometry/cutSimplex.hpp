// SPDX-License-Identifier: GPL-3.0-or-later
/// Cutting one simplex (triangle: dim 2, tetrahedron: dim 3) by the zero of a linear signed distance, or by several at an edge or corner.
/// The fluid is where a distance is positive. Pure kernel: no mesh, no solids.
#pragma once

#include <vector>

namespace flotsam
{

/// Parts of an element smaller than this, relative to the element, do not exist.
constexpr double negligiblePart = 1e-14;

/// Weight of a facet's corner at the point of quadrature beside it; the other corners share the rest. Two Gauss points (edge), three inside (triangle), degree 2.
template <int dim>
constexpr double ownCornerWeight = dim == 2 ? 0.5 * (1 + 0.57735026918962576451) : 2.0 / 3;

template <int dim>
struct SimplexFacet
{
    double area;                    ///< [m^(dim-1)]
    double weight[dim];             ///< of the quadrature points (exact for degree 2), sum = area
    double shape[dim][dim + 1];     ///< shape functions of the simplex at the points
    double normal[dim];             ///< unit, out of the fluid: -grad(distance)/|grad(distance)|
    int solid;                      ///< position in the list of solids that were cut
};

template <int dim>
struct SimplexMoments
{
    double volume;                              ///< of the fluid part [m^dim]
    double first[dim + 1];                      ///< int N_a over the fluid part
    double second[(dim + 1) * (dim + 1)];       ///< int N_a N_b over the fluid part
};

template <int dim>
struct SimplexCut : SimplexMoments<dim>
{
    int nFacets;                                ///< 0 .. dim-1; 0 if the cut is of floating point size only
    SimplexFacet<dim> facets[dim - 1];
};

/// distance: dim+1 nodal values, none zero, both signs; volume of the simplex, positive;
/// vertices: (dim+1)*dim coordinates; gradN: (dim+1)*dim gradients of the shape functions.
template <int dim>
SimplexCut<dim> cutSimplex(const double* distance, double volume, const double* vertices, const double* gradN);

/// Share of the simplex that is fluid (0..1), and its derivative to a distance added to all nodes [1/m].
struct FluidFraction { double value, slope; };
template <int dim>
FluidFraction fluidFraction(const double* distance);

template <int dim>
struct EdgeCut : SimplexMoments<dim>
{
    std::vector<SimplexFacet<dim>> facets;

    EdgeCut() : SimplexMoments<dim>{} {}

    /// Its facets keep their memory.
    void clear()
    {
        static_cast<SimplexMoments<dim>&>(*this) = {};
        facets.clear();
    }
    EdgeCut& operator=(const SimplexCut<dim>& cut)
    {
        static_cast<SimplexMoments<dim>&>(*this) = cut;
        facets.assign(cut.facets, cut.facets + cut.nFacets);
        return *this;
    }
};

/// The solid is where all of several distances are negative: an edge or a corner between the faces of a body is not cut off, and may lie in
/// a simplex with all its nodes outside. distances: nFaces*(dim+1) nodal values, none zero.
template <int dim>
void cutSimplexAtEdge(const double* distances, int nFaces, double volume, const double* vertices, const double* gradN, EdgeCut<dim>& cut);

/// Likewise of several solids, each inside of all of its own faces: the fluid is outside of all of them. faceEnd: of each solid's faces in `distances`.
/// One facet a face, whatever its outline: the points have its moments to the second.
template <int dim>
void cutSimplexOfSolids(const double* distances, const std::vector<int>& faceEnd, double volume, const double* vertices, const double* gradN, EdgeCut<dim>& cut);

/// The same of solids that neither overlap nor touch in the simplex, cut one by one: cheaper, and the same to round-off. part: for the work.
template <int dim>
void cutSimplexOfApartSolids(const double* distances, const std::vector<int>& faceEnd, double volume, const double* vertices, const double* gradN, EdgeCut<dim>& sum, EdgeCut<dim>& part);

/// The simplex has a part inside of all faces: a piece of more than leastPart of it. Far cheaper than the cut, of which it tells nothing else.
template <int dim>
bool hasSolidPart(const double* distances, int nFaces, double leastPart = negligiblePart);

/// Adds the part of a simplex's face, the one opposite to `corner`, that lies in the solids (as above); normals out of the simplex.
template <int dim>
void addFacePart(int corner, const double* distances, const std::vector<int>& faceEnd, double volume, const double* vertices, const double* gradN, std::vector<SimplexFacet<dim>>& facets);

} // namespace flotsam
