// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/viscousForce.hpp"
#include "support/boxMesh.hpp"

#include <algorithm>
#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

constexpr double rho = 1000, mu = 2;
constexpr int cells = 6;

/// A box in which the velocity is (x^2, x y, z^2) + what is linear: its Laplacian is (2, 0, 2).
struct Scene
{
    SimplexMesh mesh;
    Halo halo;
    ViscousForce force;
    std::vector<double> density, viscosity, velocity;

    explicit Scene(int dim)
    :   mesh(makeBoxMesh(MPI_COMM_WORLD, dim, {cells, cells, cells}, {0, 0, 0}, {1, 1, 1})), halo(mesh, MPI_COMM_WORLD), force(mesh, halo),
        density(mesh.nNodes, rho), viscosity(mesh.nNodes, mu)
    {
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[std::size_t(i)*dim];
            velocity.push_back(x[0]*x[0] + 3*x[1]);
            velocity.push_back(x[0]*x[1] - x[0]);
            if (dim == 3) velocity.push_back(x[2]*x[2] + x[1]);
        }
    }

    bool find(double dt = 1e3) { return force.find(density, viscosity, velocity, nullptr, dt); }

    template<class Condition>
    bool haveAllNodes(int e, Condition condition) const
    {
        const int n = mesh.dim + 1, *nodes = &mesh.elements[std::size_t(e)*n];
        return std::all_of(nodes, nodes + n, condition);
    }

    bool isInside(int i) const
    {
        const double* x = &mesh.x[std::size_t(i)*mesh.dim];
        return std::all_of(x, x + mesh.dim, [](double c) { return c > 1e-9 && c < 1 - 1e-9; });
    }

    /// Largest difference from `share` of the exact force in the element.
    double error(int e, double share) const
    {
        double worst = 0;
        for (int d = 0; d < mesh.dim; ++d)
            worst = std::max(worst, std::abs(force.values()[std::size_t(e)*mesh.dim + d] - share*(d == 1 ? 0 : 2*mu)));
        return worst;
    }
};

} // namespace

TEST_CASE("The viscous force of a quadratic velocity is exact where all elements around are fluid")
{
    for (int dim : {2, 3})
    {
        Scene scene(dim);
        REQUIRE(scene.find());
        for (int e = 0; e < scene.mesh.nElements; ++e)
            if (scene.haveAllNodes(e, [&](int i) { return scene.isInside(i); })) CHECK(scene.error(e, 1) < 1e-9);
    }
}

TEST_CASE("Elements beside a density that varies have no viscous force")
{
    Scene scene(2);
    const double surface = 0.5, h = 1.0/cells;
    const auto y = [&](int i) { return scene.mesh.x[std::size_t(i)*2 + 1]; };
    for (int i = 0; i < scene.mesh.nNodes; ++i)
        if (y(i) > surface + 1e-9) scene.density[i] = 1;
    REQUIRE(scene.find());
    for (int e = 0; e < scene.mesh.nElements; ++e)
    {
        if (!scene.haveAllNodes(e, [&](int i) { return scene.isInside(i); })) continue;
        const bool isAway = scene.haveAllNodes(e, [&](int i) { return y(i) < surface - 0.5*h || y(i) > surface + 1.5*h; });
        CHECK(scene.error(e, isAway ? 1 : 0) < 1e-9);
    }
}

TEST_CASE("The viscous force is left out where the time step is short")
{
    Scene scene(3);
    const double h = scene.mesh.h[0], viscousTime = h*h*rho/mu;
    CHECK(!scene.find(1e-3*viscousTime));
    CHECK(scene.find(1e-2*viscousTime));
}
