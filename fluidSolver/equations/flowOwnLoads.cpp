// SPDX-License-Identifier: GPL-3.0-or-later
/// Loads of the fluid on solids in which there is no unknown.
#include "equations/flowEquation.hpp"
#include "equations/rigidCoupling.hpp"

namespace flotsam
{

namespace
{

/// Of facets that follow each other most are pieces of one face of a solid in one element: what its nodes' arms are is found once for them.
template<int D>
struct PressureArms
{
    const FacetPressure* of = nullptr;
    RigidArm<D> arm[D + 1];

    bool isOf(const FacetPressure& facet) const
    {
        return of && of->element == facet.element && of->solid == facet.solid && std::equal(of->normal, of->normal + D, facet.normal);
    }

    void set(const FacetPressure& facet, const SimplexMesh& mesh, const Solid& solid)
    {
        of = &facet;
        const Turning<D> turning(mesh, solid);
        for (int a = 0; a <= D; ++a)
        {
            arm[a] = RigidArm<D>(mesh, solid, mesh.elements[std::size_t(facet.element)*(D + 1) + a]);
            arm[a].onSurface(turning, facet.normal);
        }
    }
};

} // namespace

/// The surface's own pressure (surfacePressure.hpp) on the solids. What they cover of each other feels it where it feels the pressure itself.
template<int D>
void FlowEquation::addSurfaceLoads(const std::vector<FacetPressure>& facets)
{
    constexpr int nDof = RigidArm<D>::nDof;
    PressureArms<D> arms;
    for (const FacetPressure& facet : facets)
    {
        if (!mesh_.isOwnedElement[facet.element]) continue;
        if (facet.isCovered && (isLayerNode_.empty() || !isOfLayer<D>(facet.element))) continue;
        if (!arms.isOf(facet)) arms.set(facet, mesh_, (*step_.solids)[facet.solid]);
        double* load = &ownLoads_[std::size_t(facet.solid)*nDof];
        for (int a = 0; a <= D; ++a)
        {
            double force[D];
            for (int d = 0; d < D; ++d) force[d] = facet.first[a]*facet.normal[d];
            arms.arm[a].template addLoads<1>(force, load);
            arms.arm[a].template removeTurning<1>(0, force, load);
        }
    }
}

/// After the walls with their edges and the layers, which add to them.
template<int D>
void FlowEquation::assembleOwnLoads()
{
    constexpr int nDof = RigidArm<D>::nDof;
    if (step_.surfacePressure) addSurfaceLoads<D>(*step_.surfacePressure);
    const bool isBeyond = step_.solids && beyond_.isReached(*step_.solids);
    beyondInertia_.assign(isBeyond ? ownLoads_.size()*nDof : 0, 0.0);
    if (isBeyond)
    {
        beyond_.addLoads(step_, nDof, ownLoads_, beyondInertia_);
        halo_.sum(beyondInertia_.data(), int(beyondInertia_.size()));
    }
    beyondRate_.assign(isBeyond ? step_.solids->size() : 0, 0.0);
    beyondHistory_.assign(isBeyond ? ownLoads_.size() : 0, 0.0);
    if (step_.surfacePressure || !isLayerNode_.empty() || isBeyond || solidEdges_.isAny()) halo_.sum(ownLoads_.data(), int(ownLoads_.size()));
    for (std::size_t s = 0; s < system_.solids.size(); ++s) system_.solids[s].load.assign(&ownLoads_[s*nDof], &ownLoads_[s*nDof] + nDof);
}

/// Of the mean over the step as that of the body itself: what the last step's load has of it, a share of the mean, is made up for.
void FlowEquation::setBeyondInertia(std::size_t s, const FreeBody& body, double dt)
{
    if (beyondInertia_.empty()) return;
    const std::size_t n = system_.nDof;
    SolidCoupling& solid = system_.solids[s];
    const double* inertia = &beyondInertia_[s*n*n];
    const double last = 1/body.newLoadShare - 1;
    double start[6], change[6];
    toDegreesOfFreedom(mesh_, {body.velocity, body.angularVelocity}, start);
    toDegreesOfFreedom(mesh_, body.lastChange, change);
    beyondRate_[s] = 1/(body.newLoadShare*dt);
    for (std::size_t r = 0; r < n; ++r)
    {
        double& history = beyondHistory_[s*n + r] = 0;
        for (std::size_t c = 0; c < n; ++c)
        {
            solid.inertia[r*n + c] += beyondRate_[s]*inertia[r*n + c];
            history += inertia[r*n + c]*(beyondRate_[s]*start[c] + last*change[c]);
        }
        solid.rhs[r] += history;
    }
}

void FlowEquation::addBeyondRows(const std::vector<double>& q, std::vector<double>& rows) const
{
    const std::size_t n = system_.nDof;
    for (std::size_t s = 0; s < beyondRate_.size(); ++s)
        for (std::size_t r = 0; r < n; ++r)
        {
            rows[s*n + r] -= beyondHistory_[s*n + r];
            for (std::size_t c = 0; c < n; ++c) rows[s*n + r] += beyondRate_[s]*beyondInertia_[(s*n + r)*n + c]*q[s*n + c];
        }
}

template void FlowEquation::assembleOwnLoads<2>();
template void FlowEquation::assembleOwnLoads<3>();

} // namespace flotsam
