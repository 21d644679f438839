// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies in water at rest on a mesh with moved nodes, released: what the first step makes of them.
#pragma once

#include "geometry/coverBuilder.hpp"
#include "support/cutFlows.hpp"
#include "support/waterAtRest.hpp"

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
    :   shape_(std::move(shape)), mesh_(makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.12)), halo_(mesh_, MPI_COMM_WORLD)
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
        fluid.start(waterAtRest(fluid, level, profile), false);
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
    std::shared_ptr<const Shape> shape_;
    SimplexMesh mesh_;
    Halo halo_;
    FluidProperties properties_;
    NumericsControls controls_;
    double mass_, inertia_;
};

} // namespace flotsam
