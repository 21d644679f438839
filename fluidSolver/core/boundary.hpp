// SPDX-License-Identifier: GPL-3.0-or-later
/// Boundary conditions of the fluid as the kernels see them: plain kinds and nodal values, no dictionaries.
#pragma once

#include "core/timeJump.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flotsam
{

/// Values of one patch at one time, per node of the patch (`BoundaryPatch::nodes`).
struct PatchValues
{
    std::vector<double> velocity;   ///< nodes*dim, for Velocity::Fixed [m/s]
    std::vector<double> pressure;   ///< nodes, for Pressure::Fixed and Total: full pressure (total: p0) [Pa]
    std::vector<double> alpha;      ///< nodes, phase field of fluid that enters
};

struct Cover;

/// State a condition may depend on (flow rates over the wetted part, variable heights). Local nodes, halo up to date.
struct BoundaryState
{
    double time;
    const double* velocity; ///< nNodes*dim
    const double* alpha;    ///< nNodes
    const Cover* cover = nullptr;           ///< null: no solids
    const double* entering = nullptr;       ///< per node of the patch: phase field of what enters, PatchValues::alpha of the same time; null: that of the nodes
    double liquidInflow = 0;                ///< that the velocity of the patch is made of, where the level floats [m^3/s]
};

struct BoundaryPatch
{
    /// Slip, NoSlip: walls at rest, their normal velocity prescribed at the nodes; NoSlip: the tangential one held weakly on the faces.
    /// Open: no constraint on the velocity.
    enum class Velocity { Fixed, Slip, NoSlip, Open };
    /// Natural with Open is interFoam's zeroGradient/zeroGradient outlet: the pressure there is the unknown's own value, the
    /// boundary term int p v.n stays in the equations (without it the outlet would silently be held at p = 0).
    /// Total: p = p0 - rho |u|^2/2 where the fluid enters.
    enum class Pressure { Natural, Fixed, Total };
    enum class Phase { Natural, Inflow };               ///< Inflow: PatchValues::alpha where the fluid enters, else natural

    std::string name;
    bool isNoSlipWall = false;      ///< of kind Fixed at zero or NoSlip; at shared nodes it wins over patches that prescribe a velocity along themselves
    bool stopsBodies = false;       ///< a wall to them (constant/bodies); walls do in any case
    int meshPatch = -1;             ///< index into SimplexMesh::patches
    Velocity velocity = Velocity::Fixed;
    Pressure pressure = Pressure::Natural;
    Phase phase = Phase::Natural;
    bool isWall() const { return velocity == Velocity::Slip || velocity == Velocity::NoSlip; }

    std::vector<int> nodes;         ///< local nodes of the patch (owned and halo), ascending

    std::vector<TimeJump> jumps;    ///< of a prescribed velocity over time

    /// Fills the values for a time. Collective (may sum over ranks).
    std::function<void(const BoundaryState&, PatchValues&)> evaluate;
};

} // namespace flotsam
