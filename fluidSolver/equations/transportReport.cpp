// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/transportReport.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

double variation(double alpha)
{
    return std::max(0., alpha*(1 - alpha));
}

} // namespace

double liquidOf(const SimplexMesh& mesh, const std::vector<double>& dualVolume, const std::vector<double>& alpha)
{
    double sum = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        sum += dualVolume[i]*alpha[i];
    }
    return sum;
}

double largestSpeed(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& u)
{
    double largest = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        double square = 0;
        for (int d = 0; d < mesh.dim; ++d)
        {
            square += u[std::size_t(i)*mesh.dim + d]*u[std::size_t(i)*mesh.dim + d];
        }
        largest = std::max(largest, square);
    }
    return std::sqrt(halo.max(largest));
}

void restoreLiquid(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& dualVolume,
    std::vector<double>& alpha, TransportReport& report)
{
    constexpr int maxIterations = 5;    // more than one only when |c| would exceed 1
    const double target = report.liquidBefore + report.inflow - report.outflow;
    for (int iteration = 0; iteration < maxIterations; ++iteration)
    {
        double sums[2] = {liquidOf(mesh, dualVolume, alpha), 0};
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            sums[1] += dualVolume[i]*variation(alpha[i]);
        }
        halo.sum(sums, 2);
        const double missing = target - sums[0];
        report.liquidAfter = sums[0];
        if (iteration == 0)
        {
            report.redistributed = missing;
        }
        if (sums[1] <= 0 || std::abs(missing) <= 1e-15*std::abs(target))
        {
            return;
        }
        const double c = std::clamp(missing/sums[1], -1., 1.);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            alpha[i] += c*variation(alpha[i]);
        }
        if (std::abs(missing) <= sums[1])
        {
            report.liquidAfter = target;
            return;
        }
    }
}

} // namespace flotsam
