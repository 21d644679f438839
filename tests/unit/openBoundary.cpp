// SPDX-License-Identifier: GPL-3.0-or-later
/// What open boundaries take from the fluid's kinetic energy, beside the skew-symmetric convection, which takes none
/// (docs/numerics/2-momentum.md, 2.8).
#include "core/patchFaces.hpp"
#include "equations/fluid.hpp"
#include "support/flowCases.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

constexpr double rho = 1000;    // [kg/m^3]

/// Slip patches, those across x of the given kind.
std::vector<BoundaryPatch> channelPatches(const SimplexMesh& mesh, BoundaryPatch::Velocity ends)
{
    std::vector<BoundaryPatch> patches = allPatches(mesh, BoundaryPatch::Velocity::Slip);
    for (int p : {0, 1}) patches[p] = makePatch(mesh, p, ends);
    return patches;
}

/// Sheared: the ends are not across an axis.
SimplexMesh shearedBox(int dim)
{
    SimplexMesh mesh = makeBoxMesh(MPI_COMM_WORLD, dim, {6, 4, 3}, {0, 0, 0}, {1, 1, dim == 2 ? 2. : 0.7}, 0.15);
    for (int i = 0; i < mesh.nNodes; ++i) mesh.x[std::size_t(i)*dim] += 0.4*mesh.x[std::size_t(i)*dim + 1];
    mesh.computeGeometry();
    return mesh;
}

/// Velocity block of the system of a flow that is `velocity` everywhere.
std::vector<double> velocityBlock(const SimplexMesh& mesh, const Halo& halo, BoundaryPatch::Velocity ends, const Vec3& velocity)
{
    Fluid fluid(mesh, halo, oneFluid(rho, 1e-3), NumericsControls(), channelPatches(mesh, ends));
    FlowState state = restState(mesh);
    for (int i = 0; i < mesh.nNodes; ++i)
        for (int d = 0; d < mesh.dim; ++d) state.u[std::size_t(i)*mesh.dim + d] = velocity[d];
    state.uOld = state.u;
    fluid.start(state, false);
    fluid.beginStep(0.1);
    fluid.assemble();
    return fluid.equation().system().matrix.velocity;
}

/// Area vector of a patch [m^(dim-1)], outwards.
Vec3 areaOf(const SimplexMesh& mesh, const Halo& halo, int patch)
{
    double sum[3] = {}, v[3];
    for (std::size_t f = 0; f < mesh.patches[patch].faceElement.size(); ++f)
    {
        if (!mesh.isOwnedElement[mesh.patches[patch].faceElement[f]]) continue;
        outwardVector(mesh, mesh.patches[patch], f, v);
        for (int d = 0; d < mesh.dim; ++d) sum[d] += v[d];
    }
    halo.sum(sum, 3);
    return Vec3(sum[0], sum[1], sum[2]);
}

/// w.(what the open patch adds to the matrix) w, for the same w at all of its nodes.
double taken(const SimplexMesh& mesh, const Halo& halo, int patch, const std::vector<double>& added, const Vec3& w)
{
    const NodeGraph graph(mesh);
    const std::size_t dim = mesh.dim;
    double sum = 0;
    for (int i : nodesOf(mesh.patches[patch]))
    {
        if (i >= mesh.nOwned) continue;
        for (int k = graph.rowStart[i]; k < graph.rowStart[i + 1]; ++k)
            for (std::size_t r = 0; r < dim; ++r)
                for (std::size_t c = 0; c < dim; ++c) sum += w[r]*added[k*dim*dim + r*dim + c]*w[c];
    }
    return halo.sum(sum);
}

} // namespace

// Half of what the fluid carries: of what leaves all, of what enters the part along the boundary, so that it ends without one.
TEST_CASE("an open boundary takes the energy of what leaves, and of what enters that along the boundary")
{
    usePetsc();
    for (const int dim : {2, 3})
    {
        const SimplexMesh mesh = shearedBox(dim);
        const Halo halo(mesh, MPI_COMM_WORLD);
        const Vec3 velocity(1.3, -0.6, dim == 2 ? 0 : 0.5);
        std::vector<double> added = velocityBlock(mesh, halo, BoundaryPatch::Velocity::Open, velocity);
        const std::vector<double> closed = velocityBlock(mesh, halo, BoundaryPatch::Velocity::Slip, velocity);
        for (std::size_t k = 0; k < added.size(); ++k) added[k] -= closed[k];
        for (const int patch : {0, 1})
        {
            const Vec3 area = areaOf(mesh, halo, patch), normal = area.normalized();
            const double flux = velocity.dot(area);     // [m^dim/s]
            REQUIRE((flux < 0) == (patch == 0));
            for (const Vec3& w : {normal, Vec3(-normal.y(), normal.x(), 0), Vec3(0.3, 1, 0), Vec3(1, 0, dim == 2 ? 0 : 1)})
            {
                const double across = w.dot(normal), counted = flux > 0 ? w.squaredNorm() : w.squaredNorm() - across*across;
                CHECK(taken(mesh, halo, patch, added, w) == within(0.5*rho*std::abs(flux)*counted, 1e-14*rho*std::abs(flux)*w.squaredNorm()));
            }
        }
    }
}
