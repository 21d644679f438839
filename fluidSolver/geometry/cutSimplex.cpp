// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/simplexDivision.hpp"

#include <algorithm>

namespace flotsam
{
namespace
{

constexpr double justInside = -1e-300; // in place of zero: what is on a face is on the same side of it from both sides

/// Follows the parts of one simplex through the faces of a body.
template <int dim>
class EdgeCutter
{
public:
    EdgeCutter(const double* distances, int nFaces, double volume, const double* vertices, const double* gradN)
        : distances_(distances), nFaces_(nFaces), volume_(volume), vertices_(vertices), gradN_(gradN) {}

    EdgeCut<dim> cut()
    {
        SimplexPoint<dim> whole[dim + 1] = {};
        for (int a = 0; a <= dim; ++a) whole[a].n[a] = 1;
        cutPart(whole, volume_, 0);
        return std::move(result_);
    }

private:
    using Point = SimplexPoint<dim>;

    double valueAt(int face, const Point& p) const
    {
        double value = 0;
        for (int a = 0; a <= dim; ++a) value += distances_[face * (dim + 1) + a] * p.n[a];
        return value > 0 ? value : std::min(value, justInside);
    }

    template <int nCorners>
    int valuesAt(int face, const Point* corners, double* values) const
    {
        int nPositive = 0;
        for (int i = 0; i < nCorners; ++i)
        {
            values[i] = valueAt(face, corners[i]);
            nPositive += values[i] > 0;
        }
        return nPositive;
    }

    static void toElement(const Point* corners, const Point* local, int n, Point* result)
    {
        for (int i = 0; i < n; ++i)
            for (int a = 0; a <= dim; ++a)
            {
                result[i].n[a] = 0;
                for (int j = 0; j <= dim; ++j) result[i].n[a] += local[i].n[j] * corners[j].n[a];
            }
    }

    /// A part inside of all faces before `face`: what is outside of this one is fluid, the rest goes on.
    void cutPart(const Point* corners, double partVolume, int face)
    {
        if (face == nFaces_) return;
        double values[dim + 1];
        const int nPositive = valuesAt<dim + 1>(face, corners, values);
        if (nPositive == 0) return cutPart(corners, partVolume, face + 1);
        if (nPositive == dim + 1) return addPart<dim>(result_, corners, partVolume, volume_);
        const SimplexDivision<dim> outside = divideSimplex<dim>(values);
        for (double& v : values) v = -v;
        const SimplexDivision<dim> inside = divideSimplex<dim>(values);
        Point part[dim + 1];
        for (int k = 0; k < outside.nParts; ++k)
        {
            toElement(corners, outside.parts[k].corner, dim + 1, part);
            addPart<dim>(result_, part, outside.parts[k].share * partVolume, volume_);
        }
        for (int k = 0; k < outside.nFacets; ++k)
        {
            toElement(corners, outside.facets[k].corner, dim, part);
            cutFacet(part, face, face + 1);
        }
        for (int k = 0; k < inside.nParts; ++k)
        {
            if (inside.parts[k].share * partVolume < negligiblePart * volume_) continue;
            toElement(corners, inside.parts[k].corner, dim + 1, part);
            cutPart(part, inside.parts[k].share * partVolume, face + 1);
        }
    }

    /// A piece of face `own`, inside of all faces before `face`: keeps what is inside of this one.
    void cutFacet(const Point* corners, int own, int face)
    {
        if (face == nFaces_) return addFacet(corners, own);
        double values[dim];
        const int nPositive = valuesAt<dim>(face, corners, values);
        if (nPositive == dim) return;
        if (nPositive == 0) return cutFacet(corners, own, face + 1);
        Point inside[2][dim];
        const int n = keepInside(corners, values, inside);
        for (int k = 0; k < n; ++k) cutFacet(inside[k], own, face + 1);
    }

    static Point between(const Point& a, double va, const Point& b, double vb)
    {
        Point p;
        for (int k = 0; k <= dim; ++k) p.n[k] = (a.n[k] * vb - b.n[k] * va) / (vb - va);
        return p;
    }

    /// Corners in cyclic order: a segment or a triangle without the part where the values are positive.
    static int keepInside(const Point* corners, const double* values, Point (*result)[dim])
    {
        Point kept[dim + 1];
        int n = 0;
        for (int i = 0; i < dim; ++i)
        {
            const int next = (i + 1) % dim;
            if (values[i] < 0) kept[n++] = corners[i];
            if ((values[i] < 0) != (values[next] < 0) && (dim == 3 || next > i)) kept[n++] = between(corners[i], values[i], corners[next], values[next]);
        }
        for (int k = 0; k + dim <= n; ++k)
        {
            result[k][0] = kept[0];
            for (int i = 1; i < dim; ++i) result[k][i] = kept[k + i];
        }
        return n - dim + 1;
    }

    void addFacet(const Point* corners, int face)
    {
        SimplexFacet<dim> facet;
        if (!setFacet<dim>(facet, corners, volume_, vertices_)) return;
        setDescent<dim>(facet.normal, distances_ + face * (dim + 1), gradN_);
        result_.facets.push_back(facet);
    }

    const double* distances_;
    int nFaces_;
    double volume_;
    const double *vertices_, *gradN_;
    EdgeCut<dim> result_{};
};

} // namespace

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
        setDescent<dim>(facet.normal, distance, gradN);
        ++cut.nFacets;
    }
    return cut;
}

/// In the unit simplex: shares and slopes are the same in all.
template <int dim>
FluidFraction fluidFraction(const double* distance)
{
    double vertices[(dim + 1) * dim] = {}, gradN[(dim + 1) * dim] = {}, square = 0, area = 0;
    for (int d = 0; d < dim; ++d)
    {
        vertices[(d + 1) * dim + d] = gradN[(d + 1) * dim + d] = 1;
        gradN[d] = -1;
        square += (distance[d + 1] - distance[0]) * (distance[d + 1] - distance[0]);
    }
    const double volume = dim == 2 ? 1.0 / 2 : 1.0 / 6;
    const SimplexCut<dim> cut = cutSimplex<dim>(distance, volume, vertices, gradN);
    for (int f = 0; f < cut.nFacets; ++f) area += cut.facets[f].area;
    return {cut.volume / volume, area / (volume * std::sqrt(square))};
}

template <int dim>
EdgeCut<dim> cutSimplexAtEdge(const double* distances, int nFaces, double volume, const double* vertices, const double* gradN)
{
    return EdgeCutter<dim>(distances, nFaces, volume, vertices, gradN).cut();
}

template SimplexCut<2> cutSimplex<2>(const double*, double, const double*, const double*);
template SimplexCut<3> cutSimplex<3>(const double*, double, const double*, const double*);
template FluidFraction fluidFraction<2>(const double*);
template FluidFraction fluidFraction<3>(const double*);
template EdgeCut<2> cutSimplexAtEdge<2>(const double*, int, double, const double*, const double*);
template EdgeCut<3> cutSimplexAtEdge<3>(const double*, int, double, const double*, const double*);

} // namespace flotsam
