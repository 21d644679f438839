// SPDX-License-Identifier: GPL-3.0-or-later
/// mu lap u of the elements, which P1 functions lack. Without it the residual of SUPG, PSPG and u' errs by first order wherever viscosity counts, and PSPG gives
/// the pressure at a no-slip wall the normal derivative of a fluid without viscosity. Divergence of recovered nodal gradients (Jansen, Collis, Whiting &
/// Shakib 1999, doi 10.1016/S0045-7825(98)00284-9) of the extrapolated velocity: right-hand sides only.
#pragma once

#include "equations/nodalGradients.hpp"

namespace flotsam
{

class ViscousForce
{
public:
    ViscousForce(const SimplexMesh& mesh, const Halo& halo);

    /// rho, mu: nNodes [kg/m^3], [Pa s]; u: nNodes*dim [m/s]; cover: null without solids; dt [s]. False, with nothing done, where dt is so short that viscosity
    /// counts nowhere. Collective.
    bool find(const std::vector<double>& rho, const std::vector<double>& mu, const std::vector<double>& u, const Cover* cover, double dt);

    /// nElements*dim [N/m^3]; 0 outside the fluid and beside elements in which the density varies.
    const std::vector<double>& values() const { return values_; }

private:
    template<int D> void findForces(const std::vector<double>& mu, const Cover* cover);
    void markKinks(const std::vector<double>& rho);

    const SimplexMesh& mesh_;
    const Halo& halo_;
    NodalGradients gradients_;
    double leastLength_;                    // of the elements, all ranks [m]
    std::vector<int> isKink_;               // nNodes: the velocity has a kink there
    std::vector<double> values_;
};

} // namespace flotsam
