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

} // namespace

/// alpha that a cell's mean gains per length by which its surface moves [1/m]; 0 in cells without one.
double DualCellTransport::profileCapacity(const Arguments& in, int i) const
{
    const bool hasSurface = reconstruction_.kind(i) == ProfileKind::Front && in.surface->planes.has(i) && (!in.cover || in.cover->isActiveNode[i]);
    return hasSurface ? variation(in.alpha[i])/width_[i] : 0;
}

/// By how much node i puts the surface further into the gas than node j does [m], times the square of the cosine between their connection and
/// the surface's normal: beside each other they may differ. By the mean of both planes, which is exact to the third order on a bent surface.
/// Both nodes have a surface.
template<int dim>
double DualCellTransport::disagreement(const Arguments& in, int i, int j) const
{
    const InterfacePlanes& planes = in.surface->planes;
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
    for (std::size_t k : frontElements_)
    {
        const int e = stored_[active_[k]];
        const int* nodes = &mesh_.elements[std::size_t(e)*n];
        double capacity[n];
        for (int a = 0; a < n; ++a) capacity[a] = profileCapacity(in, nodes[a]);
        const double share = std::min(mostOfDisagreement, timeStep(in, activeLevel_[k])*in.surface->rate/std::sqrt(mesh_.h[e]));
        const double volume = share*fluidVolume(mesh_, in.cover, e)/n;
        for (int p = 0; p < Pairs::count; ++p)
        {
            const int a = Pairs::first[p], b = Pairs::second[p], i = nodes[a], j = nodes[b];
            if (capacity[a] == 0 || capacity[b] == 0) continue;
            const double distance = disagreement<dim>(in, i, j);
            if (distance == 0) continue;
            antiFlux_[k*Pairs::count + p] += volume*distance*2*capacity[a]*capacity[b]/(capacity[a] + capacity[b]);
        }
    }
}

template void DualCellTransport::keepProfile<2>(const Arguments&);
template void DualCellTransport::keepProfile<3>(const Arguments&);

} // namespace flotsam
