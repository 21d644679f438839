// SPDX-License-Identifier: GPL-3.0-or-later
/// Gravity as a force per element that is exactly the gradient of a P1 function when the fluid rests.
///
/// In an element with a density gradient, f = sum_k grad N_k rho_k g.(x_k - x_G) = grad I_h(rho g.x) - (g.x_G) grad rho_h,
/// x_G: foot on the nearest surface plane, mean over the nodes; between two surfaces on the one that the element belongs to. With a flat surface g.x_G is one number and the nodal
/// pressure p_k = rho_k g.(x_k - x_G) cancels f in every element, for any mesh and any nodal rho. Elsewhere f = rho g.
#pragma once

#include "core/controls.hpp"
#include "equations/interfacePlanes.hpp"

namespace flotsam
{

/// result: nElements*dim [N/m^3]. rho: nNodes. planes: null or empty: f = rho_e g everywhere.
void gravityForce(const SimplexMesh& mesh, const std::array<double, 3>& gravity, const std::vector<double>& rho,
    const InterfacePlanes* planes, const Cover* cover, std::vector<double>& result);

} // namespace flotsam
