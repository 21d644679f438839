// SPDX-License-Identifier: GPL-3.0-or-later
/// What a restart needs of the coupling besides the engine's own state.
#pragma once

#include "demCoupling/coupling/numberArchive.hpp"

#include <algorithm>

namespace flotsam
{

/// Whether a body takes part. Numbers: in states to restart from.
enum class Presence : char { There = 0, Left = 1, Awaited = 2 };

struct CouplingRecord
{
    std::vector<Load> wallLoads, lastLoads;
    std::vector<Motion> lastChanges;
    std::vector<Load> contact, guess;
    std::vector<LoadShare> shares;
    std::vector<double> smooth;     ///< SmoothMotion::save()
    std::vector<char> isHeld;
    std::vector<Presence> presence;
    std::vector<int> counts, wallCounts;
    double largestOverlap = 0;
    std::vector<Vec3> peaks, wallPeaks; ///< as in ContactSummary
};

/// The order is that of the files: another one is another formatVersion (io/checkpoint.cpp).
template <class Archive, class Record>
void passRecord(Archive& archive, Record& record)
{
    passAll(archive, record.wallLoads, record.lastLoads, record.lastChanges, record.contact, record.guess);
    passAll(archive, record.shares, record.smooth, record.isHeld, record.presence);
    passAll(archive, record.counts, record.wallCounts, record.largestOverlap, record.peaks, record.wallPeaks);
}

/// visit(list of one, of the other): what both have of each body.
template <class Record, class OtherRecord, class Visit>
void forEachList(Record& one, OtherRecord& other, Visit visit)
{
    visit(one.lastLoads, other.lastLoads);
    visit(one.lastChanges, other.lastChanges);
    visit(one.contact, other.contact);
    visit(one.guess, other.guess);
    visit(one.shares, other.shares);
    visit(one.smooth, other.smooth);
    visit(one.isHeld, other.isHeld);
    visit(one.presence, other.presence);
    visit(one.counts, other.counts);
    visit(one.peaks, other.peaks);
}

/// The record of some bodies; what is not a body's stays.
inline CouplingRecord recordOf(const std::vector<int>& bodies, const CouplingRecord& all)
{
    CouplingRecord record = all;
    forEachList(record, all, [&](auto& list, const auto& from)
    {
        const std::size_t width = all.isHeld.empty() ? 0 : from.size()/all.isHeld.size();
        list.clear();
        for (const int b : bodies) list.insert(list.end(), from.begin() + std::ptrdiff_t(b*width), from.begin() + std::ptrdiff_t((b + 1)*width));
    });
    return record;
}

/// The record of all with what a record of some bodies says; what that says of no body counts for all.
inline CouplingRecord recordWith(const std::vector<int>& bodies, const CouplingRecord& some, const CouplingRecord& all)
{
    CouplingRecord record = all;
    record.wallLoads = some.wallLoads;
    record.wallCounts = some.wallCounts;
    record.wallPeaks = some.wallPeaks;
    record.largestOverlap = some.largestOverlap;
    forEachList(record, some, [&](auto& list, const auto& from)
    {
        const std::size_t width = bodies.empty() ? 0 : from.size()/bodies.size();
        for (std::size_t k = 0; k < bodies.size(); ++k) std::copy_n(from.begin() + std::ptrdiff_t(k*width), width, list.begin() + std::ptrdiff_t(bodies[k]*width));
    });
    return record;
}

inline std::vector<double> numbersOf(const CouplingRecord& record)
{
    NumberWriter writer;
    passRecord(writer, record);
    return writer.numbers();
}

} // namespace flotsam
