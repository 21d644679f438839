// SPDX-License-Identifier: GPL-3.0-or-later
/// The moving surfaces of all bodies and structures in the history file, and the XDMF file that lets ParaView show them.
#pragma once

#include "io/bodyHistory.hpp"

namespace flotsam
{

class Hdf5File;

/// Group /surface: triangles, member (once); time, points, velocity, memberVelocity, contactForce (rows per written time).
class SurfaceSeries
{
public:
    SurfaceSeries(const std::string& file, const std::vector<HistoryMember>& members);

    bool isEmpty() const { return triangles_.empty(); }

    void create(Hdf5File& out) const;
    /// Cuts off times later than `startTime`. Throws when the stored surfaces have another number of points or triangles.
    void continueFrom(Hdf5File& out, double startTime);
    /// The stored surfaces of some members get those of the others, as points at their start. before: number of each member among the stored ones, -1: it is new.
    void widen(Hdf5File& out, const std::vector<HistoryMember>& members, const std::vector<int>& before) const;
    /// Adds one time; a time that is not later than the last one is ignored.
    void append(Hdf5File& out, double time, const std::vector<BodyRecord>& records);
    /// Writes <file without ending>.xdmf for the times added so far.
    void writeXdmf() const;

private:
    std::string file_;
    std::vector<Vec3> points_;          ///< body frames, all members
    std::vector<int> pointMember_;
    std::vector<int> triangles_;        ///< 3 point numbers each
    std::vector<int> triangleMember_;
    std::vector<double> times_;
};

} // namespace flotsam
