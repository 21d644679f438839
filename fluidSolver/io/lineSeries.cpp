// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/lineSeries.hpp"

#include "io/hdf5File.hpp"
#include "io/xdmfParts.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace flotsam
{

namespace
{

const std::string group = "/restraints";

std::string joined(const std::vector<std::string>& names)
{
    return std::accumulate(names.begin(), names.end(), std::string(), [](const std::string& all, const std::string& name) { return all.empty() ? name : all + ' ' + name; });
}

/// Where the file is of a version without them: nobody knows what its lines were fastened to.
void createMembers(Hdf5File& out, std::size_t nLines, std::size_t nTimes)
{
    out.createTable(group + "/members", 2, nLines, Hdf5File::Storage::Int32);
    if (nTimes == 0) return;
    const std::vector<int> unknown(2*nLines*nTimes, -1);
    out.appendRows(group + "/members", unknown.data(), nLines*nTimes);
}

} // namespace

void LineSeries::create(Hdf5File& out) const
{
    if (isEmpty()) return;
    const std::size_t n = names_.size();
    std::vector<int> ends(2 * n);
    std::iota(ends.begin(), ends.end(), 0);
    out.createTable(group + "/lines", 2, n, Hdf5File::Storage::Int32);
    out.appendRows(group + "/lines", ends.data(), n);
    out.createTable(group + "/time", 1, 256);
    out.createTable(group + "/points", 3, 2 * n);   // double precision, as those of the surfaces: maps' grids
    out.createTable(group + "/tension", 1, n);
    createMembers(out, n, 0);
    out.setAttribute(group, "names", joined(names_));
    for (const auto& [table, unit] : {std::pair<const char*, const char*>{"/time", "s"}, {"/points", "m"}, {"/tension", "N"}}) out.setAttribute(group + table, "unit", std::string(unit));
}

std::vector<std::string> LineSeries::namesIn(const Hdf5File& file)
{
    std::istringstream list(file.stringAttribute(group, "names"));
    return {std::istream_iterator<std::string>(list), {}};
}

void LineSeries::widen(Hdf5File& out, const std::vector<std::string>& names, const std::vector<int>& before)
{
    const std::size_t n = names.size(), stored = namesIn(out).size(), nTimes = out.rows(group + "/time");
    const auto widenTable = [&](const std::string& table, std::size_t perLine, double unknown)
    {
        const std::vector<double> had = out.readArray(table);
        std::vector<double> now(nTimes * n * perLine, unknown);
        for (std::size_t t = 0; t < nTimes; ++t)
            for (std::size_t i = 0; i < n; ++i)
                if (before[i] >= 0) std::copy_n(&had[(t * stored + std::size_t(before[i])) * perLine], perLine, &now[(t * n + i) * perLine]);
        out.setRows(table, 0);
        out.appendRows(table, now.data(), now.size() / out.columns(table));
    };
    widenTable(group + "/points", 6, 0);
    widenTable(group + "/tension", 1, 0);
    if (out.exists(group + "/members")) widenTable(group + "/members", 2, -1);
    std::vector<int> ends(2 * n);
    std::iota(ends.begin(), ends.end(), 0);
    out.setRows(group + "/lines", 0);
    out.appendRows(group + "/lines", ends.data(), n);
    out.setAttribute(group, "names", joined(names));
}

void LineSeries::continueFrom(Hdf5File& out, double startTime)
{
    if (!out.exists(group)) return create(out);
    if (isEmpty() || out.stringAttribute(group, "names") != joined(names_))
        throw std::runtime_error(file_ + ": holds other restraints (" + out.stringAttribute(group, "names") + "); rename or remove it to start a new one");
    times_ = out.readArray(group + "/time");
    if (!out.exists(group + "/members")) createMembers(out, names_.size(), times_.size());
    while (!times_.empty() && times_.back() > startTime) times_.pop_back();
    out.setRows(group + "/time", times_.size());
    out.setRows(group + "/points", 2 * names_.size() * times_.size());
    for (const char* table : {"/tension", "/members"}) out.setRows(group + table, names_.size() * times_.size());
}

void LineSeries::append(Hdf5File& out, double time, const std::vector<LineRecord>& lines)
{
    if (isEmpty() || (!times_.empty() && time <= times_.back())) return;
    if (lines.size() != names_.size()) throw std::logic_error(file_ + ": " + std::to_string(lines.size()) + " lines for " + std::to_string(names_.size()) + " names");
    std::vector<double> points, tension;
    std::vector<int> members;
    for (const LineRecord& line : lines)
    {
        for (const Vec3* end : {&line.begin, &line.end}) points.insert(points.end(), end->data(), end->data() + 3);
        tension.push_back(line.tension);
        members.insert(members.end(), {line.first, line.second});
    }
    out.appendRows(group + "/points", points.data(), 2 * lines.size());
    out.appendRows(group + "/tension", tension.data(), lines.size());
    out.appendRows(group + "/members", members.data(), lines.size());
    out.appendRows(group + "/time", &time, 1);
    times_.push_back(time);
}

void LineSeries::writeXdmf() const
{
    if (isEmpty()) return;
    const std::string data = fileNameOf(file_) + ":" + group;
    const std::size_t n = names_.size(), nTimes = times_.size();
    writeXdmfFile(folderOf(file_) + "restraints.xdmf", "restraints", [&](std::ostream& out)
    {
        for (std::size_t t = 0; t < nTimes; ++t)
        {
            out << "<Grid Name=\"lines\" GridType=\"Uniform\"><Time Value=\"" << times_[t] << "\"/>\n"
                << "<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"" << n << "\">" << XdmfSlab{data + "/lines", "Int", 0, n, n, 2} << "</Topology>\n"
                << "<Geometry GeometryType=\"XYZ\">" << XdmfSlab{data + "/points", "Float", 2 * n * t, 2 * n, 2 * n * nTimes, 3, 8} << "</Geometry>\n"
                << "<Attribute Name=\"tension\" AttributeType=\"Scalar\" Center=\"Cell\">" << XdmfSlab{data + "/tension", "Float", n * t, n, n * nTimes, 1, 8} << "</Attribute>\n</Grid>\n";
        }
    });
}

} // namespace flotsam
