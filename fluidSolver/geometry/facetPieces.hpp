// SPDX-License-Identifier: GPL-3.0-or-later
/// Pieces of a plane face joined to one facet; private to geometry.
#pragma once

#include "geometry/cutSimplex.hpp"

namespace flotsam
{

/// One facet for all pieces of a face: their moments to the second are all that walls take of them. Pieces of a face have one normal, to the last bit.
template <int dim>
void mergePieces(std::vector<SimplexFacet<dim>>& facets);

} // namespace flotsam
