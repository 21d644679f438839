// SPDX-License-Identifier: GPL-3.0-or-later
/// How thick the phase field's profile is.
#pragma once

#include "algebra/halo.hpp"
#include "core/nodeGraph.hpp"

namespace flotsam
{

/// Interface width [m] per local node: `factor` times the mean length h of the elements around it or, where they are tall, times L - h, L the extent along `gravity`
/// (space axes, any size; zero: none) of the tallest. A level surface's place is read from the nodes of the elements that it cuts, up to L away, and the profile says
/// nothing beyond 11.5 widths (alpha 1e-5, facingElements.hpp): a thinner one in tall elements lets water at rest move (docs/numerics, 2.10). Collective.
std::vector<double> interfaceWidth(const SimplexMesh& mesh, const NodeGraph& graph, const Halo& halo, double factor, const std::array<double, 3>& gravity = {});

} // namespace flotsam
