// SPDX-License-Identifier: GPL-3.0-or-later
/// Inertia of second order in time at nodes that the surface passes: where it would be less than what else is in the row, it is of first order.
#include "equations/elementLoader.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

using namespace flotsam;

namespace
{

struct Node
{
    FlowState state;
    FlowStepData step;
    NodalData nodal;

    explicit Node(double older, double old, double now, double dt = 0.01, double dtOld = 0.01)
    {
        state.u = {1, 2};
        state.uOld = {3, 4};
        step.state = &state;
        step.time = TimeScheme::bdf(2, dt, dtOld);
        nodal.rhoOlder = {older};
        nodal.rhoOld = {old};
        nodal.rho = {now};
    }

    NodeInertia own() const { return nodeInertia(0, 2, false, step, nodal); }
    bool isSecondOrder() const { return own().isSecondOrder == 1; }
};

} // namespace

TEST_CASE("nodes that fill, empty or stay are of second order; those that have just lost their liquid, or lost it and get it back, are not")
{
    CHECK(Node(1, 1, 1).isSecondOrder());
    CHECK(Node(1, 1, 500).isSecondOrder());
    CHECK(Node(1, 500, 1000).isSecondOrder());
    CHECK(Node(1000, 1000, 500).isSecondOrder());
    CHECK(Node(1, 1000, 1000).isSecondOrder());
    CHECK(Node(1000, 1000, 1).isSecondOrder());
    CHECK(!Node(1000, 1, 1).isSecondOrder());
    CHECK(!Node(500, 1, 500).isSecondOrder());
    CHECK(!Node(1000, 1, 300).isSecondOrder());
    CHECK(Node(600, 500, 600).isSecondOrder());
}

TEST_CASE("whatever the densities and steps: inertia is half of first order's at least, and what appears by second order alone is at most the inertia")
{
    for (const double ratio : {0.2, 0.5, 1.0, 2.0})
        for (const double older : {1.0, 30.0, 500.0, 1000.0})
            for (const double old : {1.0, 30.0, 500.0, 1000.0})
                for (const double now : {1.0, 30.0, 500.0, 1000.0})
                {
                    const double dt = 0.01;
                    const Node node(older, old, now, dt, dt/ratio);
                    const NodeInertia own = node.own();
                    const double firstRate = (now - old)/dt, firstInertia = 0.5*(now + old)/dt;
                    CAPTURE(ratio);
                    CAPTURE(older);
                    CAPTURE(old);
                    CAPTURE(now);
                    CHECK(own.inertia >= 0.5*firstInertia*(1 - 1e-12));
                    CHECK(own.densityRate - firstRate <= own.inertia*(1 + 1e-12));
                    if (own.isSecondOrder == 0) CHECK(own.densityRate == near(firstRate, 1e-14));
                    // in a uniform flow the row holds whatever the order: inertia u - history = rate u/2
                    Node uniform = node;
                    uniform.state.u = uniform.state.uOld = {7, 7};
                    uniform.step.state = &uniform.state;
                    const NodeInertia same = uniform.own();
                    CHECK(same.inertia*7 - same.momentumHistory[0] == within(0.5*same.densityRate*7, 2e-15*same.inertia*7));
                }
}
