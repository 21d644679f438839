// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/budgets.hpp"

#include "equations/materials.hpp"
#include "equations/rigidCoupling.hpp"

#include <algorithm>

namespace flotsam
{

FluidBudget fluidBudget(const Fluid& fluid, const FluidProperties& properties, const NumericsControls& controls, const Cover* cover)
{
    const SimplexMesh& mesh = fluid.mesh();
    const FlowState& state = fluid.state();
    const int dim = mesh.dim, n = dim + 1;
    double sums[6] = {0, 0, 0, 0, 0, 0}; // momentum, mass, kinetic, potential
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e]) continue;
        const ElementState part = cover ? cover->state[e] : ElementState::Fluid;
        if (part == ElementState::Solid) continue;
        const int* nodes = &mesh.elements[std::size_t(e)*n];
        const CutElement* cut = part == ElementState::Cut ? &cover->cuts[cover->cutIndex[e]] : nullptr;
        double first[4], second[16], rho = 0;
        const double volume = cut ? cut->volume : mesh.volume[e];
        for (int a = 0; a < n; ++a)
        {
            first[a] = cut ? cut->first[a] : volume/n;
            rho += first[a]/volume*density(properties, controls, state.alpha[nodes[a]]);
            for (int b = 0; b < n; ++b) second[a*n + b] = cut ? cut->second[a*n + b] : volume*(a == b ? 2 : 1)/(n*(n + 1));
        }
        sums[3] += rho*volume;
        double lightest = 1e300, heaviest = 0, nodal[4];
        for (int a = 0; a < n; ++a)
        {
            nodal[a] = density(properties, controls, state.alpha[nodes[a]]);
            lightest = std::min(lightest, nodal[a]);
            heaviest = std::max(heaviest, nodal[a]);
        }
        // the solver's masses: lumped and the nodes' own where the density varies, but for cut elements
        const bool isLumped = !cut && heaviest > lightest*(1 + 1e-10);
        for (int d = 0; d < dim; ++d)
            for (int a = 0; a < n; ++a)
            {
                const double u = state.u[std::size_t(nodes[a])*dim + d];
                sums[d] += (isLumped ? nodal[a] : rho)*first[a]*u;
                if (isLumped) sums[4] += 0.5*nodal[a]*first[a]*u*u;
                else
                    for (int b = 0; b < n; ++b) sums[4] += 0.5*rho*second[a*n + b]*u*state.u[std::size_t(nodes[b])*dim + d];
                // int rho x with nodal rho: an interface inside an element keeps its height
                for (int b = 0; b < n; ++b)
                    sums[5] -= second[a*n + b]*density(properties, controls, state.alpha[nodes[a]])*properties.gravity[mesh.axes[d]]
                        *mesh.x[std::size_t(nodes[b])*dim + d];
            }
    }
    fluid.halo().sum(sums, 6);
    FluidBudget budget;
    for (int d = 0; d < dim; ++d) budget.momentum[mesh.axes[d]] = mesh.thickness*sums[d];
    for (int d = 0; d < 3; ++d) budget.weight[d] = mesh.thickness*sums[3]*properties.gravity[d];
    budget.kinetic = mesh.thickness*sums[4];
    budget.potential = mesh.thickness*sums[5];
    return budget;
}

Vec3 wallReaction(const Fluid& fluid)
{
    const SimplexMesh& mesh = fluid.mesh();
    const FlowSystem& system = fluid.equation().system();
    const FlowState& state = fluid.state();
    const int dim = mesh.dim, B = dim + 1;
    std::vector<double> x(std::size_t(mesh.nNodes)*B), rows(std::size_t(mesh.nOwned)*B), q;
    for (int i = 0; i < mesh.nNodes; ++i)
    {
        for (int d = 0; d < dim; ++d) x[std::size_t(i)*B + d] = state.u[std::size_t(i)*dim + d];
        x[std::size_t(i)*B + dim] = state.p[i];
    }
    for (const Motion& m : fluid.solidMotions())
    {
        Solid solid;
        solid.motion = m;
        q.resize(q.size() + system.nDof);
        solidVelocity(mesh, solid, &q[q.size() - system.nDof]);
    }
    FlowOperator(fluid.graph(), fluid.halo(), system, mesh.nOwned).fluidRows(x.data(), q.empty() ? nullptr : q.data(), rows.data());
    double sums[3] = {0, 0, 0};
    for (const NodeConstraint& c : system.constraints)
    {
        if (!system.isActive[c.node]) continue;
        for (int k = 0; k < c.nDirections; ++k)
        {
            double along = 0;
            for (int d = 0; d < dim; ++d)
                along += (rows[std::size_t(c.node)*B + d] - system.rhs[std::size_t(c.node)*B + d])*c.direction[k][d];
            for (int d = 0; d < dim; ++d) sums[d] += along*c.direction[k][d];
        }
    }
    fluid.halo().sum(sums, 3);
    Vec3 force = Vec3::Zero();
    for (int d = 0; d < dim; ++d) force[mesh.axes[d]] = mesh.thickness*sums[d];
    return force;
}

} // namespace flotsam
