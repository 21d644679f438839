// SPDX-License-Identifier: GPL-3.0-or-later
/// Momentum and energy of the fluid and what acts on it, from the discrete equations.
#pragma once

#include "equations/fluid.hpp"

namespace flotsam
{

/// Space frame; 2D: times the thickness.
struct FluidBudget
{
    Vec3 momentum = Vec3::Zero();   ///< int rho u [N s]
    Vec3 weight = Vec3::Zero();     ///< int rho g [N]
    double kinetic = 0;             ///< int rho u.u/2 [J]
    double potential = 0;           ///< - int rho g.x [J]
};

/// Integrals over the fluid part (cover null: everywhere), exact for P1 u and element means of rho. Collective.
FluidBudget fluidBudget(const Fluid& fluid, const FluidProperties& properties, const NumericsControls& controls, const Cover* cover);

/// Force of the mesh's walls on the fluid in the last accepted step: residual of the rows of their prescribed velocities. Collective.
Vec3 wallReaction(const Fluid& fluid);

} // namespace flotsam
