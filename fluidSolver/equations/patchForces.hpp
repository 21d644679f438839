// SPDX-License-Identifier: GPL-3.0-or-later
/// Force of the fluid on patches of the mesh, from the discrete equations.
///
/// With the test function that is 1 everywhere the momentum rows are the budget of the fluid: what they leave where a wall prescribes the velocity, and what the walls'
/// own terms add to them (FlowEquation::addPatchForces), is the force between fluid and walls, to round-off and whatever the mesh. An integral of the stress
/// would be one order less accurate, and the budget would not close by it.
///
/// A node's reaction belongs to all patches that meet there. Each has the pressure on its faces; what is left goes to those whose normals it is along.
///
/// Along the wall's normal: pressure (the normal viscous stress vanishes at a rigid wall); across it: friction.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/simplexMesh.hpp"
#include "geometry/solid.hpp"

#include <vector>

namespace flotsam
{

/// Of the fluid on a patch, in space, of a 2D mesh times its thickness; moments about the origin of space.
struct PatchForce
{
    Vec3 pressure = Vec3::Zero(), friction = Vec3::Zero();              ///< [N]
    Vec3 pressureMoment = Vec3::Zero(), frictionMoment = Vec3::Zero();  ///< [N m]; 2D: along the empty direction alone
};

/// Adds the momentum rows of a block of (D+1)^2 values, row-major, times a node's velocity and pressure.
template<int D>
inline void addMomentumRows(const double* block, const double* x, double* force)
{
    for (int k = 0; k < D; ++k)
        for (int l = 0; l <= D; ++l) force[k] += block[k*(D + 1) + l]*x[l];
}

class PatchForces
{
public:
    /// asked: indices in `patches`, which let no fluid through.
    PatchForces(const SimplexMesh& mesh, const Halo& halo, const std::vector<BoundaryPatch>& patches, const std::vector<int>& asked);

    bool isAsked(int patch) const { return isAsked_[patch]; }
    bool isNear(int node) const { return place_[node] >= 0; }   ///< of an asked patch; owned nodes and those of their elements

    void start();
    /// Force f (dim values) on a node, from a face with terms of its own; normal: the face's, unit.
    void addFace(int patch, int node, const double* f, const double* normal);
    /// Pressure on the part of a face that goes to its node: part of what addReaction() has there.
    void addTraction(int patch, int node, const double* f);
    void addReaction(int node, const double* f);
    /// What walls that meet at the node `edge` feel at another one.
    void addAtEdge(int edge, int node, const double* f);
    /// Pressure on a face; first: int N_a p at the corners of its element, normal: unit, out of the mesh.
    void addFacet(int patch, int element, const double* first, const double* normal);
    /// Shares out the reactions; sums of all ranks. Collective.
    void finish();

    /// One per patch; of those that were not asked for zero.
    const std::vector<PatchForce>& result() const { return result_; }

private:
    /// Faces of a patch and of one direction around a node. normal: unit, out of the mesh, in the mesh's components; size: their area; traction: of this step.
    struct Share { int patch; Vec3 normal; double size; Vec3 traction; };

    void findNodes();
    static void addToShares(int patch, const Vec3& area, std::vector<Share>& shares);
    void add(int patch, int node, const double* pressure, const double* friction);
    void shareOut(int place, int node, const double* f);
    Vec3 toSpace(const double* f) const;

    const SimplexMesh& mesh_;
    const Halo& halo_;
    const std::vector<BoundaryPatch>& patches_;
    std::vector<char> isAsked_;
    std::vector<int> place_;            // nNodes: in start_, -1: at no asked patch
    std::vector<int> node_, first_;     // of each place; first_ has one more
    std::vector<Share> shares_;
    std::vector<double> reaction_;      // places*dim
    std::vector<PatchForce> result_;
};

} // namespace flotsam
