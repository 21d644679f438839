// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cutSimplex.hpp"
#include "support/near.hpp"

#include <Eigen/Dense>
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

using namespace flotsam;

namespace
{

template <int dim>
EdgeCut<dim> cutAtEdge(const double* distances, int nFaces, double volume, const double* vertices, const double* gradN)
{
    EdgeCut<dim> cut;
    cutSimplexAtEdge<dim>(distances, nFaces, volume, vertices, gradN, cut);
    return cut;
}

template <int dim>
struct Simplex
{
    using Vector = Eigen::Matrix<double, dim, 1>;
    double vertices[(dim + 1) * dim];
    double gradN[(dim + 1) * dim];
    double volume;

    explicit Simplex(const std::array<Vector, dim + 1>& x)
    {
        Eigen::Matrix<double, dim, dim> edges;
        for (int a = 0; a <= dim; ++a) Eigen::Map<Vector>(vertices + a * dim) = x[a];
        for (int a = 0; a < dim; ++a) edges.col(a) = x[a + 1] - x[0];
        volume = std::abs(edges.determinant()) / (dim == 2 ? 2 : 6);
        const Eigen::Matrix<double, dim, dim> g = edges.inverse();
        Vector first = Vector::Zero();
        for (int a = 1; a <= dim; ++a)
        {
            Eigen::Map<Vector>(gradN + a * dim) = g.row(a - 1).transpose();
            first -= g.row(a - 1).transpose();
        }
        Eigen::Map<Vector>(gradN + 0) = first;
    }
    SimplexCut<dim> cut(const double* distance) const { return cutSimplex<dim>(distance, volume, vertices, gradN); }
};

template <int dim>
Simplex<dim> randomSimplex(std::mt19937& generator, double scale = 1)
{
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (;;)
    {
        std::array<typename Simplex<dim>::Vector, dim + 1> x;
        for (auto& p : x)
            for (int d = 0; d < dim; ++d) p[d] = scale * uniform(generator);
        const Simplex<dim> simplex(x);
        if (simplex.volume > 0.05 * std::pow(scale, dim)) return simplex;
    }
}

template <int dim>
Simplex<dim> unitSimplex()
{
    std::array<typename Simplex<dim>::Vector, dim + 1> x;
    x[0].setZero();
    for (int d = 0; d < dim; ++d) x[d + 1] = Simplex<dim>::Vector::Unit(d);
    return Simplex<dim>(x);
}

/// Distances with the given signs (bit a: node a is fluid), magnitudes from 1e-9 to 1.
template <int dim>
void fillDistance(std::mt19937& generator, int pattern, double* distance)
{
    std::uniform_real_distribution<double> exponent(-9, 0);
    for (int a = 0; a <= dim; ++a) distance[a] = std::pow(10, exponent(generator)) * (pattern >> a & 1 ? 1 : -1);
}

template <int dim>
double exactSecond(int a, int b, double volume) { return volume * (a == b ? 2 : 1) / ((dim + 1) * (dim + 2)); }

template <int dim>
void checkParts(double scale)
{
    std::mt19937 generator(7);
    double worst = 0, worstArea = 0;
    for (int pattern = 1; pattern < (1 << (dim + 1)) - 1; ++pattern)
        for (int repeat = 0; repeat < 50; ++repeat)
        {
            const Simplex<dim> simplex = randomSimplex<dim>(generator, scale);
            double distance[dim + 1], reversed[dim + 1];
            fillDistance<dim>(generator, pattern, distance);
            for (int a = 0; a <= dim; ++a) reversed[a] = -distance[a];
            const SimplexCut<dim> fluid = simplex.cut(distance), solid = simplex.cut(reversed);
            const double v = simplex.volume;
            worst = std::max(worst, std::abs(fluid.volume + solid.volume - v) / v);
            worst = std::max(worst, std::abs(fluidFraction<dim>(distance).value - fluid.volume / v));
            double areas[2] = {0, 0};
            for (int f = 0; f < fluid.nFacets; ++f) areas[0] += fluid.facets[f].area;
            for (int f = 0; f < solid.nFacets; ++f) areas[1] += solid.facets[f].area;
            worstArea = std::max(worstArea, std::abs(areas[0] - areas[1]) / std::pow(v, (dim - 1.0) / dim));
            for (int a = 0; a <= dim; ++a)
            {
                worst = std::max(worst, std::abs(fluid.first[a] + solid.first[a] - v / (dim + 1)) / v);
                for (int b = 0; b <= dim; ++b)
                {
                    const int ab = a * (dim + 1) + b;
                    worst = std::max(worst, std::abs(fluid.second[ab] + solid.second[ab] - exactSecond<dim>(a, b, v)) / v);
                }
            }
        }
    CHECK(worst < 3e-14); // three dropped parts at most
    CHECK(worstArea < 1e-12); // cut points move by round-off of the coordinates
}

/// The integrals of 1, x_0, x_0^2 over the part x_0 < s of the unit simplex are known.
template <int dim>
void checkPlaneCut(double s)
{
    const Simplex<dim> simplex = unitSimplex<dim>();
    double distance[dim + 1];
    for (int a = 0; a <= dim; ++a) distance[a] = s - (a == 1 ? 1 : 0); // fluid: x_0 < s
    const SimplexCut<dim> cut = simplex.cut(distance);
    const double r = 1 - s; // the section at x_0 is (1 - x_0)^(dim-1)/(dim-1)!
    CHECK(cut.volume == near(dim == 2 ? s - s*s/2 : s*(1 - s*(1 - s/3))/2, 1e-13));
    CHECK(cut.first[1] == near(s*s*(dim == 2 ? 1./2 - s/3 : 1./4 - s/3 + s*s/8), 1e-13));
    CHECK(cut.second[dim + 2] == near(s*s*s*(dim == 2 ? 1./3 - s/4 : 1./6 - s/4 + s*s/10), 1e-13));

    REQUIRE(cut.nFacets == 1);
    CHECK(cut.facets[0].normal[0] == near(1, 1e-14));
    CHECK(cut.facets[0].area == near(dim == 2 ? r : r * r / 2, 1e-14));
    // degree 2 along the facet: int x_1^2 = r^3/3 (edge) or r^4/12 (triangle)
    double square = 0, weights = 0;
    for (int q = 0; q < dim; ++q)
    {
        square += cut.facets[0].weight[q] * std::pow(cut.facets[0].shape[q][2], 2);
        weights += cut.facets[0].weight[q];
    }
    CHECK(square == near(dim == 2 ? r * r * r / 3 : std::pow(r, 4) / 12, 1e-14));
    CHECK(weights == near(cut.facets[0].area, 1e-15));
}

} // namespace

TEST_CASE_TEMPLATE("fluid part and solid part make the element: all sign patterns, any size", Dim, std::integral_constant<int, 2>,
                   std::integral_constant<int, 3>)
{
    for (const double scale : {1e-6, 1.0, 1e6}) checkParts<Dim::value>(scale);
}

TEST_CASE_TEMPLATE("plane cut: volume, moments, area and quadrature exact", Dim, std::integral_constant<int, 2>,
                   std::integral_constant<int, 3>)
{
    for (const double s : {1e-3, 0.25, 0.5, 0.9}) checkPlaneCut<Dim::value>(s);
}

TEST_CASE("two fluid nodes: the facet is a rectangle with exact quadrature of degree 2")
{
    // cut by x = s between the nodes {0, 2} and {1, 3}
    const Simplex<3> simplex({Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {1, 0, 1}});
    const double s = 0.4, distance[4] = {s, s - 1, s, s - 1};
    const SimplexCut<3> cut = simplex.cut(distance);
    REQUIRE(cut.nFacets == 2);
    // section x = s: y in [0, 1-s], z in [0, s]
    double area = 0, integral = 0;
    for (int f = 0; f < 2; ++f)
        for (int q = 0; q < 3; ++q)
        {
            const SimplexFacet<3>& facet = cut.facets[f];
            const double y = facet.shape[q][2], z = facet.shape[q][3], x = facet.shape[q][1] + facet.shape[q][3];
            CHECK(x == near(s, 1e-14));
            area += facet.weight[q];
            integral += facet.weight[q] * (y * z + z * z);
        }
    CHECK(area == near(s * (1 - s), 1e-14));
    CHECK(integral == near(s * s / 2 * (1 - s) * (1 - s) / 2 + (1 - s) * s * s * s / 3, 1e-14));
}

TEST_CASE_TEMPLATE("slope of the fluid share is the facet's area over |grad distance|", Dim, std::integral_constant<int, 2>,
                   std::integral_constant<int, 3>)
{
    constexpr int dim = Dim::value;
    std::mt19937 generator(3);
    for (int pattern = 1; pattern < (1 << (dim + 1)) - 1; ++pattern)
    {
        const Simplex<dim> simplex = randomSimplex<dim>(generator);
        double distance[dim + 1], gradient[dim] = {}, area = 0, length = 0;
        std::uniform_real_distribution<double> uniform(0.1, 1);
        for (int a = 0; a <= dim; ++a) distance[a] = uniform(generator) * (pattern >> a & 1 ? 1 : -1);
        for (int a = 0; a <= dim; ++a)
            for (int d = 0; d < dim; ++d) gradient[d] += distance[a] * simplex.gradN[a * dim + d];
        for (int d = 0; d < dim; ++d) length += gradient[d] * gradient[d];
        const SimplexCut<dim> cut = simplex.cut(distance);
        for (int f = 0; f < cut.nFacets; ++f) area += cut.facets[f].area;
        CHECK(fluidFraction<dim>(distance).slope * simplex.volume == near(area / std::sqrt(length), 1e-14));
    }
}

TEST_CASE_TEMPLATE("divergence theorem on a cut corner", Dim, std::integral_constant<int, 2>,
                   std::integral_constant<int, 3>)
{
    // dim*volume = int x.n over the boundary; with the origin at the one fluid corner only the facet contributes
    constexpr int dim = Dim::value;
    std::mt19937 generator(11);
    for (int corner = 0; corner <= dim; ++corner)
    {
        const Simplex<dim> simplex = randomSimplex<dim>(generator);
        double distance[dim + 1], flux = 0;
        fillDistance<dim>(generator, 1 << corner, distance);
        distance[corner] = 0.7;
        const SimplexCut<dim> cut = simplex.cut(distance);
        for (int f = 0; f < cut.nFacets; ++f)
            for (int q = 0; q < dim; ++q)
                for (int d = 0; d < dim; ++d)
                {
                    double x = -simplex.vertices[corner * dim + d];
                    for (int a = 0; a <= dim; ++a) x += cut.facets[f].shape[q][a] * simplex.vertices[a * dim + d];
                    flux += cut.facets[f].weight[q] * x * cut.facets[f].normal[d];
                }
        CHECK(flux == near(dim * cut.volume, 1e-14));
    }
}

TEST_CASE_TEMPLATE("two faces, one after the other or in the other order: the same parts; a face that holds all does not count", Dim,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>)
{
    constexpr int dim = Dim::value;
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int repeat = 0; repeat < 200; ++repeat)
    {
        const Simplex<dim> simplex = randomSimplex<dim>(generator);
        double values[3 * (dim + 1)], swapped[3 * (dim + 1)];
        for (int a = 0; a <= dim; ++a)
        {
            values[a] = swapped[2 * (dim + 1) + a] = uniform(generator);
            values[dim + 1 + a] = swapped[a] = uniform(generator);
            values[2 * (dim + 1) + a] = swapped[dim + 1 + a] = -1;
        }
        const EdgeCut<dim> one = cutAtEdge<dim>(values, 3, simplex.volume, simplex.vertices, simplex.gradN);
        const EdgeCut<dim> other = cutAtEdge<dim>(swapped, 3, simplex.volume, simplex.vertices, simplex.gradN);
        double worst = std::abs(one.volume - other.volume), areas = 0;
        for (int m = 0; m < (dim + 1) * (dim + 1); ++m) worst = std::max(worst, std::abs(one.second[m] - other.second[m]));
        CHECK(worst < 1e-13 * simplex.volume);
        for (const auto& facet : one.facets) areas += facet.area;
        for (const auto& facet : other.facets) areas -= facet.area;
        CHECK(std::abs(areas) < 1e-12);
    }
}

namespace
{

/// Largest difference of the moments, and of the sums over the facets of (1, N_a) n and N_a N_b n, each solid's, over volume and a unit of area.
template <int dim>
double differenceOf(const Simplex<dim>& simplex, const EdgeCut<dim>& one, const EdgeCut<dim>& other, int nSolids)
{
    constexpr int n = dim + 1, perSolid = dim * (1 + n + n * n);
    double worst = std::abs(one.volume - other.volume);
    for (int a = 0; a < n; ++a) worst = std::max(worst, std::abs(one.first[a] - other.first[a]));
    for (int ab = 0; ab < n * n; ++ab) worst = std::max(worst, std::abs(one.second[ab] - other.second[ab]));
    worst /= simplex.volume;
    std::vector<double> sums(std::size_t(perSolid) * nSolids, 0);
    for (const EdgeCut<dim>* cut : {&one, &other})
        for (const SimplexFacet<dim>& facet : cut->facets)
            for (int q = 0; q < dim; ++q)
                for (int d = 0; d < dim; ++d)
                {
                    const double area = (cut == &one ? 1 : -1) * facet.weight[q] * facet.normal[d];
                    double* sum = &sums[std::size_t(facet.solid) * perSolid + d];
                    sum[0] += area;
                    for (int a = 0; a < n; ++a) sum[dim * (1 + a)] += area * facet.shape[q][a];
                    for (int ab = 0; ab < n * n; ++ab) sum[dim * (1 + n + ab)] += area * facet.shape[q][ab / n] * facet.shape[q][ab % n];
                }
    for (const double sum : sums) worst = std::max(worst, std::abs(sum));
    return worst;
}

} // namespace

// Wedges with two faces each, on both sides of a plane and a gap away from it; with the gap's sign turned they overlap.
TEST_CASE_TEMPLATE("solids apart from each other are cut one by one as they are together; parts, overlaps and touches are told from none", Dim,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>)
{
    constexpr int dim = Dim::value, n = dim + 1;
    std::mt19937 generator(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    double worst = 0;
    int nBoth = 0;
    for (int repeat = 0; repeat < 500; ++repeat)
    {
        const Simplex<dim> simplex = randomSimplex<dim>(generator);
        double plane[n], apart[4 * n], joined[4 * n];
        for (double& value : plane) value = uniform(generator);
        const double gap = repeat % 2 ? 1e-6 : 0.2;
        for (int a = 0; a < n; ++a)
        {
            apart[a] = plane[a] + gap;                  // 0, 1: faces of the first
            apart[n + a] = uniform(generator);
            apart[2 * n + a] = -plane[a] + gap;         // 2, 3: of the second
            apart[3 * n + a] = uniform(generator);
        }
        EdgeCut<dim> one, other, part;
        cutSimplexOfApartSolids<dim>(apart, {2, 4}, simplex.volume, simplex.vertices, simplex.gradN, one, part);
        cutSimplexOfSolids<dim>(apart, {2, 4}, simplex.volume, simplex.vertices, simplex.gradN, other);
        worst = std::max(worst, differenceOf(simplex, one, other, 2));
        CHECK_FALSE(hasSolidPart<dim>(apart, 4));
        double solid = simplex.volume - one.volume;
        for (int k = 0; k < 2; ++k)
        {
            const EdgeCut<dim> alone = cutAtEdge<dim>(apart + 2 * k * n, 2, simplex.volume, simplex.vertices, simplex.gradN);
            CHECK(hasSolidPart<dim>(apart + 2 * k * n, 2) == (simplex.volume - alone.volume > 1e-13 * simplex.volume));
            solid -= simplex.volume - alone.volume;
            nBoth += alone.volume < simplex.volume;
        }
        CHECK(std::abs(solid) < 1e-13 * simplex.volume);
        for (int a = 0; a < 4 * n; ++a) joined[a] = apart[a] - 1.01 * gap;      // closer by more than the gap
        for (int a = 0; a < n; ++a) joined[n + a] = joined[3 * n + a] = -1;     // nothing but the two planes
        const double least = *std::min_element(plane, plane + n), largest = *std::max_element(plane, plane + n);
        if (std::abs(least) > 0.01 && std::abs(largest) > 0.01) CHECK(hasSolidPart<dim>(joined, 4) == (least < 0 && largest > 0));
    }
    std::printf("%dD: solids apart one by one and together differ by %.1e, %d parts\n", dim, worst, nBoth);
    CHECK(nBoth > 600);
    CHECK(worst < 1e-12);
}

TEST_CASE("the corner of a box in an element with all nodes outside")
{
    // solid: x > 0.2, y > 0.3, z > 0.1 in the unit simplex, a corner of side 0.4
    const Simplex<3> simplex = unitSimplex<3>();
    const double values[12] = {0.2, -0.8, 0.2, 0.2, 0.3, 0.3, -0.7, 0.3, 0.1, 0.1, 0.1, -0.9};
    const EdgeCut<3> cut = cutAtEdge<3>(values, 3, simplex.volume, simplex.vertices, simplex.gradN);
    CHECK(simplex.volume - cut.volume == near(0.064 / 6, 1e-14));
    Eigen::Vector3d areas = Eigen::Vector3d::Zero();
    double first = 0;
    for (const SimplexFacet<3>& facet : cut.facets)
        for (int q = 0; q < 3; ++q)
            for (int d = 0; d < 3; ++d)
            {
                areas[d] += facet.weight[q] * facet.normal[d];
                if (d == 0) first += facet.weight[q] * facet.normal[0] * facet.shape[q][2];
            }
    for (int d = 0; d < 3; ++d) CHECK(areas[d] == near(0.08, 1e-14));
    CHECK(first == near(0.08 * (0.3 + 0.4 / 3), 1e-14));
}

TEST_CASE("parts of floating point size have no facet and no volume")
{
    const Simplex<3> simplex = unitSimplex<3>();
    const double corner[4] = {1e-12, -1, -1, -1};
    const SimplexCut<3> cut = simplex.cut(corner);
    CHECK(cut.nFacets == 0);
    CHECK(cut.volume == 0);
}
