// SPDX-License-Identifier: GPL-3.0-or-later
/// Facets of one cut element that count as one.
#include "equations/facetGroups.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

CutFacet facetOf(double angle, double area)
{
    CutFacet facet{};
    facet.normal[0] = std::cos(angle);
    facet.normal[1] = std::sin(angle);
    facet.area = area;
    facet.nPoints = 1;
    facet.weight[0] = area;
    for (double& shape : facet.shape[0]) shape = 1./3;
    return facet;
}

} // namespace

TEST_CASE("pieces of one face are one group whatever the round-off of their normals, two faces are two")
{
    Cover cover;
    cover.facets = {facetOf(0.3, 1), facetOf(0.3 + 1e-15, 2), facetOf(0.3 + 1e-3, 4)};
    cover.cuts.resize(1);
    cover.cuts[0].element = 0;
    cover.cuts[0].facetStart = 0;
    cover.cuts[0].facetEnd = 3;
    FacetGroups<2> ofCover;
    const std::vector<FacetGroup<2>>& groups = ofCover.of(cover, 1, 1);
    REQUIRE(groups.size() == 2);
    CHECK(groups[0].area == near(3, 1e-14));
    CHECK(groups[1].area == near(4, 1e-14));
}
