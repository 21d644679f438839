// SPDX-License-Identifier: GPL-3.0-or-later
/// What restores the profile where nothing flows (docs/numerics.md, section 4).
#include "equations/dualCellTransport.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

constexpr double mostOfDisagreement = 0.1;  // that a pair gives up in a part of the step: explicit
constexpr double sameSurface = 0.5;         // least cosine between the planes of two cells of one surface

/// alpha that a cell's mean gains per length by which its surface moves [1/m].
double capacity(double alpha, double width)
{
    return variation(alpha)/width;
}

} // namespace

/// By how much node i puts the surface further into the gas than node j does [m], times the square of the cosine between their connection and
/// the surface's normal: beside each other they may differ. By the mean of both planes, which is exact to the third order on a bent surface.
template<int dim>
double DualCellTransport::disagreement(const Arguments& in, int i, int j) const
{
    const InterfacePlanes& planes = in.surface->planes;
    const auto isFront = [&](int k) {
        return reconstruction_.kind(k) == ProfileKind::Front && planes.has(k) && (!in.cover || in.cover->isActiveNode[k]);
    };
    if (!isFront(i) || !isFront(j)) return 0;
    double along = 0, square = 0, cosine = 0;
    for (int d = 0; d < dim; ++d)
    {
        const double t = mesh_.x[std::size_t(j)*dim + d] - mesh_.x[std::size_t(i)*dim + d];
        along += 0.5*(planes.normal(i)[d] + planes.normal(j)[d])*t;
        square += t*t;
        cosine += planes.normal(i)[d]*planes.normal(j)[d];
    }
    if (cosine < sameSurface) return 0;
    return along*along/square*(in.surface->distance[i] + along - in.surface->distance[j]);
}

/// The Allen-Cahn flux of eq 6 for cells that disagree about the surface: what one has too much of goes to the other. A profile that all cells
/// agree on is left alone on any mesh. gamma is about the speed sqrt(g h) of the shortest waves instead of |u|max: water at rest needs it.
template<int dim>
void DualCellTransport::keepProfile(const Arguments& in)
{
    using Pairs = CornerPairs<dim>;
    constexpr int n = dim + 1;
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
        const int e = stored_[active_[k]];
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        const double share = std::min(mostOfDisagreement, timeStep(in, activeLevel_[k])*in.surface->rate/std::sqrt(mesh_.h[e]));
        const double volume = share*fluidVolume(mesh_, in.cover, e)/n;
        for (int p = 0; p < Pairs::count; ++p)
        {
            const int i = nodes[Pairs::first[p]], j = nodes[Pairs::second[p]];
            const double distance = disagreement<dim>(in, i, j);
            if (distance == 0) continue;
            const double own = capacity(in.alpha[i], width_[i]), other = capacity(in.alpha[j], width_[j]);
            antiFlux_[k*Pairs::count + p] += volume*distance*2*own*other/(own + other);
        }
    }
}

template void DualCellTransport::keepProfile<2>(const Arguments&);
template void DualCellTransport::keepProfile<3>(const Arguments&);

} // namespace flotsam
