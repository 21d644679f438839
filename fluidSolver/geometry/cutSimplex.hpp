// SPDX-License-Identifier: GPL-3.0-or-later
/// Cutting one simplex (triangle: dim 2, tetrahedron: dim 3) by the zero of a linear signed distance.
/// The fluid is where the distance is positive. Pure kernel: no mesh, no solids, no allocation.
#pragma once

namespace flotsam
{

/// Parts of an element smaller than this, relative to the element, do not exist.
constexpr double negligiblePart = 1e-14;

template <int dim>
struct SimplexFacet
{
    double area;                    ///< [m^(dim-1)]
    double weight[dim];             ///< of the quadrature points (exact for degree 2), sum = area
    double shape[dim][dim + 1];     ///< shape functions of the simplex at the points
};

template <int dim>
struct SimplexCut
{
    double volume;                              ///< of the fluid part [m^dim]
    double first[dim + 1];                      ///< int N_a over the fluid part
    double second[(dim + 1) * (dim + 1)];       ///< int N_a N_b over the fluid part
    double normal[dim];                         ///< unit, out of the fluid: -grad(distance)/|grad(distance)|
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

} // namespace flotsam
