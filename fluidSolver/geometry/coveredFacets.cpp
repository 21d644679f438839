// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: what solids cover of each other's surfaces, see CoveredFacet.
#include "geometry/coverBuilder.hpp"

#include <algorithm>
#include <map>

namespace flotsam
{

/// Of solids that move or may.
void CoverBuilder::findCovered(Cover& cover, const std::vector<Solid>& solids)
{
    cover.coveredFacets.clear();
    cover.coveredVolumes.clear();
    std::map<int, CoveredVolume> volumes;
    const auto volumeOf = [&](int e) -> CoveredVolume& { return volumes.try_emplace(e, CoveredVolume{e, {}, {}}).first->second; };
    sharedCuts_.clear();
    for (const CutElement& cut : cover.cuts)
        if ((mesh_.isOwnedElement[cut.element] || cut.element < mesh_.nInnerElements) && isShared(cover, cover.nearestSolid[nodesOf(cut.element)[0]], cut.element)) sharedCuts_.push_back(cut.element);
    findSharedNodes(cover);
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].kind == Solid::Kind::Fixed) continue;
        const int solid = static_cast<int>(s);
        const auto isOthers = [&](const Sample& sample) { return cover.nearestSolid[sample.node] != solid; };
        if (std::none_of(samples_[s].begin(), samples_[s].end(), isOthers)) continue;
        forEachElementAlone(solids[s], samples_[s], [&](int e)
        {
            if (!isShared(cover, solid, e)) return;
            mesh_.dim == 2 ? addAlone<2>(cover, solids, solid, volumeOf(e)) : addAlone<3>(cover, solids, solid, volumeOf(e));
        }, [this](int node) { return isSharedNode_[node] != 0; });
    }
    for (int e : sharedCuts_) subtractCut(cover, solids, e);
    for (const CoveredFacet& facet : cover.coveredFacets) volumeOf(facet.element);
    for (auto& [element, volume] : volumes)
    {
        subtractSolidPart(cover, volume);
        cover.coveredVolumes.push_back(volume);
    }
}

/// Nodes of elements with nodes of several solids, among those that moving solids may cut: most of the elements around a body are its own.
void CoverBuilder::findSharedNodes(const Cover& cover)
{
    isSharedNode_.resize(mesh_.nNodes);
    for (int i : sharedNodes_) isSharedNode_[i] = 0;
    sharedNodes_.clear();
    for (int e : touchedElements_)
    {
        if (!isShared(cover, cover.nearestSolid[nodesOf(e)[0]], e)) continue;
        for (int a = 0; a <= mesh_.dim; ++a)
        {
            const int i = nodesOf(e)[a];
            if (isSharedNode_[i]) continue;
            isSharedNode_[i] = 1;
            sharedNodes_.push_back(i);
        }
    }
}

bool CoverBuilder::isShared(const Cover& cover, int solid, int element) const
{
    const int* nodes = nodesOf(element);
    return std::any_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return cover.nearestSolid[i] != solid; });
}

/// area: positive for the solid alone; shape: shape functions at the quadrature points, of equal weights.
void CoverBuilder::addCovered(Cover& cover, int solid, int element, double area, const double* normal, int nPoints, const double (*shape)[4]) const
{
    for (int q = 0; q < nPoints; ++q)
    {
        CoveredFacet& facet = cover.coveredFacets.emplace_back(CoveredFacet{element, solid, {}, {}});
        for (int d = 0; d < mesh_.dim; ++d) facet.area[d] = area / nPoints * normal[d];
        std::copy(shape[q], shape[q] + mesh_.dim + 1, facet.shape);
    }
}

template <int dim>
void CoverBuilder::addAlone(Cover& cover, const std::vector<Solid>& solids, int solid, CoveredVolume& volume) const
{
    visitCutAlone<dim>(solids[solid], volume.element, [&](const SimplexMoments<dim>& fluid, const SimplexFacet<dim>* facets, int nFacets)
    {
        addSolidPart(1, fluid.first, fluid.second, volume);
        for (int f = 0; f < nFacets; ++f)
        {
            double shape[3][4] = {};
            for (int q = 0; q < dim; ++q) std::copy(facets[f].shape[q], facets[f].shape[q] + dim + 1, shape[q]);
            addCovered(cover, solid, volume.element, facets[f].area, facets[f].normal, dim, shape);
        }
    });
}

/// What the cover has of the moving solids' surfaces.
void CoverBuilder::subtractCut(Cover& cover, const std::vector<Solid>& solids, int element) const
{
    const CutElement& cut = cover.cuts[cover.cutIndex[element]];
    for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        if (const CutFacet& facet = cover.facets[f]; solids[facet.solid].kind != Solid::Kind::Fixed)
            addCovered(cover, facet.solid, element, -facet.area, facet.normal, facet.nPoints, facet.shape);
}

/// Of an element nearest to one solid alone, into which another reaches, it is what the one cuts out, which is not in the sum.
void CoverBuilder::subtractSolidPart(const Cover& cover, CoveredVolume& volume) const
{
    const double none[16] = {};
    const int e = volume.element;
    if (!isShared(cover, cover.nearestSolid[nodesOf(e)[0]], e)) return;
    if (cover.state[e] == ElementState::Solid) addSolidPart(-1, none, none, volume);
    else if (cover.state[e] == ElementState::Cut) addSolidPart(-1, cover.cuts[cover.cutIndex[e]].first, cover.cuts[cover.cutIndex[e]].second, volume);
}

/// first, second: moments of the fluid part.
void CoverBuilder::addSolidPart(double sign, const double* first, const double* second, CoveredVolume& volume) const
{
    const int n = mesh_.dim + 1;
    const double share = mesh_.volume[volume.element] / n;
    for (int a = 0; a < n; ++a)
    {
        volume.first[a] += sign * (share - first[a]);
        for (int b = 0; b < n; ++b) volume.second[a * n + b] += sign * (share * (a == b ? 2 : 1) / (n + 1) - second[a * n + b]);
    }
}

} // namespace flotsam
