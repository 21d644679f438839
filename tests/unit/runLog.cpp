// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/runLog.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

using namespace flotsam;

namespace
{

void rest(int milliseconds)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

double at(const PhaseTimers::Seconds& seconds, Phase phase)
{
    return seconds[std::size_t(phase)];
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("nested phases add up to the whole, each second counted once")
{
    const auto start = std::chrono::steady_clock::now();
    PhaseTimers timers;
    {
        PhaseTimer flow(timers, Phase::FlowSolve);
        rest(10);
        {
            PhaseTimer dem(timers, Phase::Dem);
            rest(20);
        }
        rest(10);
    }
    rest(5);
    const auto wall = timers.wall();
    const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;

    CHECK(at(wall, Phase::FlowSolve) >= 0.020);
    CHECK(at(wall, Phase::Dem) >= 0.020);
    CHECK(at(wall, Phase::Other) >= 0.005);
    CHECK(at(wall, Phase::Cut) == 0);
    const double sum = std::accumulate(wall.begin(), wall.end(), 0.0);
    CHECK(sum >= 0.045);
    CHECK(sum <= all.count());
    CHECK(at(timers.cpu(), Phase::Dem) < 0.015); // asleep
}

TEST_CASE("starting and stopping a phase costs next to nothing")
{
    PhaseTimers timers;
    const int n = 10000;
    for (int i = 0; i < n; ++i) PhaseTimer t(timers, Phase::Exchange);
    const auto wall = timers.wall();
    const double each = std::accumulate(wall.begin(), wall.end(), 0.0) / n;
    MESSAGE("us per phase: " << 1e6 * each);
    CHECK(each < 100e-6);
}

TEST_CASE("a step is one line; a heading comes every 25 lines; the time left follows the pace")
{
    PhaseTimers timers;
    RunLog log(timers, 0, 10);
    CHECK(log.timeLeft() < 0);
    int headings = 0;
    for (int i = 1; i <= 51; ++i)
    {
        StepReport report;
        report.step = i;
        report.time = 0.1 * i;
        report.dt = 0.1;
        report.limit = "body";
        report.linearIterations = 12;
        report.massError = -1.5e-13;
        report.bodiesInContact = 20;
        report.courant = CourantNumbers{1.25, 2.5, 0.75}*0.1;
        { PhaseTimer t(timers, Phase::Cut); rest(1); }
        const std::string text = log.stepLine(report);
        const bool hasHeading = contains(text, "time [s]");
        headings += hasHeading;
        CHECK(std::count(text.begin(), text.end(), '\n') == (hasHeading ? 2 : 1));
        CHECK(contains(text, "body"));
        CHECK(contains(text, "-1.5e-13"));
        for (const char* courant : {" 0.125 ", " 0.25 ", " 0.075 "}) CHECK(contains(text, courant));
        if (i == 1)
        {
            const auto end = text.find('\n');
            MESSAGE("\n" << text);
            CHECK(text.size() - end - 2 == within(double(end), 2)); // columns stand under their heading
        }
    }
    CHECK(headings == 3);
    // 49 steps of a millisecond or somewhat more are left
    CHECK(log.timeLeft() >= 0.049);
    CHECK(log.timeLeft() < 2);
}

TEST_CASE("late times are told apart by the steps between them")
{
    PhaseTimers timers;
    RunLog log(timers, 86400, 86500);
    StepReport report;
    report.dt = 0.005;
    report.time = 86400.005;
    CHECK(contains(log.stepLine(report), " 86400.005 "));
    report.time = 86400.01;
    CHECK(contains(log.stepLine(report), " 86400.01 "));
    report.dt = 1e-6;
    report.time = 123456.789012;
    CHECK(contains(log.stepLine(report), "  123456.789 ")); // as far as the column goes
}

TEST_CASE("force statistics are means over time and pass through a checkpoint")
{
    ForceStatistics statistics({"pipe1", "pipe2"});
    const double water[3] = {3, 0, 4}, none[3] = {0, 0, 0}, contact[3] = {-3, 0, 0}, peak[3] = {-12, 5, 0};
    statistics.add(0, 1, water, none, peak);
    ForceStatistics continued({"pipe1", "pipe2"});
    continued.restore(statistics.values());
    continued.add(0, 3, none, contact, contact);
    const auto result = continued.result();
    CHECK(result[0].name == "pipe1");
    CHECK(result[0].meanFluid[0] == 0.75);
    CHECK(result[0].meanFluid[2] == 1);
    CHECK(result[0].meanContact[0] == -2.25);
    CHECK(result[0].maxFluid == 5);
    CHECK(result[0].maxTotal == 5);
    CHECK(result[0].maxContact == 3);
    CHECK(result[0].peakContact == 13);
    CHECK(result[1].maxTotal == 0);
    CHECK(result[1].meanFluid[0] == 0);
    CHECK_THROWS_AS(ForceStatistics({"one"}).restore(statistics.values()), std::runtime_error);
}

TEST_CASE("the summary names phases, anomalies, mass balance and forces")
{
    RunSummary s;
    s.steps = 100;
    s.repeatedSteps = 3;
    s.nodes = 10000;
    s.wall[std::size_t(Phase::FlowSolve)] = 6;
    s.wall[std::size_t(Phase::Dem)] = 2;
    s.anomalies = {{"clipped alpha", 7}};
    s.bodies = 12;
    s.bodiesLeft = 3;
    s.bodiesAwaited = 4;
    s.largestOverlap = 0.03;
    s.thinnestBody = 0.2;
    s.mass.initial = 1;
    s.mass.inflow = 0.5;
    s.mass.outflow = 0.25;
    s.mass.final = 1.25 + 1e-9;
    s.unbalancedVolume = 0.0321;
    s.structures = {{"pipe1", {1, 2, 3}, {4, 5, 6}, 7, 8, 9}};
    const std::string text = RunLog::summary(s);
    MESSAGE(text);
    for (const char* part : {"100 steps, 3 repeated", "75.0", "6.0000", "clipped alpha", "4 of 12 bodies have not come in", "3 of 12 bodies have left", "0.03 m, 15 % of the thinnest body. Contact is too soft", "1e-09", "0.0321", "pipe1"}) CHECK(contains(text, part));
    s.overlapPressedBy = "gate"; // more stiffness would be no help
    const std::string pressed = RunLog::summary(s);
    CHECK(contains(pressed, "15 % of the thinnest body. Structure gate pressed them together"));
    CHECK(!contains(pressed, "too soft"));
    s.isTwoPhase = false; // what enters is not counted
    CHECK(contains(RunLog::summary(s), "at the start 1, at the end 1.25: "));
    CHECK(!contains(RunLog::summary(s), "liquid"));
    CHECK(s.mass.error() == near(1e-9, 3e-7));
    CHECK(MassBalance{2, 0.5, 1, 1.501}.relativeError() == near(0.0005, 1e-9));     // over the start
    CHECK(MassBalance{0, 2, 1, 1.01}.relativeError() == near(0.01/1.01, 1e-9));     // a channel that begins dry
    CHECK(MassBalance{0, 0, 0, 0}.relativeError() == 0);
}
