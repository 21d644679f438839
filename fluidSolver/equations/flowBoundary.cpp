// SPDX-License-Identifier: GPL-3.0-or-later
/// Boundary conditions on the mesh's patches: prescribed directions, open boundaries.
#include "equations/flowEquation.hpp"

#include "core/patchFaces.hpp"
#include "equations/faceMoments.hpp"
#include "equations/gasRegion.hpp"
#include "equations/rigidCoupling.hpp"
#include "equations/shutPockets.hpp"
#include "equations/slipNormals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace flotsam
{

namespace
{

/// A face of a wall, with area vector v, to the normals of its nodes, with the weights by which these are exact on circles and spheres (Max 1999,
/// doi 10.1080/10867651.1999.10487501): one over the squares of its edges at the node.
void addToNormals(const SimplexMesh& mesh, const int* nodes, const double* v, std::map<int, SlipNormals>& slip)
{
    const int dim = mesh.dim;
    for (int k = 0; k < dim; ++k)
    {
        double place[3] = {}, weighted[3], weight = 1;
        for (int l = 0; l < dim; ++l)
        {
            double square = 0;
            for (int d = 0; d < dim; ++d)
            {
                const double edge = mesh.x[std::size_t(nodes[l])*dim + d] - mesh.x[std::size_t(nodes[k])*dim + d];
                place[d] += edge/dim;
                square += edge*edge;
            }
            if (l != k) weight /= square;
        }
        for (int d = 0; d < dim; ++d) weighted[d] = weight*v[d];
        slip[nodes[k]].addFace(weighted, place, dim);
    }
}

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
        if (!p.isWall()) continue;
        const MeshPatch& patch = mesh_.patches[p.meshPatch];
        for (std::size_t f = 0; f < patch.faceElement.size(); ++f)
        {
            double v[3];
            outwardVector(mesh_, patch, f, v);
            addToNormals(mesh_, &patch.faceNodes[f*dim], v, slip);
        }
    }
    for (int i = 0; i < mesh_.nNodes; ++i)
        if (isFixed[i]) constraints_.push_back(wholeVelocity(i, dim));
    for (auto& [node, normals] : slip) normals.findWalls();
    findWallRims(isFixed);
    std::vector<int> isEdge(mesh_.nNodes, 0), isBend(mesh_.nNodes, 0);
    for (const auto& [node, normals] : slip)
    {
        if (isFixed[node]) continue;
        constraints_.push_back(normals.constraint(node, dim));
        isEdge[node] = normals.hasEdge();
        isBend[node] = normals.isBent();
    }
    halo_.update(isEdge, 1);    // second-ring copies do not see all of their faces
    halo_.update(isBend, 1);
    isSlipEdge_.assign(isEdge.begin(), isEdge.end());
    isSlipBend_.assign(isBend.begin(), isBend.end());
    findEdgeElements(slip);
    for (const NodeConstraint& c : constraints_)
        if (c.node < mesh_.nOwned) system_.constraints.push_back(c);
    nPatchConstraints_ = system_.constraints.size();
    std::vector<double> flags(isPressureFixed.begin(), isPressureFixed.end());
    halo_.update(flags, 1);
    system_.isPressureFixed.assign(flags.begin(), flags.end());
    isPatchPressureFixed_ = system_.isPressureFixed;
    isPressureWeak_.assign(mesh_.nNodes, 0);
}

/// Nodes of no-slip walls at which the velocity is prescribed. Patches of `wall` type do not move them: they may move along themselves, but nothing passes.
void FlowEquation::findWallRims(const std::vector<char>& isFixed)
{
    std::vector<char> isResting(mesh_.nNodes, 0);
    for (const BoundaryPatch& p : patches_)
        for (int i : p.nodes)
            if (p.isNoSlipWall && isFixed[i]) isResting[i] = 1;
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (isResting[i]) restingNodes_.push_back(i);
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        const bool isWall = patches_[p].isNoSlipWall || mesh_.patches[patches_[p].meshPatch].type == "wall";
        if (patches_[p].velocity == BoundaryPatch::Velocity::Fixed && !isWall) addRimNodes(int(p), isResting);
    }
}

void FlowEquation::addRimNodes(int p, const std::vector<char>& isResting)
{
    const int dim = mesh_.dim;
    const MeshPatch& faces = mesh_.patches[patches_[p].meshPatch];
    const std::vector<int>& nodes = patches_[p].nodes;
    std::map<int, std::array<double, 3>> area;
    for (std::size_t k = 0; k < faces.faceNodes.size(); ++k)
    {
        const int i = faces.faceNodes[k];
        if (i >= mesh_.nOwned || !isResting[i]) continue;   // owned nodes see all of their faces
        double v[3];
        outwardVector(mesh_, faces, k/dim, v);
        for (int d = 0; d < dim; ++d) area[i][d] += v[d];
    }
    for (const auto& [node, v] : area) rimNodes_.push_back({node, p, int(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()), v});
}

/// A node that an inlet shares with a no-slip wall moves with the inlet, and the wall holds the fluid on its faces, as everywhere. Resting nodes would make a layer without
/// momentum, one element thick, behind the inlet. Nothing passes a lid: there the wall wins.
void FlowEquation::setRimVelocities(const std::vector<PatchValues>& values, std::vector<double>& x) const
{
    constexpr double along = 1e-6;      // across over whole velocity: round-off
    const int dim = mesh_.dim, B = dim + 1;
    for (int i : restingNodes_)
        for (int d = 0; d < dim; ++d) x[std::size_t(i)*B + d] = 0;
    for (const RimNode& rim : rimNodes_)
    {
        const double* u = &values[rim.patch].velocity[std::size_t(rim.position)*dim];
        double through = 0, area2 = 0, speed2 = 0;
        for (int d = 0; d < dim; ++d)
        {
            through += u[d]*rim.area[d];
            area2 += rim.area[d]*rim.area[d];
            speed2 += u[d]*u[d];
        }
        if (through*through > along*along*area2*speed2)
            for (int d = 0; d < dim; ++d) x[std::size_t(rim.node)*B + d] = u[d];
    }
}

bool FlowEquation::isOfPocket(int e) const
{
    const int n = mesh_.dim + 1, *nodes = &mesh_.elements[std::size_t(e)*n];
    return step_.pockets && std::any_of(nodes, nodes + n, [&](int i) { return step_.pockets->isNode(i); });
}

/// Shut pockets are solved for nothing: see ShutPockets.
void FlowEquation::holdPockets()
{
    system_.constraints.resize(nPatchConstraints_);
    if (!step_.pockets || !step_.pockets->areAny()) return;
    for (int i = 0; i < mesh_.nOwned; ++i)
        if (step_.pockets->isNode(i)) system_.constraints.push_back(wholeVelocity(i, mesh_.dim));
}

/// Velocity of the nearest solid and pressure of the pockets' nodes. Before the patches' values, which count where a node has both.
void FlowEquation::applyPockets(std::vector<double>& x) const
{
    if (!step_.pockets || !step_.pockets->areAny()) return;
    for (int i = 0; i < mesh_.nNodes; ++i)
    {
        if (!step_.pockets->isNode(i)) continue;
        double q[6], *values = &x[std::size_t(i)*(mesh_.dim + 1)];
        values[mesh_.dim] = step_.pockets->pressure(i);
        if (step_.cover->nearestSolid[i] < 0) continue; // beside gas that is left out
        const Solid& solid = (*step_.solids)[step_.cover->nearestSolid[i]];
        solidVelocity(mesh_, solid, q);
        if (mesh_.dim == 2) RigidArm<2>(mesh_, solid, i).velocity(q, values);
        else RigidArm<3>(mesh_, solid, i).velocity(q, values);
    }
}

/// Nodes through whose faces liquid enters under a given pressure. What the skew-symmetric convection leaves out there makes that pressure the total one,
/// p + rho (u.n) u/2 = p0: the unknown is the static pressure, lower by rho u^2/2. Held at p0 it would contradict the momentum by the dynamic pressure, which
/// then goes into the first elements. It is left to the equations; p0 acts in the boundary term alone (addOpenFace). For gas that is too little to matter.
/// Not in solids that stick out of the mesh: no equation has a pressure there, and what the start of each solve extrapolates would run away.
void FlowEquation::findWeakPressures()
{
    const int dim = mesh_.dim;
    const auto isGiven = [](const BoundaryPatch& p) { return p.velocity == BoundaryPatch::Velocity::Open && p.pressure != BoundaryPatch::Pressure::Natural; };
    if (std::none_of(patches_.begin(), patches_.end(), isGiven)) return;
    entering_.assign(mesh_.nNodes, 0.0);
    for (const BoundaryPatch& patch : patches_)
    {
        if (!isGiven(patch)) continue;
        const MeshPatch& faces = mesh_.patches[patch.meshPatch];
        for (std::size_t f = 0; f < faces.faceElement.size(); ++f)
        {
            const int* nodes = &faces.faceNodes[f*dim];
            double v[3], through = 0;
            outwardVector(mesh_, faces, f, v);
            for (int k = 0; k < dim; ++k)
                for (int d = 0; d < dim; ++d) through += nodal_.advection[std::size_t(nodes[k])*dim + d]*v[d]/dim;
            for (int k = 0; k < dim; ++k) entering_[nodes[k]] -= through/dim;
        }
    }
    halo_.update(entering_, 1);      // second-ring copies do not see all of their faces
    const auto isLiquid = [this](int i) { return (!fluid_.isTwoPhase || step_.state->alpha[i] > 0.5) && !(step_.cover && step_.cover->distance[i] < 0); };
    for (int i = 0; i < mesh_.nNodes; ++i) isPressureWeak_[i] = entering_[i] > 0 && isLiquid(i);
}

/// By patches, at the edge of gas that is left out, in shut pockets.
void FlowEquation::fixPressures()
{
    findWeakPressures();
    for (int i = 0; i < mesh_.nNodes; ++i)
        system_.isPressureFixed[i] = (isPatchPressureFixed_[i] && !isPressureWeak_[i]) || (step_.gas && step_.gas->isEdge()[i]) || (step_.pockets && step_.pockets->isNode(i));
}

void FlowEquation::applyConstraints(const std::vector<PatchValues>& values, std::vector<double>& x) const
{
    const int dim = mesh_.dim, B = dim + 1;
    applyPockets(x);
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
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        const BoundaryPatch& patch = patches_[p];
        if (patch.velocity != BoundaryPatch::Velocity::Fixed) continue;
        for (std::size_t k = 0; k < patch.nodes.size(); ++k)
            for (int d = 0; d < dim; ++d)
                x[std::size_t(patch.nodes[k])*B + d] = values[p].velocity[k*dim + d];
    }
    setRimVelocities(values, x);
    for (std::size_t p = 0; p < patches_.size(); ++p)
    {
        if (patches_[p].pressure == BoundaryPatch::Pressure::Natural) continue;
        for (std::size_t k = 0; k < patches_[p].nodes.size(); ++k)
        {
            const int i = patches_[p].nodes[k];
            if (isPressureWeak_[i]) continue;
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
            const FaceMoments<D> moments(mesh_, step_.cover, faces.faceElement[f], nodes);
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
