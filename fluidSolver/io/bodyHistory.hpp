// SPDX-License-Identifier: GPL-3.0-or-later
/// Time series of bodies and structure members in HDF5 (bodies.h5), and their surfaces and the lines between them for ParaView (bodies.xdmf, restraints.xdmf, contacts.xdmf).
#pragma once

#include "geometry/solid.hpp"
#include "io/contactSeries.hpp"
#include "io/lineSeries.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace flotsam
{

/// One line of a body's (or structure member's) history. Space frame, SI units.
struct BodyRecord
{
    Pose pose;
    Motion motion;
    Vec3 fluidForce = Vec3::Zero(), fluidMoment = Vec3::Zero();         ///< [N], [N m] about the origin of the pose
    Vec3 contactForce = Vec3::Zero(), contactMoment = Vec3::Zero();
    Vec3 peakContactForce = Vec3::Zero();   ///< largest within the step; contactForce is its mean over the step [N]
    int contacts = 0;
    double wetFraction = 0; ///< liquid share of the surface, 0..1
    bool hasLeft = false;   ///< the mesh, for good
    bool isAwaited = false; ///< has not come in yet: not there
};

struct HistoryMember
{
    std::string name;       ///< HDF5 group /bodies/<name> or /structures/<name>
    bool isStructure = false;
    double mass = 0;        ///< [kg], 0 for structures
    double volume = 0;      ///< [m^3]
    TriSurface surface;     ///< in the body frame
    double longest = 0, thinnest = 0;   ///< extents of the shape [m]
    Pose start = {};        ///< where it is to come in, if it does so later than the file begins
};

/// Written by rank 0. Records are kept in memory and written in blocks (every 64 records or every second of wall time, with many members less often, at
/// flush(), writeSurface() and the end); between blocks the file is closed, so that it can be read (h5py) at any time and
/// survives a kill. Datasets per member: time-major [nTimes x k] float64 with attribute "unit"; all share one "time".
class BodyHistory
{
public:
    /// Creates `file`, or continues it when it holds records earlier than `startTime` (restart): later ones are cut off.
    /// One of some of the members gets the others, `awaited` in its records. Throws when a file to be continued has members that are not among these, or is damaged.
    /// lines: names of restraints; walls: of what bodies touch that is no member.
    BodyHistory(const std::string& file, const std::vector<HistoryMember>& members, double startTime, const std::vector<std::string>& lines = {},
        const std::vector<std::string>& walls = {});
    ~BodyHistory();

    double lastTime() const; ///< of the last record; -infinity: there is none

    /// Appends one time to every member. Scalars (dt, mass error, ...) go to /run/<name>, NaN where one was not given.
    /// A time that is not later than the last record is ignored: a restart repeats the state it starts from.
    void append(double time, const std::vector<BodyRecord>& records,
        const std::vector<std::pair<std::string, double>>& scalars);

    /// Puts all records given so far into the file. Call at write times, before an exit, at a stop.
    void flush();

    /// Adds the surfaces at this time to /surface in the HDF5 file and rewrites the XDMF file next to it (bodies.xdmf):
    /// all surfaces as one moving triangulation, with member number, velocity and contact force. Call at write times.
    void writeSurface(double time, const std::vector<BodyRecord>& records);
    /// The same of the lines, to /restraints and restraints.xdmf.
    void writeLines(double time, const std::vector<LineRecord>& lines);
    /// The same of contacts, to /contacts and contacts.xdmf; see ContactSeries::append().
    void writeContacts(double time, const std::vector<ContactRecord>& contacts, const Vec3& aside);

private:
    struct Implementation;
    std::unique_ptr<Implementation> impl_;
};

} // namespace flotsam
