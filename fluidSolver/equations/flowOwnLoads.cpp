// SPDX-License-Identifier: GPL-3.0-or-later
/// Loads of the fluid on solids in which there is no unknown.
#include "equations/flowEquation.hpp"
#include "equations/rigidCoupling.hpp"

namespace flotsam
{

/// The surface's own pressure (surfacePressure.hpp) on a facet. What solids cover of each other feels it where it feels the pressure itself.
template<int D>
void FlowEquation::addSurfaceLoad(const FacetPressure& facet)
{
    constexpr int N = D + 1, nDof = RigidArm<D>::nDof;
    if (!mesh_.isOwnedElement[facet.element]) return;
    if (facet.isCovered && (isLayerNode_.empty() || !isOfLayer<D>(facet.element))) return;
    const Solid& solid = (*step_.solids)[facet.solid];
    const Turning<D> turning(mesh_, solid);
    double* load = &ownLoads_[std::size_t(facet.solid)*nDof];
    for (int a = 0; a < N; ++a)
    {
        RigidArm<D> arm(mesh_, solid, mesh_.elements[std::size_t(facet.element)*N + a]);
        arm.onSurface(turning, facet.normal);
        double force[D];
        for (int d = 0; d < D; ++d) force[d] = facet.first[a]*facet.normal[d];
        arm.template addLoads<1>(force, load);
        arm.template removeTurning<1>(0, force, load);
    }
}

/// After the walls with their edges and the layers, which add to them.
template<int D>
void FlowEquation::assembleOwnLoads()
{
    constexpr int nDof = RigidArm<D>::nDof;
    if (step_.surfacePressure)
        for (const FacetPressure& facet : *step_.surfacePressure) addSurfaceLoad<D>(facet);
    const bool isBeyond = step_.solids && beyond_.isReached(*step_.solids);
    if (isBeyond) beyond_.addLoads(step_, nDof, ownLoads_);
    if (step_.surfacePressure || !isLayerNode_.empty() || isBeyond || solidEdges_.isAny()) halo_.sum(ownLoads_.data(), int(ownLoads_.size()));
    for (std::size_t s = 0; s < system_.solids.size(); ++s) system_.solids[s].load.assign(&ownLoads_[s*nDof], &ownLoads_[s*nDof] + nDof);
}

template void FlowEquation::assembleOwnLoads<2>();
template void FlowEquation::assembleOwnLoads<3>();

} // namespace flotsam
