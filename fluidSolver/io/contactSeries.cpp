// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/contactSeries.hpp"

#include "io/hdf5File.hpp"
#include "io/xdmfParts.hpp"

#include <numeric>
#include <ostream>
#include <stdexcept>

namespace flotsam
{

namespace
{

const std::string group = "/contacts";
constexpr std::size_t chunkRows = 256;

struct Table { const char *name, *unit, *meaning; std::size_t columns; Hdf5File::Storage storage; std::size_t rowsPerContact; };

/// Those with rows of contacts.
constexpr Table tables[] = {
    {"/first", "", "number of the one member, as in /surface/member; from the number of members on: walls, as named by the group's attribute", 1, Hdf5File::Storage::Int32, 1},
    {"/second", "", "number of the other", 1, Hdf5File::Storage::Int32, 1},
    {"/point", "m", "centre of the places where they touch, weighted by force and time", 3, Hdf5File::Storage::Float64, 1},
    {"/force", "N", "on first, mean over the step that ends at the time, space frame", 3, Hdf5File::Storage::Float64, 1},
    {"/overlap", "m", "deepest of their contact surfaces in that step", 1, Hdf5File::Storage::Float64, 1},
    {"/spheres", "1", "most spheres of contact surfaces that touched at once", 1, Hdf5File::Storage::Int32, 1},
    {"/line", "m", "three points each: from one to the other, for pictures", 3, Hdf5File::Storage::Float64, 3}};

std::string joined(const std::vector<std::string>& names)
{
    return std::accumulate(names.begin(), names.end(), std::string(), [](const std::string& all, const std::string& name) { return all.empty() ? name : all + ' ' + name; });
}

} // namespace

void ContactSeries::create(Hdf5File& out) const
{
    out.createTable(group + "/time", 1, chunkRows);
    out.setAttribute(group + "/time", "unit", std::string("s"));
    out.createTable(group + "/begin", 1, chunkRows, Hdf5File::Storage::Int32);
    out.setAttribute(group + "/begin", "meaning", std::string("first row of each time, and the number of all rows"));
    const int zero = 0;
    out.appendRows(group + "/begin", &zero, 1);
    for (const Table& table : tables)
    {
        out.createTable(group + table.name, table.columns, chunkRows, table.storage);
        out.setAttribute(group + table.name, "unit", std::string(table.unit));
        out.setAttribute(group + table.name, "meaning", std::string(table.meaning));
    }
    out.createTable(group + "/lines", 3, chunkRows, Hdf5File::Storage::Int32);
    out.setAttribute(group, "walls", joined(walls_));
}

void ContactSeries::continueFrom(Hdf5File& out, double startTime)
{
    if (!out.exists(group)) return;
    if (out.stringAttribute(group, "walls") != joined(walls_))
        throw std::runtime_error(file_ + ": its contacts are with other walls (" + out.stringAttribute(group, "walls") + "; now: " + joined(walls_) + "); rename or remove it to start a new one");
    times_ = out.readArray(group + "/time");
    while (!times_.empty() && times_.back() > startTime) times_.pop_back();
    begins_.clear();
    for (const double begin : out.readArray(group + "/begin")) begins_.push_back(std::size_t(begin));
    begins_.resize(times_.size() + 1);
    out.setRows(group + "/time", times_.size());
    out.setRows(group + "/begin", begins_.size());
    for (const Table& table : tables) out.setRows(group + table.name, table.rowsPerContact*begins_.back());
    nLines_ = out.rows(group + "/lines");
}

void ContactSeries::append(Hdf5File& out, double time, const std::vector<ContactRecord>& contacts, const Vec3& aside)
{
    aside_ = aside;
    if (!times_.empty() && time <= times_.back()) return;
    if (!out.exists(group)) create(out);
    std::vector<int> first, second, spheres, lines;
    std::vector<double> point, force, overlap, line;
    const auto put = [](std::vector<double>& list, const Vec3& v) { list.insert(list.end(), v.data(), v.data() + 3); };
    for (const ContactRecord& c : contacts)
    {
        first.push_back(c.first);
        second.push_back(c.second);
        put(point, c.point);
        put(force, c.force);
        overlap.push_back(c.overlap);
        spheres.push_back(c.spheres);
        for (const Vec3& end : c.line) put(line, end);
    }
    const std::size_t n = contacts.size();
    for (; nLines_ < n; ++nLines_)
        for (int k = 0; k < 3; ++k) lines.push_back(int(3*nLines_) + k);
    out.appendRows(group + "/first", first.data(), n);
    out.appendRows(group + "/second", second.data(), n);
    out.appendRows(group + "/point", point.data(), n);
    out.appendRows(group + "/force", force.data(), n);
    out.appendRows(group + "/overlap", overlap.data(), n);
    out.appendRows(group + "/spheres", spheres.data(), n);
    out.appendRows(group + "/line", line.data(), 3*n);
    out.appendRows(group + "/lines", lines.data(), lines.size()/3);
    begins_.push_back(begins_.back() + n);
    const int end = int(begins_.back());
    out.appendRows(group + "/begin", &end, 1);
    out.appendRows(group + "/time", &time, 1);  // last: what a kill leaves behind the last time is cut off
    times_.push_back(time);
}

void ContactSeries::writeXdmf() const
{
    const std::string data = fileNameOf(file_) + ":" + group;
    const std::size_t nRows = begins_.back();
    writeXdmfFile(folderOf(file_) + "contacts.xdmf", "contacts", [&](std::ostream& out)
    {
        for (std::size_t t = 0; t < times_.size(); ++t)
        {
            const std::size_t n = rowsOf(t), begin = begins_[t];
            out << "<Grid Name=\"contacts\" GridType=\"Uniform\"><Time Value=\"" << times_[t] << "\"/>\n";
            if (n == 0)
            {
                writeNone(out);
                continue;
            }
            const auto perContact = [&](const char* table, const char* type, std::size_t columns, int precision)
            { return XdmfSlab{data + table, type, begin, n, nRows, columns, precision}; };
            out << "<Topology TopologyType=\"Polyline\" NodesPerElement=\"3\" NumberOfElements=\"" << n << "\">" << XdmfSlab{data + "/lines", "Int", 0, n, nLines_, 3} << "</Topology>\n"
                << "<Geometry GeometryType=\"XYZ\">" << XdmfSlab{data + "/line", "Float", 3*begin, 3*n, 3*nRows, 3, 8} << "</Geometry>\n"
                << "<Attribute Name=\"force\" AttributeType=\"Vector\" Center=\"Cell\">" << perContact("/force", "Float", 3, 8) << "</Attribute>\n"
                << "<Attribute Name=\"overlap\" AttributeType=\"Scalar\" Center=\"Cell\">" << perContact("/overlap", "Float", 1, 8) << "</Attribute>\n"
                << "<Attribute Name=\"first\" AttributeType=\"Scalar\" Center=\"Cell\">" << perContact("/first", "Int", 1, 4) << "</Attribute>\n"
                << "<Attribute Name=\"second\" AttributeType=\"Scalar\" Center=\"Cell\">" << perContact("/second", "Int", 1, 4) << "</Attribute>\n</Grid>\n";
        }
    });
}

/// A point: XDMF's reader knows no empty grid, and without one would show what was there before.
void ContactSeries::writeNone(std::ostream& out) const
{
    const auto inlined = [](const char* size, const char* type, const std::string& value)
    { return std::string("<DataItem Dimensions=\"") + size + "\" NumberType=\"" + type + "\" Format=\"XML\">" + value + "</DataItem>"; };
    out << "<Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\" NumberOfElements=\"1\">" << inlined("1 1", "Int", "0") << "</Topology>\n<Geometry GeometryType=\"XYZ\">"
        << inlined("1 3", "Float", std::to_string(aside_[0]) + ' ' + std::to_string(aside_[1]) + ' ' + std::to_string(aside_[2])) << "</Geometry>\n<Attribute Name=\"force\" AttributeType=\"Vector\" Center=\"Cell\">" << inlined("1 3", "Float", "0 0 0") << "</Attribute>\n";
    for (const char* name : {"overlap", "first", "second"})
        out << "<Attribute Name=\"" << name << "\" AttributeType=\"Scalar\" Center=\"Cell\">" << inlined("1 1", "Float", "0") << "</Attribute>\n";
    out << "</Grid>\n";
}

} // namespace flotsam
