// SPDX-License-Identifier: GPL-3.0-or-later
/// Potential flows between slip patches: what one step makes of fluid at rest under pressures on open patches.
#pragma once

#include "equations/fluid.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace flotsam
{

/// Patch of this index open, with the pressure that sets fluid of density 1 moving with grad `potential` (of a point) within a step of dt [s].
template<class Potential>
BoundaryPatch drivenPatch(const SimplexMesh& mesh, int index, double dt, Potential potential)
{
    BoundaryPatch patch = makePatch(mesh, index, BoundaryPatch::Velocity::Open);
    patch.evaluate = [&mesh, dt, potential, nodes = patch.nodes](const BoundaryState&, PatchValues& values)
    {
        values.pressure.clear();
        for (int i : nodes) values.pressure.push_back(-potential(&mesh.x[std::size_t(i)*mesh.dim])/dt);
        values.alpha.assign(nodes.size(), 1);
    };
    return patch;
}

/// Fluid after one step from rest.
inline FlowState afterOneStep(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& properties, std::vector<BoundaryPatch> patches, double dt)
{
    usePetsc();
    NumericsControls controls;
    controls.tolerance = 1e-10;
    Fluid fluid(mesh, halo, properties, controls, std::move(patches));
    fluid.start(restState(mesh), true);
    fluid.beginStep(dt);
    fluid.assemble();
    REQUIRE(fluid.solve({}).hasConverged);
    fluid.endStep();
    return fluid.state();
}

/// Nodal L2 error of the first two components over the norm of `exact` (of a point); isLeftOut: of a point.
template<class Exact, class IsLeftOut>
double planeFlowError(const SimplexMesh& mesh, const Halo& halo, const FlowState& state, Exact exact, IsLeftOut isLeftOut)
{
    double error = 0, norm = 0;
    for (int i = 0; i < mesh.nOwned; ++i)
    {
        const double* x = &mesh.x[std::size_t(i)*mesh.dim];
        if (isLeftOut(x)) continue;
        const std::array<double, 2> u = exact(x);
        for (int d = 0; d < 2; ++d)
        {
            error += std::pow(state.u[std::size_t(i)*mesh.dim + d] - u[d], 2);
            norm += u[d]*u[d];
        }
    }
    return std::sqrt(halo.sum(error)/halo.sum(norm));
}

/// Largest velocity component of any node [m/s].
inline double largestComponent(const SimplexMesh& mesh, const Halo& halo, const FlowState& state)
{
    double largest = 0;
    for (int i = 0; i < mesh.nOwned*mesh.dim; ++i) largest = std::max(largest, std::abs(state.u[i]));
    return halo.max(largest);
}

} // namespace flotsam
