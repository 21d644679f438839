// SPDX-License-Identifier: GPL-3.0-or-later
/// A bar in a steady current at Reynolds number 20, 2D: what holds it feels its drag.
#pragma once

#include "support/coupledRig.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

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

/// The same, round: fixed and held bars have different terms at sharp edges (docs/numerics/3-solids.md, 3.12), these none.
inline BodyDefinition makeRoundBar(double density, const Vec3& position)
{
    BodyDefinition bar = makeBar(density, position);
    bar.shape = makeCylinder(Vec3(0, 0, -0.5), Vec3(0, 0, 1), 0.5*side);
    const double radius = 0.5*side;
    bar.volume = std::acos(-1.0)*radius*radius;
    bar.mass = density*bar.volume;
    bar.principalInertia = bar.mass/12*Vec3(1 + 3*radius*radius, 1 + 3*radius*radius, 6*radius*radius);
    return bar;
}

/// 1.2 s, until the flow is steady, of `held`, then of the same bar held before its release as it stands (a penetration of contact away from where it began: on so coarse a mesh
/// the drag changes by 0.2 % within an element; a round structure is cut otherwise, 3.5): its drag [N], and the largest number of repeats of a step of `held`.
struct Beside { double drag = 0; int repeats = 0; };

inline Beside runBesideFixed(Channel& channel, CoupledStep& held, const BodyDefinition& bar)
{
    constexpr int steps = 60;
    constexpr double dt = 0.02;
    Beside result;
    held.start(channel.rest(), true);
    for (int k = 0; k < steps; ++k)
    {
        const StepResult step = held.step(dt);
        REQUIRE(step.isAccepted);
        result.repeats = std::max(result.repeats, step.solves - 1);
    }
    DemSetup dem;
    dem.bodies = {bar};
    dem.bodies[0].pose = held.records()[0].pose;
    dem.bodies[0].releaseTime = 1e9;
    dem.laws = {ContactLaw()};
    dem.box = {Vec3(0, 0, 0), Vec3(2, 1, 1)};
    CoupledStep still(channel.mesh, channel.halo, channel.fluid, channel.controls, channel.patches, Scene({}, dem.bodies, Vec3::Zero()), &dem, channel.timers);
    still.start(channel.rest(), true);
    for (int k = 0; k < steps; ++k) REQUIRE(still.step(dt).isAccepted);
    result.drag = still.records()[0].fluidForce[0];
    return result;
}

} // namespace flotsam::barInCurrent
