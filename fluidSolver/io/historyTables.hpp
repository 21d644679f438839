// SPDX-License-Identifier: GPL-3.0-or-later
/// The tables that every member has in the history file, and how a file gets those of members that come late.
#pragma once

#include "io/bodyHistory.hpp"
#include "io/hdf5File.hpp"

namespace flotsam
{

class SurfaceSeries;

struct Series
{
    const char* name;
    std::size_t columns;
    const char* unit;
    const char* meaning;
};

/// Order as in pack().
constexpr Series allSeries[] = {
    {"position", 3, "m", "origin of the body frame in space; free body: its centre of mass"},
    {"orientation", 4, "1", "unit quaternion w x y z, body frame to space"},
    {"velocity", 3, "m/s", "of the origin, space frame"},
    {"angularVelocity", 3, "rad/s", "space frame"},
    {"fluidForce", 3, "N", "of the fluid on the member, space frame"},
    {"fluidMoment", 3, "N m", "of the fluid about the origin, space frame"},
    {"contactForce", 3, "N", "of bodies and walls on the member, space frame"},
    {"contactMoment", 3, "N m", "of bodies and walls about the origin, space frame"},
    {"peakContactForce", 3, "N", "of bodies and walls on the member at the instant of the step at which it was largest, space frame"},
    {"contacts", 1, "1", "number of touching partners"},
    {"wetFraction", 1, "1", "liquid share of the surface"},
    {"left", 1, "1", "1: has left the mesh and was taken out, rests where it left"},
    {"awaited", 1, "1", "1: not there yet, comes in at its position"}};

constexpr std::size_t recordSize = 32;
constexpr std::size_t chunkRows = 256;      ///< rows a dataset grows by in the file

/// Appends the record's numbers, recordSize of them.
void pack(const BodyRecord& record, std::vector<double>& numbers);

std::string groupOf(const HistoryMember& member);           ///< "/bodies/<name>"
std::vector<std::string> groupsIn(const Hdf5File& file);    ///< of all members that it has

/// The group of a member, with empty tables.
void createTables(Hdf5File& out, const HistoryMember& member);
/// Writes the members' numbers in /surface/member, and how many there are; both groups are made also where they have no members: scripts loop over them.
void numberMembers(Hdf5File& out, const std::vector<HistoryMember>& members);

/// A file of some of the members, and of some of the lines, gets the others: `awaited` at their start in its records, nothing to be seen on its surfaces. A copy is
/// changed, which then takes the file's place: a kill leaves one or the other.
void addToHistory(const std::string& file, const std::vector<HistoryMember>& members, const SurfaceSeries& surface, const LineSeries& lines);

} // namespace flotsam
