// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/transportBoundary.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

struct Scene
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;
    VolumeFlux flux;

    Scene(int dim, int n)
        : mesh(makeBoxMesh(MPI_COMM_SELF, dim, {n, n, n}, {0, 0, 0}, {1, 1.2, 0.9}, 0.15)), graph(mesh), halo(mesh, MPI_COMM_SELF),
          flux(mesh, graph)
    {
    }

    /// A field that is neither divergence-free nor zero at the boundary.
    std::vector<double> velocity() const
    {
        std::vector<double> u(std::size_t(mesh.nNodes)*mesh.dim);
        for (std::size_t k = 0; k < u.size(); ++k)
        {
            u[k] = std::sin(1.7*double(k) + 0.3);
        }
        return u;
    }

    std::vector<double> fineScale() const
    {
        std::vector<double> u(std::size_t(mesh.nElements)*mesh.dim);
        for (std::size_t k = 0; k < u.size(); ++k)
        {
            u[k] = 0.1*std::cos(0.9*double(k));
        }
        return u;
    }

    std::vector<double> sumOfPairs(const std::vector<double>& u, const std::vector<double>& fine, const Cover* cover) const
    {
        std::vector<double> sum(mesh.nNodes, 0);
        double pair[6];
        for (int e = 0; e < mesh.nElements; ++e)
        {
            const int* nodes = &mesh.elements[std::size_t(e)*(mesh.dim + 1)];
            mesh.dim == 2 ? flux.ofElement<2>(e, u, fine, cover, pair) : flux.ofElement<3>(e, u, fine, cover, pair);
            int p = 0;
            for (int a = 0; a <= mesh.dim; ++a)
            {
                for (int b = a + 1; b <= mesh.dim; ++b, ++p)
                {
                    sum[nodes[a]] += pair[p];
                    sum[nodes[b]] -= pair[p];
                }
            }
        }
        return sum;
    }

    std::vector<double> sumOfRows(const std::vector<double>& u, const std::vector<double>& fine, const Cover* cover) const
    {
        std::vector<double> sum(mesh.nNodes, 0);
        for (int e = 0; e < mesh.nElements; ++e)
        {
            for (int a = 0; a <= mesh.dim; ++a)
            {
                sum[mesh.elements[std::size_t(e)*(mesh.dim + 1) + a]] += flux.row(e, a, u, fine, cover);
            }
        }
        return sum;
    }
};

double largestDifference(const std::vector<double>& a, const std::vector<double>& b)
{
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        worst = std::max(worst, std::abs(a[i] - b[i]));
    }
    return worst;
}

/// Some elements cut in half (by volume), some solid: what the fluxes read of a cover.
Cover artificialCover(const Scene& scene)
{
    Cover cover;
    const int n = scene.mesh.dim + 1;
    cover.state.assign(scene.mesh.nElements, ElementState::Fluid);
    cover.cutIndex.assign(scene.mesh.nElements, -1);
    for (int e = 0; e < scene.mesh.nElements; ++e)
    {
        if (e % 7 == 3)
        {
            cover.state[e] = ElementState::Solid;
        }
        else if (e % 5 == 2)
        {
            cover.state[e] = ElementState::Cut;
            cover.cutIndex[e] = static_cast<int>(cover.cuts.size());
            CutElement cut{};
            cut.element = e;
            cut.volume = 0.5*scene.mesh.volume[e];
            for (int a = 0; a < n; ++a)
            {
                cut.first[a] = cut.volume*(a + 1.)/(n*(n + 1)/2.);
            }
            cover.cuts.push_back(cut);
        }
    }
    return cover;
}

} // namespace

TEST_CASE("pair fluxes sum to the continuity row at every node, for any velocity and any cover")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(dim, 5);
        const std::vector<double> u = scene.velocity(), fine = scene.fineScale();
        const Cover cover = artificialCover(scene);
        for (const Cover* c : {static_cast<const Cover*>(nullptr), &cover})
        {
            CHECK(largestDifference(scene.sumOfPairs(u, fine, c), scene.sumOfRows(u, fine, c)) < 1e-14);
        }
    }
}

TEST_CASE("pair fluxes of a linear velocity are exact: the flux through the dual faces of the inside")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(dim, 4);
        std::vector<double> u(std::size_t(scene.mesh.nNodes)*dim);
        for (int i = 0; i < scene.mesh.nNodes; ++i)     // divergence 0.4
        {
            const double* x = &scene.mesh.x[std::size_t(i)*dim];
            u[std::size_t(i)*dim] = 0.3*x[0] - x[1];
            u[std::size_t(i)*dim + 1] = x[0] + 0.1*x[1];
            if (dim == 3)
            {
                u[std::size_t(i)*dim + 2] = 0.5*x[0];
            }
        }
        const std::vector<double> sum = scene.sumOfPairs(u, {}, nullptr), volume = dualVolumes(scene.mesh, nullptr);
        std::vector<char> isBoundary(scene.mesh.nNodes, 0);
        for (const MeshPatch& patch : scene.mesh.patches)
        {
            for (const int i : patch.faceNodes)
            {
                isBoundary[i] = 1;
            }
        }
        for (int i = 0; i < scene.mesh.nNodes; ++i)
        {
            if (!isBoundary[i])
            {
                CHECK(sum[i] == near(0.4*volume[i], 1e-14));
            }
        }
    }
}

TEST_CASE("given boundary velocity: int N_i u.n adds up to the divergence; open nodes close their balance")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(dim, 4);
        const std::vector<double> u = scene.velocity(), fine = scene.fineScale();
        std::vector<BoundaryPatch> patches(scene.mesh.patches.size());
        std::vector<PatchValues> values(patches.size());
        for (std::size_t p = 0; p < patches.size(); ++p)
        {
            patches[p].meshPatch = static_cast<int>(p);
            std::vector<int>& nodes = patches[p].nodes;
            nodes = scene.mesh.patches[p].faceNodes;
            std::sort(nodes.begin(), nodes.end());
            nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        }
        TransportBoundary boundary(scene.mesh, scene.graph, scene.flux);
        boundary.evaluate(u, fine, nullptr, patches, values, {}, {});
        double through = 0, divergence = 0;
        for (const BoundaryFlux& b : boundary.fluxes())
        {
            through += b.flux;
        }
        for (int e = 0; e < scene.mesh.nElements; ++e)
        {
            for (int k = 0; k < (dim + 1)*dim; ++k)
            {
                const int i = scene.mesh.elements[std::size_t(e)*(dim + 1) + k/dim];
                divergence += scene.mesh.volume[e]*scene.mesh.gradN[std::size_t(e)*(dim + 1)*dim + k]*u[std::size_t(i)*dim + k%dim];
            }
        }
        CHECK(through == near(divergence, 1e-14));

        patches[1].velocity = BoundaryPatch::Velocity::Open;
        patches[2].velocity = BoundaryPatch::Velocity::Slip;
        boundary.evaluate(u, fine, nullptr, patches, values, {}, {});
        std::vector<double> balance = scene.sumOfRows(u, fine, nullptr);
        for (const BoundaryFlux& b : boundary.fluxes())
        {
            balance[b.node] += b.flux;
        }
        for (const int i : patches[1].nodes)
        {
            CHECK(std::abs(balance[i]) < 1e-14);
        }
    }
}
