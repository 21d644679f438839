// SPDX-License-Identifier: GPL-3.0-or-later
/// Who touches whom, and with what force, in the history file, and the XDMF file that lets ParaView show the lines along which load is carried.
#pragma once

#include "geometry/solid.hpp"

#include <array>
#include <iosfwd>
#include <string>
#include <vector>

namespace flotsam
{

class Hdf5File;

/// Two members that touch, means over a step; in however many places they do, they are one.
struct ContactRecord
{
    int first = 0, second = 0;      ///< numbers of members; walls that are none come behind them
    Vec3 point = Vec3::Zero();      ///< [m]
    Vec3 force = Vec3::Zero();      ///< on `first` [N]
    double overlap = 0;             ///< the deepest [m]
    int spheres = 0;
    std::array<Vec3, 3> line{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};    ///< from one to the other [m]
};

/// Group /contacts: time, begin (of each time's rows; one more), a row for each contact of the others. Without bodies nothing is appended, and there is no group.
class ContactSeries
{
public:
    /// walls: names of what bodies touch that is no member, in the order of its numbers.
    ContactSeries(const std::string& file, const std::vector<std::string>& walls) : file_(file), walls_(walls) {}

    /// Cuts off times later than `startTime`. Throws when the stored walls are others.
    void continueFrom(Hdf5File& out, double startTime);
    /// Adds one time; a time that is not later than the last one is ignored. aside: where ParaView gets a point of no force at times
    /// without contacts, any place in the scene [m].
    void append(Hdf5File& out, double time, const std::vector<ContactRecord>& contacts, const Vec3& aside);
    /// Writes contacts.xdmf beside the file, for the times added so far.
    void writeXdmf() const;

private:
    void create(Hdf5File& out) const;
    void writeNone(std::ostream& out) const;
    std::size_t rowsOf(std::size_t time) const { return begins_[time + 1] - begins_[time]; }

    std::string file_;
    std::vector<std::string> walls_;
    std::vector<double> times_;
    std::vector<std::size_t> begins_{0};
    std::size_t nLines_ = 0;    ///< whose point numbers are in the file: the most that any time had
    Vec3 aside_ = Vec3::Zero();
};

} // namespace flotsam
