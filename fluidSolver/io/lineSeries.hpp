// SPDX-License-Identifier: GPL-3.0-or-later
/// Moving straight lines with a tension (springs and tethers) in the history file, and the XDMF file that lets ParaView show them.
#pragma once

#include "geometry/solid.hpp"

#include <string>
#include <vector>

namespace flotsam
{

class Hdf5File;

/// One that is not there has both ends at one place: nothing to be seen.
struct LineRecord
{
    Vec3 begin = Vec3::Zero(), end = Vec3::Zero();  ///< [m]
    double tension = 0;                             ///< negative: it pushes [N]
    int first = -1, second = -1;                    ///< members that its ends are fastened to; -1: a point of space
};

/// Group /restraints: lines (once); time, points, tension, members (rows per written time). Without lines there is no group.
class LineSeries
{
public:
    LineSeries(const std::string& file, const std::vector<std::string>& names) : file_(file), names_(names) {}

    void create(Hdf5File& out) const;
    /// Cuts off times later than `startTime`; makes the group where a run goes on with lines that it did not have before. Throws when the stored lines are others.
    void continueFrom(Hdf5File& out, double startTime);
    /// Adds one time; a time that is not later than the last one is ignored.
    void append(Hdf5File& out, double time, const std::vector<LineRecord>& lines);
    /// Writes restraints.xdmf beside the file, for the times added so far.
    void writeXdmf() const;

    bool isEmpty() const { return names_.empty(); }
    const std::vector<std::string>& names() const { return names_; }

    static std::vector<std::string> namesIn(const Hdf5File& file);  ///< of the stored lines
    /// The stored lines get others, which are not there at their times. before: number of each name among the stored lines, -1: it is new.
    static void widen(Hdf5File& out, const std::vector<std::string>& names, const std::vector<int>& before);

private:
    std::string file_;
    std::vector<std::string> names_;
    std::vector<double> times_;
};

} // namespace flotsam
