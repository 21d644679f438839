// SPDX-License-Identifier: GPL-3.0-or-later
/// Division of a simplex by the zero of a linear function into simplices and facets, and their moments; private to geometry.
#pragma once

#include "geometry/cutSimplex.hpp"

namespace flotsam
{

/// A point of a simplex by its shape functions.
template <int dim>
struct SimplexPoint { double n[dim + 1]; };

/// The part of a simplex where the function is positive, and the zero in it.
template <int dim>
struct SimplexDivision
{
    struct Part { SimplexPoint<dim> corner[dim + 1]; double share; };  // share of the simplex's volume
    struct Facet { SimplexPoint<dim> corner[dim]; };

    Part parts[dim];
    int nParts = 0;
    Facet facets[dim - 1];
    int nFacets = 0;
};

/// values: dim+1, at least one positive and one not.
template <int dim>
SimplexDivision<dim> divideSimplex(const double* values);

/// Adds the moments of a part of a simplex of volume `elementVolume`. Negligible parts are dropped.
template <int dim>
void addPart(SimplexMoments<dim>& moments, const SimplexPoint<dim>* corners, double partVolume, double elementVolume);

/// False: of floating point size only.
template <int dim>
bool setFacet(SimplexFacet<dim>& facet, const SimplexPoint<dim>* corners, double elementVolume, const double* vertices);

/// Unit vector against the gradient of the function with these nodal values.
template <int dim>
void setDescent(double* direction, const double* values, const double* gradN);

} // namespace flotsam
