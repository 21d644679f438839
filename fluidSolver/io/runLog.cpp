// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/runLog.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numeric>
#include <stdexcept>

namespace flotsam
{

namespace
{

constexpr int linesPerHeading = 25;
constexpr double negligibleVolume = 1e-9; // of the liquid
constexpr double paceMemory = 0.05; ///< weight of a new step in the smoothed pace: about the last 20 steps

__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

double sum(const PhaseTimers::Seconds& seconds)
{
    return std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

double norm(const std::array<double, 3>& v)
{
    return std::hypot(v[0], v[1], v[2]);
}

std::string clockText(double seconds)
{
    if (seconds < 0) return "?";
    const long s = std::lround(seconds);
    if (s >= 86400) return format("%ldd%02ldh", s / 86400, s / 3600 % 24);
    return s >= 3600 ? format("%ldh%02ldm", s / 3600, s / 60 % 60) : format("%ldm%02lds", s / 60, s % 60);
}

double seconds(const std::timespec& from, const std::timespec& to)
{
    return double(to.tv_sec - from.tv_sec) + 1e-9 * double(to.tv_nsec - from.tv_nsec);
}

/// Digits of a time by which a hundredth of the step is told, as many as the column takes.
int digitsOfTime(double time, double dt)
{
    if (!(dt > 0) || !(time > dt)) return 6;
    return std::clamp(int(std::ceil(std::log10(100*time/dt))), 6, 10);
}

std::timespec processorTime()
{
    std::timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now;
}

/// Lines of the summary; scale: what errors are over [m^3].
std::string volumes(const RunSummary& s, double scale)
{
    const double error = scale > 0 ? s.mass.error() / scale : 0;
    const std::string displaced = s.mass.displaced == 0 ? "" : format("  gave way to bodies that were put in %.8g\n", s.mass.displaced);
    if (!s.isTwoPhase)
        return format("\n  volume of the fluid [m^3], which moving bodies change as they cut other elements\n  at the start %.8g, at the end %.8g: %.2g of it\n", s.mass.initial, s.mass.final, error)
            + displaced;
    return format("\n  liquid volume [m^3]\n  at the start %.8g, in %.8g, out %.8g, at the end %.8g\n  storage %.8g, error %.3g (%.2g of the liquid)\n", s.mass.initial, s.mass.inflow,
        s.mass.outflow, s.mass.final, s.mass.storage(), s.mass.error(), error)
        + displaced;
}

} // namespace

const char* phaseName(Phase phase)
{
    static const char* const names[nPhases] = {
        "flow assembly", "flow solve", "phase field", "cut", "DEM", "exchange", "output", "other"};
    return names[std::size_t(phase)];
}

// --- timers -------------------------------------------------------------------------------------------------------

PhaseTimers::PhaseTimers() : stack_{Phase::Other}, lastWall_(Clock::now()), lastCpu_(processorTime())
{
    stack_.reserve(16);
}

void PhaseTimers::charge()
{
    const auto wallNow = Clock::now();
    const auto cpuNow = processorTime();
    const auto phase = std::size_t(stack_.back());
    wall_[phase] += std::chrono::duration<double>(wallNow - lastWall_).count();
    cpu_[phase] += seconds(lastCpu_, cpuNow);
    lastWall_ = wallNow;
    lastCpu_ = cpuNow;
}

void PhaseTimers::start(Phase phase)
{
    charge();
    stack_.push_back(phase);
}

void PhaseTimers::stop()
{
    charge();
    if (stack_.size() > 1) stack_.pop_back();
}

PhaseTimers::Seconds PhaseTimers::wall() const
{
    PhaseTimers now(*this);
    now.charge();
    return now.wall_;
}

PhaseTimers::Seconds PhaseTimers::cpu() const
{
    PhaseTimers now(*this);
    now.charge();
    return now.cpu_;
}

// --- forces -------------------------------------------------------------------------------------------------------

ForceStatistics::ForceStatistics(const std::vector<std::string>& names) : names_(names), sums_(names.size()) {}

void ForceStatistics::add(std::size_t member, double dt, const double* fluidForce, const double* contactForce,
    const double* peakContactForce)
{
    Sums& s = sums_.at(member);
    std::array<double, 3> fluid, contact, total;
    for (int d = 0; d < 3; ++d)
    {
        fluid[d] = fluidForce[d];
        contact[d] = contactForce[d];
        total[d] = fluid[d] + contact[d];
        s.fluid[d] += dt * fluid[d];
        s.contact[d] += dt * contact[d];
    }
    s.time += dt;
    s.maxFluid = std::max(s.maxFluid, norm(fluid));
    s.maxContact = std::max(s.maxContact, norm(contact));
    s.maxTotal = std::max(s.maxTotal, norm(total));
    s.peakContact = std::max(s.peakContact, norm({peakContactForce[0], peakContactForce[1], peakContactForce[2]}));
}

std::vector<MemberForces> ForceStatistics::result() const
{
    std::vector<MemberForces> list(sums_.size());
    for (std::size_t m = 0; m < list.size(); ++m)
    {
        const Sums& s = sums_[m];
        const double weight = s.time > 0 ? 1 / s.time : 0;
        list[m].name = names_[m];
        for (int d = 0; d < 3; ++d)
        {
            list[m].meanFluid[d] = weight * s.fluid[d];
            list[m].meanContact[d] = weight * s.contact[d];
        }
        list[m].maxFluid = s.maxFluid;
        list[m].maxContact = s.maxContact;
        list[m].maxTotal = s.maxTotal;
        list[m].peakContact = s.peakContact;
    }
    return list;
}

std::string forceTable(const std::string& of, const std::vector<MemberForces>& members)
{
    if (members.empty()) return "";
    std::string text = "\n  " + format("%-24s", ("forces on " + of + " [N]").c_str()) + "   mean of water (x y z)               mean of contact (x y z)"
        "             largest: water   contact       both    impact\n";
    for (const MemberForces& m : members)
    {
        text += format("  %-22s %11.4g %11.4g %11.4g %11.4g %11.4g %11.4g %15.4g %9.4g %10.4g %9.4g\n", m.name.c_str(),
            m.meanFluid[0], m.meanFluid[1], m.meanFluid[2], m.meanContact[0], m.meanContact[1], m.meanContact[2],
            m.maxFluid, m.maxContact, m.maxTotal, m.peakContact);
    }
    return text;
}

std::vector<double> ForceStatistics::values() const
{
    std::vector<double> list;
    for (const Sums& s : sums_)
    {
        list.push_back(s.time);
        list.insert(list.end(), s.fluid.begin(), s.fluid.end());
        list.insert(list.end(), s.contact.begin(), s.contact.end());
        list.insert(list.end(), {s.maxFluid, s.maxContact, s.maxTotal, s.peakContact});
    }
    return list;
}

void ForceStatistics::restore(const std::vector<double>& values)
{
    constexpr std::size_t n = 11;
    if (values.size() != n * sums_.size())
    {
        throw std::runtime_error("force statistics: stored for " + std::to_string(values.size() / n)
            + " structure members, the case has " + std::to_string(sums_.size()));
    }
    for (std::size_t m = 0; m < sums_.size(); ++m)
    {
        const double* v = values.data() + n * m;
        sums_[m] = {v[0], {v[1], v[2], v[3]}, {v[4], v[5], v[6]}, v[7], v[8], v[9], v[10]};
    }
}

// --- step line ----------------------------------------------------------------------------------------------------

RunLog::RunLog(const PhaseTimers& timers, double startTime, double endTime)
    : timers_(timers), endTime_(endTime), lastTime_(startTime), lastWall_(timers.wall())
{
}

std::string RunLog::stepLine(const StepReport& r)
{
    const auto now = timers_.wall();
    PhaseTimers::Seconds spent;
    for (std::size_t i = 0; i < nPhases; ++i) spent[i] = now[i] - lastWall_[i];
    const double total = sum(spent), advance = r.time - lastTime_;
    lastWall_ = now;
    lastTime_ = r.time;

    // a plain mean at first, then a memory of the last steps: the pace changes when bodies arrive
    const double weight = std::max(paceMemory, 1.0 / double(lines_ + 1));
    meanWall_ += weight * (total - meanWall_);
    meanAdvance_ += weight * (advance - meanAdvance_);
    timeLeft_ = meanAdvance_ > 0 ? std::max(0.0, endTime_ - r.time) * meanWall_ / meanAdvance_ : -1;

    const auto share = [&](std::initializer_list<Phase> phases)
    {
        double part = 0;
        for (const Phase p : phases) part += spent[std::size_t(p)];
        return total > 0 ? int(std::lround(100 * part / total)) : 0;
    };
    std::string text;
    if (lines_++ % linesPerHeading == 0)
    {
        text += "    step     time [s]    dt [s]  limit   iter rep  mass err touch |  Co mean      max     body |flow phas  cut  dem  out  rest %| s/step    left\n";
    }
    text += format("%8ld %12.*g %9.3g  %-7s %4d %3d %9.1e %5d |  %8.3g %8.3g %8.3g |%4d %4d %4d %4d %4d %4d  |%7.3g %7s\n", r.step, digitsOfTime(r.time, r.dt), r.time, r.dt,
        r.limit.c_str(), r.linearIterations, r.contactRepeats, r.massError, r.bodiesInContact, r.courant.mean, r.courant.largest, r.courant.bodies,
        share({Phase::FlowAssembly, Phase::FlowSolve}), share({Phase::PhaseField}), share({Phase::Cut}),
        share({Phase::Dem, Phase::Exchange}), share({Phase::Output}), share({Phase::Other}), total,
        clockText(timeLeft_).c_str());
    return text;
}

// --- summary ------------------------------------------------------------------------------------------------------

std::string RunLog::summary(const RunSummary& s)
{
    const double wall = sum(s.wall), cpu = sum(s.cpu);
    const double work = double(s.steps) * double(s.nodes);
    std::string text = format("\nSummary: %ld steps, %ld repeated, %lld nodes, %d rank%s, %.4g s wall, %.4g s processor\n\n",
        s.steps, s.repeatedSteps, s.nodes, s.ranks, s.ranks == 1 ? "" : "s", wall, cpu);

    text += "  phase            wall [s]     %   processor [s]   us per node and step\n";
    for (std::size_t i = 0; i < nPhases; ++i)
    {
        text += format("  %-14s %10.3f %5.1f %15.3f %22.4f\n", phaseName(Phase(i)), s.wall[i],
            wall > 0 ? 100 * s.wall[i] / wall : 0, s.cpu[i], work > 0 ? 1e6 * s.wall[i] / work : 0);
    }
    text += format("  %-14s %10.3f %5.1f %15.3f %22.4f\n", "all", wall, 100.0, cpu, work > 0 ? 1e6 * wall / work : 0);

    if (!s.anomalies.empty())
    {
        text += "\n  counted in this run (0 is good; faces are limited wherever fronts meet in a splash)\n";
        for (const auto& a : s.anomalies) text += format("  %-40s %12lld\n", a.first.c_str(), a.second);
    }
    if (s.bodiesAwaited > 0) text += format("\n  %d of %d bodies have not come in\n", s.bodiesAwaited, s.bodies);
    if (s.bodiesLeft > 0) text += format("\n  %d of %d bodies have left the mesh\n", s.bodiesLeft, s.bodies);
    if (s.largestOverlap > RunLog::deepOverlap * s.thinnestBody)
    {
        const std::string cause = s.overlapPressedBy.empty() ? "Contact is too soft: give constant/bodies more `stiffness`"
                                                             : "Structure " + s.overlapPressedBy + " pressed them together: it moves as prescribed whatever is in its way";
        text += format("\n  contact surfaces overlapped by up to %.2g m, %.0f %% of the thinnest body. %s\n", s.largestOverlap, 100 * s.largestOverlap / s.thinnestBody, cause.c_str());
    }
    const double scale = std::max({s.mass.initial, s.mass.final, s.mass.inflow});
    text += volumes(s, scale);

    if (s.unbalancedVolume > negligibleVolume * scale)
    {
        text += format("  basins without a given pressure: surfaces swept %.3g m^3 more than these can give; their gas made room\n", s.unbalancedVolume);
    }

    text += forceTable("structures", s.structures);
    return text;
}

} // namespace flotsam
