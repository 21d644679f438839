// SPDX-License-Identifier: GPL-3.0-or-later
/// How the liquid of the dual cells is spread over the elements they consist of.
#pragma once

#include "algebra/halo.hpp"
#include "core/simplexMesh.hpp"
#include "geometry/cover.hpp"

#include <vector>

namespace flotsam
{

/// Liquid in the share of every corner of every element [m^dim] (nElements*(dim+1)). alpha: means over the dual cells, halo up to date; cover: null without
/// solids; width: of the profile, nNodes [m]. In each dual cell the surface is a plane normal to the gradient of alpha, placed so that the shares
/// together have what the cell has, to round-off; the less the gradients around agree (sheets, drops), the more evenly all of it is spread. P1 means of the
/// nodal values would smear the surface over an element and more. Collective; copies of nodes have their owners' planes: the same for any number of ranks.
std::vector<double> liquidShares(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const std::vector<double>& alpha, const std::vector<double>& width);

} // namespace flotsam
