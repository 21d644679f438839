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
#include "equations/elementLoader.hpp"
#include "equations/flowEquation.hpp"

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
    for (int e = 0; e < mesh_.nElements; ++e)
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

/// Added to what addElement() has of the nodes' velocities: the difference that the part along the wall makes.
template<int D>
void FlowEquation::addEdgeElement(const EdgeElement& edge)
{
    constexpr int N = D + 1, B = D + 1;
    const int e = edge.element, *nodes = &mesh_.elements[std::size_t(e)*N];
    ElementData<D> data;
    if (!loadElementData<D>(e, mesh_, step_, fluid_, controls_, nodal_, data)) return;
    double across[N][N][D], seen[N][D], force[N][D];    // Q_b grad N_a; of grad N_a what is along the wall; Q_a f. Q: EdgeElement::across
    const auto acrossWall = [&](int corner, const double* v, double* result)
    {
        for (int k = 0; k < D; ++k)
        {
            result[k] = 0;
            for (int l = 0; l < D; ++l) result[k] += edge.across[corner][k*D + l]*v[l];
        }
    };
    for (int a = 0; a < N; ++a)
    {
        for (int b = 0; b < N; ++b) acrossWall(b, data.gradN + a*D, across[a][b]);
        for (int d = 0; d < D; ++d) seen[a][d] = data.gradN[a*D + d] - across[a][a][d];
        acrossWall(a, data.force, force[a]);
    }
    const double gradDiv = data.tauCont*data.volume;
    for (int a = 0; a < N; ++a)
    {
        if (nodes[a] >= mesh_.nOwned) continue;
        const double forced = (data.isVarying ? 1 + data.forceShare[a] : 1)*data.first[a];
        for (int k = 0; k < D; ++k) system_.rhs[std::size_t(nodes[a])*B + k] -= forced*force[a][k];
        const double arriving = std::max(0.0, halfEntering(data, a));
        for (int b = 0; b < N; ++b)
        {
            double m[B*B] = {};
            for (int k = 0; k < D; ++k)
            {
                for (int l = 0; l < D && a == b; ++l) m[k*B + l] = arriving*edge.across[a][k*D + l];
                for (int l = 0; l < D; ++l) m[k*B + l] += gradDiv*(seen[a][k]*seen[b][l] - data.gradN[a*D + k]*data.gradN[b*D + l]);
                m[k*B + D] = -forced*across[b][a][k];
                m[D*B + k] = data.first[b]*across[a][b][k];
            }
            system_.matrix.add<D>(graph_.slot(nodes[a], (std::size_t(e)*N + a)*N + b), m);
        }
    }
}

template<int D>
void FlowEquation::assembleEdges()
{
    for (const EdgeElement& edge : edgeElements_)
        if (edge.element < mesh_.nInnerElements) addEdgeElement<D>(edge);
}

/// From u', which convects with the nodes' velocities: their part across the walls, mean over the element's fluid part.
template<int D>
void FlowEquation::takeWhatWouldPass(const std::vector<double>& x, std::vector<double>& result) const
{
    constexpr int N = D + 1;
    ElementData<D> data;
    for (const EdgeElement& edge : edgeElements_)
    {
        if (!loadElement<D>(edge.element, data)) continue;
        const int* nodes = &mesh_.elements[std::size_t(edge.element)*N];
        for (int a = 0; a < N; ++a)
        {
            const double *u = &x[std::size_t(nodes[a])*(D + 1)], share = data.first[a]/data.volume;
            for (int k = 0; k < D; ++k)
                for (int l = 0; l < D; ++l) result[std::size_t(edge.element)*D + k] -= share*edge.across[a][k*D + l]*u[l];
        }
    }
}

template void FlowEquation::assembleEdges<2>();
template void FlowEquation::assembleEdges<3>();
template void FlowEquation::takeWhatWouldPass<2>(const std::vector<double>&, std::vector<double>&) const;
template void FlowEquation::takeWhatWouldPass<3>(const std::vector<double>&, std::vector<double>&) const;

} // namespace flotsam
