// SPDX-License-Identifier: GPL-3.0-or-later
/// The linear cut: by one distance.
#include "geometry/simplexDivision.hpp"

#include <algorithm>

namespace flotsam
{

template <int dim>
SimplexCut<dim> cutSimplex(const double* distance, double volume, const double* vertices, const double* gradN)
{
    const SimplexDivision<dim> division = divideSimplex<dim>(distance);
    SimplexCut<dim> cut{};
    for (int k = 0; k < division.nParts; ++k) addPart<dim>(cut, division.parts[k].corner, division.parts[k].share * volume, volume);
    for (int k = 0; k < division.nFacets; ++k)
    {
        SimplexFacet<dim>& facet = cut.facets[cut.nFacets];
        if (!setFacet<dim>(facet, division.facets[k].corner, volume, vertices)) continue;
        facet.solid = 0;
        if (cut.nFacets == 0) setDescent<dim>(facet.normal, distance, gradN);
        else std::copy(cut.facets[0].normal, cut.facets[0].normal + dim, facet.normal);
        ++cut.nFacets;
    }
    return cut;
}

namespace
{

/// Share of the edge from a to b that lies on a's side of the zero, and its derivative to a distance added to both.
FluidFraction shareOfEdge(double a, double b)
{
    return {a / (a - b), 1 / (a - b)};
}

FluidFraction operator*(FluidFraction a, FluidFraction b)
{
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

FluidFraction operator+(FluidFraction a, FluidFraction b)
{
    return {a.value + b.value, a.slope + b.slope};
}

FluidFraction rest(FluidFraction a)
{
    return {1 - a.value, -a.slope};
}

} // namespace

/// Parts are simplices whose shares are products of shares of edges: a corner, its complement, or (tetrahedron, two and two nodes) three of them.
template <int dim>
FluidFraction fluidFraction(const double* distance)
{
    double wet[dim + 1] = {}, dry[dim + 1] = {};
    int nWet = 0, nDry = 0;
    for (int a = 0; a <= dim; ++a) (distance[a] > 0 ? wet[nWet++] : dry[nDry++]) = distance[a];
    if (dim == 3 && nWet == 2)
    {
        const FluidFraction t00 = shareOfEdge(wet[0], dry[0]), t01 = shareOfEdge(wet[0], dry[1]);
        const FluidFraction t10 = shareOfEdge(wet[1], dry[0]), t11 = shareOfEdge(wet[1], dry[1]);
        return t00 * t01 + rest(t00) * t10 * t11 + t00 * rest(t01) * t11;
    }
    const bool isCorner = nWet == 1; // of fluid; else of solid
    FluidFraction corner{1, 0};
    for (int k = 0; k < dim; ++k) corner = corner * (isCorner ? shareOfEdge(wet[0], dry[k]) : shareOfEdge(dry[0], wet[k]));
    return isCorner ? corner : rest(corner);
}

template SimplexCut<2> cutSimplex<2>(const double*, double, const double*, const double*);
template SimplexCut<3> cutSimplex<3>(const double*, double, const double*, const double*);
template FluidFraction fluidFraction<2>(const double*);
template FluidFraction fluidFraction<3>(const double*);

} // namespace flotsam
