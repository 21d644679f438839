// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the equations have the forces on patches.
#include "algebra/flowOperator.hpp"
#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"
#include "equations/flowEquation.hpp"
#include "equations/patchForces.hpp"

namespace flotsam
{

/// What the rows leave along the directions that patches prescribe: the force on the fluid.
void FlowEquation::addReactions(const std::vector<double>& x, const std::vector<double>& q, PatchForces& forces) const
{
    const int dim = mesh_.dim, B = dim + 1;
    std::vector<double> rows(std::size_t(mesh_.nOwned)*B);
    FlowOperator(graph_, halo_, system_, mesh_.nOwned).fluidRows(x.data(), q.empty() ? nullptr : q.data(), rows.data());
    for (std::size_t k = 0; k < nPatchConstraints_; ++k)
    {
        const NodeConstraint& c = system_.constraints[k];
        if (!system_.isActive[c.node] || !forces.isNear(c.node)) continue;
        double force[3] = {};
        for (int j = 0; j < c.nDirections; ++j)
        {
            double along = 0;
            for (int d = 0; d < dim; ++d) along += (rows[std::size_t(c.node)*B + d] - system_.rhs[std::size_t(c.node)*B + d])*c.direction[j][d];
            for (int d = 0; d < dim; ++d) force[d] -= along*c.direction[j][d];
        }
        forces.addReaction(c.node, force);
    }
}

/// The pressure on a face that has no terms of its own.
template<int D>
void FlowEquation::addFaceTraction(int p, std::size_t f, const std::vector<double>& x, PatchForces& forces) const
{
    const MeshPatch& faces = mesh_.patches[patches_[p].meshPatch];
    const int e = faces.faceElement[f], *nodes = &faces.faceNodes[f*D];
    if (step_.cover && step_.cover->state[e] == ElementState::Solid) return;
    const FaceMoments<D> moments(mesh_, step_.cover, e, nodes);
    double v[3], force[D];
    outwardVector(mesh_, faces, f, v);
    for (int k = 0; k < D; ++k)
    {
        if (nodes[k] >= mesh_.nOwned || !forces.isNear(nodes[k])) continue;
        double pressure = 0;
        for (int l = 0; l < D; ++l) pressure += moments.second[k*D + l]*x[std::size_t(nodes[l])*(D + 1) + D];
        for (int d = 0; d < D; ++d) force[d] = pressure*v[d];
        forces.addTraction(p, nodes[k], force);
    }
}

template<int D>
void FlowEquation::addPatchForcesT(const std::vector<double>& x, PatchForces& forces) const
{
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        if (patches_[p].velocity == BoundaryPatch::Velocity::Open) continue;
        const MeshPatch& faces = mesh_.patches[patches_[p].meshPatch];
        for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
        {
            if (faces.faceElement[f] >= mesh_.nInnerElements) continue;
            if (!hasWallTerms(patches_[p], f)) addFaceTraction<D>(int(p), f, x, forces);
            else if (forces.isAsked(int(p))) addFaceForce<D>(int(p), f, x, forces);
        }
    }
    addEdgeForces<D>(x, forces);
}

void FlowEquation::addPatchForces(const std::vector<double>& x, const std::vector<double>& q, PatchForces& forces) const
{
    addReactions(x, q, forces);
    if (mesh_.dim == 2) addPatchForcesT<2>(x, forces); else addPatchForcesT<3>(x, forces);
}

} // namespace flotsam
