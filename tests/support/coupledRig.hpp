// SPDX-License-Identifier: GPL-3.0-or-later
/// What a coupled step refers to, for tests that drive it directly.
#pragma once

#include "demCoupling/coupling/coupledStep.hpp"
#include "support/flowCases.hpp"

#include <utility>

namespace flotsam
{

/// One fluid at the defaults, no patches yet; must outlive the steps made of it.
struct CoupledRig
{
    SimplexMesh mesh;
    Halo halo{mesh, MPI_COMM_WORLD};
    FluidProperties fluid;
    NumericsControls controls;
    std::vector<BoundaryPatch> patches;
    PhaseTimers timers;

    explicit CoupledRig(SimplexMesh m) : mesh(std::move(m))
    {
        usePetsc();
        fluid.isTwoPhase = false;
    }
};

} // namespace flotsam
