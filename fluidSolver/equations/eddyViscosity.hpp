// SPDX-License-Identifier: GPL-3.0-or-later
/// Eddy viscosity of a stream over a bed that no element resolves, by Prandtl's mixing length: nu_t = l^2 |S|, |S|^2 = 2 S:S of the velocity's recovered gradients, with
/// l = kappa y sqrt(1 - y/H) of a stream of depth H, y from its no-slip patches and solids. A uniform stream has the logarithmic profile with it and nu_t = kappa u* y (1 - y/H)
/// (Nezu & Nakagawa, Turbulence in Open-Channel Flows, 1993). From two thirds of H on, where that l is largest, it stays. Close to a smooth wall l has van Driest's factor
/// 1 - exp(-y+/26) (1956, doi 10.2514/8.3713).
#pragma once

#include "core/boundary.hpp"
#include "core/controls.hpp"
#include "equations/elementLoader.hpp"
#include "equations/nodalGradients.hpp"

namespace flotsam
{

class EddyViscosity
{
public:
    /// Collective.
    EddyViscosity(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const NumericsControls& controls);

    /// From the advecting velocity: into nodal.eddy, and on to nodal.mu. Of liquid alone: beside its surface, where gas that is dragged along would count, nu_t is that of the
    /// liquid below. cover: null without solids. Collective.
    void add(const Cover* cover, NodalData& nodal);

private:
    double ofLiquid(int node, double nu, const Cover* cover) const;
    void extend();

    const SimplexMesh& mesh_;
    const Halo& halo_;
    double depth_;
    bool isSmooth_;
    NodalGradients gradients_;
    std::vector<double> distance_;              // nNodes, from the patches, where it counts [m]
    std::vector<double> eddy_, sum_, count_;    // nNodes: nu_t, unknown: -1 [m^2/s]; of the neighbours that have one
};

/// nu_t [m^2/s] of a mixing length [m] at the distance y from a smooth wall [m], shear [1/s]: with van Driest's factor, whose friction velocity is that of the stress
/// here, (nu + nu_t) |S|.
double dampedEddyViscosity(double mixingLength, double y, double shear, double nu);

} // namespace flotsam
