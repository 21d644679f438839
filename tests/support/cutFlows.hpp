// SPDX-License-Identifier: GPL-3.0-or-later
/// Exact flows with cut walls: annular Couette flow, flows around a resting disc or sphere.
#pragma once

#include "geometry/coverBuilder.hpp"
#include "support/errorTable.hpp"
#include "support/forcedFlow.hpp"

namespace flotsam
{

/// Everything farther than `radius` from the z axis.
std::shared_ptr<const Shape> makeOutsideOfCylinder(double radius);

/// Flow between a cylinder that turns and an outer one at rest; rho, mu constant, no body force.
struct AnnularCouette
{
    double innerRadius = 0.15, outerRadius = 0.4, spin = 4;  ///< [m], [rad/s]
    Vec3 centre = Vec3(0.5, 0.5, 0);

    double swirl() const;       ///< B of u_theta = A r + B/r [m^2/s]
    ExactFlow flow(double rho) const;
    double torque(double mu) const { return 4*M_PI*mu*swirl(); } ///< on the outer cylinder; opposite on the inner one [N m/m]
    std::vector<Solid> solids() const;                           ///< outer, inner
};

/// Forced flow at rest on a disc (dim 2) or sphere: u = curl((r^2 - R^2)^2 A), p = sin(2x) cos(2.5y) (+ sin(2z + 0.5)).
struct FlowAroundBody
{
    int dim = 2;
    double radius = 0.23;
    Vec3 centre = Vec3(0.5, 0.5, 0.5);

    ExactFlow flow() const;
    std::vector<Solid> solids() const;
};

/// Errors of the steady flow around a disc or sphere, FlowAroundBody, in the unit square or cube with n cells a side and moved nodes. Collective.
ErrorTable errorsAroundBody(int dim, const char* title, double rho, double mu, const std::vector<int>& sizes);

/// Point k = 0, 1, .. of the Halton sequence in [0,1)^3 (bases 2, 3, 5).
Vec3 haltonPoint(int k);

} // namespace flotsam
