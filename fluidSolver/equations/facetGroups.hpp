// SPDX-License-Identifier: GPL-3.0-or-later
/// Facets of the solids' surfaces, gathered by element, solid and direction: what the wall terms are integrated over.
#pragma once

#include "geometry/cover.hpp"

#include <vector>

namespace flotsam
{

/// The facets of one solid in one cut element that look the same way, integrated.
template<int D>
struct FacetGroup
{
    int element, solid, cut;
    double normal[D], area;
    double m1[D + 1], m2[(D + 1)*(D + 1)]; ///< int N_a, int N_a N_b

    /// int N_a N_b with N_a and N_b replaced by their means.
    double ofMeans(int a, int b) const { return m1[a]*m1[b]/area; }
};

/// Those of a cover; its memory is kept from step to step.
template<int D>
class FacetGroups
{
public:
    /// In the order of the solids; of the first `nInner` elements. Valid until the next one.
    const std::vector<FacetGroup<D>>& of(const Cover& cover, int nInner, std::size_t nSolids);

private:
    void sortBySolid(std::size_t nSolids);

    std::vector<FacetGroup<D>> found_, sorted_;
    std::vector<std::size_t> next_; // of each solid: place of its next group
};

} // namespace flotsam
