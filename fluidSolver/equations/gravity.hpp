// SPDX-License-Identifier: GPL-3.0-or-later
/// Gravity as a force per element that is exactly the gradient of a P1 function when the fluid rests.
///
/// In an element with a density gradient, f = sum_k grad N_k rho_k g.(x_k - x_G) = grad I_h(rho g.x) - (g.x_G) grad rho_h,
/// x_G: foot on the nearest surface plane, mean over the nodes; between two surfaces on the one that the element belongs to. With a flat surface g.x_G is one number
/// and the nodal pressure p_k = rho_k g.(x_k - x_G) cancels f in every element, for any mesh and any nodal rho. Elsewhere f = rho g.
///
/// rho_k is there only what the surface accounts for (surfaceDensity()); the rest weighs f = rho g. Spray or mist above a flat surface would
/// otherwise weigh nothing: its force would be a gradient as well, and the pressure would carry it.
#pragma once

#include "core/controls.hpp"
#include "equations/interfacePlanes.hpp"

namespace flotsam
{

/// Density of the nodes as far as their surface plane accounts for it: of the fluid of the other side a node has no more than the profile would give it
/// if the plane were one element length nearer. nNodes; rho where a node has no plane, and inside solids of `cover` (null: none), where the surface goes on
/// and nothing is adrift, however far its plane comes from; within an element length of a solid by the distance along the plane's normal alone. width: nNodes [m].
void surfaceDensity(const SimplexMesh& mesh, const FluidProperties& fluid, const NumericsControls& controls, const InterfacePlanes& planes,
    const Cover* cover, const std::vector<double>& width, const std::vector<double>& alpha, std::vector<double>& result);

/// Planes for every node where alpha may weigh: over gravityLayers rings at least, in thin elements (rings are closer than the profile is wide) over more.
InterfacePlanes::Extent planesExtent(const NumericsControls& controls, const std::vector<double>& width);

/// g.(x_k - x_G) of an element's nodes [m^2/s^2]. False: f = rho g there. g: in-plane components. ofSurface: surfaceDensity().
template<int dim>
bool balancedPotentials(const SimplexMesh& mesh, const double* g, const InterfacePlanes& planes, const std::vector<double>& ofSurface, int e, double* potential);

/// What a node's pressure has at rest beyond that of two fluids with a sharp surface between them [Pa]. sharp: the node's share of liquid then, 0 or 1.
double profilePressure(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface, int i, double sharp);

/// result: nElements*dim [N/m^3]. rho, ofSurface (surfaceDensity()): nNodes. planes: null or empty: f = rho_e g everywhere.
void gravityForce(const SimplexMesh& mesh, const std::array<double, 3>& gravity, const std::vector<double>& rho,
    const InterfacePlanes* planes, const std::vector<double>& ofSurface, const Cover* cover, std::vector<double>& result);

} // namespace flotsam
