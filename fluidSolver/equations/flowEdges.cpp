// SPDX-License-Identifier: GPL-3.0-or-later
/// What elements over a wall see of the velocity at its re-entrant edge.
///
/// A stream that leaves a sharp edge is tangential to the wall that it comes along, what lies behind the edge to the other wall: the velocity has no single value there.
/// Were the nodal one to hold in all elements around, what lies behind would be dragged along, out of the wall. The stream then opens into half an element behind the edge
/// and slows down, at a pressure below its surroundings by its dynamic pressure, and grad-div resists the gas that would have to flow in. So an element over one of the walls
/// sees of the edge's velocity the part along that wall, u - n (n.u), and so do its test functions, wherever volume counts: continuity and pressure, grad-div, and, as
/// the difference is a constant in the element's rows, u' of what convects. Inertia stays that of the dual cell with the node's velocity.
///
/// What enters the edge's dual cell from an element over a wall has the velocity that is seen there: on its way through the dual cell's faces (u_b + u - n (n.u))/2 instead
/// of the mean (u_b + u)/2 of the skew form. The difference, half the mass flux times n (n.u), holds the edge's velocity to the wall that a stream comes along.
///
/// Structures that cut the mesh have edges as well (solidEdges.hpp): the same, of velocities relative to the structure, whose load is the reaction.
#include "equations/elementLoader.hpp"
#include "equations/flowEquation.hpp"
#include "equations/patchForces.hpp"
#include "equations/rigidCoupling.hpp"

#include <algorithm>
#include <array>

namespace flotsam
{

namespace
{

constexpr int mostWalls = 4;    // that meet in an edge at one node

using Vector = std::array<double, 3>;

/// Share of a simplex's volume on the side of a plane through one of its corners where `n` points; at: the other corners as seen from that one, dim of them.
double shareBeyond(const Vector* at, int dim, const Vector& n)
{
    double d[3] = {};
    int nBeyond = 0, lone = 0;
    for (int k = 0; k < dim; ++k)
    {
        for (int l = 0; l < dim; ++l) d[k] += n[l]*at[k][l];
        nBeyond += d[k] > 0;
    }
    if (nBeyond == 0 || nBeyond == dim) return nBeyond ? 1 : 0;
    for (int k = 0; k < dim; ++k)       // the corner that is alone on its side, in 2D the one beyond
        if (nBeyond == 1 ? d[k] > 0 : d[k] <= 0) lone = k;
    double share = 1;
    for (int k = 0; k < dim; ++k)
        if (k != lone) share *= d[lone]/(d[lone] - d[k]);
    return nBeyond == 1 ? share : 1 - share;
}

/// Adds to q, dim*dim, n n for each wall by the element's share over this wall alone: on its side of the fluid and beyond all others.
void addWallsBelow(const Vector* at, int dim, const std::vector<Vector>& normals, double* q)
{
    double beyond[mostWalls];
    for (std::size_t w = 0; w < normals.size(); ++w) beyond[w] = shareBeyond(at, dim, normals[w]);
    for (std::size_t w = 0; w < normals.size(); ++w)
    {
        double share = 1;
        for (std::size_t v = 0; v < normals.size(); ++v) share *= v == w ? 1 - beyond[v] : beyond[v];
        for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l) q[k*dim + l] += share*normals[w][k]*normals[w][l];
    }
}

/// Half of the mass that enters the dual cell of corner a from this element [kg/s], negative if it leaves.
template<int D>
double halfEntering(const ElementData<D>& e, int a)
{
    if (!e.isVarying) return 0.5*e.rho*e.ag[a]*e.volume;
    double leaving = 0;
    for (int b = 0; b <= D; ++b) leaving += e.convection[a*(D + 1) + b];
    return -leaving;
}

/// What an edge element adds, w its test function: Q w and Q u taken out of where volume counts. Q: EdgeElement::across.
template<int D>
struct EdgeTerms
{
    static constexpr int N = D + 1, B = D + 1;

    const ElementData<D>& data;
    const EdgeElement& edge;
    double force[N][D];         ///< gravity on Q w [N], taken from the right-hand side
    double weight[N];           ///< int N_a, of pressure and gravity
    double arriving[N];         ///< half of the mass that enters the dual cell [kg/s]
    double across[N][N][D];     ///< Q_b grad N_a at [a][b]
    double seen[N][D];          ///< of grad N_a what is along the wall

    EdgeTerms(const ElementData<D>& data_, const EdgeElement& edge_)
    :   data(data_), edge(edge_)
    {
        for (int a = 0; a < N; ++a)
        {
            weight[a] = (data.isVarying ? 1 + data.forceShare[a] : 1)*data.first[a];
            arriving[a] = std::max(0.0, halfEntering(data, a));
            for (int b = 0; b < N; ++b) acrossWall(b, data.gradN + a*D, across[a][b]);
            acrossWall(a, data.force, force[a]);
            for (int d = 0; d < D; ++d)
            {
                seen[a][d] = data.gradN[a*D + d] - across[a][a][d];
                force[a][d] *= weight[a];
            }
        }
    }

    /// Row a, column b.
    void block(int a, int b, double* m) const
    {
        const double gradDiv = data.tauCont*data.volume;
        std::fill(m, m + B*B, 0.0);
        for (int k = 0; k < D; ++k)
        {
            for (int l = 0; l < D && a == b; ++l) m[k*B + l] = arriving[a]*edge.across[a][k*D + l];
            for (int l = 0; l < D; ++l) m[k*B + l] += gradDiv*(seen[a][k]*seen[b][l] - data.gradN[a*D + k]*data.gradN[b*D + l]);
            m[k*B + D] = -weight[a]*across[b][a][k];
            m[D*B + k] = data.first[b]*across[a][b][k];
        }
    }

private:
    void acrossWall(int corner, const double* v, double* result) const
    {
        for (int k = 0; k < D; ++k)
        {
            result[k] = 0;
            for (int l = 0; l < D; ++l) result[k] += edge.across[corner][k*D + l]*v[l];
        }
    }
};

/// Added to what addElement() has of the nodes' velocities: the difference that the part along the wall makes.
template<int D>
void addRows(const EdgeTerms<D>& terms, const SimplexMesh& mesh, const NodeGraph& graph, FlowSystem& system)
{
    constexpr int N = D + 1, B = D + 1;
    const int e = terms.edge.element, *nodes = &mesh.elements[std::size_t(e)*N];
    for (int a = 0; a < N; ++a)
    {
        if (nodes[a] >= mesh.nOwned) continue;
        for (int k = 0; k < D; ++k) system.rhs[std::size_t(nodes[a])*B + k] -= terms.force[a][k];
        for (int b = 0; b < N; ++b)
        {
            double m[B*B];
            terms.block(a, b, m);
            system.matrix.add<D>(graph.slot(nodes[a], (std::size_t(e)*N + a)*N + b), m);
        }
    }
}

} // namespace

void FlowEquation::findEdgeElements(const std::map<int, SlipNormals>& slip)
{
    const int dim = mesh_.dim, N = dim + 1;
    edgeElements_.clear();
    if (!halo_.any(std::any_of(isSlipEdge_.begin(), isSlipEdge_.end(), [](char is) { return is; }))) return;
    std::vector<std::vector<Vector>> normals(mesh_.nNodes);
    for (int w = 0; w < mostWalls; ++w)     // second-ring copies do not see all of their faces
    {
        std::vector<double> normal(std::size_t(mesh_.nNodes)*dim, 0.0);
        for (const auto& [node, walls] : slip)
            if (const auto all = isSlipEdge_[node] ? walls.edgeNormals() : std::vector<Vector>{}; w < int(all.size()))
                std::copy_n(all[w].begin(), dim, &normal[std::size_t(node)*dim]);
        halo_.update(normal, dim);
        for (int i = 0; i < mesh_.nNodes; ++i)
        {
            Vector n{};
            std::copy_n(&normal[std::size_t(i)*dim], dim, n.begin());
            if (n != Vector{}) normals[i].push_back(n);
        }
    }
    for (int e = 0; e < mesh_.nInnerElements; ++e)
    {
        const int* nodes = &mesh_.elements[std::size_t(e)*N];
        EdgeElement edge{e};
        for (int a = 0; a < N; ++a)
        {
            if (normals[nodes[a]].empty()) continue;
            Vector at[3] = {};
            for (int b = 0, k = 0; b < N; ++b)
            {
                if (b == a) continue;
                for (int d = 0; d < dim; ++d) at[k][d] = mesh_.x[std::size_t(nodes[b])*dim + d] - mesh_.x[std::size_t(nodes[a])*dim + d];
                ++k;
            }
            addWallsBelow(at, dim, normals[nodes[a]], edge.across[a]);
        }
        const double* q = edge.across[0];
        if (std::any_of(q, q + N*9, [](double value) { return value != 0; })) edgeElements_.push_back(edge);
    }
}

template<int D>
void FlowEquation::addEdgeElement(const EdgeElement& edge)
{
    ElementData<D> data;
    if (loadElementData<D>(edge.element, mesh_, step_, fluid_, controls_, nodal_, data)) addRows(EdgeTerms<D>(data, edge), mesh_, graph_, system_);
}

/// The same at a structure's edge: the blocks are of the nodal jumps, the structure's row and column follow.
template<int D>
void FlowEquation::addSolidEdge(const SolidEdges::Element& edge, const Turning<D>& turning, SolidCoupling& coupling)
{
    constexpr int N = D + 1, B = D + 1, nDof = RigidArm<D>::nDof;
    const bool isOwned = mesh_.isOwnedElement[edge.element];
    ElementData<D> data;
    if (!loadElementData<D>(edge.element, mesh_, step_, fluid_, controls_, nodal_, data)) return;
    const int* nodes = &mesh_.elements[std::size_t(edge.element)*N];
    const Solid& solid = (*step_.solids)[edge.solid];
    const EdgeTerms<D> terms(data, edge);
    addRows(terms, mesh_, graph_, system_);
    RigidArm<D> arm[N];
    RigidBlocks<D> rigid;
    for (int a = 0; a < N; ++a)
    {
        arm[a] = RigidArm<D>(mesh_, solid, nodes[a]);
        arm[a].onSurface(turning, edge.normal);
    }
    for (int a = 0; a < N; ++a)
    {
        for (int b = 0; b < N; ++b)
        {
            double m[B*B];
            terms.block(a, b, m);
            rigid.add(a, b, m, arm);
        }
        const int place = placeOf<D>(nodes[a], placeInSolid_, coupling);
        if (nodes[a] < mesh_.nOwned) rigid.subtractColumn(a, &coupling.column[std::size_t(place)*B*nDof]);
        if (!isOwned) continue;
        double* load = &ownLoads_[std::size_t(edge.solid)*nDof];
        arm[a].template addLoads<1>(terms.force[a], load);
        arm[a].template removeTurning<1>(0, terms.force[a], load);
    }
    if (!isOwned) return;
    for (int b = 0; b < N; ++b) rigid.subtractRow(b, &coupling.row[std::size_t(placeOf<D>(nodes[b], placeInSolid_, coupling))*B*nDof]);
    rigid.addBlock(arm, coupling.block.data());
}

template<int D>
void FlowEquation::assembleEdges()
{
    for (const EdgeElement& edge : edgeElements_) addEdgeElement<D>(edge);
}

/// What these terms leave of a uniform test function: the walls that meet in the edge feel it.
template<int D>
void FlowEquation::addEdgeForces(const std::vector<double>& x, PatchForces& forces) const
{
    constexpr int N = D + 1, B = D + 1;
    ElementData<D> data;
    for (const EdgeElement& edge : edgeElements_)
    {
        const int* nodes = &mesh_.elements[std::size_t(edge.element)*N];
        const int corner = edge.cornerOfEdge(N);
        if (!mesh_.isOwnedElement[edge.element] || !forces.isNear(nodes[corner])) continue;
        if (!loadElementData<D>(edge.element, mesh_, step_, fluid_, controls_, nodal_, data)) continue;
        const EdgeTerms<D> terms(data, edge);
        for (int a = 0; a < N; ++a)
        {
            double m[B*B], force[D];
            std::copy_n(terms.force[a], D, force);
            for (int b = 0; b < N; ++b)
            {
                terms.block(a, b, m);
                addMomentumRows<D>(m, &x[std::size_t(nodes[b])*B], force);
            }
            forces.addAtEdge(nodes[corner], nodes[a], force);
        }
    }
}

/// From u', which convects with the nodes' velocities: their part across the walls, mean over the element's fluid part. Of structures relative to their motion.
template<int D>
void FlowEquation::takeWhatWouldPass(const std::vector<double>& x, std::vector<double>& result) const
{
    constexpr int N = D + 1;
    ElementData<D> data;
    const auto take = [&](const EdgeElement& edge, const auto& ofWall)
    {
        if (!loadElement<D>(edge.element, data)) return;
        const int* nodes = &mesh_.elements[std::size_t(edge.element)*N];
        for (int a = 0; a < N; ++a)
        {
            double wall[D] = {};
            ofWall(nodes[a], wall);
            const double *u = &x[std::size_t(nodes[a])*(D + 1)], share = data.first[a]/data.volume;
            for (int k = 0; k < D; ++k)
                for (int l = 0; l < D; ++l) result[std::size_t(edge.element)*D + k] -= share*edge.across[a][k*D + l]*(u[l] - wall[l]);
        }
    };
    for (const EdgeElement& edge : edgeElements_) take(edge, [](int, double*) {});
    for (const SolidEdges::Element& edge : solidEdges_.elements())
    {
        const Solid& solid = (*step_.solids)[edge.solid];
        double q[6] = {};
        solidVelocity(mesh_, solid, q);
        take(edge, [&](int node, double* wall) { RigidArm<D>(mesh_, solid, node).velocity(q, wall); });
    }
}

template void FlowEquation::assembleEdges<2>();
template void FlowEquation::assembleEdges<3>();
template void FlowEquation::addEdgeForces<2>(const std::vector<double>&, PatchForces&) const;
template void FlowEquation::addEdgeForces<3>(const std::vector<double>&, PatchForces&) const;
template void FlowEquation::addSolidEdge<2>(const SolidEdges::Element&, const Turning<2>&, SolidCoupling&);
template void FlowEquation::addSolidEdge<3>(const SolidEdges::Element&, const Turning<3>&, SolidCoupling&);
template void FlowEquation::takeWhatWouldPass<2>(const std::vector<double>&, std::vector<double>&) const;
template void FlowEquation::takeWhatWouldPass<3>(const std::vector<double>&, std::vector<double>&) const;

} // namespace flotsam
