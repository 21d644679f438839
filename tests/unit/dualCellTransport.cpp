// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/near.hpp"
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

VelocityField fieldOf(int dim)
{
    return dim == 2 ? vortexField() : deformationField();
}

double largestDifference(const TransportScene& scene, const TransportScene& whole)
{
    double worst = 0;
    for (int i = 0; i < scene.mesh.nNodes; ++i)
    {
        worst = std::max(worst, std::abs(scene.alpha[i] - whole.alpha[scene.mesh.originalNode[i]]));
    }
    return scene.halo.max(worst);
}

} // namespace

TEST_CASE("a constant stays constant")
{
    for (const int dim : {2, 3})
    {
        TransportScene scene(MPI_COMM_WORLD, dim, 10, defaultWidth, fieldOf(dim));
        for (const double constant : {0., 0.3, 1.})
        {
            scene.alpha.assign(scene.mesh.nNodes, constant);
            scene.advance(0.05, 1);
            double worst = 0;
            for (const double a : scene.alpha)
            {
                worst = std::max(worst, std::abs(a - constant));
            }
            CHECK(scene.halo.max(worst) < 1e-12);
        }
    }
}

TEST_CASE("any start field: volume to round-off, bounds, and the same on any number of ranks")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 32 : 12;
        TransportScene scene(MPI_COMM_WORLD, dim, n, defaultWidth, fieldOf(dim)), whole(MPI_COMM_SELF, dim, n, defaultWidth, fieldOf(dim));
        for (TransportScene* s : {&scene, &whole})
        {
            for (int i = 0; i < s->mesh.nNodes; ++i)    // a ball, and noise around it
            {
                const Point x = s->point(i);
                const double r = std::hypot(x[0] - 0.45, x[1] - 0.6);
                s->alpha[i] = r < 0.2 ? 1 : r < 0.35 ? 0.5 + 0.5*std::sin(7.*double(s->mesh.originalNode[i])) : 0;
            }
            // the discrete fluxes of the two meshes agree to the tolerance of their solution only: take the same
        }
        for (std::size_t k = 0; k < scene.fineScale.size(); ++k)
        {
            scene.fineScale[k] = 0;
        }
        whole.fineScale.assign(whole.fineScale.size(), 0);
        for (int step = 0; step < 8; ++step)
        {
            const TransportReport r = scene.advance(0.4/n, 1), w = whole.advance(0.4/n, 1);
            CHECK(r.liquidAfter == near(w.liquidAfter, 3e-14));
            CHECK(r.redistributed == within(w.redistributed, 1e-14*w.liquidAfter));
            CHECK(r.nBand == w.nBand);
            CHECK(r.nRoof == w.nRoof);
            CHECK(r.nLimited == w.nLimited);
            CHECK(r.liquidAfter == near(r.liquidBefore, 1e-14));
            CHECK(r.minAlpha > -1e-12);
            CHECK(r.maxAlpha < 1 + 1e-12);
        }
        CHECK(largestDifference(scene, whole) < 1e-12);
    }
}

TEST_CASE("steps longer than a dual cell allows are divided")
{
    TransportScene one(MPI_COMM_WORLD, 2, 32, defaultWidth, vortexField()), many(MPI_COMM_WORLD, 2, 32, defaultWidth, vortexField());
    for (TransportScene* s : {&one, &many})
    {
        s->fill(disc({0.5, 0.75, 0}, 0.15, 2));
    }
    const TransportReport report = one.advance(0.1, 1);
    CHECK(report.subSteps > 3);
    CHECK(std::abs(report.redistributed) < 1e-12*report.liquidAfter);
    for (int k = 0; k < 10; ++k)
    {
        many.advance(0.01, 1);
    }
    CHECK(one.distanceTo(many.alpha) < 5e-3);
    CHECK_THROWS_WITH_AS(one.advance(0.1, 1e9), doctest::Contains("phase transport"), std::runtime_error);
}

TEST_CASE("a filling box: what enters arrives, the front moves with the fluid")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 32 : 12;
        TransportScene scene(MPI_COMM_WORLD, dim, n, defaultWidth, [](const Point&) { return Point{1, 0, 0}; });
        scene.values[0].alpha.assign(scene.values[0].alpha.size(), 1);     // xMin
        scene.patches[1].velocity = BoundaryPatch::Velocity::Open;         // xMax
        double inflow = 0, outflow = 0, first = -1, last = 0;
        for (int step = 0; step < 3*n; ++step)      // one and a half box lengths
        {
            const TransportReport r = scene.advance(0.5/n, 1);
            first = first < 0 ? r.liquidBefore : first;
            inflow += r.inflow;
            outflow += r.outflow;
            last = r.liquidAfter;
            CHECK(std::abs(r.redistributed) < 1e-13);
            if (step == n - 1)
            {
                CHECK(last == near(0.5, 1e-14));
                CHECK(outflow < 1e-6);
            }
        }
        CHECK(first == 0);
        CHECK(inflow == near(1.5, 2e-14));
        CHECK(last == near(1, 5e-8));
        CHECK(inflow - outflow == near(last, 1e-14));
    }
}

// The surface lies along the flow. With alpha(1 - alpha) = -w d alpha/dz the flux of eq 6 is gamma (delta - w) d alpha/dz, so the second moment of -d alpha/dz across
// the surface changes at the rate 2 gamma (delta - w), beside what it does without mobility.
TEST_CASE("mobility: a profile of another width goes towards the model's at the model's rate")
{
    constexpr double mobility = 0.5, duration = 0.02, widthOverLength = 2;
    const auto rateOf = [](double mobility, double wider, double& delta)
    {
        TransportScene scene(MPI_COMM_WORLD, 2, 48, widthOverLength, [](const Point&) { return Point{1, 0, 0}; });
        scene.controls.mobility = mobility;
        const auto isInside = [&](int i) { return std::abs(scene.point(i)[0] - 0.6) < 0.2; };
        const auto height = [&](int i) { return scene.point(i)[1] - 0.5; };
        double sums[2] = {0, 0};
        for (int i = 0; i < scene.mesh.nOwned; ++i)
            if (isInside(i)) { sums[0] += scene.volume[i]*scene.transport.width()[i]; sums[1] += scene.volume[i]; }
        scene.halo.sum(sums, 2);
        delta = sums[0]/sums[1];
        for (int i = 0; i < scene.mesh.nNodes; ++i) scene.alpha[i] = 1/(1 + std::exp(height(i)/(wider*delta)));
        const auto moment = [&]
        {
            double sum = 0;
            for (int i = 0; i < scene.mesh.nOwned; ++i)
                if (isInside(i)) sum += 2*scene.volume[i]*height(i)*scene.alpha[i];
            return scene.halo.sum(sum)/sums[1]; // of a box of height 1
        };
        const double before = moment();
        for (int k = 0; k < 4; ++k) scene.advance(duration/4, 1);
        return (moment() - before)/duration;
    };
    for (const double wider : {0.7, 1.5})
    {
        double delta;
        const double rate = rateOf(mobility, wider, delta) - rateOf(0, wider, delta), expected = 2*mobility*delta*(1 - wider);
        MESSAGE("width ", wider, " delta: rate of the second moment ", rate, ", of the model ", expected);
        CHECK(std::abs(rate - expected) < 0.2*std::abs(expected));
    }
}
