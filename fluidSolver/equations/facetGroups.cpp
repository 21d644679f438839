// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/facetGroups.hpp"

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
std::vector<FacetGroup<D>> groupFacets(const Cover& cover, int nInner)
{
    std::vector<FacetGroup<D>> groups;
    for (std::size_t c = 0; c < cover.cuts.size(); ++c)
    {
        const CutElement& cut = cover.cuts[c];
        if (cut.element >= nInner) continue;
        const std::size_t first = groups.size();
        for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        {
            const CutFacet& facet = cover.facets[f];
            std::size_t g = first;
            while (g < groups.size() && !looksAlike(groups[g], facet)) ++g;
            if (g == groups.size()) groups.push_back(emptyGroup<D>(cut.element, int(c), facet));
            integrate(facet, groups[g]);
        }
    }
    std::stable_sort(groups.begin(), groups.end(), [](const auto& l, const auto& r) { return l.solid < r.solid; });
    return groups;
}

template std::vector<FacetGroup<2>> groupFacets<2>(const Cover&, int);
template std::vector<FacetGroup<3>> groupFacets<3>(const Cover&, int);

} // namespace flotsam
