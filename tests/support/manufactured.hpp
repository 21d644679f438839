// SPDX-License-Identifier: GPL-3.0-or-later
/// Steady manufactured solutions on sequences of box meshes.
#pragma once

#include "support/errorTable.hpp"
#include "support/forcedFlow.hpp"

namespace flotsam
{

/// Trigonometric velocity whose Laplacian does not vanish, trigonometric pressure.
ExactFlow waves(int dim);

/// Velocity that is the gradient of a harmonic function (laplace u = 0), the same pressure.
ExactFlow potentialFlow(int dim);

/// Errors of the steady flow on the unit square or cube with n cells a side; interior nodes moved by `moved` cells. Collective.
ErrorTable steadyErrors(int dim, const char* title, const ExactFlow& exact, double rho, double mu, const std::vector<int>& sizes,
    double moved);

} // namespace flotsam
