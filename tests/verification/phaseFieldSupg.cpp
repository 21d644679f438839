// SPDX-License-Identifier: GPL-3.0-or-later
#include "equations/phaseFieldSupg.hpp"
#include "support/transportScene.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace flotsam;

namespace
{

struct Outcome { double error, massDrift, lowest, highest; };

/// The reversed vortex (2D) or deformation field (3D) with the SUPG form on the scene's mesh and velocity.
Outcome run(TransportScene& scene, double period, int steps, double mobility)
{
    scene.controls.mobility = mobility;
    PhaseFieldSupg phase(scene.mesh, scene.graph, scene.halo, scene.controls);
    const std::vector<double> start = scene.alpha;
    std::vector<double> u(scene.velocity.size()), fine(scene.fineScale.size());
    Outcome outcome{0, 0, 0, 1};
    const double dt = period/steps;
    double first = 0, last = 0;
    for (int s = 0; s < steps; ++s)
    {
        const double amplitude = std::cos(M_PI*(s + 1)/steps);  // an implicit step takes the velocity at its end
        for (std::size_t k = 0; k < u.size(); ++k)
        {
            u[k] = amplitude*scene.velocity[k];
        }
        for (std::size_t k = 0; k < fine.size(); ++k)
        {
            fine[k] = amplitude*scene.fineScale[k];
        }
        const TransportReport r = phase.advance(scene.alpha, dt, u, fine, nullptr, scene.patches, scene.values, {});
        first = s == 0 ? r.liquidBefore : first;
        last = r.liquidAfter;
        CHECK(std::abs(r.redistributed) < 1e-8*first);      // conservative but for the linear solver's tolerance
        outcome.lowest = std::min(outcome.lowest, r.minAlpha);
        outcome.highest = std::max(outcome.highest, r.maxAlpha);
    }
    outcome.error = scene.distanceTo(start);
    outcome.massDrift = last/first - 1;
    return outcome;
}

} // namespace

TEST_CASE("SUPG phase field: reversed vortex")
{
    double error[2];
    for (int level = 0; level < 2; ++level)
    {
        const int n = 32 << level;
        TransportScene scene(MPI_COMM_WORLD, 2, n, 0.75, vortexField());
        scene.fill(disc({0.5, 0.75, 0}, 0.15, 2));
        const Outcome r = run(scene, 2, 4*n, 1);
        MESSAGE("n ", n, " error ", r.error, " mass ", r.massDrift, " alpha ", r.lowest, " .. ", r.highest);
        CHECK(std::abs(r.massDrift) < 1e-12);
        CHECK(r.lowest > -0.05);
        CHECK(r.highest < 1.05);
        error[level] = r.error;
    }
    CHECK(error[1] < 0.25);
    CHECK(error[1] < 0.7*error[0]);
}

TEST_CASE("SUPG phase field: a constant stays constant; the same on any number of ranks")
{
    for (const int dim : {2, 3})
    {
        const int n = dim == 2 ? 24 : 10;
        const VelocityField field = dim == 2 ? vortexField() : deformationField();
        TransportScene scene(MPI_COMM_WORLD, dim, n, 0.75, field), whole(MPI_COMM_SELF, dim, n, 0.75, field);
        scene.alpha.assign(scene.mesh.nNodes, 0.3);
        run(scene, 0.2, 2, 1);
        double worst = 0;
        for (const double a : scene.alpha)
        {
            worst = std::max(worst, std::abs(a - 0.3));
        }
        CHECK(scene.halo.max(worst) < 1e-9);

        for (TransportScene* s : {&scene, &whole})
        {
            s->fill(disc({0.45, 0.6, 0.5}, 0.25, dim));
            run(*s, 0.5, 12, 1);
        }
        worst = 0;
        for (int i = 0; i < scene.mesh.nNodes; ++i)
        {
            worst = std::max(worst, std::abs(scene.alpha[i] - whole.alpha[scene.mesh.originalNode[i]]));
        }
        CHECK(scene.halo.max(worst) < 1e-6);    // the compression is switched by thresholds; the solver stops at 1e-10
    }
}
