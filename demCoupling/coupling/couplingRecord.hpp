// SPDX-License-Identifier: GPL-3.0-or-later
/// What a restart needs of the coupling besides the engine's own state.
#pragma once

#include "demCoupling/coupling/numberArchive.hpp"

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

inline std::vector<double> numbersOf(const CouplingRecord& record)
{
    NumberWriter writer;
    passRecord(writer, record);
    return writer.numbers();
}

} // namespace flotsam
