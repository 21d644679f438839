// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: what solids cover of each other's surfaces, see CoveredFacet.
#include "geometry/coverBuilder.hpp"

#include <algorithm>

namespace flotsam
{

/// Of solids that move or may.
void CoverBuilder::findCovered(Cover& cover, const std::vector<Solid>& solids)
{
    cover.coveredFacets.clear();
    cover.coveredVolumes.clear();
    cover.areSolidsClose = false;
    findSharedNodes(cover);
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].kind == Solid::Kind::Fixed) continue;
        const int solid = static_cast<int>(s);
        const auto isOthers = [&](const Sample& sample) { return cover.nearestSolid[sample.node] != solid || isSharedNode_[sample.node]; };
        if (std::none_of(samples_[s].begin(), samples_[s].end(), isOthers)) continue;
        forEachElementAlone(solids[s], samples_[s], [&](int e)
        {
            if (!isShared(cover, solid, e)) return;
            mesh_.dim == 2 ? addAlone<2>(cover, solids, solid, e) : addAlone<3>(cover, solids, solid, e);
        }, [this](int node) { return isSharedNode_[node] != 0; });
    }
    for (const CutElement& cut : cover.cuts)
        if (cut.element < mesh_.nInnerElements && isShared(cover, cover.nearestSolid[nodesOf(cut.element)[0]], cut.element))
            subtractCut(cover, solids, cut);
    for (CoveredVolume& volume : cover.coveredVolumes)
    {
        subtractSolidPart(cover, volume);
        coveredVolumeOf_[volume.element] = -1;
    }
}

/// That of the element, a new one at first.
CoveredVolume& CoverBuilder::coveredVolume(Cover& cover, int element)
{
    if (coveredVolumeOf_.empty()) coveredVolumeOf_.assign(mesh_.nElements, -1);
    int& position = coveredVolumeOf_[element];
    if (position >= 0) return cover.coveredVolumes[position];
    position = static_cast<int>(cover.coveredVolumes.size());
    return cover.coveredVolumes.emplace_back(CoveredVolume{element, {}});
}

/// Nodes of elements with nodes of several solids, among those that moving solids may cut: most of the elements around a body are its own.
void CoverBuilder::findSharedNodes(Cover& cover)
{
    for (int i : sharedNodes_) isSharedNode_[i] = 0;
    sharedNodes_.clear();
    for (int e : touchedElements_)
    {
        const bool isClear = isAmongSharp(e) && sharpElement_[e] == SharpElement::Clear, isOfSeveral = !isClear && isShared(cover, cover.nearestSolid[nodesOf(e)[0]], e);
        cover.areSolidsClose = cover.areSolidsClose || isClear || isOfSeveral;
        if (!isOfSeveral) continue;
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
    if (isAmongSharp(element) && sharpElement_[element] != SharpElement::Alone) return sharpElement_[element] != SharpElement::Clear;
    const int* nodes = nodesOf(element);
    return std::any_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return cover.nearestSolid[i] != solid; });
}

/// area: positive for the solid alone; shape: shape functions at the quadrature points, nCorners each.
template <int nCorners>
void CoverBuilder::addCovered(Cover& cover, int solid, int element, double area, const double* normal, int nPoints, const double (*shape)[nCorners]) const
{
    CoveredFacet& facet = cover.coveredFacets.emplace_back();
    facet.element = element;
    facet.solid = solid;
    facet.nPoints = nPoints;
    for (int d = 0; d < mesh_.dim; ++d) facet.area[d] = area / nPoints * normal[d];
    for (int q = 0; q < nPoints; ++q) std::copy(shape[q], shape[q] + nCorners, facet.shape[q]);
}

template <int dim>
void CoverBuilder::addAlone(Cover& cover, const std::vector<Solid>& solids, int solid, int element)
{
    visitCutAlone<dim>(solids[solid], element, [&](const SimplexMoments<dim>& fluid, const SimplexFacet<dim>* facets, int nFacets)
    {
        addSolidPart(1, fluid.second, coveredVolume(cover, element));
        for (int f = 0; f < nFacets; ++f) addCovered(cover, solid, element, facets[f].area, facets[f].normal, dim, facets[f].shape);
    });
}

/// What the cover has of the moving solids' surfaces.
void CoverBuilder::subtractCut(Cover& cover, const std::vector<Solid>& solids, const CutElement& cut)
{
    for (int f = cut.facetStart; f < cut.facetEnd; ++f)
    {
        const CutFacet& facet = cover.facets[f];
        if (solids[facet.solid].kind == Solid::Kind::Fixed) continue;
        addCovered(cover, facet.solid, cut.element, -facet.area, facet.normal, facet.nPoints, facet.shape);
        coveredVolume(cover, cut.element);
    }
}

/// Of an element nearest to one solid alone, into which another reaches, it is what the one cuts out, which is not in the sum.
void CoverBuilder::subtractSolidPart(const Cover& cover, CoveredVolume& volume) const
{
    const double none[16] = {};
    const int e = volume.element;
    if (!isShared(cover, cover.nearestSolid[nodesOf(e)[0]], e)) return;
    if (cover.state[e] == ElementState::Solid) addSolidPart(-1, none, volume);
    else if (cover.state[e] == ElementState::Cut) addSolidPart(-1, cover.cuts[cover.cutIndex[e]].second, volume);
}

/// second: moments of the fluid part.
void CoverBuilder::addSolidPart(double sign, const double* second, CoveredVolume& volume) const
{
    const int n = mesh_.dim + 1;
    const double share = mesh_.volume[volume.element] / n / (n + 1);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) volume.second[a * n + b] += sign * (share * (a == b ? 2 : 1) - second[a * n + b]);
}

} // namespace flotsam
