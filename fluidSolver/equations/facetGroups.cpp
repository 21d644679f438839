// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/facetGroups.hpp"

#include "core/roomyVector.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

/// Angle up to which facets lie on one face: where parts of a union divide the face, each piece has its normal with its own round-off. Terms of means over a group must not
/// depend on that.
constexpr double sameNormal = 1e-6;

template<int D>
bool looksAlike(const FacetGroup<D>& group, const CutFacet& facet)
{
    double square = 0;
    for (int d = 0; d < D; ++d) square += (facet.normal[d] - group.normal[d])*(facet.normal[d] - group.normal[d]);
    return group.solid == facet.solid && square < sameNormal*sameNormal;
}

template<int D>
FacetGroup<D> emptyGroup(int element, int cut, const CutFacet& facet)
{
    FacetGroup<D> group{};
    group.element = element;
    group.solid = facet.solid;
    group.cut = cut;
    std::copy(facet.normal, facet.normal + D, group.normal);
    return group;
}

template<int D>
void integrate(const CutFacet& facet, FacetGroup<D>& group)
{
    constexpr int N = D + 1;
    group.area += facet.area;
    for (int q = 0; q < facet.nPoints; ++q)
        for (int a = 0; a < N; ++a)
        {
            const double wa = facet.weight[q]*facet.shape[q][a];
            group.m1[a] += wa;
            for (int b = 0; b < N; ++b) group.m2[a*N + b] += wa*facet.shape[q][b];
        }
}

} // namespace

template<int D>
const std::vector<FacetGroup<D>>& FacetGroups<D>::of(const Cover& cover, int nInner, std::size_t nSolids)
{
    found_.clear();
    reserveRoom(found_, cover.facets.size());
    for (std::size_t c = 0; c < cover.cuts.size(); ++c)
    {
        const CutElement& cut = cover.cuts[c];
        if (cut.element >= nInner) continue;
        const std::size_t first = found_.size();
        for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        {
            const CutFacet& facet = cover.facets[f];
            std::size_t g = first;
            while (g < found_.size() && !looksAlike(found_[g], facet)) ++g;
            if (g == found_.size()) found_.push_back(emptyGroup<D>(cut.element, int(c), facet));
            integrate(facet, found_[g]);
        }
    }
    sortBySolid(nSolids);
    return sorted_;
}

/// By counting: those of one solid keep their order.
template<int D>
void FacetGroups<D>::sortBySolid(std::size_t nSolids)
{
    next_.assign(nSolids + 1, 0);
    for (const FacetGroup<D>& group : found_) ++next_[group.solid + 1];
    for (std::size_t s = 1; s <= nSolids; ++s) next_[s] += next_[s - 1];
    reserveRoom(sorted_, found_.size());
    sorted_.resize(found_.size());
    for (const FacetGroup<D>& group : found_) sorted_[next_[group.solid]++] = group;
}

template class FacetGroups<2>;
template class FacetGroups<3>;

} // namespace flotsam
