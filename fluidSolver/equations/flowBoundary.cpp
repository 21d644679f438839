// SPDX-License-Identifier: GPL-3.0-or-later
/// Boundary conditions on the mesh's patches: prescribed directions, open boundaries.
#include "equations/flowEquation.hpp"

#include "geometry/cutSimplex.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace flotsam
{

namespace
{

constexpr double sameNormal = 0.9; // cosine above which two slip faces at a node belong to one smooth wall

/// Area vector of a patch face (outward), dim components.
void faceVector(const SimplexMesh& mesh, const int* nodes, double* v)
{
    const double* x = mesh.x.data();
    if (mesh.dim == 2)
    {
        const double *a = x + 2*nodes[0], *b = x + 2*nodes[1];
        v[0] = b[1] - a[1];
        v[1] = a[0] - b[0];
        return;
    }
    double e[2][3];
    for (int k = 0; k < 2; ++k)
        for (int d = 0; d < 3; ++d) e[k][d] = x[3*nodes[k + 1] + d] - x[3*nodes[0] + d];
    for (int d = 0; d < 3; ++d)
        v[d] = 0.5*(e[0][(d + 1) % 3]*e[1][(d + 2) % 3] - e[0][(d + 2) % 3]*e[1][(d + 1) % 3]);
}

/// Area vector pointing away from the element behind the face.
void outwardVector(const SimplexMesh& mesh, const MeshPatch& patch, std::size_t f, double* v)
{
    const int dim = mesh.dim;
    const int* nodes = &patch.faceNodes[f*dim];
    faceVector(mesh, nodes, v);
    const int* element = &mesh.elements[std::size_t(patch.faceElement[f])*(dim + 1)];
    double inward = 0;
    for (int a = 0; a <= dim; ++a)
        for (int d = 0; d < dim; ++d)
            inward += v[d]*(mesh.x[std::size_t(element[a])*dim + d] - mesh.x[std::size_t(nodes[0])*dim + d]);
    if (inward > 0) for (int d = 0; d < dim; ++d) v[d] = -v[d];
}

/// int N_k N_l over the fluid part of a face, over the face's area (shape functions of the face itself).
template<int D>
struct FaceMoments
{
    double second[D*D], first[D];

    FaceMoments(const Cover* cover, const int* nodes)
    {
        double distance[D];
        int nSolid = 0;
        for (int k = 0; k < D; ++k)
        {
            distance[k] = cover ? cover->distance[nodes[k]] : farDistance;
            nSolid += distance[k] < 0;
        }
        if (nSolid == 0) fill(1);
        else if (nSolid == D) fill(0);
        else integrateCut(distance);
        for (int k = 0; k < D; ++k)
        {
            first[k] = 0;
            for (int l = 0; l < D; ++l) first[k] += second[k*D + l];
        }
    }

private:
    void fill(double share)
    {
        for (int k = 0; k < D; ++k)
            for (int l = 0; l < D; ++l) second[k*D + l] = share*(k == l ? 2. : 1.)/(D*(D + 1));
    }

    void integrateCut(const double* distance)
    {
        if constexpr (D == 3)
        {
            constexpr double vertices[6] = {0, 0, 1, 0, 0, 1}, gradN[6] = {-1, -1, 1, 0, 0, 1};
            const SimplexCut<2> cut = cutSimplex<2>(distance, 0.5, vertices, gradN);
            for (int m = 0; m < 9; ++m) second[m] = 2*cut.second[m];
        }
        else
        {
            // the edge from its fluid end, of which the part s in [0, t] is fluid: N = 1 - s there, s at the other end
            const int fluid = distance[0] > 0 ? 0 : 1, solid = 1 - fluid;
            const double t = distance[fluid]/(distance[fluid] - distance[solid]);
            second[fluid*2 + fluid] = (1 - (1 - t)*(1 - t)*(1 - t))/3;
            second[solid*2 + solid] = t*t*t/3;
            second[1] = second[2] = t*t/2 - t*t*t/3;
        }
    }
};

/// Normals of the slip faces at one node, grouped into smooth walls.
struct SlipNormals
{
    std::vector<std::array<double, 3>> sums;

    void add(const double* v, int dim)
    {
        double size = 0;
        for (int d = 0; d < dim; ++d) size += v[d]*v[d];
        size = std::sqrt(size);
        for (auto& s : sums)
        {
            double dot = 0, length = 0;
            for (int d = 0; d < dim; ++d) { dot += s[d]*v[d]; length += s[d]*s[d]; }
            if (std::abs(dot) > sameNormal*size*std::sqrt(length))
            {
                for (int d = 0; d < dim; ++d) s[d] += dot > 0 ? v[d] : -v[d];
                return;
            }
        }
        std::array<double, 3> s{};
        std::copy(v, v + dim, s.begin());
        sums.push_back(s);
    }

    /// Orthonormal directions (Gram-Schmidt).
    NodeConstraint constraint(int node, int dim) const
    {
        NodeConstraint c{};
        c.node = node;
        for (std::array<double, 3> s : sums)
        {
            double size = 0;
            for (int d = 0; d < dim; ++d) size += s[d]*s[d];
            const double whole = std::sqrt(size);
            for (int k = 0; k < c.nDirections; ++k)
            {
                double along = 0;
                for (int d = 0; d < dim; ++d) along += s[d]*c.direction[k][d];
                for (int d = 0; d < dim; ++d) s[d] -= along*c.direction[k][d];
            }
            size = 0;
            for (int d = 0; d < dim; ++d) size += s[d]*s[d];
            if (std::sqrt(size) < 0.1*whole || c.nDirections == dim) continue;
            for (int d = 0; d < dim; ++d) c.direction[c.nDirections][d] = s[d]/std::sqrt(size);
            ++c.nDirections;
        }
        return c;
    }
};

} // namespace

void FlowEquation::buildConstraints()
{
    const int dim = mesh_.dim;
    std::map<int, SlipNormals> slip;
    std::vector<char> isFixed(mesh_.nNodes, 0), isPressureFixed(mesh_.nNodes, 0);
    for (const BoundaryPatch& p : patches_)
    {
        if (p.velocity == BoundaryPatch::Velocity::Fixed) for (int i : p.nodes) isFixed[i] = 1;
        if (p.pressure != BoundaryPatch::Pressure::Natural) for (int i : p.nodes) isPressureFixed[i] = 1;
        if (p.velocity != BoundaryPatch::Velocity::Slip) continue;
        const MeshPatch& patch = mesh_.patches[p.meshPatch];
        double v[3];
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            outwardVector(mesh_, patch, f, v);
            for (int k = 0; k < dim; ++k) slip[patch.faceNodes[f*dim + k]].add(v, dim);
        }
    }
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (!isFixed[i]) continue;
        NodeConstraint c{};
        c.node = i;
        c.nDirections = dim;
        for (int d = 0; d < dim; ++d) c.direction[d][d] = 1;
        constraints_.push_back(c);
    }
    for (const auto& [node, normals] : slip)
        if (!isFixed[node]) constraints_.push_back(normals.constraint(node, dim));
    for (const NodeConstraint& c : constraints_)
        if (c.node < mesh_.nOwned) system_.constraints.push_back(c);
    std::vector<double> flags(isPressureFixed.begin(), isPressureFixed.end());
    halo_.update(flags, 1);
    system_.isPressureFixed.assign(flags.begin(), flags.end());
    bool any = false;
    for (int i = 0; i < mesh_.nOwned; ++i) any = any || system_.isPressureFixed[i];
    system_.hasPressureLevel = halo_.any(any);
    isPatchPressureFixed_ = system_.isPressureFixed;
}

void FlowEquation::applyConstraints(const std::vector<PatchValues>& values, std::vector<double>& x) const
{
    const int dim = mesh_.dim, B = dim + 1;
    for (const NodeConstraint& c : constraints_)
    {
        double* u = &x[std::size_t(c.node)*B];
        for (int k = 0; k < c.nDirections; ++k)
        {
            double along = 0;
            for (int d = 0; d < dim; ++d) along += u[d]*c.direction[k][d];
            for (int d = 0; d < dim; ++d) u[d] -= along*c.direction[k][d];
        }
    }
    // walls win over inflow where patches meet: zero velocity is written last
    for (int pass = 0; pass < 2; ++pass)
        for (std::size_t p = 0; p < patches_.size(); ++p)
        {
            const BoundaryPatch& patch = patches_[p];
            if (patch.velocity != BoundaryPatch::Velocity::Fixed) continue;
            if (patch.isNoSlipWall != (pass == 1)) continue;
            for (std::size_t k = 0; k < patch.nodes.size(); ++k)
                for (int d = 0; d < dim; ++d)
                    x[std::size_t(patch.nodes[k])*B + d] = values[p].velocity[k*dim + d];
        }
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        if (patches_[p].pressure == BoundaryPatch::Pressure::Natural) continue;
        for (std::size_t k = 0; k < patches_[p].nodes.size(); ++k)
        {
            const int i = patches_[p].nodes[k];
            // Total: the dynamic part acts implicitly, through the boundary term that the skew-symmetric convection leaves
            // out (p + rho (u.n) u/2 = p0). Subtracted here from the last velocity it feeds back on itself within the
            // step and blows up at any time step (measured)
            x[std::size_t(i)*B + dim] = values[p].pressure[k];
        }
    }
    if (step_.gas) applyGasEdge(x);
    halo_.update(x, B);
}

template<int D>
void FlowEquation::assembleOpenBoundaries()
{
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        const BoundaryPatch& patch = patches_[p];
        if (patch.velocity != BoundaryPatch::Velocity::Open) continue;
        const MeshPatch& faces = mesh_.patches[patch.meshPatch];
        const bool hasPressure = patch.pressure != BoundaryPatch::Pressure::Natural;
        auto pressureAt = [&](int i) -> double
        {
            if (!hasPressure) return 0;
            const auto k = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), i) - patch.nodes.begin();
            return (*step_.patchValues)[p].pressure[k];
        };
        for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
        {
            const int* nodes = &faces.faceNodes[f*D];
            if (step_.gas && step_.cover->state[faces.faceElement[f]] == ElementState::Solid) continue;
            const FaceMoments<D> moments(step_.cover, nodes);
            double v[3];
            outwardVector(mesh_, faces, f, v);
            double pressure[D] = {};
            for (int k = 0; k < D && hasPressure; ++k) pressure[k] = pressureAt(nodes[k]);
            addOpenFace<D>(nodes, v, moments.first, moments.second, hasPressure ? pressure : nullptr);
        }
    }
}

/// pressure: prescribed at the face's nodes; null: the unknown's own value acts.
template<int D>
void FlowEquation::addOpenFace(const int* nodes, const double* v, const double* first, const double* second, const double* pressure)
{
    constexpr int B = D + 1;
    double size2 = 0;
    for (int d = 0; d < D; ++d) size2 += v[d]*v[d];
    for (int k = 0; k < D; ++k)
    {
        const int i = nodes[k];
        if (i >= mesh_.nOwned || first[k] <= 0) continue;
        double flux = 0;
        for (int d = 0; d < D; ++d) flux += nodal_.advection[std::size_t(i)*D + d]*v[d]*first[k];
        // boundary part of the skew-symmetric convection where the fluid leaves (lumped); what enters brings no
        // tangential velocity (pressureInletOutletVelocity)
        double* m = &system_.matrix.velocity[std::size_t(graph_.diagonal[i])*D*D];
        for (int d = 0; d < D; ++d)
        {
            m[d*D + d] += 0.5*nodal_.rho[i]*std::abs(flux);
            for (int l = 0; l < D && flux < 0; ++l) m[d*D + l] += 0.5*nodal_.rho[i]*flux*v[d]*v[l]/size2;
        }
        for (int l = 0; l < D; ++l)     // - int p_ext w.n
        {
            const double weight = second[k*D + l];
            if (pressure)
            {
                for (int d = 0; d < D; ++d) system_.rhs[std::size_t(i)*B + d] -= weight*pressure[l]*v[d];
                continue;
            }
            double* column = &system_.matrix.gradient[std::size_t(graph_.find(i, nodes[l]))*D];
            for (int d = 0; d < D; ++d) column[d] += weight*v[d];
        }
    }
}

template void FlowEquation::addOpenFace<2>(const int*, const double*, const double*, const double*, const double*);
template void FlowEquation::addOpenFace<3>(const int*, const double*, const double*, const double*, const double*);
template void FlowEquation::assembleOpenBoundaries<2>();
template void FlowEquation::assembleOpenBoundaries<3>();

} // namespace flotsam
