// SPDX-License-Identifier: GPL-3.0-or-later
/// Water between solids that lie on each other.
///
/// No element lies between them, so no pressure of the flow acts on what they cover of each other (CoveredFacet), and the fluid around would press them together: a bar
/// 2 cm thick under 10 cm of water with eight times its weight. Driftwood is not that smooth: water gets between. So the nodes there, which are inside the solids, have
/// a pressure, which acts on both solids alike. Their continuity rows say that the volume between the solids is filled from the fluid at the rim, along an
/// unresolved layer as under bodies on walls (flowFilms.cpp): in proportion to the gradient of pressure and weight. What the layer holds is not fluid to the
/// transport: it moves when the gap reaches an element.
#include "equations/flowEquation.hpp"
#include "equations/rigidCoupling.hpp"
#include "equations/shutPockets.hpp"

#include <algorithm>
#include <cmath>
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
    findLayerSolids();
}

void FlowEquation::findLayerShares()
{
    layers_.clear();
    findCoveredRuns();
    const std::vector<CoveredFacet>& facets = step_.cover->coveredFacets;
    for (std::size_t k = 0; k < coveredRuns_.size();)
    {
        double covered[3] = {}, alone = 0;
        const CoveredRun first = coveredRuns_[k];
        for (; k < coveredRuns_.size() && coveredRuns_[k].element == first.element && coveredRuns_[k].solid == first.solid; ++k)
            for (int f = coveredRuns_[k].start; f < coveredRuns_[k].end; ++f)
            {
                const double* area = facets[f].area;
                for (int d = 0; d < 3; ++d) covered[d] += facets[f].nPoints*area[d];
                alone += facets[f].nPoints*std::hypot(area[0], area[1], area[2]);
            }
        const double share = std::min(1.0, std::hypot(covered[0], covered[1], covered[2])/alone);
        if (!layers_.empty() && layers_.back().element == first.element) layers_.back().share = std::max(layers_.back().share, share);
        else layers_.push_back({first.element, share});
    }
}

/// Pieces of one solid in one element, as they follow each other: a few runs of each, by element and solid.
void FlowEquation::findCoveredRuns()
{
    coveredRuns_.clear();
    const std::vector<CoveredFacet>& facets = step_.cover->coveredFacets;
    for (int f = 0; f < int(facets.size()); ++f)
    {
        const bool isNew = coveredRuns_.empty() || coveredRuns_.back().element != facets[f].element || coveredRuns_.back().solid != facets[f].solid;
        if (isNew) coveredRuns_.push_back({facets[f].element, facets[f].solid, f, f});
        coveredRuns_.back().end = f + 1;
    }
    std::sort(coveredRuns_.begin(), coveredRuns_.end(), [](const CoveredRun& a, const CoveredRun& b)
    {
        return std::tie(a.element, a.solid, a.start) < std::tie(b.element, b.solid, b.start);
    });
}

/// What flows along the layer in an element.
template<int D>
void FlowEquation::addLayerElement(int e, double share)
{
    constexpr int N = D + 1;
    const int* nodes = &mesh_.elements[std::size_t(e)*N];
    const double *grad = &mesh_.gradN[std::size_t(e)*N*D], *force = &(*step_.elementForce)[std::size_t(e)*D];
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
                hydrostatic += force[d]*(mesh_.x[std::size_t(nodes[a])*D + d] - mesh_.x[std::size_t(nodes[b])*D + d]);
            }
            if (product < 0) addConductance<D>(nodes[a], nodes[b], -conductance*product, hydrostatic); // obtuse angles let nothing through
        }
}

/// The nearest; beside fixed solids these, whose own surface is not among what is covered.
void FlowEquation::findLayerSolids()
{
    const std::vector<Solid>& solids = *step_.solids;
    const auto isFixed = [&](int s) { return s >= 0 && solids[s].kind == Solid::Kind::Fixed; };
    layerSolid_ = step_.cover->nearestSolid;
    for (const CoveredVolume& volume : step_.cover->coveredVolumes)
    {
        const int *nodes = &mesh_.elements[std::size_t(volume.element)*(mesh_.dim + 1)], *end = nodes + mesh_.dim + 1;
        int fixed = -1;
        for (const int* i = nodes; i < end; ++i)
            if (const int s = step_.cover->nearestSolid[*i]; isFixed(s) && (fixed < 0 || s < fixed)) fixed = s;
        for (const int* i = nodes; i < end && fixed >= 0; ++i) layerSolid_[*i] = isFixed(layerSolid_[*i]) ? std::min(layerSolid_[*i], fixed) : fixed;
    }
    halo_.update(layerSolid_, 1);
}

/// All of the element's nodes have a pressure, and its solids a part in the mesh.
template<int D>
bool FlowEquation::isOfLayer(int e) const
{
    const int* nodes = &mesh_.elements[std::size_t(e)*(D + 1)];
    return std::all_of(nodes, nodes + D + 1, [&](int i)
    {
        const int s = layerSolid_[i];
        return system_.isActive[i] && (s < 0 || step_.cover->solidVolume[s] != 0 || step_.cover->solidArea[s] != 0);
    });
}

/// Solid s's share of what the layer holds at a point of the element: the shares of all are 1.
template<int D>
double FlowEquation::layerShare(int s, int e, const double* shape) const
{
    double share = 0;
    for (int a = 0; a <= D; ++a)
        if (layerSolid_[mesh_.elements[std::size_t(e)*(D + 1) + a]] == s) share += shape[a];
    return share;
}

/// The load that the unit of pressure at corner a of the element exerts on a solid, and the volume that its motion makes room for.
template<int D>
void FlowEquation::addLayerLoad(int e, int a, const double* load, SolidCoupling& coupling)
{
    constexpr int B = D + 1, nDof = RigidArm<D>::nDof;
    const int node = mesh_.elements[std::size_t(e)*(D + 1) + a];
    const std::size_t place = placeOf<D>(node, placeInSolid_, coupling);
    for (int d = 0; d < nDof; ++d)
    {
        if (mesh_.isOwnedElement[e]) coupling.row[(place*nDof + d)*B + D] -= load[d];
        if (e < mesh_.nInnerElements && node < mesh_.nOwned) coupling.column[(place*B + D)*nDof + d] += load[d];
    }
}

/// The pressure on a piece of what is covered: on its solid, less what solid s has of the layer's content there.
template<int D>
void FlowEquation::addCoveredFacet(int s, const Turning<D>& turning, const CoveredFacet& facet, SolidCoupling& coupling)
{
    double atCorner[D + 1][RigidArm<D>::nDof] = {};
    for (int q = 0; q < facet.nPoints; ++q)
    {
        const double* shape = facet.shape[q];
        const double weight = (facet.solid == s) - layerShare<D>(s, facet.element, shape);
        double force[D], load[RigidArm<D>::nDof] = {};
        for (int d = 0; d < D; ++d) force[d] = weight*facet.area[d];
        RigidArm<D> arm(mesh_, (*step_.solids)[s], &mesh_.elements[std::size_t(facet.element)*(D + 1)], shape);
        arm.onSurface(turning, facet.area);
        arm.template addLoads<1>(force, load);
        arm.template removeTurning<1>(0, force, load);
        for (int a = 0; a <= D; ++a)
            for (int d = 0; d < RigidArm<D>::nDof; ++d) atCorner[a][d] += shape[a]*load[d];
    }
    for (int a = 0; a <= D; ++a) addLayerLoad<D>(facet.element, a, atCorner[a], coupling);
}

/// The rest of the share's surface, where one solid's goes over into another's.
template<int D>
void FlowEquation::addCoveredVolume(int s, const Turning<D>& turning, const CoveredVolume& volume, SolidCoupling& coupling)
{
    constexpr int N = D + 1;
    const int* nodes = &mesh_.elements[std::size_t(volume.element)*N];
    const double* grad = &mesh_.gradN[std::size_t(volume.element)*N*D];
    double ofShare[D] = {};
    for (int a = 0; a < N; ++a)
        for (int d = 0; d < D && layerSolid_[nodes[a]] == s; ++d) ofShare[d] += grad[a*D + d];
    for (int a = 0; a < N; ++a)
    {
        double load[RigidArm<D>::nDof] = {};
        for (int b = 0; b < N; ++b)
        {
            double force[D];
            for (int d = 0; d < D; ++d) force[d] = -volume.second[a*N + b]*ofShare[d];
            RigidArm<D> arm(mesh_, (*step_.solids)[s], nodes[b]);
            arm.onSurface(turning, ofShare);
            arm.template addLoads<1>(force, load);
            arm.template removeTurning<1>(0, force, load);
        }
        addLayerLoad<D>(volume.element, a, load, coupling);
    }
}

/// The weight of a moving solid's share of what the layer holds, which is as little of the flow as the solid is: without it the share's buoyancy would lift the solid.
/// What a structure's share is besides its own part is not known.
template<int D>
void FlowEquation::addLayerWeight(int s, const Turning<D>& turning, const CoveredVolume& volume)
{
    constexpr int N = D + 1, nDof = RigidArm<D>::nDof, nAxes = nDof - D;
    if (!mesh_.isOwnedElement[volume.element] || (*step_.solids)[s].kind == Solid::Kind::Fixed) return;
    const int* nodes = &mesh_.elements[std::size_t(volume.element)*N];
    double load[nDof] = {};
    for (int b = 0; b < N; ++b)
    {
        double share = 0, force[D];
        for (int a = 0; a < N; ++a)
            if (layerSolid_[nodes[a]] == s) share += volume.second[a*N + b];
        for (int d = 0; d < D; ++d) force[d] = -share*(*step_.elementForce)[std::size_t(volume.element)*D + d];
        RigidArm<D>(mesh_, (*step_.solids)[s], nodes[b]).template addLoads<1>(force, load);
    }
    double* sum = &ownLoads_[std::size_t(s)*nDof];
    for (int d = 0; d < nDof; ++d) sum[d] += load[d];
    for (int k = 0; k < nAxes; ++k) // nor has the pressure any moment about these axes
        for (int l = 0; l < nAxes; ++l) sum[D + k] -= turning.projection[k*nAxes + l]*load[D + l];
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
    coupleLayers<D>();
}

/// What solids cover of each other, and what it makes room for.
///
/// The pressure acts on all of a solid's covered surface, which with the cut one is closed. What two solids cover of each other is not the same surface, though, where
/// the cut between them rounds a corner or one overlaps another: the sum of the forces on both is that on a small volume between them (CoveredVolume), which
/// would be a force without a reaction. It is shared out, by P1 shares that are 1 at the nodes nearest to a solid: each share is the force on a closed surface, too.
template<int D>
void FlowEquation::coupleLayers()
{
    for (auto* lists : {&facetsOf_, &volumesOf_})
    {
        lists->resize(system_.solids.size());
        for (std::vector<int>& list : *lists) list.clear();
    }
    const auto addTo = [&](std::vector<std::vector<int>>& lists, int s, int k) { if (s >= 0 && (lists[s].empty() || lists[s].back() != k)) lists[s].push_back(k); };
    for (std::size_t k = 0; k < step_.cover->coveredFacets.size(); ++k)
    {
        const CoveredFacet& facet = step_.cover->coveredFacets[k];
        if (!isOfLayer<D>(facet.element)) continue;
        addTo(facetsOf_, facet.solid, int(k));
        for (int a = 0; a <= D; ++a) addTo(facetsOf_, layerSolid_[mesh_.elements[std::size_t(facet.element)*(D + 1) + a]], int(k));
    }
    for (std::size_t k = 0; k < step_.cover->coveredVolumes.size(); ++k)
    {
        const int e = step_.cover->coveredVolumes[k].element;
        if (!isOfLayer<D>(e)) continue;
        for (int a = 0; a <= D; ++a) addTo(volumesOf_, layerSolid_[mesh_.elements[std::size_t(e)*(D + 1) + a]], int(k));
    }
    for (std::size_t s = 0; s < system_.solids.size(); ++s)
    {
        SolidCoupling& coupling = system_.solids[s];
        for (std::size_t k = 0; k < coupling.node.size(); ++k) placeInSolid_[coupling.node[k]] = int(k);
        const Turning<D> turning(mesh_, (*step_.solids)[s]);
        for (int k : facetsOf_[s]) addCoveredFacet<D>(int(s), turning, step_.cover->coveredFacets[k], coupling);
        for (int k : volumesOf_[s])
        {
            addCoveredVolume<D>(int(s), turning, step_.cover->coveredVolumes[k], coupling);
            addLayerWeight<D>(int(s), turning, step_.cover->coveredVolumes[k]);
        }
        for (int i : coupling.node) placeInSolid_[i] = -1;
    }
}

template void FlowEquation::assembleLayers<2>();
template void FlowEquation::assembleLayers<3>();
template bool FlowEquation::isOfLayer<2>(int) const;
template bool FlowEquation::isOfLayer<3>(int) const;

} // namespace flotsam
