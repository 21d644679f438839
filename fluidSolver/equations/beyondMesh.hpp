// SPDX-License-Identifier: GPL-3.0-or-later
/// Loads of the fluid on what of bodies lies beyond the mesh, where they leave it or come in: without them a log would tip over the end of the bed as soon as its tip is
/// outside, where nothing carries it, and the pressure on its other end would drive it out.
///
/// The channel is taken to go on: p is constant along the normal n of an open patch, beyond it (within 30 degrees of a vertical one: not above a top). With grad p = its gradient along the patch, G,
///
///     - int p n_s dS (surface beyond the patch) = - int_patch (p n chi + G l) dA
///
/// by the divergence theorem; chi: 1 where the patch's point lies in the body, l: length of the body on the line from there along n. Where the patch prescribes
/// the pressure, p and G are those of the prescribed values (a free overfall, p = 0, carries nothing). Else G is the weight of the fluid at the patch, and p that of water
/// and gas at rest with the flow's mean at the patch, each by itself: not the flow's beside the body, which has the pressure by which the body's own acceleration is
/// resisted on this side of the patch, and with that on the other side, too, a light body was driven on by what ought to hold it. The fluid there has to be moved by the body,
/// too: without this inertia one of a hundredth of the fluid's density rose with a hundred times gravity as soon as it was outside. It is that of the displaced fluid, axis by
/// axis times that of an ellipsoid, about: with half the body's extents a, b, c it is (1/a)/(1/b + 1/c) along the first (exact for elliptic cylinders and the sphere: Lamb,
/// Hydrodynamics, 1932). Viscous forces and a wake beyond the mesh are left out.
#pragma once

#include "algebra/halo.hpp"
#include "core/boundary.hpp"
#include "core/controls.hpp"
#include "equations/flowStep.hpp"

#include <array>

namespace flotsam
{

class BeyondMesh
{
public:
    /// Of the patches that bodies can pass (BoundaryPatch::stopsBodies). References must outlive this. Collective.
    BeyondMesh(const SimplexMesh& mesh, const Halo& halo, const FluidProperties& fluid, const std::vector<BoundaryPatch>& patches);

    /// Whether a body may reach beyond one of these patches. The same on every rank.
    bool isReached(const std::vector<Solid>& solids) const;

    /// Adds this rank's share to what bodies have: nDof numbers each of loads (force, moment about the pose's position), nDof*nDof each of inertia, to be multiplied with the rate of
    /// solidVelocity(); 2D: per unit thickness. Collective.
    void addLoads(const FlowStepData& step, int nDof, std::vector<double>& loads, std::vector<double>& inertia) const;

private:
    struct Face;
    struct Outside;
    struct Passage { int patch; std::array<Vec3, 2> bounds; }; // patch: in patches_; bounds: of all of its faces, all ranks [m]

    bool isReached(const Passage& passage, const Solid& solid) const;
    double side(const FlowStepData& step, int node) const;
    void setStreamPressures(const FlowStepData& step, const BoundaryPatch& patch, std::vector<double>& p) const;
    Face makeFace(const FlowStepData& step, const BoundaryPatch& patch, std::size_t f, const std::vector<double>& pressure) const;
    std::vector<Face> makeFaces(const FlowStepData& step, const BoundaryPatch& patch, const std::vector<double>& pressure) const;
    double weightShare(const std::vector<Face>& faces) const;
    double density(const Face& face, const std::array<double, 3>& shape) const;
    void addFace(const Face& face, const Solid& solid, double share, Outside& outside) const;
    void addSolid(const std::vector<Face>& faces, const Solid& solid, double share, double* load, double* inertia) const;

    const SimplexMesh& mesh_;
    const Halo& halo_;
    const FluidProperties& fluid_;
    Vec3 gravity_;
    const std::vector<BoundaryPatch>& patches_;
    std::vector<std::array<double, 3>> points_; // shape functions of a face where the lines begin
    std::vector<Passage> passages_;
};

} // namespace flotsam
