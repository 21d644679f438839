// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/historyTables.hpp"

#include "io/surfaceSeries.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>

namespace flotsam
{

namespace
{

void createSeries(Hdf5File& out, const std::string& group, const Series& series)
{
    out.createTable(group + series.name, series.columns, chunkRows);
    out.setAttribute(group + series.name, "unit", std::string(series.unit));
    out.setAttribute(group + series.name, "meaning", std::string(series.meaning));
}

/// As many records as the file has times.
void fillTables(Hdf5File& out, const HistoryMember& member, std::size_t nRecords)
{
    BodyRecord record;
    record.pose = member.start;
    record.isAwaited = true;
    std::vector<double> numbers;
    pack(record, numbers);
    std::size_t offset = 0;
    for (const Series& series : allSeries)
    {
        std::vector<double> column;
        for (std::size_t k = 0; k < nRecords; ++k)
            column.insert(column.end(), numbers.begin() + std::ptrdiff_t(offset), numbers.begin() + std::ptrdiff_t(offset + series.columns));
        out.appendRows(groupOf(member) + "/" + series.name, column.data(), nRecords);
        offset += series.columns;
    }
}

/// Number of each member in the file, -1: it is new.
std::vector<int> numbersIn(const Hdf5File& file, const std::vector<HistoryMember>& members)
{
    std::vector<int> numbers;
    for (const HistoryMember& member : members) numbers.push_back(file.exists(groupOf(member)) ? int(file.integerAttribute(groupOf(member), "member")) : -1);
    return numbers;
}

/// The numbers of /contacts: members, then walls; of /restraints: members, -1 for points of space.
void renumberMembers(Hdf5File& out, const std::vector<int>& before)
{
    const int nBefore = int(std::count_if(before.begin(), before.end(), [](int number) { return number >= 0; })), nNow = int(before.size());
    std::map<int, int> now;
    for (int m = 0; m < nNow; ++m)
        if (before[m] >= 0) now[before[m]] = m;
    for (const char* table : {"/contacts/first", "/contacts/second", "/restraints/members"})
    {
        if (!out.exists(table)) continue;
        std::vector<double> numbers = out.readArray(table);
        for (double& number : numbers)
            if (number >= 0) number = number >= nBefore ? number + (nNow - nBefore) : now.at(int(number));
        out.setRows(table, 0);
        out.appendRows(table, numbers.data(), numbers.size()/out.columns(table));
    }
}

void addLines(Hdf5File& out, const std::vector<std::string>& names)
{
    const std::string group = "/restraints";
    if (!out.exists(group) || names.empty()) return;
    const std::vector<std::string> had = LineSeries::namesIn(out);
    std::vector<int> before;
    std::size_t known = 0;
    for (const std::string& name : names)
    {
        const auto at = std::find(had.begin(), had.end(), name);
        before.push_back(at == had.end() ? -1 : int(at - had.begin()));
        known += at != had.end();
    }
    if (known != had.size() || names.size() == known) return;  // others, or the same: LineSeries tells
    LineSeries::widen(out, names, before);
}

void copyFile(const std::string& from, const std::string& to)
{
    std::ifstream in(from, std::ios::binary);
    std::ofstream out(to, std::ios::binary | std::ios::trunc);
    out << in.rdbuf();
    out.close();
    if (!in || !out) throw std::runtime_error(to + ": cannot write (a full disk?). The history " + from + " is to get the bodies that are new: rename it, and the run begins another one");
}

} // namespace

void pack(const BodyRecord& r, std::vector<double>& out)
{
    const auto put = [&](const Vec3& v) { out.insert(out.end(), v.data(), v.data() + 3); };
    put(r.pose.position);
    const auto& q = r.pose.orientation;
    out.insert(out.end(), {q.w(), q.x(), q.y(), q.z()});
    put(r.motion.velocity);
    put(r.motion.angularVelocity);
    put(r.fluidForce);
    put(r.fluidMoment);
    put(r.contactForce);
    put(r.contactMoment);
    put(r.peakContactForce);
    out.insert(out.end(), {double(r.contacts), r.wetFraction, r.hasLeft ? 1.0 : 0.0, r.isAwaited ? 1.0 : 0.0});
}

std::string groupOf(const HistoryMember& member)
{
    return (member.isStructure ? "/structures/" : "/bodies/") + member.name;
}

std::vector<std::string> groupsIn(const Hdf5File& file)
{
    std::vector<std::string> groups;
    for (const char* group : {"/bodies", "/structures"})
        for (const std::string& name : file.names(group)) groups.push_back(std::string(group) + "/" + name);
    return groups;
}

void createTables(Hdf5File& out, const HistoryMember& member)
{
    const std::string group = groupOf(member);
    for (const Series& series : allSeries) createSeries(out, group + "/", series);
    out.link("/run/time", group + "/time");
    out.setAttribute(group, "mass", member.mass);
    out.setAttribute(group, "volume", member.volume);
    out.setAttribute(group, "longest", member.longest);
    out.setAttribute(group, "thinnest", member.thinnest);
}

void numberMembers(Hdf5File& out, const std::vector<HistoryMember>& members)
{
    const auto nStructures = std::count_if(members.begin(), members.end(), [](const HistoryMember& m) { return m.isStructure; });
    out.setAttribute("/structures", "members", std::int64_t(nStructures));
    out.setAttribute("/bodies", "members", std::int64_t(members.size()) - nStructures);
    for (std::size_t m = 0; m < members.size(); ++m) out.setAttribute(groupOf(members[m]), "member", std::int64_t(m)); // number in /surface/member
}

void addToHistory(const std::string& file, const std::vector<HistoryMember>& members, const SurfaceSeries& surface, const LineSeries& lines)
{
    std::vector<int> before;
    {
        const Hdf5File in(file, Hdf5File::Mode::Read);
        before = numbersIn(in, members);
        const bool isComplete = std::find(before.begin(), before.end(), -1) == before.end();
        if (isComplete && (!in.exists("/restraints") || LineSeries::namesIn(in).size() >= lines.names().size())) return;
    }
    const std::string temporary = file + ".tmp";
    copyFile(file, temporary);
    Hdf5File out(temporary, Hdf5File::Mode::ReadWrite);
    const std::size_t nRecords = out.rows("/run/time");
    for (std::size_t m = 0; m < members.size(); ++m)
    {
        if (before[m] >= 0) continue;
        createTables(out, members[m]);
        fillTables(out, members[m], nRecords);
    }
    numberMembers(out, members);
    surface.widen(out, members, before);
    renumberMembers(out, before);
    addLines(out, lines.names());
    out.close();
    if (std::rename(temporary.c_str(), file.c_str()) != 0) throw std::runtime_error(file + ": cannot rename " + temporary + " (" + std::strerror(errno) + ")");
}

} // namespace flotsam
