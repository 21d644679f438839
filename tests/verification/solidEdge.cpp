// SPDX-License-Identifier: GPL-3.0-or-later
/// Sharp edges of structures that cut the mesh, wherever they lie in its elements: a jet that leaves one, water at rest around them.
#include "demCoupling/coupling/coupledStep.hpp"
#include "support/coupledRig.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace flotsam;

namespace
{

constexpr int n = 20;           // elements over 1 m
constexpr double h = 1./n;

/// A jet in air, without gravity: it slides along the top of a box, leaves it at the edge and goes straight on. Nothing acts on the box, and the jet keeps its speed.
struct Jet : CoupledRig
{
    static constexpr double speed = 3, thickness = 0.3;    // [m/s], [m]

    double drag, lift;          ///< on the box, means over the second half, over the jet's momentum flux
    double slowest = 1e300;     ///< speed of nodes well inside the jet behind the edge, over the jet's
    double deflection = 0;      ///< of the jet's momentum behind the edge [rad]

    /// side: the box's edge from a node, in elements.
    Jet(double side, Solid::Wall wall) : CoupledRig(makeBoxMesh(MPI_COMM_WORLD, 2, {2*n, n, 1}, {-1, -0.4, 0}, {1, 0.6, 1})), top_(side*h)
    {
        fluid.isTwoPhase = true;
        fluid.gravity = {0, 0, 0};
        patches = allPatches(mesh, BoundaryPatch::Velocity::Open);
        patches[0] = makePatch(mesh, 0, BoundaryPatch::Velocity::Fixed, [this](const double* x, double) { return velocity(x); }, 1);
        patches[0].phase = BoundaryPatch::Phase::Inflow;
        patches[0].evaluate = [this, nodes = patches[0].nodes, base = patches[0].evaluate](const BoundaryState& state, PatchValues& values)
        {
            base(state, values);
            for (std::size_t k = 0; k < nodes.size(); ++k) values.alpha[k] = content(&mesh.x[2*std::size_t(nodes[k])]);
        };
        SceneStructure box;
        box.solid.wall = wall;
        box.solid.shape = makeBox(Vec3(top_ - 0.35, top_ - 0.3, 0.5), Vec3(0.7, 0.6, 2));
        CoupledStep run(mesh, halo, fluid, controls, patches, Scene({box}, {}, Vec3::Zero()), nullptr, timers);
        FlowState start = restState(mesh);
        for (int i = 0; i < mesh.nNodes; ++i)
        {
            const double* x = &mesh.x[2*std::size_t(i)];
            start.alpha[i] = content(x);
            start.u[2*std::size_t(i)] = velocity(x)[0];
        }
        start.uOld = start.u;
        start.alphaOld = start.alphaOlder = start.alpha;
        run.start(std::move(start), false);
        Vec3 force = Vec3::Zero();
        constexpr int steps = 80;
        for (int k = 0; k < steps; ++k)
        {
            REQUIRE(run.step(0.4*h/speed).isAccepted);
            if (k >= steps/2) force += run.fluid().solidLoads()[0].force/(steps - steps/2);
        }
        const double flux = 1000*speed*speed*thickness;
        drag = force[0]/flux;
        lift = force[1]/flux;
        look(run.fluid().state());
    }

private:
    double depth(const double* x) const { return std::min(x[1] - top_, top_ + thickness - x[1]); }
    double content(const double* x) const { return 1/(1 + std::exp(-depth(x)/(0.2*h))); }
    std::array<double, 3> velocity(const double* x) const { return {depth(x) > -1e-9 ? speed : 0, 0, 0}; }

    void look(const FlowState& state)
    {
        double momentum[2] = {};
        for (int i = 0; i < mesh.nOwned; ++i)
        {
            const double *x = &mesh.x[2*std::size_t(i)], *u = &state.u[2*std::size_t(i)];
            if (x[0] < top_ + 2*h || x[0] > 0.6) continue;
            if (depth(x) > 1.5*h) slowest = std::min(slowest, std::hypot(u[0], u[1])/speed);
            for (int d = 0; d < 2; ++d) momentum[d] += state.alpha[i]*u[d];
        }
        slowest = halo.min(slowest);
        halo.sum(momentum, 2);
        deflection = std::atan2(momentum[1], momentum[0]);
    }

    double top_;
};

/// Water under a gate of two elements' thickness, 0.32 m deep, in front of it; depth of the jet behind over the opening.
double contraction(double side)
{
    constexpr double h = 0.01, opening = 8*h;
    CoupledRig rig(makeBoxMesh(MPI_COMM_WORLD, 2, {110, 36, 1}, {-0.6, 0, 0}, {0.5, 36*h, 1}));
    rig.fluid.isTwoPhase = true;
    rig.fluid.gravity = {0, -9.81, 0};
    rig.patches = allPatches(rig.mesh, BoundaryPatch::Velocity::Slip);
    for (int p : {1, 3}) rig.patches[p] = makePatch(rig.mesh, p, BoundaryPatch::Velocity::Open);
    SceneStructure gate;
    gate.solid.wall = Solid::Wall::Slip;
    gate.solid.shape = makeBox(Vec3((1 + side)*h, opening + side*h + 0.5, 0.5), Vec3(2*h, 1, 2));
    CoupledStep run(rig.mesh, rig.halo, rig.fluid, rig.controls, rig.patches, Scene({gate}, {}, Vec3::Zero()), nullptr, rig.timers);
    FlowState start = restState(rig.mesh);
    for (int i = 0; i < rig.mesh.nNodes; ++i)
    {
        const double* x = &rig.mesh.x[2*std::size_t(i)];
        start.alpha[i] = x[0] < (1 + side)*h && x[1] < 0.32 ? 1 : 0;
    }
    start.alphaOld = start.alphaOlder = start.alpha;
    run.start(std::move(start), true);
    double liquid = 0;
    constexpr double dt = 0.002, end = 0.8, last = 0.3;
    for (int k = 1; k*dt < end + 0.5*dt; ++k)
    {
        REQUIRE(run.step(dt).isAccepted);
        for (int i = 0; i < rig.mesh.nOwned && k*dt > end - last; ++i)
        {
            const double* x = &rig.mesh.x[2*std::size_t(i)];
            if (x[0] < 2*opening - 1e-9 || x[0] > 4*opening - 1e-9) continue;
            liquid += run.fluid().state().alpha[i]*(x[1] < 0.5*h ? 0.5 : 1)*h*h*dt/last;
        }
    }
    return rig.halo.sum(liquid)/(2*opening)/(opening + side*h);
}

} // namespace

TEST_CASE("a jet that slides along a structure leaves its edge straight on, wherever that lies in the elements")
{
    for (const Solid::Wall wall : {Solid::Wall::Slip, Solid::Wall::NoSlip})
        for (const double side : {0.1, 0.5, 0.9})
        {
            const Jet jet(side, wall);
            std::printf("%s, edge %.1f elements from a node: drag %.4f, lift %.4f of the jet's momentum, slowest %.3f, deflection %.4f\n", wall == Solid::Wall::Slip ? "slip" : "no-slip", side,
                jet.drag, jet.lift, jet.slowest, jet.deflection);
            CHECK(std::abs(jet.drag) < 0.05);
            CHECK(std::abs(jet.lift) < 0.055);
            CHECK(std::abs(jet.deflection) < 0.06);
            CHECK(jet.slowest > 0.9);
        }
}

TEST_CASE("water under a gate of eight elements' opening contracts, wherever its edge lies in the elements")
{
    for (const double side : {0.1, 0.5, 0.9})
    {
        const double found = contraction(side);
        std::printf("gate, edge %.1f elements from a node: contraction %.3f\n", side, found);
        CHECK(found == near(0.61, 0.11));   // free-streamline theory; 0.70 in the middle of an element when the elements over the faces all see the edge's velocity
    }
}
