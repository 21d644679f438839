// SPDX-License-Identifier: GPL-3.0-or-later
/// CoverBuilder: what solids cover of each other's surfaces, see CoveredFacet.
#include "geometry/coverBuilder.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// Of solids that move or may; what fixed ones lose is the reaction, but for what they cover of each other.
void CoverBuilder::findCovered(Cover& cover, const std::vector<Solid>& solids)
{
    cover.coveredFacets.clear();
    sharedCuts_.clear();
    for (const CutElement& cut : cover.cuts)
        if ((mesh_.isOwnedElement[cut.element] || cut.element < mesh_.nInnerElements) && isShared(cover, cover.nearestSolid[nodesOf(cut.element)[0]], cut.element)) sharedCuts_.push_back(cut.element);
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (solids[s].kind == Solid::Kind::Fixed) continue;
        const int solid = static_cast<int>(s);
        const auto isOthers = [&](const Sample& sample) { return cover.nearestSolid[sample.node] != solid; };
        if (std::none_of(samples_[s].begin(), samples_[s].end(), isOthers)) continue;
        forEachElementAlone(solids[s], samples_[s], [&](int e)
        {
            if (!isShared(cover, solid, e)) return;
            mesh_.dim == 2 ? addAlone<2>(cover, solids, solid, e) : addAlone<3>(cover, solids, solid, e);
        });
        for (int e : sharedCuts_) subtractCut(cover, solids, solid, e);
    }
}

bool CoverBuilder::isShared(const Cover& cover, int solid, int element) const
{
    const int* nodes = nodesOf(element);
    return std::any_of(nodes, nodes + mesh_.dim + 1, [&](int i) { return cover.nearestSolid[i] != solid; });
}

/// area: positive for the solid alone; shape: shape functions at the dim quadrature points.
void CoverBuilder::addCovered(Cover& cover, const std::vector<Solid>& solids, int solid, int element, double area, const double* normal, const double (*shape)[4]) const
{
    CoveredFacet& facet = cover.coveredFacets.emplace_back(CoveredFacet{element, solid, -1, {}, {}});
    for (int d = 0; d < mesh_.dim; ++d) facet.area[d] = area * normal[d];
    for (int q = 0; q < mesh_.dim; ++q)
        for (int a = 0; a <= mesh_.dim; ++a) facet.shape[a] += shape[q][a] / mesh_.dim;
    facet.other = nearestOther(cover, solids, solid, element, facet.shape);
}

template <int dim>
void CoverBuilder::addAlone(Cover& cover, const std::vector<Solid>& solids, int solid, int element) const
{
    visitCutAlone<dim>(solids[solid], element, [&](const SimplexMoments<dim>&, const SimplexFacet<dim>* facets, int nFacets)
    {
        for (int f = 0; f < nFacets; ++f)
        {
            double shape[3][4] = {};
            for (int q = 0; q < dim; ++q) std::copy(facets[f].shape[q], facets[f].shape[q] + dim + 1, shape[q]);
            addCovered(cover, solids, solid, element, facets[f].area, facets[f].normal, shape);
        }
    });
}

/// What the cover has of the solid's surface.
void CoverBuilder::subtractCut(Cover& cover, const std::vector<Solid>& solids, int solid, int element) const
{
    const CutElement& cut = cover.cuts[cover.cutIndex[element]];
    for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        if (const CutFacet& facet = cover.facets[f]; facet.solid == solid) addCovered(cover, solids, solid, element, -facet.area, facet.normal, facet.shape);
}

int CoverBuilder::nearestOther(const Cover& cover, const std::vector<Solid>& solids, int solid, int element, const double* shape) const
{
    const Vec3 x = pointIn(element, shape);
    int nearest = -1;
    double least = 2 * farDistance;
    for (int a = 0; a <= mesh_.dim; ++a)
    {
        const int s = cover.nearestSolid[nodesOf(element)[a]];
        if (s < 0 || s == solid || s == nearest) continue;
        const double d = std::abs(solids[s].distance(x));
        if (d > least || (d == least && s > nearest)) continue;
        least = d;
        nearest = s;
    }
    return nearest;
}

} // namespace flotsam
