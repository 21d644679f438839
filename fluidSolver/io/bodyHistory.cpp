// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bodyHistory.hpp"

#include "io/hdf5File.hpp"
#include "io/historyTables.hpp"
#include "io/surfaceSeries.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

namespace flotsam
{

namespace
{

constexpr std::size_t maxBufferedRows = 64;
constexpr double maxBufferedSeconds = 1;    ///< or what keeps the time that goes into the file below `largestShare` of the run's: of hundreds of bodies it takes tenths of a second
constexpr double largestShare = 0.01;

/// The start time may have been through a text of 12 digits.
double roundOff(double startTime) { return 1e-11 * std::abs(startTime); }

void checkNames(const std::string& file, const std::vector<HistoryMember>& members)
{
    std::set<std::string> groups;
    for (const auto& member : members)
    {
        if (member.name.empty() || member.name == "." || member.name.find('/') != std::string::npos)
        {
            throw std::runtime_error(file + ": \"" + member.name + "\" cannot name a body or structure; use a word without /");
        }
        if (!groups.insert(groupOf(member)).second)
        {
            throw std::runtime_error(file + ": two " + (member.isStructure ? "structures" : "bodies") + " are called "
                + member.name + "; give each its own name");
        }
    }
}

} // namespace

struct BodyHistory::Implementation
{
    std::string file;
    std::vector<HistoryMember> members;
    SurfaceSeries surface;
    LineSeries lines;
    ContactSeries contacts;

    std::size_t rowsInFile = 0;
    double lastTime = -std::numeric_limits<double>::infinity();
    std::vector<double> times;                      ///< of the records not yet in the file
    std::vector<std::vector<double>> records;       ///< per member: times.size() records of recordSize numbers
    std::map<std::string, std::vector<double>> scalars; ///< every name ever given; times.size() values each
    std::chrono::steady_clock::time_point lastFlush = std::chrono::steady_clock::now();
    double flushSeconds = 0;                        ///< that the last flush took

    Implementation(const std::string& file, const std::vector<HistoryMember>& members, double startTime, const std::vector<std::string>& lines,
        const std::vector<std::string>& walls);
    void create();
    bool continueUndamaged(double startTime);
    bool continueFrom(double startTime);
    void checkMembers(const Hdf5File& out) const;
    void checkAlone(const Hdf5File& out) const;
    bool isEarlier(double startTime) const;
    void flushTo(Hdf5File& out);
    void flush();
};

BodyHistory::Implementation::Implementation(
    const std::string& fileName, const std::vector<HistoryMember>& memberList, double startTime, const std::vector<std::string>& lineNames,
    const std::vector<std::string>& walls)
    : file(fileName), members(memberList), surface(fileName, memberList), lines(fileName, lineNames), contacts(fileName, walls), records(memberList.size())
{
    checkNames(file, members);
    if (::access(file.c_str(), F_OK) != 0 || !continueUndamaged(startTime)) create();
    for (auto& member : members) member.surface = TriSurface(); // kept by `surface`
}

void BodyHistory::Implementation::create()
{
    Hdf5File out(file, Hdf5File::Mode::Create);
    out.setAttribute("/", "kind", std::string("flotsam body history"));
    out.setAttribute("/", "formatVersion", std::int64_t(1));
    out.createTable("/run/time", 1, chunkRows);
    out.setAttribute("/run/time", "unit", std::string("s"));
    for (const HistoryMember& member : members) createTables(out, member);
    numberMembers(out, members);
    surface.create(out);
    lines.create(out);
    out.close();
}

void BodyHistory::Implementation::checkMembers(const Hdf5File& out) const
{
    std::set<std::string> wanted;
    for (const auto& member : members) wanted.insert(groupOf(member));
    for (const std::string& group : groupsIn(out))
    {
        if (!wanted.count(group))
        {
            throw std::runtime_error(file + ": holds " + group + ", which this case does not have; rename or remove the file "
                "to start a new one");
        }
    }
}

bool BodyHistory::Implementation::continueUndamaged(double startTime)
{
    try { return continueFrom(startTime); }
    catch (const Hdf5Error& error)
    {
        throw std::runtime_error(std::string(error.what()) + ": cut off, damaged, or not a file of flotsamFoam. Rename or remove it: the run goes on with a new one,"
            " without the records before its start");
    }
}

/// False when the file holds nothing earlier than the start: it belongs to an earlier run and is replaced.
bool BodyHistory::Implementation::isEarlier(double startTime) const
{
    const Hdf5File in(file, Hdf5File::Mode::Read);
    if (!in.exists("/run/time"))
    {
        throw std::runtime_error(file + ": not a body history of this program; rename or remove it");
    }
    const std::vector<double> oldTimes = in.readArray("/run/time");
    if (oldTimes.empty() || oldTimes.front() >= startTime - roundOff(startTime)) return false;
    checkMembers(in);
    return true;
}

/// False: see isEarlier().
bool BodyHistory::Implementation::continueFrom(double startTime)
{
    if (!isEarlier(startTime)) return false;
    addToHistory(file, members, surface, lines);
    Hdf5File out(file, Hdf5File::Mode::ReadWrite);
    const double limit = startTime + roundOff(startTime);
    const std::vector<double> oldTimes = out.readArray("/run/time");
    std::size_t kept = std::upper_bound(oldTimes.begin(), oldTimes.end(), limit) - oldTimes.begin();

    std::vector<std::string> tables;
    for (const auto& member : members)
    {
        for (const auto& series : allSeries) tables.push_back(groupOf(member) + "/" + series.name);
    }
    for (const auto& name : out.names("/run"))
    {
        tables.push_back("/run/" + name);
        if (name != "time") scalars[name];
    }
    // a kill in the middle of a block may have left series of different lengths
    for (const auto& table : tables) kept = std::min(kept, out.rows(table));
    for (const auto& table : tables) out.setRows(table, kept);
    surface.continueFrom(out, limit);
    lines.continueFrom(out, limit);
    contacts.continueFrom(out, limit);
    out.close();
    rowsInFile = kept;
    if (kept > 0) lastTime = oldTimes[kept - 1];
    return true;
}

/// Two runs in one folder would mix up every file of theirs, in silence.
void BodyHistory::Implementation::checkAlone(const Hdf5File& out) const
{
    if (const std::size_t there = out.rows("/run/time"); there != rowsInFile)
        throw std::runtime_error(file + " has " + std::to_string(there) + " records, of which this run knows " + std::to_string(rowsInFile)
            + ": another run writes into the same folder. This one ends; let the other go on, or end it and start again");
}

void BodyHistory::Implementation::flushTo(Hdf5File& out)
{
    checkAlone(out);
    const std::size_t n = times.size();
    std::vector<double> column;
    for (std::size_t m = 0; m < members.size(); ++m)
    {
        std::size_t offset = 0;
        for (const auto& series : allSeries)
        {
            column.clear();
            for (std::size_t i = 0; i < n; ++i)
            {
                const auto first = records[m].begin() + i * recordSize + offset;
                column.insert(column.end(), first, first + series.columns);
            }
            out.appendRows(groupOf(members[m]) + "/" + series.name, column.data(), n);
            offset += series.columns;
        }
        records[m].clear();
    }
    for (auto& scalar : scalars)
    {
        const std::string path = "/run/" + scalar.first;
        if (!out.exists(path))
        {
            out.createTable(path, 1, chunkRows);
            const std::vector<double> missing(rowsInFile, std::numeric_limits<double>::quiet_NaN());
            out.appendRows(path, missing.data(), missing.size());
        }
        out.appendRows(path, scalar.second.data(), n);
        scalar.second.clear();
    }
    out.appendRows("/run/time", times.data(), n);
    times.clear();
    rowsInFile += n;
}

void BodyHistory::Implementation::flush()
{
    const auto start = std::chrono::steady_clock::now();
    if (!times.empty())
    {
        Hdf5File out(file, Hdf5File::Mode::ReadWrite);
        flushTo(out);
        out.close();
    }
    lastFlush = std::chrono::steady_clock::now();
    flushSeconds = std::chrono::duration<double>(lastFlush - start).count();
}

BodyHistory::BodyHistory(const std::string& file, const std::vector<HistoryMember>& members, double startTime, const std::vector<std::string>& lines,
    const std::vector<std::string>& walls)
    : impl_(new Implementation(file, members, startTime, lines, walls))
{
}

BodyHistory::~BodyHistory()
{
    try
    {
        impl_->flush();
    }
    catch (const std::exception& error)
    {
        std::cerr << "Warning: the last records of the body history are lost: " << error.what() << '\n';
    }
}

double BodyHistory::lastTime() const { return impl_->lastTime; }

void BodyHistory::append(double time, const std::vector<BodyRecord>& records,
    const std::vector<std::pair<std::string, double>>& scalars)
{
    Implementation& my = *impl_;
    if (records.size() != my.members.size())
    {
        throw std::logic_error(my.file + ": " + std::to_string(records.size()) + " records for "
            + std::to_string(my.members.size()) + " members");
    }
    if (!(time > my.lastTime)) return;
    my.lastTime = time;
    my.times.push_back(time);
    for (std::size_t m = 0; m < records.size(); ++m) pack(records[m], my.records[m]);

    const std::size_t n = my.times.size();
    const double missing = std::numeric_limits<double>::quiet_NaN();
    for (const auto& scalar : scalars)
    {
        if (scalar.first == "time") throw std::logic_error(my.file + ": \"time\" is taken, give the scalar another name");
        auto& values = my.scalars[scalar.first];
        values.resize(n - 1, missing); // new: earlier records of this block did not have it
        values.push_back(scalar.second);
    }
    for (auto& scalar : my.scalars) scalar.second.resize(n, missing);

    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - my.lastFlush;
    if (n >= maxBufferedRows || age.count() > std::max(maxBufferedSeconds, my.flushSeconds / largestShare)) my.flush();
}

void BodyHistory::flush()
{
    impl_->flush();
}

void BodyHistory::writeSurface(double time, const std::vector<BodyRecord>& records)
{
    impl_->flush();
    if (impl_->surface.isEmpty()) return;
    {
        Hdf5File out(impl_->file, Hdf5File::Mode::ReadWrite);
        impl_->surface.append(out, time, records);
        out.close();
    }
    impl_->surface.writeXdmf();
}

void BodyHistory::writeLines(double time, const std::vector<LineRecord>& lines)
{
    if (impl_->lines.isEmpty()) return;
    {
        Hdf5File out(impl_->file, Hdf5File::Mode::ReadWrite);
        impl_->lines.append(out, time, lines);
        out.close();
    }
    impl_->lines.writeXdmf();
}

void BodyHistory::writeContacts(double time, const std::vector<ContactRecord>& contacts, const Vec3& aside)
{
    {
        Hdf5File out(impl_->file, Hdf5File::Mode::ReadWrite);
        impl_->contacts.append(out, time, contacts, aside);
        out.close();
    }
    impl_->contacts.writeXdmf();
}

} // namespace flotsam
