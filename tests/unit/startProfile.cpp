// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/dualCells.hpp"
#include "equations/initialProfile.hpp"
#include "equations/interfaceWidth.hpp"
#include "equations/interfacePlanes.hpp"
#include "equations/surfaceLevel.hpp"
#include "support/boxMesh.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace flotsam;

namespace
{

struct Scene
{
    SimplexMesh mesh;
    NodeGraph graph;
    Halo halo;
    std::vector<double> width;

    Scene(MPI_Comm comm, int dim, int n, double perturbation, double size = 1)
        : mesh(makeBoxMesh(comm, dim, {n, n, dim == 2 ? 1 : n}, {0, 0, 0}, {size, size, size}, perturbation)), graph(mesh), halo(mesh, comm),
          width(interfaceWidth(mesh, graph, halo, 0.35))
    {
    }

    double height(int i) const { return mesh.x[std::size_t(i)*mesh.dim + mesh.dim - 1]; }

    double volumeOf(const std::vector<double>& alpha) const
    {
        const std::vector<double> volume = dualVolumes(mesh, nullptr);
        double sum = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            sum += volume[i]*alpha[i];
        }
        return halo.sum(sum);
    }
};

} // namespace

TEST_CASE("start profile: a level surface on or between node planes gives a flat profile of the right width")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(MPI_COMM_WORLD, dim, 10, 0);
        for (const double level : {0.5, 0.55})
        {
            std::vector<double> alpha(scene.mesh.nNodes);
            for (int i = 0; i < scene.mesh.nNodes; ++i)
            {
                const double d = level - scene.height(i);
                alpha[i] = std::abs(d) < 1e-9 ? 0.5 : d > 0 ? 1 : 0;
            }
            makeStartProfile(scene.mesh, scene.graph, scene.halo, scene.width, alpha);
            // the end of the box cuts the profile's tail off: keeping the volume may shift all of it by that much
            const double at = 0.035*std::log(alpha[0]/(1 - alpha[0])) + scene.height(0);
            CHECK(std::abs(at - level) < 1e-6);
            double worst = 0;
            for (int i = 0; i < scene.mesh.nNodes; ++i)
            {
                const double d = at - scene.height(i);
                worst = std::max(worst, std::abs(alpha[i] - 1/(1 + std::exp(-d/0.035))));
            }
            CHECK(scene.halo.max(worst) < 1e-10);
        }
    }
}

TEST_CASE("start profile: keeps the volume, is the same on any number of ranks")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        const Scene scene(MPI_COMM_WORLD, dim, n, 0.15), whole(MPI_COMM_SELF, dim, n, 0.15);
        const auto ball = [dim](const Scene& s) {
            std::vector<double> alpha(s.mesh.nNodes);
            for (int i = 0; i < s.mesh.nNodes; ++i)
            {
                double r = 0;
                for (int d = 0; d < dim; ++d)
                {
                    r += std::pow(s.mesh.x[std::size_t(i)*dim + d] - 0.48, 2);
                }
                alpha[i] = std::clamp(0.5 + 0.7*(0.3 - std::sqrt(r))*24, 0., 1.);
            }
            return alpha;
        };
        std::vector<double> alpha = ball(scene), reference = ball(whole);
        const double before = scene.volumeOf(alpha);
        makeStartProfile(scene.mesh, scene.graph, scene.halo, scene.width, alpha);
        makeStartProfile(whole.mesh, whole.graph, whole.halo, whole.width, reference);
        CHECK(scene.volumeOf(alpha) == near(before, 1e-14));
        double worst = 0;
        for (int i = 0; i < scene.mesh.nNodes; ++i)
        {
            worst = std::max(worst, std::abs(alpha[i] - reference[scene.mesh.originalNode[i]]));
        }
        CHECK(scene.halo.max(worst) < 1e-12);
    }
}

TEST_CASE("start profile: at nodes that a bent surface goes through round-off does not choose the plane")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        const Scene scene(MPI_COMM_WORLD, dim, n, 0.15), other(MPI_COMM_WORLD, dim, n, 0.15, 1 + 1e-15);
        std::vector<double> alpha(scene.mesh.nNodes);
        for (int i = 0; i < scene.mesh.nNodes; ++i)
        {
            double r = 0;
            for (int d = 0; d < dim; ++d) r += std::pow(scene.mesh.x[std::size_t(i)*dim + d] - 0.48, 2);
            const double cells = (0.3 - std::sqrt(r))*n;
            // the planes of elements whose only wet corner is such a node all have its point
            alpha[i] = std::abs(cells) < 0.4 ? 0.5 : std::clamp(0.5 + cells, 0., 1.);
        }
        std::vector<double> same = alpha;
        makeStartProfile(scene.mesh, scene.graph, scene.halo, scene.width, alpha);
        makeStartProfile(other.mesh, other.graph, other.halo, other.width, same);
        double worst = 0;
        for (int i = 0; i < scene.mesh.nNodes; ++i) worst = std::max(worst, std::abs(alpha[i] - same[i]));
        CHECK(scene.halo.max(worst) < 1e-10);
    }
}

TEST_CASE("start profile: what is missing at a side of the liquid does not lower the level away from it, and the volume is kept")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(MPI_COMM_WORLD, dim, 10, 0);
        const SimplexMesh& mesh = scene.mesh;
        const std::vector<double> volume = dualVolumes(mesh, nullptr);
        std::vector<double> alpha(mesh.nNodes), given;
        StartLiquid liquid;
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            alpha[i] = std::clamp(0.5 + 3*(0.55 - scene.height(i)), 0., 1.);
            const bool isAtSide = mesh.x[std::size_t(i)*dim] < 0.25;
            liquid.isAtSide.push_back(isAtSide);
            liquid.volume.push_back((isAtSide ? 0.9 : 1)*volume[i]*alpha[i]);
        }
        given = alpha;
        makeStartProfile(mesh, scene.graph, scene.halo, scene.width, given);
        makeStartProfile(mesh, scene.graph, scene.halo, scene.width, alpha, liquid);
        double worst = 0, total = 0, largest = 0;
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            total += liquid.volume[i];
            (liquid.isAtSide[i] ? largest : worst) = std::max(liquid.isAtSide[i] ? largest : worst, std::abs(alpha[i] - given[i]));
        }
        CHECK(scene.halo.max(worst) < 1e-6);   // dual volumes of alternating diagonals differ from column to column
        CHECK(scene.halo.max(largest) > 0.1);
        CHECK(scene.volumeOf(alpha) == near(scene.halo.sum(total), 1e-13));
    }
}

TEST_CASE("start profile: a plane stays one, in all directions and on moved nodes, and an edge of the liquid has none beyond")
{
    for (const int dim : {2, 3})
        for (const double perturbation : {0., 0.1, 0.2})
        {
            const int n = 10;
            const Scene scene(MPI_COMM_WORLD, dim, n, perturbation);
            const auto profileOf = [&](auto distance, double liquid)
            {
                std::vector<double> alpha(scene.mesh.nNodes);
                for (int i = 0; i < scene.mesh.nNodes; ++i) alpha[i] = std::clamp(0.5 + distance(&scene.mesh.x[std::size_t(i)*dim])*n/6., 0., 1.);
                StartLiquid start;
                if (liquid > 0) start.volume.assign(scene.mesh.nNodes, liquid/scene.halo.sum(double(scene.mesh.nOwned)));
                makeStartProfile(scene.mesh, scene.graph, scene.halo, scene.width, alpha, start);
                return alpha;
            };
            for (int k = 0; k < 20; ++k)
            {
                const double normal[3] = {std::cos(0.3*k), std::sin(0.3*k), dim == 2 ? 0 : std::sin(1.7*k)};
                const double length = std::hypot(normal[0], normal[1], normal[2]);
                const auto distance = [&](const double* x)
                {
                    double d = 0;
                    for (int a = 0; a < dim; ++a) d += normal[a]/length*(x[a] - 0.52);
                    return d;
                };
                const std::vector<double> alpha = profileOf(distance, -1);
                double least = 1e300, most = -1e300;
                for (int i = 0; i < scene.mesh.nOwned; ++i)
                {
                    if (alpha[i] < 1e-9 || alpha[i] > 1 - 1e-6) continue;
                    const double moved = scene.width[i]*std::log(alpha[i]/(1 - alpha[i])) - distance(&scene.mesh.x[std::size_t(i)*dim]);
                    least = std::min(least, moved);
                    most = std::max(most, moved);
                }
                CHECK(scene.halo.max(most) + scene.halo.max(-least) < 1e-8);
            }
            // a wedge with its edge up: the planes of its sides go on above
            const double tilt = 0.2, top = 0.72;
            const auto insideWedge = [&](const double* x)
            {
                const double down = top - x[1], aside = std::abs(x[0] - 0.51), inside = down*std::sin(tilt) - aside*std::cos(tilt);
                return down*std::cos(tilt) + aside*std::sin(tilt) < 0 ? -std::hypot(down, aside) : inside;
            };
            const std::vector<double> alpha = profileOf(insideWedge, top*top*std::tan(tilt));
            double above = 0;
            for (int i = 0; i < scene.mesh.nOwned; ++i)
                if (scene.mesh.x[std::size_t(i)*dim + 1] > top + 1.5/n) above = std::max(above, alpha[i]);
            CHECK(scene.halo.max(above) < 0.2);
        }
}

TEST_CASE("interface planes: exact for a plane surface, in all directions and on moved nodes")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(MPI_COMM_WORLD, dim, 10, 0.15);
        const double n[3] = {0.48, dim == 2 ? 0.87727 : 0.6, 0.64};
        const double length = std::sqrt(n[0]*n[0] + n[1]*n[1] + (dim == 3 ? n[2]*n[2] : 0));
        std::vector<double> level(scene.mesh.nNodes), exact(scene.mesh.nNodes);
        for (int i = 0; i < scene.mesh.nNodes; ++i)
        {
            exact[i] = -0.51;
            for (int d = 0; d < dim; ++d)
            {
                exact[i] += n[d]/length*scene.mesh.x[std::size_t(i)*dim + d];
            }
            level[i] = 2*exact[i];
        }
        InterfacePlanes planes;
        for (const int rings : {6, 3})      // the second call reuses the storage of the first
        {
            planes.propagate(scene.mesh, scene.graph, scene.halo, level, {rings});
            double worst = 0;
            long count = 0;
            for (const int i : planes.nodes())
            {
                worst = std::max(worst, std::abs(planes.distance(i) - exact[i]));
                count += i < scene.mesh.nOwned;
            }
            CHECK(scene.halo.max(worst) < 1e-12);
            CHECK(scene.halo.sum(count) > 0);
            for (int i = 0; i < scene.mesh.nOwned; ++i)     // one cell is at least one ring
            {
                if (std::abs(exact[i]) < 0.1*rings*0.8)
                {
                    CHECK(planes.has(i));
                }
            }
        }
    }
}

TEST_CASE("surface level: the distance from a plane whose profile the dual cells have as means, in all directions and on moved nodes")
{
    for (const int dim : {2, 3})
    {
        const Scene scene(MPI_COMM_WORLD, dim, 10, 0.19);
        const DualCells cells(scene.mesh);
        const double steep[3] = {0.48, dim == 2 ? 0.87727 : 0.6, 0.64}, level[3] = {0, dim == 2 ? 1. : 0, 1};
        for (const double* direction : {steep, level})
        {
            double n[3] = {}, length = 0;
            for (int d = 0; d < dim; ++d) length += direction[d]*direction[d];
            for (int d = 0; d < dim; ++d) n[d] = direction[d]/std::sqrt(length);
            std::vector<double> alpha(scene.mesh.nNodes), exact(scene.mesh.nNodes, -0.51);
            for (int i = 0; i < scene.mesh.nNodes; ++i)
            {
                for (int d = 0; d < dim; ++d) exact[i] += n[d]*scene.mesh.x[std::size_t(i)*dim + d];
                alpha[i] = profileSlab(&cells, i, n, exact[i], scene.width[i]).mean();
            }
            scene.halo.update(alpha, 1);    // cells of second-ring copies are not whole
            std::vector<double> work, found;
            SurfaceLevel(scene.mesh, scene.halo).find(alpha, scene.width, &cells, nullptr, 1e-10, work, found);
            double worst = 0;
            for (int i = 0; i < scene.mesh.nNodes; ++i)
                if (std::abs(exact[i]) < 0.15) worst = std::max(worst, std::abs(found[i] - exact[i]));
            CHECK(scene.halo.max(worst) < 1e-7);
        }
    }
}

TEST_CASE("mean of the profile over a slab, and its derivative")
{
    const double thickness = 3, step = 1e-4;
    for (const double psi : {-4., -0.5, 0., 2.})
    {
        double sum = 0;
        for (int k = 0; k < 3000; ++k)
        {
            sum += 1/(1 + std::exp(-(psi + thickness*((k + 0.5)/3000 - 0.5))))/3000;
        }
        const ProfileSlab slab{psi, thickness};
        CHECK(slab.mean() == near(sum, 1e-7));
        const double difference = ProfileSlab{psi + step, thickness}.mean() - ProfileSlab{psi - step, thickness}.mean();
        CHECK(slab.slope() == near(difference/(2*step), 5e-9));
    }
}
