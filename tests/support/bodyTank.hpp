// SPDX-License-Identifier: GPL-3.0-or-later
/// A tank in 2D with bars over water, for tests of the coupled step.
#pragma once

#include "geometry/primitives.hpp"
#include "support/coupledRig.hpp"

#include <cmath>
#include <memory>

namespace bodyTank
{

using namespace flotsam;

constexpr double g = 9.81, side = 0.1, level = 0.5;
const Vec3 gravity(0, -g, 0);

/// 1 m x 1.2 m, elements of 0.04 m, half full, open at the top.
struct Tank : CoupledRig
{
    Tank() : CoupledRig(makeBoxMesh(MPI_COMM_WORLD, 2, {25, 30, 1}, {0, 0, 0}, {1, 1.2, 1}))
    {
        fluid.isTwoPhase = true;
        fluid.rhoLiquid = 1000;
        fluid.muLiquid = 1e-3;
        fluid.rhoGas = 1;
        fluid.muGas = 1e-5;
        fluid.gravity = {0, -g, 0};
        for (int p = 0; p < 4; ++p) patches.push_back(makePatch(mesh, p, p == 3 ? BoundaryPatch::Velocity::Open : BoundaryPatch::Velocity::Slip));
    }

    FlowState rest() const
    {
        FlowState state = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i) state.alpha[i] = mesh.x[2*std::size_t(i) + 1] <= level;
        return state;
    }
};

/// A square bar of 600 kg/m3, side `side`.
inline BodyDefinition makeBar(const std::string& name, double releaseTime, const Vec3& position)
{
    BodyDefinition bar;
    bar.name = name;
    bar.shape = makeBox(Vec3::Zero(), Vec3(side, side, 1));
    bar.volume = side*side;
    bar.mass = 600*bar.volume;
    bar.principalInertia = bar.mass/12*Vec3(1 + side*side, 1 + side*side, 2*side*side);
    bar.pose.position = position;
    bar.isPlanar = true;
    bar.thinnest = side;
    bar.releaseTime = releaseTime;
    for (double y : {-0.04, -0.02, 0.0, 0.02, 0.04})
        for (double x : {-0.04, -0.02, 0.0, 0.02, 0.04})
            if (std::max(std::abs(x), std::abs(y)) > 0.03) bar.spheres.push_back({Vec3(x, y, 0), 0.01});
    return bar;
}

/// The bars between floor and side walls.
inline DemSetup makeDem(const std::vector<BodyDefinition>& bars)
{
    DemSetup dem;
    dem.bodies = bars;
    dem.laws = {ContactLaw()};
    dem.box = {Vec3(0, 0, 0), Vec3(1, 1.2, 1)};
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0)})
    {
        WallDefinition wall;
        wall.name = "wall";
        wall.point = normal[0] < 0 ? Vec3(1, 0, 0) : Vec3(Vec3::Zero());
        wall.normal = normal;
        dem.walls.push_back(wall);
    }
    return dem;
}

inline std::unique_ptr<CoupledStep> makeRun(Tank& tank, const DemSetup& dem)
{
    return std::make_unique<CoupledStep>(tank.mesh, tank.halo, tank.fluid, tank.controls, tank.patches, Scene({}, dem.bodies, gravity), &dem, tank.timers);
}

} // namespace bodyTank
