// SPDX-License-Identifier: GPL-3.0-or-later
/// The choice between diagonal blocks and V-cycles for the velocities, given what each would take.
#include "algebra/velocityChoice.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace flotsam;

namespace
{

constexpr int restart = 30;

/// What a run of steps costs in iterations with diagonal blocks, each step of `ofDiagonal` or `ofCycles` iterations; a cycle costs 2.2.
struct Run
{
    VelocityChoice choice{restart};
    double cost = 0;
    int stepsWithCycles = 0, changes = 0;

    void steps(int n, double viscousNumber, int ofDiagonal, int ofCycles)
    {
        for (int k = 0; k < n; ++k)
        {
            const bool before = choice.usesCycles();
            choice.beginStep(viscousNumber);
            const int limit = choice.limit();
            if (limit > 0 && ofDiagonal > limit)
            {
                cost += limit;
                choice.giveUpDiagonal();
                cost += 2.2*ofCycles;
            }
            else
            {
                cost += choice.usesCycles() ? 2.2*ofCycles : ofDiagonal;
                choice.count(choice.usesCycles() ? ofCycles : ofDiagonal);
            }
            stepsWithCycles += choice.usesCycles();
            changes += choice.usesCycles() != before;
        }
    }
};

} // namespace

TEST_CASE("no cycles where viscosity reaches over a fraction of an element only")
{
    Run run;
    run.steps(100, 0.1, 150, 20);
    CHECK(run.stepsWithCycles == 0);
    CHECK(run.choice.limit() == 0);
}

TEST_CASE("over a long run the cost is near that of the better one")
{
    for (const double number : {0.5, 1., 100.})
        for (const int ofDiagonal : {20, 31, 60, 1000})
        {
            const int ofCycles = 16, n = 400;
            Run run;
            run.steps(n, number, ofDiagonal, ofCycles);
            const bool isKnown = ofDiagonal > restart || number >= 1;   // else cycles are never tried
            CHECK(run.cost < 1.1*n*(isKnown ? std::min(double(ofDiagonal), 2.2*ofCycles) : ofDiagonal));
        }
}

TEST_CASE("a flow that becomes smooth or rough is followed, without a change at every step")
{
    Run run;
    run.steps(50, 2, 1000, 50);
    CHECK(run.choice.usesCycles());
    run.steps(100, 2, 20, 15);
    CHECK(!run.choice.usesCycles());
    run.steps(20, 2, 300, 50);
    CHECK(run.choice.usesCycles());
    CHECK(run.changes < 15);
}

TEST_CASE("what is forgotten has no influence")
{
    Run run;
    run.steps(13, 2, 1000, 50);
    run.choice.forget();
    Run other;
    run.cost = 0;
    for (Run* r : {&run, &other}) r->steps(40, 0.7, 40, 12);
    CHECK(run.cost == other.cost);
}
