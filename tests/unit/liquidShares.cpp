// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/liquidShares.hpp"

#include "equations/dualCells.hpp"
#include "equations/interfaceWidth.hpp"
#include "equations/surfaceLevel.hpp"
#include "geometry/coverBuilder.hpp"
#include "support/boxMesh.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <vector>

using namespace flotsam;

namespace
{

constexpr double widthOverLength = 0.2;   // of the profile, in element lengths

struct Scene
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;

    Scene(int dim, int n, MPI_Comm comm = MPI_COMM_WORLD)
    :   mesh(makeBoxMesh(comm, dim, {n, n, n}, {0, 0, 0}, {1, 1, 1}, 0.15)), graph(mesh), halo(mesh, comm)
    {
    }

    std::vector<double> width() const { return interfaceWidth(mesh, graph, halo, widthOverLength); }
    /// Sheets, drops, full and empty nodes.
    std::vector<double> splashes() const
    {
        std::vector<double> alpha(mesh.nNodes);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[std::size_t(i)*mesh.dim];
            alpha[i] = std::clamp(0.5 + std::sin(20*x[0] + 3*x[1])*std::cos(9*x[1]) + 0.3*std::sin(31*x[mesh.dim - 1]), 0.0, 1.0);
        }
        return alpha;
    }

    int corners() const { return mesh.dim + 1; }
    bool isOwned(int node) const { return node < mesh.nOwned; }
};

/// Largest difference between the sum of a node's shares and what it has, over its volume.
double largestImbalance(const Scene& s, const Cover* cover, const std::vector<double>& alpha, const std::vector<double>& shares)
{
    const std::vector<double> volume = dualVolumes(s.mesh, cover);
    std::vector<double> sum(s.mesh.nNodes, 0.0);
    for (std::size_t k = 0; k < shares.size(); ++k) sum[s.mesh.elements[k]] += shares[k];
    double worst = 0;
    for (int i = 0; i < s.mesh.nOwned; ++i)
        if (volume[i] > 0) worst = std::max(worst, std::abs(sum[i]/volume[i] - alpha[i]));
    return s.halo.max(worst);
}

/// Mean of a function over an element, at the midpoints of a fine division of a cube that is mapped on it.
template<class Function>
double elementMean(const SimplexMesh& mesh, int e, Function f)
{
    constexpr int m = 12;
    const int dim = mesh.dim, n = dim + 1;
    double sum = 0, weights = 0;
    for (int k = 0; k < (dim == 2 ? m*m : m*m*m); ++k)
    {
        double t[3] = {(k % m + 0.5)/m, (k/m % m + 0.5)/m, (k/(m*m) + 0.5)/m}, x[3] = {}, left = 1, weight = 1;
        for (int a = 0; a < n; ++a)     // Duffy's map
        {
            const double lambda = a < dim ? left*t[a] : left;
            for (int d = 0; d < dim; ++d) x[d] += lambda*mesh.x[std::size_t(mesh.elements[e*n + a])*dim + d];
            if (a < dim) left -= lambda;
            if (a < dim - 1) weight *= std::pow(1 - t[a], dim - 1 - a);
        }
        sum += weight*f(x);
        weights += weight;
    }
    return sum/weights;
}

} // namespace

TEST_CASE("shares of any phase field add up to it and stay between empty and full, beside a solid too")
{
    for (const int dim : {2, 3})
    {
        const Scene s(dim, 8);
        std::vector<Solid> solids(1);
        solids[0].shape = makeSphere(Vec3::Zero(), 0.23);
        solids[0].pose.position = Vec3(0.51, 0.48, dim == 3 ? 0.47 : 0);
        CoverBuilder builder(s.mesh, s.graph, s.halo);
        const Cover& cover = builder.build(solids);
        const std::vector<double> alpha = s.splashes();
        for (const Cover* c : {static_cast<const Cover*>(nullptr), &cover})
        {
            const std::vector<double> shares = liquidShares(s.mesh, s.halo, c, alpha, s.width());
            CHECK(largestImbalance(s, c, alpha, shares) < 1e-12);
            double below = 0, above = 0;
            for (std::size_t k = 0; k < shares.size(); ++k)
            {
                const std::size_t e = k/s.corners();
                if (!s.isOwned(s.mesh.elements[k]) || (c && c->state[e] != ElementState::Fluid)) continue;
                below = std::max(below, -shares[k]);
                above = std::max(above, shares[k] - s.mesh.volume[e]/s.corners());
            }
            CHECK(below < 1e-15);
            CHECK(above < 1e-15);
        }
    }
}

TEST_CASE("a plane comes back as that plane")
{
    for (const int dim : {2, 3})
    {
        const Scene s(dim, 10);
        const DualCells cells(s.mesh);
        const std::vector<double> length = s.width();
        double normal[3] = {0.3, 0.6, 0.2}, size = 0;
        for (int d = 0; d < dim; ++d) size += normal[d]*normal[d];
        for (int d = 0; d < dim; ++d) normal[d] /= std::sqrt(size);
        const auto distance = [&](const double* x) { double v = -0.61; for (int d = 0; d < dim; ++d) v += normal[d]*x[d]; return v; };
        std::vector<double> alpha(s.mesh.nNodes);
        for (int i = 0; i < s.mesh.nNodes; ++i)
            alpha[i] = profileSlab(&cells, i, normal, distance(&s.mesh.x[std::size_t(i)*dim]), length[i]).mean();
        s.halo.update(alpha, 1);
        const std::vector<double> shares = liquidShares(s.mesh, s.halo, nullptr, alpha, length);
        double wrong = 0, wrongP1 = 0;
        for (int e = 0; e < s.mesh.nInnerElements; ++e)
        {
            if (!s.mesh.isOwnedElement[e]) continue;
            const double exact = elementMean(s.mesh, e, [&](const double* x) { return 1/(1 + std::exp(-distance(x)/(widthOverLength*s.mesh.h[e]))); });
            double mean = 0, liquid = 0;
            for (int a = 0; a < s.corners(); ++a)
            {
                mean += alpha[s.mesh.elements[e*s.corners() + a]]/s.corners();
                liquid += shares[e*s.corners() + a]/s.mesh.volume[e];
            }
            wrong = std::max(wrong, std::abs(liquid - exact));
            wrongP1 = std::max(wrongP1, std::abs(mean - exact));
        }
        wrong = s.halo.max(wrong);
        wrongP1 = s.halo.max(wrongP1);
        std::printf("%dD, liquid of an element, largest error: %.3f of its volume, P1 mean: %.3f\n", dim, wrong, wrongP1);
        CHECK(wrong < (dim == 2 ? 0.04 : 0.07));
        CHECK(wrongP1 > 3*wrong);
    }
}

// Cells may have no node of the rank that writes them: what it holds of the others' nodes must do.
TEST_CASE("every element that a rank holds has what it has on one rank, the outermost ones too")
{
    for (const int dim : {2, 3})
    {
        const Scene s(dim, 8), whole(dim, 8, MPI_COMM_SELF);
        const auto corners = [](const Scene& scene, int e)
        {
            std::vector<long> result;
            for (int a = 0; a < scene.corners(); ++a) result.push_back(scene.mesh.originalNode[scene.mesh.elements[std::size_t(e)*scene.corners() + a]]);
            std::sort(result.begin(), result.end());
            return result;
        };
        const auto liquid = [](const Scene& scene, const std::vector<double>& shares, int e)
        {
            return std::accumulate(&shares[std::size_t(e)*scene.corners()], &shares[std::size_t(e + 1)*scene.corners()], 0.0)/scene.mesh.volume[e];
        };
        const std::vector<double> wholeShares = liquidShares(whole.mesh, whole.halo, nullptr, whole.splashes(), whole.width());
        const std::vector<double> shares = liquidShares(s.mesh, s.halo, nullptr, s.splashes(), s.width());
        std::map<std::vector<long>, double> expected;
        for (int e = 0; e < whole.mesh.nElements; ++e) expected[corners(whole, e)] = liquid(whole, wholeShares, e);
        double worst = 0;
        for (int e = 0; e < s.mesh.nElements; ++e) worst = std::max(worst, std::abs(liquid(s, shares, e) - expected.at(corners(s, e))));
        CHECK(s.halo.max(worst) < 1e-12);
    }
}
