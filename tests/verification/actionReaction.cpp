// SPDX-License-Identifier: GPL-3.0-or-later
/// Action equals reaction in the linear system: the forces of walls and ghost faces on the fluid stand with the opposite sign in the solids' rows.
#include "algebra/flowOperator.hpp"
#include "equations/fluid.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/flowCases.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double rho = 1000, dt = 0.01;

std::vector<Solid> boxAndSphere()
{
    std::vector<Solid> solids(2);
    for (Solid& s : solids) s.kind = Solid::Kind::Free;
    solids[0].shape = makeBox(Vec3::Zero(), Vec3(0.31, 0.24, 0.3));
    solids[0].pose.position = Vec3(0.31, 0.42, 0.5);
    solids[0].pose.orientation = Eigen::AngleAxisd(0.4, Vec3::UnitZ());
    solids[1].shape = makeSphere(Vec3::Zero(), 0.17);
    solids[1].pose.position = Vec3(0.71, 0.62, 0.5);
    return solids;
}

/// Any velocities and pressures, the same on any number of ranks.
std::vector<double> someValues(const SimplexMesh& mesh)
{
    const int B = mesh.dim + 1;
    std::vector<double> x(std::size_t(mesh.nNodes)*B);
    for (int i = 0; i < mesh.nNodes; ++i)
        for (int c = 0; c < B; ++c) x[std::size_t(i)*B + c] = std::sin(1.0 + 7.77*(mesh.originalNode[i]*B + c))*(c == mesh.dim ? 1e4 : 1);
    return x;
}

/// sum -= int rho u/dt over the fluid: the inertia of a first step from rest.
void subtractInertia(const SimplexMesh& mesh, const Cover& cover, const std::vector<double>& x, double* sum)
{
    const int dim = mesh.dim, B = dim + 1;
    for (int e = 0; e < mesh.nElements; ++e)
    {
        if (!mesh.isOwnedElement[e] || cover.state[e] == ElementState::Solid) continue;
        const bool isCut = cover.state[e] == ElementState::Cut;
        for (int a = 0; a < B; ++a)
        {
            const double weight = isCut ? cover.cuts[cover.cutIndex[e]].first[a] : mesh.volume[e]/B;
            for (int d = 0; d < dim; ++d) sum[d] -= rho/dt*weight*x[std::size_t(mesh.elements[std::size_t(e)*B + a])*B + d];
        }
    }
}

} // namespace

TEST_CASE("action equals reaction to round-off: walls and ghost faces exchange what the solids' rows hold")
{
    usePetsc();
    for (int dim : {2, 3})
    {
        const int n = dim == 2 ? 16 : 8;
        const SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.1);
        const Halo halo(mesh, MPI_COMM_WORLD);
        FluidProperties properties;
        properties.isTwoPhase = false;
        properties.rhoLiquid = rho;
        properties.muLiquid = 10;
        NumericsControls controls;
        Fluid fluid(mesh, halo, properties, controls, allPatches(mesh, BoundaryPatch::Velocity::Fixed));
        fluid.start(restState(mesh), true);
        const std::vector<Solid> solids = boxAndSphere();
        CoverBuilder builder(mesh, fluid.graph(), halo);
        const Cover& cover = builder.build(solids);
        fluid.setGeometry(&cover, &solids, true);
        fluid.beginStep(dt);
        fluid.assemble();

        const FlowSystem& system = fluid.equation().system();
        const int B = dim + 1;
        const std::vector<double> x = someValues(mesh);
        std::vector<double> q(2*system.nDof), rows(std::size_t(mesh.nOwned)*B), solidRows(q.size());
        for (std::size_t k = 0; k < q.size(); ++k) q[k] = std::cos(3.3*k);
        const FlowOperator op(fluid.graph(), halo, system, mesh.nOwned);
        op.fluidRows(x.data(), q.data(), rows.data());
        op.solidRows(x.data(), q.data(), solidRows.data());

        // summed over all rows only the inertia of the fluid is left
        double sum[3] = {0, 0, 0}, size = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
            for (int d = 0; d < dim; ++d)
            {
                sum[d] += rows[std::size_t(i)*B + d];
                size += std::abs(rows[std::size_t(i)*B + d]);
            }
        subtractInertia(mesh, cover, x, sum);
        halo.sum(sum, 3);
        size = halo.sum(size);
        for (int d = 0; d < dim; ++d)
        {
            const double total = sum[d] + solidRows[d] + solidRows[system.nDof + d];
            CHECK(std::abs(total) < 1e-13*size);
        }
        CHECK(std::abs(solidRows[0]) > 1e-6*size);
    }
}
