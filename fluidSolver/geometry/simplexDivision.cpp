// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/simplexDivision.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace flotsam
{
namespace
{

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
struct CutEdge { double in, out; };

template <int dim>
SimplexPoint<dim> nodePoint(int a)
{
    SimplexPoint<dim> p{};
    p.n[a] = 1;
    return p;
}

template <int dim>
void addPart(SimplexDivision<dim>& division, double share, std::initializer_list<const SimplexPoint<dim>*> corners)
{
    auto& part = division.parts[division.nParts++];
    part.share = share;
    std::transform(corners.begin(), corners.end(), part.corner, [](const SimplexPoint<dim>* p) { return *p; });
}

template <int dim>
void addFacet(SimplexDivision<dim>& division, std::initializer_list<const SimplexPoint<dim>*> corners)
{
    auto& facet = division.facets[division.nFacets++];
    std::transform(corners.begin(), corners.end(), facet.corner, [](const SimplexPoint<dim>* p) { return *p; });
}

template <int dim>
void toSpace(const SimplexPoint<dim>& p, const double* vertices, double* x)
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

} // namespace

/// One fluid node: a corner simplex. All but one: the prism between the face of the fluid nodes and the facet.
/// Two and two (3D): the prism between the triangles (fluid 0, cut 00, cut 01) and (fluid 1, cut 10, cut 11).
template <int dim>
SimplexDivision<dim> divideSimplex(const double* values)
{
    const Signs<dim> s(values);
    const SimplexPoint<dim> p[2] = {nodePoint<dim>(s.fluid[0]), nodePoint<dim>(s.fluid[1])}; // [1] is used if there is one
    CutEdge e[2 * (dim - 1)] = {};
    SimplexPoint<dim> c[2 * (dim - 1)] = {};
    int n = 0;
    for (int i = 0; i < s.nFluid; ++i)
        for (int j = 0; j < s.nSolid; ++j, ++n)
        {
            const double positive = values[s.fluid[i]], negative = values[s.solid[j]], slope = 1 / (positive - negative);
            e[n] = {positive * slope, -negative * slope};
            c[n].n[s.fluid[i]] = e[n].out;
            c[n].n[s.solid[j]] = e[n].in;
        }

    SimplexDivision<dim> division;
    if constexpr (dim == 2)
    {
        if (s.nFluid == 1) addPart<2>(division, e[0].in * e[1].in, {&p[0], &c[0], &c[1]});
        else
        {
            addPart<2>(division, e[1].in, {&p[0], &p[1], &c[1]});
            addPart<2>(division, e[0].in * e[1].out, {&p[0], &c[0], &c[1]});
        }
        addFacet<2>(division, {&c[0], &c[1]});
    }
    else if (s.nFluid == 2)
    {
        addPart<3>(division, e[0].in * e[1].in * e[3].out, {&p[0], &c[0], &c[1], &c[3]});
        addPart<3>(division, e[0].in * e[3].in * e[2].out, {&p[0], &c[0], &c[2], &c[3]});
        addPart<3>(division, e[2].in * e[3].in, {&p[0], &p[1], &c[2], &c[3]});
        addFacet<3>(division, {&c[0], &c[1], &c[3]});
        addFacet<3>(division, {&c[0], &c[3], &c[2]});
    }
    else
    {
        if (s.nFluid == 1) addPart<3>(division, e[0].in * e[1].in * e[2].in, {&p[0], &c[0], &c[1], &c[2]});
        else
        {
            const SimplexPoint<3> last = nodePoint<3>(s.fluid[2]);
            addPart<3>(division, e[2].in, {&p[0], &p[1], &last, &c[2]});
            addPart<3>(division, e[1].in * e[2].out, {&p[0], &p[1], &c[1], &c[2]});
            addPart<3>(division, e[0].in * e[1].out * e[2].out, {&p[0], &c[0], &c[1], &c[2]});
        }
        addFacet<3>(division, {&c[0], &c[1], &c[2]});
    }
    return division;
}

/// Exact: int N_a N_b = V/((d+1)(d+2)) (sum_i N_a(i) sum_j N_b(j) + sum_i N_a(i) N_b(i)).
template <int dim>
void addPart(SimplexMoments<dim>& moments, const SimplexPoint<dim>* corners, double partVolume, double elementVolume)
{
    if (partVolume < negligiblePart * elementVolume) return;
    double sum[dim + 1] = {};
    for (int i = 0; i <= dim; ++i)
        for (int a = 0; a <= dim; ++a) sum[a] += corners[i].n[a];
    const double w = partVolume / ((dim + 1) * (dim + 2));
    for (int a = 0; a <= dim; ++a)
    {
        moments.first[a] += partVolume / (dim + 1) * sum[a];
        for (int b = a; b <= dim; ++b)
        {
            double s = sum[a] * sum[b];
            for (int i = 0; i <= dim; ++i) s += corners[i].n[a] * corners[i].n[b];
            moments.second[a * (dim + 1) + b] += w * s;
            if (b > a) moments.second[b * (dim + 1) + a] += w * s;
        }
    }
    moments.volume += partVolume;
}

/// Quadrature at dim symmetric interior points: Gauss (edge) or degree 2 (triangle).
template <int dim>
bool setFacet(SimplexFacet<dim>& facet, const SimplexPoint<dim>* corners, double elementVolume, const double* vertices)
{
    double x[dim][dim];
    for (int i = 0; i < dim; ++i) toSpace<dim>(corners[i], vertices, x[i]);
    facet.area = facetArea(x);
    const double a = facet.area / negligiblePart; // against the volume to the power (dim-1)/dim, without a root
    if (dim == 3 ? a * a * a < elementVolume * elementVolume : a * a < elementVolume) return false;

    constexpr double own = ownCornerWeight<dim>, other = (1 - own) / (dim - 1);
    for (int q = 0; q < dim; ++q)
    {
        facet.weight[q] = facet.area / dim;
        for (int a = 0; a <= dim; ++a)
        {
            facet.shape[q][a] = 0;
            for (int i = 0; i < dim; ++i) facet.shape[q][a] += (i == q ? own : other) * corners[i].n[a];
        }
    }
    return true;
}

template <int dim>
void setDescent(double* direction, const double* values, const double* gradN)
{
    double length = 0;
    for (int d = 0; d < dim; ++d)
    {
        direction[d] = 0;
        for (int a = 0; a <= dim; ++a) direction[d] -= values[a] * gradN[a * dim + d];
        length += direction[d] * direction[d];
    }
    length = std::sqrt(length);
    for (int d = 0; d < dim; ++d) direction[d] /= length;
}

template SimplexDivision<2> divideSimplex<2>(const double*);
template SimplexDivision<3> divideSimplex<3>(const double*);
template void addPart<2>(SimplexMoments<2>&, const SimplexPoint<2>*, double, double);
template void addPart<3>(SimplexMoments<3>&, const SimplexPoint<3>*, double, double);
template bool setFacet<2>(SimplexFacet<2>&, const SimplexPoint<2>*, double, const double*);
template bool setFacet<3>(SimplexFacet<3>&, const SimplexPoint<3>*, double, const double*);
template void setDescent<2>(double*, const double*, const double*);
template void setDescent<3>(double*, const double*, const double*);

} // namespace flotsam
