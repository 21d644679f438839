// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cutSimplex.hpp"

#include <cmath>
#include <initializer_list>

namespace flotsam
{
namespace
{

/// A number with its derivative to a distance added to all nodes.
struct Dual
{
    double value, slope;
};
Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }

/// Nodes by sign.
template <int dim>
struct Signs
{
    int fluid[dim + 1] = {}, solid[dim + 1] = {};
    int nFluid = 0, nSolid = 0;

    explicit Signs(const double* d)
    {
        for (int a = 0; a <= dim; ++a)
            if (d[a] > 0) fluid[nFluid++] = a;
            else solid[nSolid++] = a;
    }
};

/// The edge between a fluid and a solid node: share of it in the fluid, and the rest. Both are computed without
/// cancellation, and the sub-simplices' volumes below are sums of products of them: slivers keep all digits.
struct CutEdge
{
    Dual in, out;
    int fluid, solid;   // nodes
};

CutEdge cutEdge(const double* distance, int fluid, int solid)
{
    const double slope = 1 / (distance[fluid] - distance[solid]);
    return {{distance[fluid] * slope, slope}, {-distance[solid] * slope, -slope}, fluid, solid};
}

template <int dim>
struct Point { double n[dim + 1]; };    // shape functions

template <int dim>
Point<dim> nodePoint(int a)
{
    Point<dim> p{};
    p.n[a] = 1;
    return p;
}

template <int dim>
Point<dim> edgePoint(const CutEdge& edge)
{
    Point<dim> p{};
    p.n[edge.fluid] = edge.out.value;
    p.n[edge.solid] = edge.in.value;
    return p;
}

/// Adds the moments of a sub-simplex; exact: int N_a N_b = V/((d+1)(d+2)) (sum_i N_a(i) sum_j N_b(j) + sum_i N_a(i) N_b(i)).
template <int dim>
void addPiece(SimplexCut<dim>& cut, double pieceVolume, double elementVolume, std::initializer_list<const Point<dim>*> corners)
{
    if (pieceVolume < negligiblePart * elementVolume) return;
    double sum[dim + 1] = {};
    for (const Point<dim>* p : corners)
        for (int a = 0; a <= dim; ++a) sum[a] += p->n[a];
    const double w = pieceVolume / ((dim + 1) * (dim + 2));
    for (int a = 0; a <= dim; ++a)
    {
        cut.first[a] += pieceVolume / (dim + 1) * sum[a];
        for (int b = a; b <= dim; ++b)
        {
            double s = sum[a] * sum[b];
            for (const Point<dim>* p : corners) s += p->n[a] * p->n[b];
            cut.second[a * (dim + 1) + b] += w * s;
        }
    }
    cut.volume += pieceVolume;
}

template <int dim>
void toSpace(const Point<dim>& p, const double* vertices, double* x)
{
    for (int d = 0; d < dim; ++d)
    {
        x[d] = 0;
        for (int a = 0; a <= dim; ++a) x[d] += p.n[a] * vertices[a * dim + d];
    }
}

double facetArea(const double (&x)[2][2]) { return std::hypot(x[1][0] - x[0][0], x[1][1] - x[0][1]); }

double facetArea(const double (&x)[3][3])
{
    double e[2][3];
    for (int k = 0; k < 2; ++k)
        for (int d = 0; d < 3; ++d) e[k][d] = x[k + 1][d] - x[0][d];
    const double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                         e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    return 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/// Facet with corners p[0..dim-1]; dim symmetric interior points: Gauss (edge) or degree 2 (triangle).
template <int dim>
void addFacet(SimplexCut<dim>& cut, double elementVolume, const double* vertices, std::initializer_list<const Point<dim>*> corners)
{
    const Point<dim>* const* p = corners.begin();
    double x[dim][dim];
    for (int i = 0; i < dim; ++i) toSpace<dim>(*p[i], vertices, x[i]);
    const double area = facetArea(x);
    const double size = dim == 3 ? std::cbrt(elementVolume * elementVolume) : std::sqrt(elementVolume);
    if (area < negligiblePart * size) return;

    const double own = dim == 2 ? 0.5 * (1 + 1 / std::sqrt(3.0)) : 2.0 / 3;
    const double other = (1 - own) / (dim - 1);
    SimplexFacet<dim>& f = cut.facets[cut.nFacets++];
    f.area = area;
    for (int q = 0; q < dim; ++q)
    {
        f.weight[q] = area / dim;
        for (int a = 0; a <= dim; ++a)
        {
            f.shape[q][a] = 0;
            for (int i = 0; i < dim; ++i) f.shape[q][a] += (i == q ? own : other) * p[i]->n[a];
        }
    }
}

/// Volumes of the (at most three) sub-simplices of the fluid part over the element's.
/// One fluid node: a corner simplex. All but one: the prism between the face of the fluid nodes and the facet.
/// Two and two (3D): the prism between the triangles (fluid 0, cut 00, cut 01) and (fluid 1, cut 10, cut 11).
struct CornerVolumes { Dual v[3]; int n; };

template <int dim>
CornerVolumes cornerVolumes(const CutEdge* e)
{
    if constexpr (dim == 2) return {{e[0].in * e[1].in}, 1};
    else return {{e[0].in * e[1].in * e[2].in}, 1};
}

template <int dim>
CornerVolumes truncatedVolumes(const CutEdge* e)
{
    if constexpr (dim == 2) return {{e[1].in, e[0].in * e[1].out}, 2};
    else return {{e[2].in, e[1].in * e[2].out, e[0].in * e[1].out * e[2].out}, 3};
}

CornerVolumes wedgeVolumes(const CutEdge* e) // edges 00, 01, 10, 11
{
    return {{e[0].in * e[1].in * e[3].out, e[0].in * e[3].in * e[2].out, e[2].in * e[3].in}, 3};
}

/// All cut edges, fluid node major, and the volumes.
template <int dim>
struct Division
{
    Signs<dim> signs;
    CutEdge edge[2 * (dim - 1)] = {};
    CornerVolumes volumes;

    explicit Division(const double* d) : signs(d)
    {
        int n = 0;
        for (int i = 0; i < signs.nFluid; ++i)
            for (int j = 0; j < signs.nSolid; ++j) edge[n++] = cutEdge(d, signs.fluid[i], signs.solid[j]);
        if (signs.nFluid == 1) volumes = cornerVolumes<dim>(edge);
        else if (dim == 2 || signs.nSolid == 1) volumes = truncatedVolumes<dim>(edge);
        else volumes = wedgeVolumes(edge);
    }
};

template <int dim>
void setNormal(SimplexCut<dim>& cut, const double* distance, const double* gradN)
{
    double length = 0;
    for (int d = 0; d < dim; ++d)
    {
        cut.normal[d] = 0;
        for (int a = 0; a <= dim; ++a) cut.normal[d] -= distance[a] * gradN[a * dim + d];
        length += cut.normal[d] * cut.normal[d];
    }
    length = std::sqrt(length);
    for (int d = 0; d < dim; ++d) cut.normal[d] /= length;
}

} // namespace

template <int dim>
SimplexCut<dim> cutSimplex(const double* distance, double volume, const double* vertices, const double* gradN)
{
    const Division<dim> division(distance);
    const Signs<dim>& s = division.signs;
    const Point<dim> p[2] = {nodePoint<dim>(s.fluid[0]), nodePoint<dim>(s.fluid[1])}; // [1] is used if there is one
    Point<dim> c[2 * (dim - 1)];
    for (int n = 0; n < s.nFluid * s.nSolid; ++n) c[n] = edgePoint<dim>(division.edge[n]);

    SimplexCut<dim> cut{};
    setNormal(cut, distance, gradN);
    double v[3] = {};
    for (int i = 0; i < division.volumes.n; ++i) v[i] = division.volumes.v[i].value * volume;

    if constexpr (dim == 2)
    {
        if (s.nFluid == 1) addPiece<2>(cut, v[0], volume, {&p[0], &c[0], &c[1]});
        else
        {
            addPiece<2>(cut, v[0], volume, {&p[0], &p[1], &c[1]});
            addPiece<2>(cut, v[1], volume, {&p[0], &c[0], &c[1]});
        }
        addFacet<2>(cut, volume, vertices, {&c[0], &c[1]});
    }
    else if (s.nFluid == 2)
    {
        addPiece<3>(cut, v[0], volume, {&p[0], &c[0], &c[1], &c[3]});
        addPiece<3>(cut, v[1], volume, {&p[0], &c[0], &c[2], &c[3]});
        addPiece<3>(cut, v[2], volume, {&p[0], &p[1], &c[2], &c[3]});
        addFacet<3>(cut, volume, vertices, {&c[0], &c[1], &c[3]});
        addFacet<3>(cut, volume, vertices, {&c[0], &c[3], &c[2]});
    }
    else
    {
        if (s.nFluid == 1) addPiece<3>(cut, v[0], volume, {&p[0], &c[0], &c[1], &c[2]});
        else
        {
            const Point<3> last = nodePoint<3>(s.fluid[2]);
            addPiece<3>(cut, v[0], volume, {&p[0], &p[1], &last, &c[2]});
            addPiece<3>(cut, v[1], volume, {&p[0], &p[1], &c[1], &c[2]});
            addPiece<3>(cut, v[2], volume, {&p[0], &c[0], &c[1], &c[2]});
        }
        addFacet<3>(cut, volume, vertices, {&c[0], &c[1], &c[2]});
    }
    for (int a = 0; a <= dim; ++a)
        for (int b = 0; b < a; ++b) cut.second[a * (dim + 1) + b] = cut.second[b * (dim + 1) + a];
    return cut;
}

template <int dim>
FluidFraction fluidFraction(const double* distance)
{
    const Division<dim> division(distance);
    Dual sum{0, 0};
    for (int i = 0; i < division.volumes.n; ++i) sum = sum + division.volumes.v[i];
    return {sum.value, sum.slope};
}

template SimplexCut<2> cutSimplex<2>(const double*, double, const double*, const double*);
template SimplexCut<3> cutSimplex<3>(const double*, double, const double*, const double*);
template FluidFraction fluidFraction<2>(const double*);
template FluidFraction fluidFraction<3>(const double*);

} // namespace flotsam
