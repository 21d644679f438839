// SPDX-License-Identifier: GPL-3.0-or-later
/// Surfaces of solids inside the mesh: wall terms with the solids' rows and columns.
#include "equations/elementLoader.hpp"
#include "equations/facetGroups.hpp"
#include "equations/flowEquation.hpp"
#include "equations/layerSeparation.hpp"
#include "equations/rigidCoupling.hpp"
#include "equations/wallTerms.hpp"

#include <algorithm>

namespace flotsam
{

namespace
{

/// Means over a facet group: velocities along the normal [m/s], density [kg/m^3]. q: motion of the solid.
struct FacetMotion
{
    double wall = 0;    ///< ubar.n
    double slip = 0;    ///< (a - ubar).n
    double density = 0; ///< at the facet, not the element's mean: what the surface sweeps

    template<int D>
    FacetMotion(const FacetGroup<D>& group, const int* nodes, const RigidArm<D>* arm, const double* q, const NodalData& nodal)
    {
        for (int a = 0; a <= D; ++a)
        {
            const double share = group.m1[a]/group.area;
            double ubar[D];
            arm[a].velocity(q, ubar);
            density += share*nodal.rho[nodes[a]];
            for (int k = 0; k < D; ++k)
            {
                wall += share*ubar[k]*group.normal[k];
                slip += share*(nodal.advection[std::size_t(nodes[a])*D + k] - ubar[k])*group.normal[k];
            }
        }
    }
};

/// separationHold() in a cut element, by velocities relative to its solid. Their change in time is that of the fluid where the solid is, du/dt + (ubar.grad) u;
/// the solid's own acceleration is not in it.
template<int D>
double holdOfSolid(const ElementData<D>& e, const int* nodes, const RigidArm<D>* arm, const double* q, const NodalData& nodal, const FlowState& state, double share, double h)
{
    double mean[D], relative[(D + 1)*D], rate[D] = {}, wall[D] = {};
    const double perStep = state.dt > 0 ? 1/state.dt : 0;
    std::copy_n(e.advection, D, mean);
    for (int a = 0; a <= D; ++a)
    {
        const std::size_t first = std::size_t(nodes[a])*D;
        double ubar[D];
        arm[a].velocity(q, ubar);
        for (int d = 0; d < D; ++d)
        {
            relative[a*D + d] = nodal.advection[first + d] - ubar[d];
            mean[d] -= ubar[d]/(D + 1);
            wall[d] += ubar[d]/(D + 1);
            rate[d] += perStep*(state.u[first + d] - state.uOld[first + d])/(D + 1);
        }
    }
    for (int a = 0; a <= D; ++a)
    {
        double along = 0;
        for (int d = 0; d < D; ++d) along += wall[d]*e.gradN[a*D + d];
        for (int d = 0; d < D; ++d) rate[d] += along*nodal.advection[std::size_t(nodes[a])*D + d];
    }
    return separationHold<D>(share, e.rho, e.molecular, h, mean, relative, rate, e.gradN);
}

} // namespace

/// One facet group's terms. turning, q, coupling: of its solid; q its motion.
template<int D>
void FlowEquation::addFacetGroup(const FacetGroup<D>& group, const Solid& solid, const Turning<D>& turning, const double* q, SolidCoupling& coupling)
{
    constexpr int N = D + 1, B = D + 1, nDof = RigidArm<D>::nDof;
    ElementData<D> data;
    if (!loadElement<D>(group.element, data)) return;
    const int* nodes = &mesh_.elements[std::size_t(group.element)*N];
    RigidArm<D> arm[N];
    int place[N];
    for (int a = 0; a < N; ++a)
    {
        arm[a] = RigidArm<D>(mesh_, solid, nodes[a]);
        arm[a].onSurface(turning, group.normal);
        place[a] = placeOf<D>(nodes[a], placeInSolid_, coupling);
    }
    const FacetMotion motion(group, nodes, arm, q, nodal_);
    const bool isSlip = solid.wall == Solid::Wall::Slip;
    WallCoefficients c = controls_.nitsche ? nitscheCoefficients(data, isSlip, controls_.nitscheGamma, mesh_.h[group.element], penaltyRateOf(group.element), controls_.wallInflow*motion.slip)
                                           : penaltyCoefficients(isSlip, controls_.penalty);
    if (controls_.nitsche && !isSlip && controls_.separation > 0)
        c.tangential = std::max(c.tangential, holdOfSolid(data, nodes, arm, q, nodal_, *step_.state, controls_.separation, mesh_.h[group.element]));
    c.convection = 0.5*motion.density*motion.wall;
    const WallTerms<D> terms(c, group.normal, data.gradN);
    RigidBlocks<D> rigid;
    for (int a = 0; a < N; ++a)
    {
        const bool isRow = nodes[a] < mesh_.nOwned;
        for (int b = 0; b < N; ++b)
        {
            double m[B*B];
            const double m2 = group.m2[a*N + b], swept = c.convection*m2;
            terms.block(a, b, group.m1[a], group.m1[b], m2, isSlip ? group.ofMeans(a, b) : m2, m);
            rigid.add(a, b, m, arm);
            if (!isRow) continue;
            for (int k = 0; k < D; ++k) m[k*(B + 1)] += swept;
            system_.matrix.add<D>(graph_.slot(nodes[a], (std::size_t(group.element)*N + a)*N + b), m);
            defect_[nodes[a]] += swept; // a moving surface's part of the mass balance
            sweptOfCut_[std::size_t(group.cut)*N + a] -= swept;
        }
        if (isRow) rigid.subtractColumn(a, &coupling.column[std::size_t(place[a])*B*nDof]);
    }
    if (!mesh_.isOwnedElement[group.element]) return;
    for (int b = 0; b < N; ++b) rigid.subtractRow(b, &coupling.row[std::size_t(place[b])*B*nDof]);
    rigid.addBlock(arm, coupling.block.data());
}

template<int D>
void FlowEquation::assembleWalls()
{
    constexpr int nDof = RigidArm<D>::nDof;
    if (!step_.cover || !step_.solids) return system_.solids.clear();
    const std::vector<Solid>& solids = *step_.solids;
    system_.solids.resize(solids.size());
    for (SolidCoupling& coupling : system_.solids) coupling.clear();
    const std::vector<FacetGroup<D>>& groups = std::get<FacetGroups<D>>(facetGroups_).of(*step_.cover, mesh_.nInnerElements, solids.size());
    placeInSolid_.resize(mesh_.nNodes, -1);
    sweptOfCut_.assign(step_.cover->cuts.size()*(D + 1), 0.0);
    ownLoads_.assign(solids.size()*nDof, 0.0);
    if (controls_.nitsche) solidEdges_.find(groups, mesh_, halo_, *step_.cover, solids);
    const std::vector<SolidEdges::Element>& edges = solidEdges_.elements();
    std::size_t g = 0, edge = 0;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        SolidCoupling& coupling = system_.solids[s];
        coupling.isFree = solids[s].kind == Solid::Kind::Free;
        coupling.block.assign(nDof*nDof, 0.0);
        double q[6] = {};
        solidVelocity(mesh_, solids[s], q);
        const Turning<D> turning(mesh_, solids[s]);
        for (; g < groups.size() && groups[g].solid == int(s); ++g) addFacetGroup<D>(groups[g], solids[s], turning, q, coupling);
        for (; edge < edges.size() && edges[edge].solid == int(s); ++edge) addSolidEdge<D>(edges[edge], turning, coupling);
        for (int i : coupling.node) placeInSolid_[i] = -1;
    }
    sumSwept<D>();
}

/// What elements around a node give, where fluid appears, does not make up for what is swept out of others: bodies that rock on each other open and close a
/// gap within one node's reach, and a velocity that is linear along the gap knows the difference.
template<int D>
void FlowEquation::sumSwept()
{
    constexpr int N = D + 1;
    for (std::size_t c = 0; c < step_.cover->cuts.size(); ++c)
        for (int a = 0; a < N; ++a)
        {
            const int i = mesh_.elements[std::size_t(step_.cover->cuts[c].element)*N + a];
            if (i < mesh_.nOwned) swept_[i] += std::max(0.0, sweptOfCut_[c*N + a]);
        }
}

double FlowEquation::penaltyRateOf(int e) const { return penaltyRate(step_.time.dt, step_.gravity, step_.speed, controls_.penaltyRate, mesh_.h[e]); }

void FlowEquation::setFreeBodies(const std::vector<FreeBody>& bodies, double dt)
{
    const int n = system_.nDof, dim = mesh_.dim;
    std::size_t f = 0;
    for (std::size_t s = 0; s < system_.solids.size(); ++s)
    {
        SolidCoupling& solid = system_.solids[s];
        if (!solid.isFree) continue;
        const FreeBody& body = bodies[f++];
        solid.inertia.assign(n*n, 0.0);
        solid.rhs = solid.load;
        const double share = 1/body.newLoadShare; // the fluid's load, the solid's rows, as it is
        const double scale = share/mesh_.thickness; // 2D equations are per unit thickness
        for (int d = 0; d < dim; ++d)
        {
            const int axis = mesh_.axes[d];
            solid.inertia[d*n + d] = scale*body.mass/dt;
            solid.rhs[d] += scale*(body.mass*body.velocity[axis]/dt + body.force[axis]);
        }
        if (dim == 2)
        {
            const int axis = mesh_.axes[2];
            solid.inertia[2*n + 2] = scale*body.inertia(axis, axis)/dt;
            solid.rhs[2] += scale*(body.angularMomentum[axis]/dt + body.moment[axis]);
        }
        for (int r = 0; r < 3 && dim == 3; ++r)
        {
            for (int c = 0; c < 3; ++c) solid.inertia[(3 + r)*n + 3 + c] = share*body.inertia(r, c)/dt;
            solid.rhs[3 + r] += share*(body.angularMomentum[r]/dt + body.moment[r]);
        }
        setBeyondInertia(s, body, dt);
    }
}

template void FlowEquation::assembleWalls<2>();
template void FlowEquation::assembleWalls<3>();

} // namespace flotsam
