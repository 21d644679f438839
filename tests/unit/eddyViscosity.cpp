// SPDX-License-Identifier: GPL-3.0-or-later
/// The eddy viscosity of a stream with a logarithmic profile, beside its surface, at a smooth wall; the distances it is made of.
#include "equations/eddyViscosity.hpp"
#include "geometry/patchDistance.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <algorithm>
#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double kappa = 0.41, friction = 0.1, depth = 1, rho = 1000, mu = 1e-3, z0 = 1e-3;

/// A stream along x over its bed, y = 0 (3D: z = 0), two depths high.
struct Stream
{
    SimplexMesh mesh;
    Halo halo;
    NodalData nodal;
    NumericsControls controls;

    Stream(int dim, int n)
    :   mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {dim == 2 ? n : n/2, dim == 2 ? 2*n : 3, 2*n}, {0, 0, 0}, {1, dim == 2 ? 2. : 0.5, 2})), halo(mesh, MPI_COMM_WORLD)
    {
        controls.mixingDepth = depth;
        controls.wallRoughness = 0.02;
        nodal.rho.assign(mesh.nNodes, rho);
        nodal.mu.assign(mesh.nNodes, mu);
        nodal.fluid.assign(mesh.nNodes, NodalData::Liquid);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            nodal.advection.push_back(friction/kappa*std::log(1 + height(i)/z0));
            for (int d = 1; d < dim; ++d) nodal.advection.push_back(0);
        }
    }

    double height(int i) const { return mesh.x[std::size_t(i)*mesh.dim + mesh.dim - 1]; }

    std::vector<int> bed() const { return {2*(mesh.dim - 1)}; }

    void add(const Cover* cover = nullptr)
    {
        BoundaryPatch wall, side;
        wall.velocity = BoundaryPatch::Velocity::NoSlip;
        wall.meshPatch = bed()[0];
        side.velocity = BoundaryPatch::Velocity::Slip;
        side.meshPatch = 0;
        EddyViscosity(mesh, halo, {wall, side}, controls).add(cover, nodal);
    }

    bool isInside(int i) const
    {
        const double *x = &mesh.x[std::size_t(i)*mesh.dim], across = mesh.dim == 3 ? x[1] : 0.25;
        return x[0] > 1e-9 && x[0] < 1 - 1e-9 && across > 1e-9 && across < 0.5 - 1e-9;
    }

    /// Largest error over rho kappa u* H of nodes at heights from `first` to `last`, away from the sides, where gradients are those of one side.
    double error(double first, double last) const
    {
        double worst = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
            if (isInside(i) && height(i) > first - 1e-9 && height(i) < last + 1e-9)
                worst = std::max(worst, std::abs(nodal.eddy[i]/(rho*kappa*friction*depth) - height(i)*(1 - height(i)/depth)));
        return halo.max(worst);
    }
};

} // namespace

TEST_CASE("a logarithmic profile has the parabola kappa u* y (1 - y/H), with order 2 away from the bed")
{
    for (int dim : {2, 3})
    {
        std::vector<double> error;
        for (int n : {16, 32, 64})
        {
            if (dim == 3 && n == 64) continue;
            Stream stream(dim, n);
            stream.add();
            error.push_back(stream.error(0.25, 2./3));
            for (int i = 0; i < stream.mesh.nNodes; ++i) CHECK(stream.nodal.mu[i] == near(mu + stream.nodal.eddy[i], 1e-12));
        }
        MESSAGE("errors ", error.front(), ' ', error.back());
        CHECK(error.front() < 0.004);
        CHECK(std::log2(error[0]/error[1]) > 1.8);
    }
}

TEST_CASE("on the bed there is none, and at a solid neither")
{
    Stream stream(2, 16);
    Cover cover;
    cover.distance.assign(stream.mesh.nNodes, farDistance);
    cover.state.assign(stream.mesh.nElements, ElementState::Fluid);
    for (int i = 0; i < stream.mesh.nNodes; ++i)
        if (std::abs(stream.height(i) - 0.5) < 1e-9) cover.distance[i] = -0.01;
    stream.add(&cover);
    for (int i = 0; i < stream.mesh.nNodes; ++i)
    {
        const double y = stream.height(i);
        if (y < 1e-9 || std::abs(y - 0.5) < 1e-9) CHECK(stream.nodal.eddy[i] == 0);
        else CHECK(stream.nodal.eddy[i] > 0.02*rho*kappa*friction*depth);
    }
}

// gas that is dragged along has a shear of its own: a hundred times as much here
TEST_CASE("liquid at the surface has what the liquid below has, gas next to nothing")
{
    for (int dim : {2, 3})
    {
        Stream stream(dim, 16);
        Stream whole(dim, 16);
        whole.add();
        for (int i = 0; i < stream.mesh.nNodes; ++i)
        {
            const double y = stream.height(i);
            if (y < 0.5 - 1e-9) continue;
            stream.nodal.fluid[i] = y < 0.7 ? NodalData::Mixed : NodalData::Gas;
            stream.nodal.rho[i] = y < 0.6 ? 1000 : 1;
            stream.nodal.mu[i] = 1e-5;
            if (y > 0.56) stream.nodal.advection[std::size_t(i)*dim] = 100*(y - 0.56);
        }
        stream.add();
        const double below = rho*kappa*friction*depth*(7./16)*(9./16);
        for (int i = 0; i < stream.mesh.nOwned; ++i)
        {
            const double y = stream.height(i);
            if (y < 0.4) CHECK(stream.nodal.eddy[i] == whole.nodal.eddy[i]);
            else if (y < 0.6) CHECK(stream.nodal.eddy[i] == near(below, 0.15));
            else CHECK(stream.nodal.eddy[i] <= 1.2e-3*below);
        }
    }
}

// (nu + nu_t) S = 1 in wall units, from the wall to y+ = 1000: u+ = y+ at the wall, ln(y+)/kappa + 5.2 far from it
TEST_CASE("van Driest's layer at a smooth wall")
{
    const auto shear = [](double y)
    {
        double low = 0, high = 1;
        for (int k = 0; k < 60; ++k)
        {
            const double s = 0.5*(low + high);
            ((1 + dampedEddyViscosity(kappa*y, y, s, 1))*s > 1 ? high : low) = s;
        }
        return low;
    };
    double u = 0, y = 0;
    for (int k = 1; k <= 4000; ++k)
    {
        const double next = 1000*std::pow(k/4000., 3);
        u += (next - y)*shear(0.5*(y + next));
        y = next;
        if (k == 400) CHECK(u == near(y, 0.02));
        if (k > 2000 && k%500 == 0) CHECK(u == near(std::log(y)/kappa + 5.2, 0.02));
    }
}

TEST_CASE("distances from patches are exact up to the farthest")
{
    for (int dim : {2, 3})
    {
        const Stream stream(dim, 8);
        const std::vector<double> distance = distanceFromPatches(stream.mesh, stream.halo, {0, stream.bed()[0]}, 0.3);
        for (int i = 0; i < stream.mesh.nNodes; ++i)
            CHECK(distance[i] == near(std::min({0.3, stream.height(i), stream.mesh.x[std::size_t(i)*dim]}), 1e-12));
    }
}
