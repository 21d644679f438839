// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/flowMeasures.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace flotsam
{

namespace
{

constexpr double leastWeight = 0.25;    // of gas
constexpr double halfFull = 0.5;        // largest alpha from which an element counts in full

/// Share of its Courant number that an element with this largest alpha counts with. Spray and mist are the fastest in a splash, hold
/// hardly any liquid, and their transport has time steps of its own.
double courantWeight(double alpha) { return std::clamp(alpha/halfFull, leastWeight, 1.0); }

double squaredSpeed(const SimplexMesh& mesh, const FlowState& state, int node)
{
    const double* u = &state.u[std::size_t(node)*mesh.dim];
    double square = 0;
    for (int d = 0; d < mesh.dim; ++d) square += u[d]*u[d];
    return square;
}

struct CourantSums
{
    double largest = 0, ofVolume[2] = {0, 0};   // of volume times rate, of volume
};

/// Over this rank's elements. In every step: the number of corners is known to the compiler.
template<int dim>
CourantSums courantSums(const SimplexMesh& mesh, const Cover* cover, const FlowState& state)
{
    CourantSums sums;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e] || (cover && cover->state[e] == ElementState::Solid)) continue;
        const int* nodes = &mesh.elements[std::size_t(e)*(dim + 1)];
        const CutElement* cut = cover && cover->state[e] == ElementState::Cut ? &cover->cuts[cover->cutIndex[e]] : nullptr;
        double u[dim] = {}, square = 0, alpha = 0;
        for (int a = 0; a <= dim; ++a)
        {
            alpha = std::max(alpha, state.alpha[nodes[a]]);
            const double share = cut ? cut->first[a]/cut->volume : 1.0/(dim + 1);
            for (int d = 0; d < dim; ++d) u[d] += share*state.u[std::size_t(nodes[a])*dim + d];
        }
        for (int d = 0; d < dim; ++d) square += u[d]*u[d];
        const double rate = std::sqrt(square)/mesh.h[e], volume = fluidVolume(mesh, cover, e);
        sums.largest = std::max(sums.largest, rate*courantWeight(alpha));
        sums.ofVolume[0] += volume*rate;
        sums.ofVolume[1] += volume;
    }
    return sums;
}

} // namespace

CourantRates courantRates(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const FlowState& state)
{
    CourantSums sums = mesh.dim == 2 ? courantSums<2>(mesh, cover, state) : courantSums<3>(mesh, cover, state);
    halo.sum(sums.ofVolume, 2);
    return {sums.ofVolume[1] > 0 ? sums.ofVolume[0]/sums.ofVolume[1] : 0, halo.max(sums.largest)};
}

double longestWay(const SimplexMesh& mesh, const Halo& halo, const std::vector<double>& width, const FlowState& state)
{
    double way = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
        if (state.alpha[i] >= gasOnly) way = std::max(way, std::sqrt(squaredSpeed(mesh, state, i))*state.dt/width[i]);
    return halo.max(way);
}

std::string describeFastest(const SimplexMesh& mesh, const Halo& halo, const FlowState& state, const Cover* cover, const std::vector<Solid>* solids)
{
    double best = -1;
    int at = -1;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const double speed = squaredSpeed(mesh, state, i);
        if (speed > best) { best = speed; at = i; }
    }
    const double fastest = halo.max(best);
    double where[6] = {}; // place, alpha, distance from the nearest solid, its number from 1 on
    const bool isHere = halo.min(best == fastest ? halo.rank() : halo.size()) == halo.rank();
    if (isHere && at >= 0)
    {
        const std::array<double, 3> x = mesh.spacePoint(at);
        std::copy(x.begin(), x.end(), where);
        where[3] = state.alpha[at];
        if (cover && cover->nearestSolid[at] >= 0)
        {
            where[4] = cover->distance[at];
            where[5] = 1 + cover->nearestSolid[at];
        }
    }
    halo.sum(where, 6);
    std::ostringstream text;
    text << "|u| = " << std::sqrt(fastest) << " m/s at (" << where[0] << ' ' << where[1] << ' ' << where[2] << "), alpha " << where[3];
    if (where[5] > 0) text << ", " << std::abs(where[4]) << (where[4] < 0 ? " m inside of '" : " m from '") << (*solids)[std::size_t(where[5]) - 1].name << '\'';
    return text.str();
}

double liquidVolume(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const std::vector<double>& alpha)
{
    const int n = mesh.dim + 1;
    double sum = 0;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e]) continue;
        const ElementState state = cover ? cover->state[e] : ElementState::Fluid;
        if (state == ElementState::Solid) continue;
        const CutElement* cut = state == ElementState::Cut ? &cover->cuts[cover->cutIndex[e]] : nullptr;
        for (int a = 0; a < n; ++a)
            sum += (cut ? cut->first[a] : mesh.volume[e]/n)*alpha[mesh.elements[std::size_t(e)*n + a]];
    }
    return mesh.thickness*halo.sum(sum);
}

void findWetFractions(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, std::size_t nSolids,
    const std::vector<double>& alpha, std::vector<double>& result)
{
    std::vector<double>& sums = result; // wet area and area of each, until they are divided
    sums.assign(2*nSolids, 0.0);
    for (std::size_t f = 0; cover && f < cover->facets.size(); ++f)
    {
        const CutFacet& facet = cover->facets[f];
        if (!mesh.isOwnedElement[facet.element]) continue;
        double wet = 0;
        for (int q = 0; q < facet.nPoints; ++q)
            for (int a = 0; a <= mesh.dim; ++a)
                wet += facet.weight[q]*facet.shape[q][a]*alpha[mesh.elements[std::size_t(facet.element)*(mesh.dim + 1) + a]];
        sums[2*facet.solid] += wet;
        sums[2*facet.solid + 1] += facet.area;
    }
    if (nSolids) halo.sum(sums.data(), int(2*nSolids));
    for (std::size_t s = 0; s < nSolids; ++s) result[s] = sums[2*s + 1] > 0 ? sums[2*s]/sums[2*s + 1] : 0;
    result.resize(nSolids);
}

} // namespace flotsam
