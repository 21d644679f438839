// SPDX-License-Identifier: GPL-3.0-or-later
/// Write times and the steps that meet them: those of OpenFOAM, and the same in a run that goes on.
#include "foam/writeTimes.H"
#include "support/foamCase.H"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace flotsam;

namespace
{

constexpr double interval = 0.1, begin = 0.23, shortest = 0.03, longest = 0.05;
const std::vector<TimeJump> flows{{1.234, 0.01}, {1.45, 0.2}, {begin + 1e-3, 1e-4}};    // the second is longer than any step, the third too near the start
const std::vector<double> jumps{0.1, begin, 0.5, 0.63, 0.6302, 1.0111, 2.2};   // some before the run, at write times or beside each other

struct Record
{
    double time, step;
    bool isWriteTime;
    bool operator==(const Record& r) const { return time == r.time && step == r.step && isWriteTime == r.isWriteTime; }
};

/// A run of steps that want to be `shortest` to `longest`, from `first` on or from what an earlier one has recorded.
class Run
{
public:
    explicit Run(const std::string& control, const std::vector<Record>& past = {}, const std::string& stopAt = "endTime")
    :   clock_(parse("startFrom startTime; startTime " + Foam::name(past.empty() ? begin : past.back().time) + "; stopAt " + stopAt
            + "; endTime 10; deltaT 1; writeInterval " + Foam::name(interval) + "; writeControl " + control + "; timePrecision 17;"),
            ".", ".", "system", "constant", false, false),
        records_(past)
    {
        if (!past.empty()) clock_.setTime(past.back().time, Foam::label(past.size()));
        times_ = std::make_unique<WriteTimes>(clock_, begin, past.empty() ? 0 : past.back().step, jumps, flows);
    }

    std::vector<Record> to(std::size_t nSteps)
    {
        while (records_.size() < nSteps && clock_.value() < clock_.endTime().value() - 0.5*clock_.deltaTValue()) // Time::run() without function objects
        {
            const double step = times_->setStep(0.5*(shortest + longest) + 0.5*(longest - shortest)*std::sin(double(records_.size())));
            mayWrite_.push_back(times_->mayWriteAfter(step));
            times_->advance(step);
            records_.push_back({clock_.value(), clock_.deltaTValue(), clock_.writeTime()});
        }
        return records_;
    }

    const WriteTimes& times() const { return *times_; }
    const std::vector<bool>& mayWrite() const { return mayWrite_; }  ///< per step of this run, as was known before it

private:
    Foam::Time clock_;
    std::unique_ptr<WriteTimes> times_;
    std::vector<Record> records_;
    std::vector<bool> mayWrite_;
};

}

TEST_CASE("a run that goes on from any step makes the same steps and meets the same write times, to the last bit")
{
    for (const char* control : {"adjustableRunTime", "runTime"})
    {
        CAPTURE(control);
        Run whole(control);
        const std::vector<Record> records = whole.to(60);
        for (std::size_t stop = 1; stop < 50; ++stop)
        {
            CAPTURE(stop);
            CHECK(Run(control, {records.begin(), records.begin() + stop}).to(60) == records);
        }
    }
}

TEST_CASE("steps end at jumps, by none that is less than half as long as wanted unless two jumps or a write time are nearer than that")
{
    for (const char* control : {"adjustableRunTime", "runTime"})
    {
        CAPTURE(control);
        const std::vector<Record> records = Run(control).to(80);
        REQUIRE(records.back().time > jumps.back());
        for (const double jump : jumps)
            if (jump > begin) CHECK(std::any_of(records.begin(), records.end(), [&](const Record& r) { return std::abs(r.time - jump) < 1e-13; }));
        const auto isShort = [](const Record& r) { return r.step < 0.5*shortest; };
        CHECK(std::count_if(records.begin(), records.end(), isShort) <= (control == std::string("adjustableRunTime") ? 4 : 1));
    }
}

TEST_CASE("the steps beside a jump of what is let in are of one length, unless a write time is between; jumps longer than a step are left alone")
{
    const std::vector<Record> records = Run("runTime").to(80);
    const auto at = std::find_if(records.begin(), records.end(), [](const Record& r) { return std::abs(r.time - flows[0].time) < 1e-13; });
    REQUIRE(at != records.end());
    CHECK(at->step >= 0.5*shortest);
    CHECK((at + 1)->step == near(at->step, 1e-9));
    CHECK((at + 2)->step == near(at->step, 1e-9));
    CHECK(std::none_of(records.begin(), records.end(), [](const Record& r) { return std::abs(r.time - flows[1].time) < 1e-6; }));
    CHECK(std::none_of(records.begin(), records.end(), [](const Record& r) { return std::abs(r.time - flows[2].time) < 1e-6; }));
}

TEST_CASE("adjusted steps end at the write times, others beside them; each counts once")
{
    int nAdjusted = 0, nNearest = 0;
    for (const Record& r : Run("adjustableRunTime").to(130))
    {
        CHECK(r.step < 1.0101*longest);
        if (r.isWriteTime) CHECK(r.time == near(begin + ++nAdjusted*interval, 1e-14));
    }
    for (const Record& r : Run("runTime").to(100))
        if (r.isWriteTime) CHECK(std::abs(r.time - (begin + ++nNearest*interval)) <= longest - 0.5*shortest);
    CHECK(nAdjusted > 30);
    CHECK(nNearest > 30);
}

TEST_CASE("whether a write time comes by the end of the run is known before")
{
    for (const char* control : {"adjustableRunTime", "runTime"})
    {
        Run run(control);
        CHECK(run.times().comeBy(begin + interval));
        CHECK(!run.times().comeBy(begin + 0.99*interval));
        for (std::size_t n = 1; !run.to(n).back().isWriteTime; ++n) {}
        CHECK(run.times().comeBy(begin + 2*interval));
        CHECK(!run.times().comeBy(begin + 1.9*interval));
    }
    CHECK(Run("cpuTime").times().comeBy(begin + 0.5*interval));     // nobody knows
}

TEST_CASE("whether a step ends at a write time is known before it")
{
    for (const char* control : {"adjustableRunTime", "runTime", "timeStep; writeInterval 3"})
    {
        CAPTURE(control);
        Run run(control);
        const std::vector<Record> records = run.to(60);
        for (std::size_t n = 0; n < records.size(); ++n) CHECK(run.mayWrite()[n] == records[n].isWriteTime);
        CHECK(std::count_if(records.begin(), records.end(), [](const Record& r) { return r.isWriteTime; }) > 15);
    }
    const Run run("adjustableRunTime");
    CHECK(run.times().mayWriteAfter(interval));
    CHECK(!run.times().mayWriteAfter(0.4*interval));    // a step that is repeated with a shorter one
    CHECK(Run("cpuTime").times().mayWriteAfter(1e-6));  // nobody knows
}

TEST_CASE("a run that ends at the next write time ends at one")
{
    const std::vector<Record> past = Run("adjustableRunTime").to(4), records = Run("adjustableRunTime", past, "nextWrite").to(100);
    CHECK(records.size() < 10);
    CHECK(records.back().isWriteTime);
}
