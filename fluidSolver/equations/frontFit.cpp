// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/frontFit.hpp"
#include "equations/profileMeans.hpp"
#include "equations/profileReconstruction.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

template<int dim>
bool fitFront(const SurfaceSample* samples, int nSamples, double steepness, Front<dim>& front)
{
    using S = SurfaceShape<dim>;
    constexpr int across = S::size, size = S::size + 1;
    const int nGroups = (nSamples + nLanes - 1)/nLanes;
    Lanes alpha[maxGroups], rows[size][maxGroups], distance[maxGroups];    // rows and distances times the roots of the weights
    for (int k = 0; k < nGroups*nLanes; ++k)
    {
        const SurfaceSample& sample = samples[std::min(k, nSamples - 1)];
        alpha[k/nLanes][k % nLanes] = sample.alpha;
        distance[k/nLanes][k % nLanes] = sample.thickness;
        const double root = k < nSamples ? 4*variation(sample.alpha) : 0;
        double shape[size];
        S::derivatives(sample.along, shape);
        shape[across] = sample.across;
        for (int i = 0; i < size; ++i)
        {
            rows[i][k/nLanes][k % nLanes] = root*shape[i];
        }
    }
    frontsFromMeans(alpha[0].data(), distance[0].data(), nGroups*nLanes);
    for (int g = 0; g < nGroups; ++g)
    {
        distance[g] *= rows[0][g]/steepness;
    }
    double matrix[size][size], unknown[size];
    for (int i = 0; i < size; ++i)
    {
        unknown[i] = sumOfProducts(rows[i], distance, nGroups);
        for (int j = i; j < size; ++j)
        {
            matrix[i][j] = sumOfProducts(rows[i], rows[j], nGroups);
        }
    }
    for (int i = S::tilt; i < size; ++i)
    {
        matrix[i][i] += surfaceRidge;
    }
    unknown[across] += surfaceRidge;    // undetermined, it is that of a distance
    solveSymmetric(matrix, unknown);
    if (!(unknown[across] > 0))
    {
        return false;
    }
    double square = unknown[across]*unknown[across];
    for (int d = 0; d < S::tangents; ++d)
    {
        square += unknown[S::tilt + d]*unknown[S::tilt + d];
    }
    const double length = std::sqrt(square);
    front.across = unknown[across]/length;
    std::transform(unknown + S::tilt, unknown + S::curvature, front.tilt, [length](double b) { return b/length; });
    std::transform(unknown + S::curvature, unknown + S::size, front.curvature, [length](double k) { return std::clamp(k/length, -largestCurvature, largestCurvature); });
    return true;
}

template bool fitFront<2>(const SurfaceSample*, int, double, Front<2>&);
template bool fitFront<3>(const SurfaceSample*, int, double, Front<3>&);

} // namespace flotsam
