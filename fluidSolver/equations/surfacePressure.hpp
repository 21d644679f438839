// SPDX-License-Identifier: GPL-3.0-or-later
/// What the free surface's profile takes from the pressure on solids.
///
/// Gravity lets any profile above a level surface rest (gravity.hpp), at the nodal pressure p_k = rho_k g.(x_k - x_G). Fluid feels nothing of it, but a solid that pierces
/// the surface would: the wider the profile, the less pressure on both sides of the surface. Solids feel the pressure of a sharp surface in its place.
#pragma once

#include "core/controls.hpp"
#include "equations/interfacePlanes.hpp"
#include "geometry/cover.hpp"

namespace flotsam
{

/// Pressure of a sharp surface less that of the profile, on a facet of a solid.
struct FacetPressure
{
    int element, solid;
    double normal[3];   ///< unit, into the solid, in-plane components
    double first[4];    ///< int N_a over the facet of the difference [N, in 2D N/m]
    bool isCovered;     ///< of what solids cover of each other (CoveredFacet), its area's sign in the normal
};

/// Adds those of facets and covered ones where there is a difference. level: nNodes, SurfaceLevel; ofSurface: nNodes, surfaceDensity().
void addSurfacePressure(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
    const std::vector<double>& level, const Cover& cover, std::vector<FacetPressure>& result);

/// The same on faces of a patch that no solid covers; only those that are owned here. `solid` is -1.
void addSurfacePressure(const SimplexMesh& mesh, const FluidProperties& fluid, const InterfacePlanes& planes, const std::vector<double>& ofSurface,
    const std::vector<double>& level, const Cover* cover, const MeshPatch& patch, std::vector<FacetPressure>& result);

} // namespace flotsam
