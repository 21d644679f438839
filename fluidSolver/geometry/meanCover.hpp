// SPDX-License-Identifier: GPL-3.0-or-later
/// The geometry during a step in which solids move.
#pragma once

#include "geometry/cover.hpp"

namespace flotsam
{

/// Copies what a step still reads of the cover at its start: states, cut elements, facets and active nodes. Not what bodies cover of each other, the largest part.
void keepForMean(const Cover& cover, Cover& kept);

/// Mean over the step of what is fluid: moments of `start` and `end`, half each. Only states, cut elements and active nodes are set; its facets are those of `start` and `end`
/// (forEachFacet()). An element counts as whole only if it is at both times.
void setMeanCover(const SimplexMesh& mesh, const Cover& start, const Cover& end, Cover& mean);

/// visit(facet, share of it) of an element's facets: of a mean halves of those at both times.
template <class Visit>
void forEachFacet(const Cover& cover, int element, Visit visit)
{
    const auto visitAll = [&](const Cover& of, double share)
    {
        if (of.state[element] != ElementState::Cut) return;
        const CutElement& cut = of.cuts[of.cutIndex[element]];
        for (int f = cut.facetStart; f < cut.facetEnd; ++f) visit(of.facets[f], share);
    };
    if (!cover.start) return visitAll(cover, 1);
    visitAll(*cover.start, 0.5);
    visitAll(*cover.end, 0.5);
}

} // namespace flotsam
