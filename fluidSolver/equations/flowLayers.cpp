// SPDX-License-Identifier: GPL-3.0-or-later
/// Water between solids that lie on each other.
///
/// No element lies between them, so no pressure of the flow acts on what they cover of each other (CoveredFacet), and the fluid around would press them together: a bar
/// 2 cm thick under 10 cm of water with eight times its weight. Driftwood is not that smooth: water gets between. So the nodes there, which are inside the solids, have a pressure,
/// which acts on both solids alike; the continuity rows say that the volume that they leave each other comes from the fluid at the rim, along an unresolved layer as under bodies on walls
/// (flowFilms.cpp): in proportion to the gradient of pressure and weight. What the layer holds is not fluid to the transport: it moves when the gap reaches an element.
#include "equations/flowEquation.hpp"
#include "equations/rigidCoupling.hpp"
#include "equations/shutPockets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace flotsam
{

/// Owned nodes in solids and pockets, of elements with covered facets.
std::vector<int> FlowEquation::findLayerNodes() const
{
    std::vector<char> isOfLayer(mesh_.nNodes, 0);
    for (const CoveredFacet& facet : step_.cover->coveredFacets)
        for (int a = 0; a <= mesh_.dim; ++a) isOfLayer[mesh_.elements[std::size_t(facet.element)*(mesh_.dim + 1) + a]] = 1;
    std::vector<int> nodes;
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (isOfLayer[i] && (step_.cover->distance[i] < 0 || step_.pockets->isNode(i))) nodes.push_back(i);
    return nodes;
}

/// Of the nodes, those that fluid reaches along others. They get an unknown pressure; their velocity stays what it is.
void FlowEquation::findLayers()
{
    isLayerNode_.clear();
    if (!step_.cover || !step_.pockets || !halo_.any(!step_.cover->coveredFacets.empty())) return;
    std::vector<int> isReached(mesh_.nNodes), nodes = findLayerNodes();
    for (int i = 0; i < mesh_.nNodes; ++i) isReached[i] = system_.isActive[i] && step_.cover->distance[i] > 0 && !step_.pockets->isNode(i);
    isLayerNode_.assign(mesh_.nNodes, 0);
    for (bool areMore = true; areMore;)
    {
        std::vector<int> found, left;
        for (int i : nodes)
        {
            const auto begin = graph_.column.begin() + graph_.rowStart[i], end = graph_.column.begin() + graph_.rowStart[i + 1];
            (std::any_of(begin, end, [&](int j) { return isReached[j] != 0; }) ? found : left).push_back(i);
        }
        for (int i : found) isReached[i] = 2;
        halo_.update(isReached, 1);
        areMore = halo_.any(!found.empty());
        nodes.swap(left);
    }
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (isReached[i] != 2) continue;
        isLayerNode_[i] = 1;
        system_.isPressureFixed[i] = isPatchPressureFixed_[i];
        if (system_.isActive[i]) continue;
        system_.isActive[i] = 1;
        if (i < mesh_.nOwned) system_.constraints.push_back(wholeVelocity(i, mesh_.dim));
    }
    findLayerShares();
}

void FlowEquation::findLayerShares()
{
    layers_.clear();
    const std::vector<CoveredFacet>& facets = step_.cover->coveredFacets;
    coveredByElement_.resize(facets.size());
    std::iota(coveredByElement_.begin(), coveredByElement_.end(), 0);
    std::sort(coveredByElement_.begin(), coveredByElement_.end(), [&](int a, int b)
    {
        return std::tuple(facets[a].element, facets[a].solid, a) < std::tuple(facets[b].element, facets[b].solid, b);
    });
    for (std::size_t k = 0; k < facets.size();)
    {
        double covered[3] = {}, alone = 0;
        const CoveredFacet& first = facets[coveredByElement_[k]];
        for (; k < facets.size(); ++k)
        {
            const CoveredFacet& facet = facets[coveredByElement_[k]];
            if (facet.element != first.element || facet.solid != first.solid) break;
            const double* area = facet.area;
            for (int d = 0; d < 3; ++d) covered[d] += area[d];
            alone += std::hypot(area[0], area[1], area[2]);
        }
        const double share = std::min(1.0, std::hypot(covered[0], covered[1], covered[2])/alone);
        if (!layers_.empty() && layers_.back().element == first.element) layers_.back().share = std::max(layers_.back().share, share);
        else layers_.push_back({first.element, share});
    }
}

/// What flows along the layer in an element.
template<int D>
void FlowEquation::addLayerElement(int e, double share)
{
    constexpr int N = D + 1;
    const int* nodes = &mesh_.elements[std::size_t(e)*N];
    const double* grad = &mesh_.gradN[std::size_t(e)*N*D];
    double rho = 0;
    for (int a = 0; a < N; ++a) rho += nodal_.rho[nodes[a]]/N;
    const double conductance = share*layerThickness*mesh_.volume[e]*layerTime(mesh_.h[e])/rho;
    for (int a = 0; a < N; ++a)
        for (int b = a + 1; b < N; ++b)
        {
            if (!isLayerNode_[nodes[a]] && !isLayerNode_[nodes[b]]) continue;   // the flow's
            if (!system_.isActive[nodes[a]] || !system_.isActive[nodes[b]]) continue;
            double product = 0, hydrostatic = 0;
            for (int d = 0; d < D; ++d)
            {
                product += grad[a*D + d]*grad[b*D + d];
                hydrostatic += rho*fluid_.gravity[mesh_.axes[d]]*(mesh_.x[std::size_t(nodes[a])*D + d] - mesh_.x[std::size_t(nodes[b])*D + d]);
            }
            if (product < 0) addConductance<D>(nodes[a], nodes[b], -conductance*product, hydrostatic); // obtuse angles let nothing through
        }
}

/// The pressure on what others cover of solid s and it of others, and the volume that it makes room for by moving. Of two solids that move both list what they cover of each other: half each.
template<int D>
void FlowEquation::coupleLayers(int s)
{
    constexpr int N = D + 1, B = D + 1, nDof = RigidArm<D>::nDof;
    const std::vector<Solid>& solids = *step_.solids;
    SolidCoupling& coupling = system_.solids[s];
    for (std::size_t k = 0; k < coupling.node.size(); ++k) placeInSolid_[coupling.node[k]] = int(k);
    for (int k : coveredOf_[s])
    {
        const CoveredFacet& facet = step_.cover->coveredFacets[k];
        if (step_.cover->solidVolume[facet.other] == 0 && step_.cover->solidArea[facet.other] == 0) continue; // beside the mesh
        const int* nodes = &mesh_.elements[std::size_t(facet.element)*N];
        if (std::any_of(nodes, nodes + N, [&](int i) { return !system_.isActive[i]; })) continue;
        const double weight = (facet.solid == s ? 1 : -1)*(solids[facet.other].kind == Solid::Kind::Fixed ? 1 : 0.5);
        double force[D], load[nDof] = {};
        for (int d = 0; d < D; ++d) force[d] = weight*facet.area[d];
        RigidArm<D>(mesh_, solids[s], nodes, facet.shape).template addLoads<1>(force, load);
        for (int a = 0; a < N; ++a)
        {
            const std::size_t place = placeOf<D>(nodes[a], placeInSolid_, coupling);
            for (int d = 0; d < nDof; ++d)
            {
                if (mesh_.isOwnedElement[facet.element]) coupling.row[(place*nDof + d)*B + D] -= facet.shape[a]*load[d];
                if (facet.element < mesh_.nInnerElements && nodes[a] < mesh_.nOwned) coupling.column[(place*B + D)*nDof + d] += facet.shape[a]*load[d];
            }
        }
    }
    for (int i : coupling.node) placeInSolid_[i] = -1;
}

template<int D>
void FlowEquation::assembleLayers()
{
    if (isLayerNode_.empty()) return;
    for (int i = 0; i < mesh_.nOwned; ++i)
    {
        if (!isLayerNode_[i] || step_.cover->isActiveNode[i]) continue;
        addVelocity<D>(graph_.diagonal[i], 1);  // held: any
        system_.pressureMass[i] = 1e30;         // nothing viscous
    }
    for (const LayerElement& layer : layers_) addLayerElement<D>(layer.element, layer.share);
    coveredOf_.resize(system_.solids.size()); // many solids: not all facets for each
    for (std::vector<int>& facets : coveredOf_) facets.clear();
    for (std::size_t k = 0; k < step_.cover->coveredFacets.size(); ++k)
    {
        const CoveredFacet& facet = step_.cover->coveredFacets[k];
        if (facet.other < 0) continue;
        coveredOf_[facet.solid].push_back(int(k));
        coveredOf_[facet.other].push_back(int(k));
    }
    for (std::size_t s = 0; s < system_.solids.size(); ++s) coupleLayers<D>(int(s));
}

template void FlowEquation::assembleLayers<2>();
template void FlowEquation::assembleLayers<3>();

} // namespace flotsam
