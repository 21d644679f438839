// SPDX-License-Identifier: GPL-3.0-or-later
/// A bar in a steady current at Reynolds number 20, 2D: what holds it feels its drag.
#pragma once

#include "support/coupledRig.hpp"

#include <doctest/doctest.h>

#include <algorithm>

namespace flotsam::barInCurrent
{

constexpr double side = 0.2, speed = 1.0;

struct Channel : CoupledRig
{
    Channel() : CoupledRig(makeBoxMesh(MPI_COMM_WORLD, 2, {48, 24, 1}, {0, 0, 0}, {2, 1, 1}))
    {
        fluid.rhoLiquid = 1000;
        fluid.muLiquid = 10; // Re 20: a steady flow
        controls.tolerance = 1e-8;
        controls.contactTolerance = 1e-4;
        controls.maxContactRepeats = 20;
        auto inflow = [](const double*, double t) { return std::array<double, 3>{speed*std::min(1.0, t/0.2), 0, 0}; };
        patches.push_back(makePatch(mesh, 0, BoundaryPatch::Velocity::Fixed, inflow));
        patches.push_back(makePatch(mesh, 1, BoundaryPatch::Velocity::Open));
        for (int p : {2, 3}) patches.push_back(makePatch(mesh, p, BoundaryPatch::Velocity::Slip));
    }

    FlowState rest() const { return restState(mesh); }
};

inline BodyDefinition makeBar(double density, const Vec3& position)
{
    BodyDefinition bar;
    bar.name = "bar";
    bar.shape = makeBox(Vec3::Zero(), Vec3(side, side, 1));
    bar.volume = side*side;
    bar.mass = density*bar.volume;
    bar.principalInertia = bar.mass/12*Vec3(1 + side*side, 1 + side*side, 2*side*side);
    bar.pose.position = position;
    bar.isPlanar = true;
    bar.thinnest = side;
    for (double y : {-0.08, -0.04, 0.0, 0.04, 0.08})
        for (double x : {-0.08, 0.08}) bar.spheres.push_back({Vec3(x, y, 0), 0.02});
    return bar;
}

/// 1.2 s, until the flow is steady, of `held` and of the same bar fixed at `position`: its drag [N], and the largest number of repeats of a step of `held`.
struct Beside { double drag = 0; int repeats = 0; };

inline Beside runBesideFixed(Channel& channel, CoupledStep& held, const BodyDefinition& bar, const Vec3& position)
{
    held.start(channel.rest(), true);
    Solid fixed;
    fixed.shape = bar.shape;
    fixed.pose.position = position;
    CoupledStep still(channel.mesh, channel.halo, channel.fluid, channel.controls, channel.patches, Scene({{fixed, -1, {}}}, {}, Vec3::Zero()), nullptr, channel.timers);
    still.start(channel.rest(), true);
    Beside result;
    for (int k = 0; k < 60; ++k)
    {
        REQUIRE(still.step(0.02).isAccepted);
        const StepResult step = held.step(0.02);
        REQUIRE(step.isAccepted);
        result.repeats = std::max(result.repeats, step.solves - 1);
    }
    result.drag = still.records()[0].fluidForce[0];
    return result;
}

} // namespace flotsam::barInCurrent
