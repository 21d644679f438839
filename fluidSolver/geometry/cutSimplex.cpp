// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/simplexDivision.hpp"

#include <algorithm>

namespace flotsam
{
namespace
{

constexpr int usualFacets = 8;          // at an edge
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

    /// The part inside of all faces of the simplex's own face opposite to `corner`.
    std::vector<SimplexFacet<dim>> cutOwnFace(int corner)
    {
        Point face[dim] = {};
        for (int a = 0, i = 0; a <= dim; ++a)
            if (a != corner) face[i++].n[a] = 1;
        double opposite[dim + 1] = {};  // falls towards the face
        opposite[corner] = 1;
        cutFacet(face, opposite, 0);
        return std::move(result_.facets);
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
        Point part[dim + 1];
        for (int k = 0; k < outside.nParts; ++k)
        {
            toElement(corners, outside.parts[k].corner, dim + 1, part);
            addPart<dim>(result_, part, outside.parts[k].share * partVolume, volume_);
        }
        for (int k = 0; k < outside.nFacets; ++k)
        {
            toElement(corners, outside.facets[k].corner, dim, part);
            cutFacet(part, distances_ + face * (dim + 1), face + 1);
        }
        if (face + 1 == nFaces_) return; // the rest is inside of all
        for (double& v : values) v = -v;
        const SimplexDivision<dim> inside = divideSimplex<dim>(values);
        for (int k = 0; k < inside.nParts; ++k)
        {
            if (inside.parts[k].share * partVolume < negligiblePart * volume_) continue;
            toElement(corners, inside.parts[k].corner, dim + 1, part);
            cutPart(part, inside.parts[k].share * partVolume, face + 1);
        }
    }

    /// A piece of a face, inside of all faces before `face`: keeps what is inside of this one. own: its function, which falls along its normal.
    void cutFacet(const Point* corners, const double* own, int face)
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

    void addFacet(const Point* corners, const double* own)
    {
        SimplexFacet<dim> facet;
        if (!setFacet<dim>(facet, corners, volume_, vertices_)) return;
        if (own != ofNormal_) setDescent<dim>(normal_, own, gradN_);
        ofNormal_ = own;
        std::copy(normal_, normal_ + dim, facet.normal);
        if (result_.facets.empty()) result_.facets.reserve(usualFacets);
        result_.facets.push_back(facet);
    }

    const double* distances_;
    int nFaces_;
    double volume_;
    const double *vertices_, *gradN_;
    EdgeCut<dim> result_{};
    const double* ofNormal_ = nullptr;  // function that normal_ is of: the pieces of a face follow each other
    double normal_[dim];
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

template <int dim>
EdgeCut<dim> cutSimplexAtEdge(const double* distances, int nFaces, double volume, const double* vertices, const double* gradN)
{
    return EdgeCutter<dim>(distances, nFaces, volume, vertices, gradN).cut();
}

template <int dim>
void addFacePart(int corner, const double* distances, int nFaces, double volume, const double* vertices, const double* gradN, std::vector<SimplexFacet<dim>>& facets)
{
    const std::vector<SimplexFacet<dim>> parts = EdgeCutter<dim>(distances, nFaces, volume, vertices, gradN).cutOwnFace(corner);
    facets.insert(facets.end(), parts.begin(), parts.end());
}

template SimplexCut<2> cutSimplex<2>(const double*, double, const double*, const double*);
template SimplexCut<3> cutSimplex<3>(const double*, double, const double*, const double*);
template FluidFraction fluidFraction<2>(const double*);
template FluidFraction fluidFraction<3>(const double*);
template EdgeCut<2> cutSimplexAtEdge<2>(const double*, int, double, const double*, const double*);
template EdgeCut<3> cutSimplexAtEdge<3>(const double*, int, double, const double*, const double*);
template void addFacePart<2>(int, const double*, int, double, const double*, const double*, std::vector<SimplexFacet<2>>&);
template void addFacePart<3>(int, const double*, int, double, const double*, const double*, std::vector<SimplexFacet<3>>&);

} // namespace flotsam
