// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/surfaceSeries.hpp"

#include "io/hdf5File.hpp"
#include "io/xdmfParts.hpp"

#include <map>
#include <ostream>
#include <stdexcept>
#include <utility>

namespace flotsam
{

namespace
{

const std::string group = "/surface";

void put(std::vector<double>& list, const Vec3& v)
{
    list.insert(list.end(), v.data(), v.data() + 3);
}

} // namespace

SurfaceSeries::SurfaceSeries(const std::string& file, const std::vector<HistoryMember>& members) : file_(file)
{
    for (std::size_t m = 0; m < members.size(); ++m)
    {
        const TriSurface& surface = members[m].surface;
        const int first = int(points_.size());
        points_.insert(points_.end(), surface.points.begin(), surface.points.end());
        pointMember_.insert(pointMember_.end(), surface.points.size(), int(m));
        for (const auto& triangle : surface.triangles)
        {
            for (const int p : triangle) triangles_.push_back(first + p);
            triangleMember_.push_back(int(m));
        }
    }
}

void SurfaceSeries::create(Hdf5File& out) const
{
    if (isEmpty()) return;
    const std::size_t nTriangles = triangleMember_.size();
    out.createTable(group + "/triangles", 3, nTriangles, Hdf5File::Storage::Int32);
    out.appendRows(group + "/triangles", triangles_.data(), nTriangles);
    out.createTable(group + "/member", 1, nTriangles, Hdf5File::Storage::Int32);
    out.appendRows(group + "/member", triangleMember_.data(), nTriangles);
    out.createTable(group + "/time", 1, 256);
    // pictures need no more than single precision, but for places in the grid of a map: millions of metres
    out.createTable(group + "/points", 3, points_.size());
    out.createTable(group + "/velocity", 3, points_.size(), Hdf5File::Storage::Float32);
    out.createTable(group + "/memberVelocity", 3, nTriangles, Hdf5File::Storage::Float32);
    out.createTable(group + "/contactForce", 3, nTriangles, Hdf5File::Storage::Float32);
    const std::pair<const char*, const char*> units[] = {{"/time", "s"}, {"/points", "m"}, {"/velocity", "m/s"},
        {"/memberVelocity", "m/s"}, {"/contactForce", "N"}};
    for (const auto& u : units) out.setAttribute(group + u.first, "unit", std::string(u.second));
}

void SurfaceSeries::continueFrom(Hdf5File& out, double startTime)
{
    if (isEmpty() && !out.exists(group)) return;
    if (isEmpty() || !out.exists(group) || out.rows(group + "/triangles") != triangleMember_.size()
        || out.columns(group + "/points") != 3 || out.rows(group + "/points") % points_.size() != 0)
    {
        throw std::runtime_error(file_ + ": the surfaces of the bodies have changed since this file was begun; rename or "
            "remove it to start a new one");
    }
    times_ = out.readArray(group + "/time");
    while (!times_.empty() && times_.back() > startTime) times_.pop_back();
    const std::size_t n = times_.size();
    out.setRows(group + "/time", n);
    out.setRows(group + "/points", n * points_.size());
    out.setRows(group + "/velocity", n * points_.size());
    out.setRows(group + "/memberVelocity", n * triangleMember_.size());
    out.setRows(group + "/contactForce", n * triangleMember_.size());
}

namespace
{

/// Rows of all times again, for more members. counts: rows of each member at a time; ofNew: a row of a member that is new.
template<class OfNew>
void widenTable(Hdf5File& out, const std::string& table, const std::vector<std::size_t>& counts, const std::vector<int>& before, OfNew ofNew)
{
    std::map<int, std::size_t> first;
    for (std::size_t m = 0; m < counts.size(); ++m)
        if (before[m] >= 0) first[before[m]] = counts[m];
    std::size_t stored = 0;
    for (auto& [number, count] : first) stored += std::exchange(count, stored);
    const std::vector<double> rows = out.readArray(table);
    if (stored == 0 || rows.size() % (3*stored) != 0) throw std::runtime_error("the surfaces of the bodies have changed since the history was begun; rename or remove it to start a new one");
    const std::size_t nTimes = rows.size()/(3*stored);
    out.setRows(table, 0);
    for (std::size_t t = 0; t < nTimes; ++t)
    {
        std::vector<double> wider;
        for (std::size_t m = 0; m < counts.size(); ++m)
        {
            for (std::size_t k = 0; before[m] < 0 && k < counts[m]; ++k) put(wider, ofNew(m));
            if (before[m] < 0) continue;
            const auto at = rows.begin() + std::ptrdiff_t(3*(t*stored + first[before[m]]));
            wider.insert(wider.end(), at, at + std::ptrdiff_t(3*counts[m]));
        }
        out.appendRows(table, wider.data(), wider.size()/3);
    }
}

} // namespace

void SurfaceSeries::widen(Hdf5File& out, const std::vector<HistoryMember>& members, const std::vector<int>& before) const
{
    if (isEmpty()) return;
    if (!out.exists(group)) return create(out);
    std::vector<std::size_t> points, triangles;
    for (const HistoryMember& member : members)
    {
        points.push_back(member.surface.points.size());
        triangles.push_back(member.surface.triangles.size());
    }
    const auto atStart = [&](std::size_t m) { return members[m].start.position; };
    const auto atRest = [](std::size_t) { return Vec3(0, 0, 0); };
    widenTable(out, group + "/points", points, before, atStart);
    widenTable(out, group + "/velocity", points, before, atRest);
    widenTable(out, group + "/memberVelocity", triangles, before, atRest);
    widenTable(out, group + "/contactForce", triangles, before, atRest);
    out.setRows(group + "/triangles", 0);
    out.setRows(group + "/member", 0);
    out.appendRows(group + "/triangles", triangles_.data(), triangleMember_.size());
    out.appendRows(group + "/member", triangleMember_.data(), triangleMember_.size());
}

void SurfaceSeries::append(Hdf5File& out, double time, const std::vector<BodyRecord>& records)
{
    if (isEmpty() || (!times_.empty() && time <= times_.back())) return;
    std::vector<double> points, velocity, memberVelocity, contactForce;
    points.reserve(3 * points_.size());
    velocity.reserve(3 * points_.size());
    memberVelocity.reserve(triangles_.size());
    contactForce.reserve(triangles_.size());
    for (std::size_t i = 0; i < points_.size(); ++i)
    {
        const BodyRecord& record = records[pointMember_[i]];
        const Vec3 arm = record.isAwaited ? Vec3(0, 0, 0) : record.pose.orientation * points_[i]; // a point: nothing to be seen
        put(points, record.pose.position + arm);
        put(velocity, record.motion.velocity + record.motion.angularVelocity.cross(arm));
    }
    for (const int m : triangleMember_)
    {
        put(memberVelocity, records[m].motion.velocity);
        put(contactForce, records[m].contactForce);
    }
    out.appendRows(group + "/points", points.data(), points_.size());
    out.appendRows(group + "/velocity", velocity.data(), points_.size());
    out.appendRows(group + "/memberVelocity", memberVelocity.data(), triangleMember_.size());
    out.appendRows(group + "/contactForce", contactForce.data(), triangleMember_.size());
    out.appendRows(group + "/time", &time, 1);
    times_.push_back(time);
}

void SurfaceSeries::writeXdmf() const
{
    if (isEmpty()) return;
    const std::string name = fileNameOf(file_), data = name + ":" + group;
    const std::size_t nPoints = points_.size(), nTriangles = triangleMember_.size(), nTimes = times_.size();

    const auto rows = [&](const char* table, const char* type, std::size_t first, std::size_t count, std::size_t total, int precision = 4)
    { return XdmfSlab{data + table, type, first, count, total, 3, precision}; };
    writeXdmfFile(folderOf(file_) + name.substr(0, name.rfind('.')) + ".xdmf", "bodies", [&](std::ostream& out)
    {
        for (std::size_t t = 0; t < nTimes; ++t)
        {
            out << "<Grid Name=\"surface\" GridType=\"Uniform\"><Time Value=\"" << times_[t] << "\"/>\n"
                << "<Topology TopologyType=\"Triangle\" NumberOfElements=\"" << nTriangles << "\">"
                // a slab here, too: ParaView 5 then does not try to find out (in vain, with an error) whether the grid has changed
                << rows("/triangles", "Int", 0, nTriangles, nTriangles)
                << "</Topology>\n<Geometry GeometryType=\"XYZ\">" << rows("/points", "Float", t * nPoints, nPoints, nTimes * nPoints, 8)
                << "</Geometry>\n<Attribute Name=\"member\" AttributeType=\"Scalar\" Center=\"Cell\"><DataItem Dimensions=\""
                << nTriangles << "\" NumberType=\"Int\" Precision=\"4\" Format=\"HDF\">" << data << "/member</DataItem></Attribute>\n"
                << "<Attribute Name=\"surfaceVelocity\" AttributeType=\"Vector\" Center=\"Node\">" << rows("/velocity", "Float", t * nPoints, nPoints, nTimes * nPoints)
                << "</Attribute>\n<Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Cell\">" << rows("/memberVelocity", "Float", t * nTriangles, nTriangles, nTimes * nTriangles)
                << "</Attribute>\n<Attribute Name=\"contactForce\" AttributeType=\"Vector\" Center=\"Cell\">" << rows("/contactForce", "Float", t * nTriangles, nTriangles, nTimes * nTriangles)
                << "</Attribute>\n</Grid>\n";
        }
    });
}

} // namespace flotsam
