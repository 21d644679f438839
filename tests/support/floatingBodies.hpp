// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies in water at rest on a mesh with moved nodes, released: what the first step makes of them.
#pragma once

#include "equations/fluid.hpp"
#include "equations/initialProfile.hpp"
#include "equations/surfaceLevel.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/cutFlows.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <functional>

namespace flotsam
{

/// A closed tank, the unit square or cube with slip walls, gravity against its last direction.
class FloatingBodies
{
public:
    static constexpr double gravity = 10;   // [m/s^2]
    static constexpr int n = 10;            // elements a side

    /// Alike, of density `density`; mean inertia of a disc of this radius, about any axis.
    FloatingBodies(int dim, std::shared_ptr<const Shape> shape, double density, double radius)
    :   shape_(std::move(shape)), mesh_(makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.12)), halo_(mesh_, MPI_COMM_WORLD), cells_(mesh_)
    {
        usePetsc();
        properties_.gravity[dim - 1] = -gravity;
        controls_.tolerance = 1e-10;
        controls_.forceTolerance = 1e-8;
        controls_.maxIterations = 500;
        mass_ = density*shape_->moments().volume;
        inertia_ = mass_*radius*radius/2;
    }

    double mass() const { return mass_; }
    double inertia() const { return inertia_; }

    /// Acceleration and angular acceleration in the first step of a body at `position`, water up to `level`; profile: width of the surface's, over the default one.
    Motion release(const Vec3& position, double level, const std::function<double(const double* x)>& profile = {})
    {
        return release(std::vector<Vec3>{position}, level, profile)[0];
    }

    /// Of bodies at these positions, without what contact makes of it.
    std::vector<Motion> release(const std::vector<Vec3>& positions, double level, const std::function<double(const double* x)>& profile = {})
    {
        constexpr double dt = 0.002;
        Fluid fluid(mesh_, halo_, properties_, controls_, allPatches(mesh_, BoundaryPatch::Velocity::Slip));
        std::vector<Solid> solids(positions.size());
        for (std::size_t s = 0; s < solids.size(); ++s)
        {
            solids[s].kind = Solid::Kind::Free;
            solids[s].shape = shape_;
            solids[s].pose.position = positions[s];
        }
        fluid.start(restState(fluid, level, profile), false);
        CoverBuilder builder(mesh_, fluid.graph(), halo_);
        for (int pass = 0; pass < 6; ++pass) builder.buildExactVolume(solids);
        fluid.setGeometry(&builder.cover(), &solids, true);
        FreeBody body;
        body.mass = mass_;
        body.inertia = Eigen::Matrix3d::Identity()*inertia_;
        body.force[mesh_.dim - 1] = -gravity*mass_;
        fluid.beginStep(dt);
        fluid.assemble();
        REQUIRE(fluid.solve(std::vector<FreeBody>(solids.size(), body)).hasConverged);
        std::vector<Motion> motions = fluid.solidMotions();
        for (Motion& motion : motions)
        {
            motion.velocity /= dt;
            motion.angularVelocity /= dt;
        }
        return motions;
    }

private:
    FlowState restState(const Fluid& fluid, double level, const std::function<double(const double* x)>& profile) const
    {
        FlowState state = flotsam::restState(mesh_);
        const int dim = mesh_.dim;
        double down[3] = {};
        down[dim - 1] = -1;
        const std::vector<double> width = interfaceWidth(mesh_, fluid.graph(), halo_, controls_.interfaceWidth);
        for (int i = 0; i < mesh_.nNodes; ++i)
        {
            const double* x = &mesh_.x[std::size_t(i)*dim];
            state.alpha[i] = profileSlab(&cells_, i, down, level - x[dim - 1], width[i]*(profile ? profile(x) : 1)).mean();
        }
        halo_.update(state.alpha, 1);
        state.alphaOld = state.alphaOlder = state.alpha;
        return state;
    }

    std::shared_ptr<const Shape> shape_;
    SimplexMesh mesh_;
    Halo halo_;
    DualCells cells_;
    FluidProperties properties_;
    NumericsControls controls_;
    double mass_, inertia_;
};

} // namespace flotsam
