// SPDX-License-Identifier: GPL-3.0-or-later
/// What a run tells its user: where the time goes, one line per step, a summary at the end. Plain text to a stream;
/// the caller decides which rank prints.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace flotsam
{

enum class Phase { FlowAssembly, FlowSolve, PhaseField, Cut, Dem, Exchange, Output, Other };
constexpr std::size_t nPhases = 8;
const char* phaseName(Phase phase);

/// Wall and processor seconds by phase. Phases may nest: the time of an inner one is not counted for the outer one, so
/// that the phases add up to the whole. Everything outside any phase is Phase::Other.
class PhaseTimers
{
public:
    using Seconds = std::array<double, nPhases>;

    PhaseTimers();
    void start(Phase phase);    ///< use PhaseTimer instead
    void stop();

    Seconds wall() const;       ///< up to now
    Seconds cpu() const;        ///< of all threads of this process, user and system

private:
    void charge();

    using Clock = std::chrono::steady_clock;
    Seconds wall_{}, cpu_{};
    std::vector<Phase> stack_;  ///< the running phases, innermost last
    Clock::time_point lastWall_;
    std::timespec lastCpu_;
};

/// Charges the time of its scope to a phase:  PhaseTimer t(timers, Phase::Cut);
class PhaseTimer
{
public:
    PhaseTimer(PhaseTimers& timers, Phase phase) : timers_(timers) { timers_.start(phase); }
    ~PhaseTimer() { timers_.stop(); }
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

private:
    PhaseTimers& timers_;
};

/// Courant numbers of a step with the velocities at its start.
struct CourantNumbers
{
    double mean = 0, largest = 0;   ///< |u| dt/h of the flow; the largest as it counts for maxCo
    double bodies = 0;              ///< as it counts for maxBodyCo

    CourantNumbers operator*(double factor) const { return {factor*mean, factor*largest, factor*bodies}; }
};

/// One accepted step.
struct StepReport
{
    long step = 0;
    double time = 0, dt = 0;        ///< [s]
    std::string limit;              ///< what limits dt, one word: flow, body, cap, write, motion, growth, retry
    int linearIterations = 0;
    int contactRepeats = 0;
    double massError = 0;           ///< MassBalance::relativeError()
    int bodiesInContact = 0;
    CourantNumbers courant;
};

/// Forces on one structure member [N], space frame; means over the run's time.
struct MemberForces
{
    std::string name;
    std::array<double, 3> meanFluid{}, meanContact{};
    double maxFluid = 0, maxContact = 0, maxTotal = 0;  ///< magnitudes of means over a step
    double peakContact = 0;                             ///< magnitude within a step
};

/// Collects MemberForces over the steps. values()/restore() carry it through a checkpoint.
class ForceStatistics
{
public:
    explicit ForceStatistics(const std::vector<std::string>& names);
    void add(std::size_t member, double dt, const double* fluidForce, const double* contactForce, const double* peakContactForce);
    std::vector<MemberForces> result() const;

    std::vector<double> values() const;
    void restore(const std::vector<double>& values); ///< throws std::runtime_error for another number of members

private:
    struct Sums { double time = 0; std::array<double, 3> fluid{}, contact{}; double maxFluid = 0, maxContact = 0, maxTotal = 0, peakContact = 0; };
    std::vector<std::string> names_;
    std::vector<Sums> sums_;
};

/// Table of the summary, a line for each member; empty without. of: word for what they are.
std::string forceTable(const std::string& of, const std::vector<MemberForces>& members);

/// Liquid volumes [m^3] since the start.
struct MassBalance
{
    double initial = 0, inflow = 0, outflow = 0, final = 0;
    double displaced = 0;   ///< that gave way to bodies put into a run that went on
    double storage() const { return final - initial; }
    double error() const { return storage() - (inflow - outflow - displaced); }
    /// Over the liquid at the start or now, whichever is more: a channel may begin dry. Not over what has passed: that grows in any long run.
    double relativeError() const { return std::max(initial, final) > 0 ? error()/std::max(initial, final) : 0; }
};

struct RunSummary
{
    long steps = 0, repeatedSteps = 0;
    long long nodes = 0;                                    ///< of the whole mesh
    int ranks = 1;
    int bodies = 0, bodiesLeft = 0;                         ///< bodiesLeft: that have left the mesh since the start
    int bodiesAwaited = 0;                                  ///< that have not come in yet
    double largestOverlap = 0, thinnestBody = 0;            ///< of contact surfaces since the start; smallest extent of a body [m]
    std::string overlapPressedBy;                           ///< structure whose prescribed motion made that overlap; empty: none
    std::vector<std::pair<std::string, long long>> anomalies; ///< counted: "clipped alpha", "rejected steps", ...
    bool isTwoPhase = true;                                 ///< of a single fluid `mass` knows nothing of what enters and leaves
    MassBalance mass;
    double unbalancedVolume = 0;                            ///< swept in basins without a prescribed pressure beyond what these can give [m^3]
    std::vector<MemberForces> structures;
    PhaseTimers::Seconds wall{}, cpu{};                     ///< mean or maximum of the ranks, as the caller has reduced them
};

/// Step lines and the summary.
class RunLog
{
public:
    static constexpr double deepOverlap = 0.05; ///< of the thinnest body: such overlaps of contact surfaces are told
    static constexpr double largeCourant = 10;  ///< steps of given length beyond it are told: docs/resolution.md, "Time step"

    /// `timers` must outlive the log. `endTime` [s] for the time left.
    RunLog(const PhaseTimers& timers, double startTime, double endTime);

    /// One line (with a heading every 25 lines) ended by a newline. Shares of time are those since the last line.
    std::string stepLine(const StepReport& report);

    /// Wall seconds still to go, from the pace of the last steps; negative: not known yet.
    double timeLeft() const { return timeLeft_; }

    static std::string summary(const RunSummary& summary);

private:
    const PhaseTimers& timers_;
    double endTime_, lastTime_;
    PhaseTimers::Seconds lastWall_;
    double meanWall_ = 0, meanAdvance_ = 0; ///< smoothed wall seconds and simulated seconds of a step
    double timeLeft_ = -1;
    long lines_ = 0;
};

} // namespace flotsam
