// SPDX-License-Identifier: GPL-3.0-or-later
/// Start state of water at rest below a level surface.
#pragma once

#include "equations/fluid.hpp"
#include "equations/surfaceLevel.hpp"
#include "support/flowCases.hpp"

namespace flotsam
{

/// Water below `level` on the last axis of `fluid`'s mesh, alpha as means of the profile over dual cells, p = 0. profile: its width at a place over the default one. Collective.
inline FlowState waterAtRest(const Fluid& fluid, double level, const std::function<double(const double* x)>& profile = {})
{
    const SimplexMesh& mesh = fluid.mesh();
    const int dim = mesh.dim;
    const DualCells cells(mesh);
    const std::vector<double>& width = fluid.profileWidth();
    double down[3] = {};
    down[dim - 1] = -1;
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        const double* x = &mesh.x[std::size_t(i)*dim];
        state.alpha[i] = profileSlab(&cells, i, down, level - x[dim - 1], width[i]*(profile ? profile(x) : 1)).mean();
    }
    fluid.halo().update(state.alpha, 1);    // cells of second-ring copies are not whole
    state.alphaOld = state.alphaOlder = state.alpha;
    return state;
}

} // namespace flotsam
