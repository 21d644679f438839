// SPDX-License-Identifier: GPL-3.0-or-later
/// One fluid driven by a body force that makes a chosen velocity and pressure the exact solution (manufactured solutions), with the
/// program's own assembly and linear solver; the errors against that solution.
#pragma once

#include "algebra/flowLinearSolver.hpp"
#include "equations/basins.hpp"
#include "equations/flowEquation.hpp"

#include <functional>
#include <vector>

namespace flotsam
{

/// Divergence-free velocity [m/s] and pressure [Pa], smooth also a little outside the fluid.
struct ExactFlow
{
    std::function<void(const double* x, double t, double* u)> velocity;
    std::function<double(const double* x, double t)> pressure;
    bool isForced = true;   ///< false: it solves the equations without a body force
};

/// f = rho (du/dt + u.grad u) - mu laplace u + grad p [N/m^3] by fourth-order central differences.
void exactForce(const ExactFlow& exact, const FluidProperties& fluid, int dim, const double* x, double t, double* f);

struct FlowErrors
{
    double velocity = 0;    ///< L2 over the fluid [m/s m^(dim/2)]
    double gradient = 0;    ///< L2 of grad u
    double pressure = 0;    ///< L2 of p less its mean
    double largest = 0;     ///< largest nodal velocity error
};

/// Errors of a state over the fluid part of the mesh (cover null: everywhere) at its time. Collective.
FlowErrors flowErrors(const SimplexMesh& mesh, const Halo& halo, const Cover* cover, const FlowState& state, const ExactFlow& exact);

class ForcedFlow
{
public:
    /// All of the mesh's patches hold the exact velocity. Starts with the exact values at `time`. Collective.
    ForcedFlow(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const NumericsControls& controls,
        const ExactFlow& exact, double time = 0);

    /// Cut geometry from now on; keeps the references.
    void setGeometry(const Cover& cover, const std::vector<Solid>& solids);

    SolveReport step(double dt);

    /// Steps of `dt` until the velocity changes less than `change` times its largest value; returns the number of steps.
    int toSteadyState(double dt, double change, int maxSteps);

    FlowErrors errors() const { return flowErrors(mesh_, halo_, cover_, state_, exact_); }

    /// Force (2 or 3 components) and moment on solid s: rows of the solved system, per unit thickness in 2D.
    std::vector<double> load(int s) const;

    const NodeGraph& graph() const { return graph_; }
    const FlowSystem& system() const { return equation_.system(); }
    const FlowState& state() const { return state_; }
    double largestVelocity() const;     ///< of the active nodes

private:
    void setForce(double t);

    const SimplexMesh& mesh_;
    const Halo& halo_;
    NodeGraph graph_;
    FluidProperties fluid_;
    NumericsControls controls_;
    ExactFlow exact_;
    std::vector<BoundaryPatch> patches_;
    std::vector<PatchValues> values_;
    FlowEquation equation_;
    FlowLinearSolver solver_;
    Basins basins_;
    FlowState state_;
    const Cover* cover_ = nullptr;
    const std::vector<Solid>* solids_ = nullptr;
    std::vector<double> force_, x_, q_;
};

} // namespace flotsam
