// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/solidExtension.hpp"
#include "geometry/meanCover.hpp"
#include "support/near.hpp"
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

std::vector<Solid> cylinderAt(double x, double y, double radius)
{
    Solid solid;
    solid.name = "cylinder";
    solid.kind = Solid::Kind::Prescribed;
    solid.shape = makeCylinder(Vec3(0, 0, -2), Vec3(0, 0, 2), radius);
    solid.pose.position = Vec3(x, y, 0.5);
    return {solid};
}

LiquidShape belowLevel(double level, int dim)
{
    return [=](const Point& x) { return x[dim - 1] - level; };
}

/// All patches: given velocity; entering fluid carries the alpha the start profile has there.
void carryStartAlpha(TransportScene& scene)
{
    for (std::size_t p = 0; p < scene.patches.size(); ++p)
    {
        for (std::size_t k = 0; k < scene.patches[p].nodes.size(); ++k)
        {
            scene.values[p].alpha[k] = scene.alpha[scene.patches[p].nodes[k]];
        }
    }
}

} // namespace

TEST_CASE("a cylinder that drifts with the fluid, half out of the liquid, disturbs neither level nor volume")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 40 : 16;
        const double radius = 0.13, speed = 1, dt = 0.3/n;
        TransportScene scene(MPI_COMM_WORLD, dim, n, defaultWidth, [](const Point&) { return Point{1, 0, 0}; });
        scene.fill(belowLevel(0.52, dim));
        carryStartAlpha(scene);
        const std::vector<double> start = scene.alpha;
        double x = 0.35, inflow = 0, outflow = 0, first = 0, last = 0, moved = 0;
        int mostSubSteps = 0;
        Cover before = cutMesh(scene.mesh, scene.graph, scene.halo, cylinderAt(x, 0.5, radius)), during;
        for (int step = 0; step < n; ++step)        // 0.3 of the box
        {
            x += dt*speed;
            const Cover cover = cutMesh(scene.mesh, scene.graph, scene.halo, cylinderAt(x, 0.5, radius));
            setMeanCover(scene.mesh, before, cover, during);
            if (step == 0) scene.transport.setLiquidVolume(scene.halo.sum(liquidOf(scene.mesh, dualVolumes(scene.mesh, &before), scene.alpha)));
            const TransportReport r = scene.transport.advance(scene.alpha, dt, scene.velocity, {}, &during, scene.patches, scene.values, {}, {}, &cover);
            extendIntoSolids(scene.mesh, scene.graph, scene.halo, cover, scene.alpha);
            before = cover;
            CHECK(scene.halo.sum(liquidOf(scene.mesh, dualVolumes(scene.mesh, &cover), scene.alpha)) == near(r.liquidAfter, 2e-14));
            first = step == 0 ? r.liquidBefore : first;
            last = r.liquidAfter;
            inflow += r.inflow;
            outflow += r.outflow;
            moved += std::abs(r.redistributed);
            mostSubSteps = std::max(mostSubSteps, r.subSteps);
            CHECK(r.minAlpha > -1e-12);
            CHECK(r.maxAlpha < 1 + 1e-12);
        }
        CHECK(mostSubSteps <= 3);   // small dual cells do not set the time step
        CHECK(last == near(first + inflow - outflow, 1e-14));
        const Cover cover = cutMesh(scene.mesh, scene.graph, scene.halo, cylinderAt(x, 0.5, radius));
        double worst = 0, sum = 0;
        for (int i = 0; i < scene.mesh.nOwned; ++i)
        {
            if (cover.isActiveNode[i])
            {
                worst = std::max(worst, std::abs(scene.alpha[i] - start[i]));
                sum += scene.volume[i]*std::abs(scene.alpha[i] - start[i]);
            }
        }
        MESSAGE("dim ", dim, " largest deviation ", scene.halo.max(worst), " mean ", scene.halo.sum(sum), " redistributed ", moved);
        CHECK(scene.halo.sum(sum) < (dim == 2 ? 2.5e-3 : 6e-3));
        CHECK(moved < 0.02*last);
    }
}

TEST_CASE("a fixed cylinder in a current: liquid passes it without leaving the bounds")
{
    const int n = 40;
    const double radius = 0.15;
    // potential flow about a cylinder at (0.5, 0.5), continued into it
    const VelocityField field = [radius](const Point& x) {
        const double a = x[0] - 0.5, b = x[1] - 0.5, r2 = std::max(a*a + b*b, 0.5*radius*radius), q = radius*radius/(r2*r2);
        return Point{1 - q*(a*a - b*b), -2*q*a*b, 0};
    };
    TransportScene scene(MPI_COMM_WORLD, 2, n, defaultWidth, field);
    scene.patches[1].velocity = BoundaryPatch::Velocity::Open;
    scene.values[0].alpha.assign(scene.values[0].alpha.size(), 1);
    const Cover cover = cutMesh(scene.mesh, scene.graph, scene.halo, cylinderAt(0.5, 0.5, radius));
    double moved = 0, last = 0, expected = 0;
    for (int step = 0; step < 6*n; ++step)      // the box filled twice
    {
        const TransportReport r = scene.transport.advance(scene.alpha, 0.4/n, scene.velocity, {}, &cover, scene.patches, scene.values, {});
        extendIntoSolids(scene.mesh, scene.graph, scene.halo, cover, scene.alpha);
        expected += r.inflow - r.outflow;
        last = r.liquidAfter;
        moved += std::abs(r.redistributed);
        CHECK(r.minAlpha > -1e-12);
        CHECK(r.maxAlpha < 1 + 1e-12);
        CHECK(r.subSteps <= 4);
    }
    CHECK(last == near(expected, 2e-14));
    MESSAGE("filled ", last, " of ", 1 - M_PI*radius*radius, ", redistributed ", moved);
    CHECK(last > 0.97*(1 - M_PI*radius*radius));
}

TEST_CASE("values inside solids: the mean of the wet neighbours, the same on any number of ranks")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 12;
        TransportScene scene(MPI_COMM_WORLD, dim, n, defaultWidth, rotationField()), whole(MPI_COMM_SELF, dim, n, defaultWidth, rotationField());
        for (TransportScene* s : {&scene, &whole})
        {
            const Cover cover = cutMesh(s->mesh, s->graph, s->halo, cylinderAt(0.5, 0.5, 0.3));
            for (int i = 0; i < s->mesh.nNodes; ++i)
            {
                s->alpha[i] = 0.25 + 0.5*s->point(i)[0];
            }
            s->halo.update(s->alpha, 1);
            extendIntoSolids(s->mesh, s->graph, s->halo, cover, s->alpha);
        }
        double worst = 0, lowest = 1, highest = 0;
        for (int i = 0; i < scene.mesh.nNodes; ++i)
        {
            worst = std::max(worst, std::abs(scene.alpha[i] - whole.alpha[scene.mesh.originalNode[i]]));
            lowest = std::min(lowest, scene.alpha[i]);
            highest = std::max(highest, scene.alpha[i]);
        }
        CHECK(scene.halo.max(worst) < 1e-13);
        CHECK(scene.halo.min(lowest) > 0.2499);
        CHECK(scene.halo.max(highest) < 0.7501);
    }
}
