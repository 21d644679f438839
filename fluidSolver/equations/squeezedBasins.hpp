// SPDX-License-Identifier: GPL-3.0-or-later
/// Which structure changes the volume of fluid that nothing lets in or out.
#pragma once

#include "algebra/halo.hpp"
#include "geometry/cover.hpp"

#include <string>

namespace flotsam
{

/// Of the structures that move as prescribed the one that sweeps most in basins that have a pressure level to keep, and where: "'piston' about (0.1 0.4 0)"; empty: none does.
/// level: FlowSystem::level (nNodes, or empty: no such basins). Collective.
std::string describeSqueezed(const SimplexMesh& mesh, const Halo& halo, const Cover& cover, const std::vector<Solid>& solids, const std::vector<int>& level);

} // namespace flotsam
