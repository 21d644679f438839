// SPDX-License-Identifier: GPL-3.0-or-later
/// Rigid motions of solids at the nodes, and the solids' rows and columns from the blocks of the nodes at their surface: action equals reaction.
#pragma once

#include "algebra/flowSystem.hpp"
#include "core/simplexMesh.hpp"
#include "geometry/solid.hpp"

#include <algorithm>
#include <cmath>

namespace flotsam
{

/// +1 when (axes[0], axes[1], axes[2]) of a 2D mesh is a right-handed order of x, y, z, else -1.
double planeOrientation(const SimplexMesh& mesh);

/// A motion as the system's degrees of freedom q (3 in 2D: in-plane velocity, rotation about the empty axis; 6 in 3D).
void toDegreesOfFreedom(const SimplexMesh& mesh, const Motion& motion, double* q);

/// That of a solid.
void solidVelocity(const SimplexMesh& mesh, const Solid& solid, double* q);

/// Solid::turning() by the system's rotations.
template<int D>
struct Turning
{
    static constexpr int nAxes = D == 2 ? 1 : 3;

    bool isAny;
    double projection[nAxes*nAxes];

    Turning(const SimplexMesh& mesh, const Solid& solid)
    {
        const Eigen::Matrix3d turning = solid.turning();
        const auto axisOf = [&](int k) { return D == 2 ? mesh.axes[2] : k; };
        for (int k = 0; k < nAxes; ++k)
            for (int l = 0; l < nAxes; ++l) projection[k*nAxes + l] = turning(axisOf(k), axisOf(l));
        // in 2D an axis askew is none
        isAny = D == 2 ? projection[0] > 1 - 1e-9 : turning.any();
    }
};

/// A rigid motion of a solid at one node, by the solid's degrees of freedom (solidVelocity()).
template<int D>
struct RigidArm
{
    static constexpr int nDof = D == 2 ? 3 : 6, nAxes = nDof - D;

    double r[D];    // from the solid's position; 2D: times the plane's orientation
    // Pressure has no moment about axes around which the solid turns into itself: on its true surface it has none, on a flat facet it has, and would set a round log
    // spinning. turn: this moment of the facet's unit normal (nAxes).
    bool isTurning = false;
    double normal[D] = {}, turn[nAxes] = {};

    RigidArm() = default;
    RigidArm(const SimplexMesh& mesh, const Solid& solid, int node)
    {
        const std::array<double, 3> x = mesh.spacePoint(node);
        const double orientation = D == 2 ? planeOrientation(mesh) : 1;
        for (int d = 0; d < D; ++d) r[d] = orientation*(x[mesh.axes[d]] - solid.pose.position[mesh.axes[d]]);
    }

    /// At the point of an element with these shape functions.
    RigidArm(const SimplexMesh& mesh, const Solid& solid, const int* nodes, const double* shape)
    {
        std::fill(r, r + D, 0.0);
        for (int a = 0; a <= D; ++a)
        {
            const RigidArm arm(mesh, solid, nodes[a]);
            for (int d = 0; d < D; ++d) r[d] += shape[a]*arm.r[d];
        }
    }

    /// On a flat piece of the solid's surface, for removeTurning(); v: along its normal (D).
    void onSurface(const Turning<D>& turning, const double* v)
    {
        double length = 0;
        for (int d = 0; d < D; ++d) length += v[d]*v[d];
        if (!turning.isAny || length == 0) return;
        length = std::sqrt(length);
        for (int d = 0; d < D; ++d) normal[d] = v[d]/length;
        double moment[nDof] = {};   // of the normal, behind its force
        addLoads<1>(normal, moment);
        for (int k = 0; k < nAxes; ++k)
        {
            turn[k] = 0;
            for (int l = 0; l < nAxes; ++l) turn[k] += turning.projection[k*nAxes + l]*moment[D + l];
        }
        isTurning = true;
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

    /// Takes the moments about axes of symmetry (onSurface()) of the j-th of n forces, a pressure's, out of what addLoads() has added.
    template<int n>
    void removeTurning(int j, const double* force, double* load) const
    {
        if (!isTurning) return;
        double alongNormal = 0;
        for (int d = 0; d < D; ++d) alongNormal += normal[d]*force[d*n + j];
        for (int k = 0; k < nAxes; ++k) load[(D + k)*n + j] -= turn[k]*alongNormal;
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
        arm[a].template removeTurning<B>(D, m, row[b]);
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

} // namespace flotsam
