// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/facetPieces.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace flotsam
{
namespace
{

/// Moments of a plane piece of surface in shape functions.
template <int dim>
struct PlanePiece
{
    using Shape = Eigen::Matrix<double, dim + 1, 1>;

    double area = 0;
    Shape first = Shape::Zero();
    Eigen::Matrix<double, dim + 1, dim + 1> second = Eigen::Matrix<double, dim + 1, dim + 1>::Zero();

    void add(const SimplexFacet<dim>& facet)
    {
        area += facet.area;
        for (int q = 0; q < dim; ++q)
        {
            const Shape shape = Eigen::Map<const Shape>(facet.shape[q]);
            first += facet.weight[q] * shape;
            second += facet.weight[q] * shape * shape.transpose();
        }
    }

    /// Of equal weights, with the piece's moments to the second: mean + L d_q, L L^T the variance (of rank dim - 1), d_q the corners of a regular simplex around 0.
    void setPoints(SimplexFacet<dim>& facet) const
    {
        static const double corner[3][2] = {{std::sqrt(2.), 0}, {-std::sqrt(0.5), std::sqrt(1.5)}, {-std::sqrt(0.5), -std::sqrt(1.5)}};
        const Shape mean = first / area;
        Eigen::Matrix<double, dim + 1, dim + 1> variance = second / area - mean * mean.transpose();
        facet.area = area;
        for (int q = 0; q < dim; ++q)
        {
            facet.weight[q] = area / dim;
            Eigen::Map<Shape>(facet.shape[q]) = mean;
        }
        for (int k = 0; k < dim - 1; ++k) // columns of L: Cholesky with pivots
        {
            int pivot = 0;
            const double largest = variance.diagonal().maxCoeff(&pivot);
            if (!(largest > 0)) return;
            const Shape column = variance.col(pivot) / std::sqrt(largest);
            variance -= column * column.transpose();
            for (int q = 0; q < dim; ++q) Eigen::Map<Shape>(facet.shape[q]) += (dim == 2 ? 1. - 2 * q : corner[q][k]) * column;
        }
    }
};

} // namespace

template <int dim>
void mergePieces(std::vector<SimplexFacet<dim>>& facets)
{
    std::size_t nMerged = 0;
    std::vector<char> isDone(facets.size(), 0);
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
        if (isDone[f]) continue;
        SimplexFacet<dim> merged = facets[f];
        PlanePiece<dim> piece;
        int n = 0;
        for (std::size_t g = f; g < facets.size(); ++g)
        {
            if (isDone[g] || facets[g].solid != merged.solid || !std::equal(merged.normal, merged.normal + dim, facets[g].normal)) continue;
            piece.add(facets[g]);
            isDone[g] = 1;
            ++n;
        }
        if (n > 1) piece.setPoints(merged);
        facets[nMerged++] = merged; // nMerged <= f: what stood there is done
    }
    facets.resize(nMerged);
}

template void mergePieces<2>(std::vector<SimplexFacet<2>>&);
template void mergePieces<3>(std::vector<SimplexFacet<3>>&);

} // namespace flotsam
