// SPDX-License-Identifier: GPL-3.0-or-later
/// Boundary patches and start states for flow tests on box meshes.
#pragma once

#include "algebra/flowLinearSolver.hpp"
#include "core/boundary.hpp"
#include "core/flowState.hpp"
#include "support/boxMesh.hpp"

#include <algorithm>
#include <functional>

namespace flotsam
{

/// PETSc for the whole test program.
inline void usePetsc() { static PetscSession session(MPI_COMM_WORLD); }

/// Sorted local nodes of a mesh patch.
inline std::vector<int> nodesOf(const MeshPatch& patch)
{
    std::vector<int> nodes(patch.faceNodes);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

using VelocityFunction = std::function<std::array<double, 3>(const double* x, double t)>;

/// Patch with kind `velocity`; Fixed: values of `u` (zero when empty); Open: pressure prescribed `p` (0).
inline BoundaryPatch makePatch(const SimplexMesh& mesh, int index, BoundaryPatch::Velocity velocity, VelocityFunction u = {},
    double alphaInflow = 0)
{
    BoundaryPatch patch;
    patch.name = mesh.patches[index].name;
    patch.meshPatch = index;
    patch.velocity = velocity;
    patch.nodes = nodesOf(mesh.patches[index]);
    if (velocity == BoundaryPatch::Velocity::Open)
    {
        patch.pressure = BoundaryPatch::Pressure::Fixed;
        patch.phase = BoundaryPatch::Phase::Inflow;
    }
    const SimplexMesh* m = &mesh;
    const std::vector<int> nodes = patch.nodes;
    patch.evaluate = [m, nodes, u, alphaInflow](const BoundaryState& s, PatchValues& values)
    {
        values.velocity.assign(nodes.size()*m->dim, 0.0);
        values.pressure.assign(nodes.size(), 0.0);
        values.alpha.assign(nodes.size(), alphaInflow);
        if (!u) return;
        for (std::size_t k = 0; k < nodes.size(); ++k)
        {
            const auto v = u(&m->x[std::size_t(nodes[k])*m->dim], s.time);
            for (int d = 0; d < m->dim; ++d) values.velocity[k*m->dim + d] = v[d];
        }
    };
    return patch;
}

/// All patches of one kind.
inline std::vector<BoundaryPatch> allPatches(const SimplexMesh& mesh, BoundaryPatch::Velocity velocity, VelocityFunction u = {})
{
    std::vector<BoundaryPatch> patches;
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) patches.push_back(makePatch(mesh, int(p), velocity, u));
    return patches;
}

/// One fluid without gravity. rho [kg/m^3], mu [Pa s].
inline FluidProperties oneFluid(double rho, double mu)
{
    FluidProperties properties;
    properties.isTwoPhase = false;
    properties.rhoLiquid = rho;
    properties.muLiquid = mu;
    return properties;
}

inline FlowState restState(const SimplexMesh& mesh)
{
    FlowState s;
    s.u.assign(std::size_t(mesh.nNodes)*mesh.dim, 0.0);
    s.uOld = s.u;
    s.p.assign(mesh.nNodes, 0.0);
    s.alpha.assign(mesh.nNodes, 1.0);
    return s;
}

} // namespace flotsam
