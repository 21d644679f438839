// SPDX-License-Identifier: GPL-3.0-or-later
/// Surfaces of solids inside the mesh: wall terms with the solids' rows and columns, ghost penalty.
#include "equations/elementLoader.hpp"
#include "equations/flowEquation.hpp"
#include "equations/wallTerms.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

namespace
{

/// The facets of one solid in one cut element that look the same way, integrated.
template<int D>
struct FacetGroup
{
    int element, solid, cut;
    double normal[D], area;
    double m1[D + 1], m2[(D + 1)*(D + 1)]; ///< int N_a, int N_a N_b

    /// int N_a N_b with N_a and N_b replaced by their means.
    double ofMeans(int a, int b) const { return m1[a]*m1[b]/area; }
};

template<int D>
std::vector<FacetGroup<D>> groupFacets(const Cover& cover, int nInner, const std::vector<char>& isOwnedElement)
{
    constexpr int N = D + 1;
    std::vector<FacetGroup<D>> groups;
    for (std::size_t c = 0; c < cover.cuts.size(); ++c)
    {
        const CutElement& cut = cover.cuts[c];
        if (cut.element >= nInner && !isOwnedElement[cut.element]) continue;
        const std::size_t first = groups.size();
        for (int f = cut.facetStart; f < cut.facetEnd; ++f)
        {
            const CutFacet& facet = cover.facets[f];
            std::size_t g = first;
            while (g < groups.size() && !(groups[g].solid == facet.solid && std::equal(facet.normal, facet.normal + D, groups[g].normal))) ++g;
            if (g == groups.size())
            {
                groups.push_back({});
                groups.back().element = cut.element;
                groups.back().solid = facet.solid;
                groups.back().cut = int(c);
                std::copy(facet.normal, facet.normal + D, groups.back().normal);
            }
            FacetGroup<D>& group = groups[g];
            group.area += facet.area;
            for (int q = 0; q < facet.nPoints; ++q)
                for (int a = 0; a < N; ++a)
                {
                    const double wa = facet.weight[q]*facet.shape[q][a];
                    group.m1[a] += wa;
                    for (int b = 0; b < N; ++b) group.m2[a*N + b] += wa*facet.shape[q][b];
                }
        }
    }
    std::stable_sort(groups.begin(), groups.end(), [](const auto& l, const auto& r) { return l.solid < r.solid; });
    return groups;
}

/// A rigid motion of a solid at one node, by the solid's degrees of freedom (solidVelocity()).
template<int D>
struct RigidArm
{
    static constexpr int nDof = D == 2 ? 3 : 6;

    double r[D];    // from the solid's position; 2D: times the plane's orientation

    RigidArm() = default;
    RigidArm(const SimplexMesh& mesh, const Solid& solid, int node)
    {
        const std::array<double, 3> x = mesh.spacePoint(node);
        const double orientation = D == 2 ? planeOrientation(mesh) : 1;
        for (int d = 0; d < D; ++d) r[d] = orientation*(x[mesh.axes[d]] - solid.pose.position[mesh.axes[d]]);
    }

    /// V + omega x r.
    void velocity(const double* q, double* u) const
    {
        for (int d = 0; d < D; ++d) u[d] = q[d];
        if constexpr (D == 2)
        {
            u[0] -= q[2]*r[1];
            u[1] += q[2]*r[0];
        }
        else for (int d = 0; d < D; ++d) u[d] += q[3 + (d + 1) % 3]*r[(d + 2) % 3] - q[3 + (d + 2) % 3]*r[(d + 1) % 3];
    }

    /// Adds n forces and their moments to `load` (nDof*n): they do the forces' work in every rigid motion. force: component k of the j-th at [k*n + j].
    template<int n>
    void addLoads(const double* force, double* load) const
    {
        for (int k = 0; k < D*n; ++k) load[k] += force[k];
        const auto addMoments = [&](int k, int l, double* moment)
        {
            for (int j = 0; j < n; ++j) moment[j] += r[k]*force[l*n + j] - r[l]*force[k*n + j];
        };
        if constexpr (D == 2) addMoments(0, 1, load + 2*n);
        else for (int d = 0; d < D; ++d) addMoments((d + 1) % 3, (d + 2) % 3, load + (3 + d)*n);
    }
};

/// What a facet group's blocks of the nodal jumps are for the solid's degrees of freedom, but for the sign that [u] = u - ubar gives.
template<int D>
struct RigidBlocks
{
    static constexpr int N = D + 1, B = D + 1, nDof = RigidArm<D>::nDof;

    double column[N][nDof*B] = {};  ///< rows of the node by the solid: transposed
    double row[N][nDof*B] = {};     ///< the solid's rows by the node

    void add(int a, int b, const double* m, const RigidArm<D>* arm)
    {
        double transposed[D*B];
        for (int k = 0; k < D; ++k)
            for (int r = 0; r < B; ++r) transposed[k*B + r] = m[r*B + k];
        arm[b].template addLoads<B>(transposed, column[a]);
        arm[a].template addLoads<B>(m, row[b]);
    }

    void subtractColumn(int a, double* sum) const
    {
        for (int r = 0; r < B; ++r)
            for (int d = 0; d < nDof; ++d) sum[r*nDof + d] -= column[a][d*B + r];
    }

    void subtractRow(int b, double* sum) const
    {
        for (int k = 0; k < nDof*B; ++k) sum[k] -= row[b][k];
    }

    /// Of the solid by itself; sum: nDof*nDof, row-major.
    void addBlock(const RigidArm<D>* arm, double* sum) const
    {
        for (int a = 0; a < N; ++a)
        {
            double momentum[D*nDof];    // rows of the node
            for (int k = 0; k < D; ++k)
                for (int d = 0; d < nDof; ++d) momentum[k*nDof + d] = column[a][d*B + k];
            arm[a].template addLoads<nDof>(momentum, sum);
        }
    }
};

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

/// Place of a node in the solid's coupling, which gets it if it has not. position: nNodes, -1 for nodes that have none.
template<int D>
int placeOf(int node, std::vector<int>& position, SolidCoupling& coupling)
{
    constexpr int width = (D + 1)*RigidArm<D>::nDof;
    if (position[node] < 0)
    {
        position[node] = int(coupling.node.size());
        coupling.node.push_back(node);
        coupling.column.resize(coupling.column.size() + width);
        coupling.row.resize(coupling.row.size() + width);
    }
    return position[node];
}

/// Share of the inertial ghost penalties that a face needs: none between elements of which half or more is fluid, all beside vanishing cuts. The nodes of
/// larger parts are held by the flow itself, and what the penalty takes from a flow along a round wall is drag (docs/numerics.md). The viscous penalty stays
/// whole: there it improves the stress.
double ghostWeight(const SimplexMesh& mesh, const Cover& cover, const InteriorFace& face)
{
    const auto share = [&](int e) { return fluidVolume(mesh, &cover, e)/mesh.volume[e]; };
    const double lack = std::max(0.0, 1 - 2*std::min(share(face.element[0]), share(face.element[1])));
    return lack*lack;   // smooth where it vanishes: moving bodies feel no kink
}

bool hasOneDensity(const std::vector<double>& rho, const int* nodes, int n)
{
    return std::all_of(nodes, nodes + n, [&](int i) { return std::abs(rho[i] - rho[nodes[0]]) < 1e-6*rho[nodes[0]]; });
}

} // namespace

double planeOrientation(const SimplexMesh& mesh)
{
    return (mesh.axes[1] - mesh.axes[0] + 3) % 3 == 1 ? 1 : -1;
}

void solidVelocity(const SimplexMesh& mesh, const Solid& solid, double* q)
{
    const Vec3 &v = solid.motion.velocity, &w = solid.motion.angularVelocity;
    if (mesh.dim == 2)
    {
        q[0] = v[mesh.axes[0]];
        q[1] = v[mesh.axes[1]];
        q[2] = w[mesh.axes[2]];
        return;
    }
    for (int d = 0; d < 3; ++d) { q[d] = v[d]; q[3 + d] = w[d]; }
}

template<int D>
void FlowEquation::assembleWalls()
{
    constexpr int N = D + 1, B = D + 1, nDof = D == 2 ? 3 : 6;
    system_.solids.clear();
    if (!step_.cover || !step_.solids) return;
    const std::vector<Solid>& solids = *step_.solids;
    system_.solids.resize(solids.size());
    const std::vector<FacetGroup<D>> groups = groupFacets<D>(*step_.cover, mesh_.nInnerElements, mesh_.isOwnedElement);
    std::vector<int> position(mesh_.nNodes, -1);
    ElementData<D> data;
    std::size_t g = 0;
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        const Solid& solid = solids[s];
        SolidCoupling& coupling = system_.solids[s];
        coupling.isFree = solid.kind == Solid::Kind::Free;
        coupling.block.assign(nDof*nDof, 0.0);
        double q[6] = {};
        solidVelocity(mesh_, solid, q);
        for (; g < groups.size() && groups[g].solid == int(s); ++g)
        {
            const FacetGroup<D>& group = groups[g];
            if (!loadElement<D>(group.element, data)) continue;
            const int* nodes = &mesh_.elements[std::size_t(group.element)*N];
            const bool isInner = group.element < mesh_.nInnerElements;
            const bool isOwned = mesh_.isOwnedElement[group.element];
            RigidArm<D> arm[N];
            int place[N];
            for (int a = 0; a < N; ++a)
            {
                arm[a] = RigidArm<D>(mesh_, solid, nodes[a]);
                place[a] = placeOf<D>(nodes[a], position, coupling);
            }
            const FacetMotion motion(group, nodes, arm, q, nodal_);
            const bool isSlip = solid.wall == Solid::Wall::Slip;
            WallCoefficients c = controls_.nitsche ? nitscheCoefficients(data, isSlip, controls_.nitscheGamma, mesh_.h[group.element], step_.time.dt, motion.slip)
                                                   : penaltyCoefficients(isSlip, controls_.penalty);
            c.convection = 0.5*motion.density*motion.wall;
            const WallTerms<D> terms(c, group.normal, data.gradN);
            RigidBlocks<D> rigid;
            for (int a = 0; a < N; ++a)
            {
                const bool isRow = isInner && nodes[a] < mesh_.nOwned;
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
                    swept_[nodes[a]] -= swept;
                }
                if (isRow) rigid.subtractColumn(a, &coupling.column[std::size_t(place[a])*B*nDof]);
            }
            if (!isOwned) continue;
            for (int b = 0; b < N; ++b) rigid.subtractRow(b, &coupling.row[std::size_t(place[b])*B*nDof]);
            rigid.addBlock(arm, coupling.block.data());
        }
        for (int i : coupling.node) position[i] = -1;
    }
}

template<int D>
void FlowEquation::assembleGhosts()
{
    constexpr int N = D + 1;
    system_.ghosts.clear();
    if (!step_.cover) return;
    ElementData<D> side[2];
    for (const GhostFace& face : step_.cover->ghostFaces)
    {
        const InteriorFace& f = graph_.faces[face.face];
        bool isNeeded = false;
        for (int s = 0; s < 2; ++s)
        {
            loadElement<D>(f.element[s], side[s]);
            for (int a = 0; a < N; ++a) isNeeded |= mesh_.elements[std::size_t(f.element[s])*N + a] < mesh_.nOwned;
        }
        if (!isNeeded) continue;
        GhostTerm term{};
        int n = 0;
        for (int a = 0; a < N; ++a)
        {
            const int i = mesh_.elements[std::size_t(f.element[0])*N + a];
            if (i != f.opposite[0]) term.node[n++] = i;
        }
        term.node[n] = f.opposite[0];
        term.node[n + 1] = f.opposite[1];
        for (int s = 0; s < 2; ++s)
        {
            const double sign = s == 0 ? 1 : -1;
            for (int a = 0; a < N; ++a)
            {
                const int i = mesh_.elements[std::size_t(f.element[s])*N + a];
                const int k = int(std::find(term.node, term.node + D + 2, i) - term.node);
                double gn = 0;
                for (int d = 0; d < D; ++d) gn += side[s].gradN[a*D + d]*face.normal[d];
                term.jumpVelocity[k] += sign*gn;
                term.jumpPressure[k] += sign*gn/side[s].rho;
            }
            double fn = 0;
            for (int d = 0; d < D && step_.elementForce; ++d) fn += (*step_.elementForce)[std::size_t(f.element[s])*D + d]*face.normal[d];
            term.pressureSource += sign*fn/side[s].rho;
        }
        double speed = 0;
        for (int d = 0; d < D; ++d)
        {
            const double mean = 0.5*(side[0].advection[d] + side[1].advection[d]);
            speed += mean*mean;
        }
        speed = std::sqrt(speed);
        const double h = 0.5*(mesh_.h[f.element[0]] + mesh_.h[f.element[1]]);
        const double mu = 0.5*(side[0].mu + side[1].mu), rho = 0.5*(side[0].rho + side[1].rho);
        const double lighter = std::min(side[0].rho, side[1].rho);
        // at the water line all of it: it levels surfaces that would come to rest aslant beside a body
        const double weight = hasOneDensity(nodal_.rho, term.node, D + 2) ? ghostWeight(mesh_, *step_.cover, f) : 1;
        term.velocityFactor = face.area*(controls_.ghostVelocity*mu*h + weight*controls_.ghostConvection*rho*speed*h*h);
        term.pressureFactor = weight*face.area*controls_.ghostPressure*h*h*h*lighter*lighter
            /(std::min(side[0].mu, side[1].mu) + lighter*(speed*h + h*h/step_.time.dt));
        system_.ghosts.push_back(term);
    }
}

void FlowEquation::ghostFluxes(const std::vector<double>& x, std::vector<PairFlux>& result) const
{
    const int n = mesh_.dim + 2, B = mesh_.dim + 1;
    result.clear();
    for (const GhostTerm& g : system_.ghosts)
    {
        if (g.pressureFactor == 0) continue;
        double jump = -g.pressureSource;
        for (int j = 0; j < n; ++j) jump += g.jumpPressure[j]*x[std::size_t(g.node[j])*B + B - 1];
        const double f = g.pressureFactor*jump;
        for (int j = 0; j < n; ++j)
            for (int k = j + 1; k < n; ++k)
                result.push_back({g.node[j], g.node[k], f*(g.jumpPressure[j] - g.jumpPressure[k])/n});
    }
    for (const FilmPair& f : films_)
        result.push_back({f.a, f.b, f.conductance*(x[std::size_t(f.a)*B + B - 1] - x[std::size_t(f.b)*B + B - 1] - f.hydrostatic)});
}

void FlowEquation::setFreeBodies(const std::vector<FreeBody>& bodies, double dt)
{
    const int n = system_.nDof, dim = mesh_.dim;
    std::size_t f = 0;
    for (SolidCoupling& solid : system_.solids)
    {
        if (!solid.isFree) continue;
        const FreeBody& body = bodies[f++];
        solid.inertia.assign(n*n, 0.0);
        solid.rhs.assign(n, 0.0);
        const double share = 1/body.newLoadShare; // the fluid's load, the solid's rows, as it is
        const double scale = share/mesh_.thickness; // 2D equations are per unit thickness
        for (int d = 0; d < dim; ++d)
        {
            const int axis = mesh_.axes[d];
            solid.inertia[d*n + d] = scale*body.mass/dt;
            solid.rhs[d] = scale*(body.mass*body.velocity[axis]/dt + body.force[axis]);
        }
        if (dim == 2)
        {
            const int axis = mesh_.axes[2];
            solid.inertia[2*n + 2] = scale*body.inertia(axis, axis)/dt;
            solid.rhs[2] = scale*(body.angularMomentum[axis]/dt + body.moment[axis]);
            continue;
        }
        for (int r = 0; r < 3; ++r)
        {
            for (int c = 0; c < 3; ++c) solid.inertia[(3 + r)*n + 3 + c] = share*body.inertia(r, c)/dt;
            solid.rhs[3 + r] = share*(body.angularMomentum[r]/dt + body.moment[r]);
        }
    }
}

template void FlowEquation::assembleWalls<2>();
template void FlowEquation::assembleWalls<3>();
template void FlowEquation::assembleGhosts<2>();
template void FlowEquation::assembleGhosts<3>();

} // namespace flotsam
