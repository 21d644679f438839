// SPDX-License-Identifier: GPL-3.0-or-later
/// Agreements between ranks about nodes that carry the same key (a number that means the same node on every rank).
#pragma once

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace flotsam
{

/// Collective. The owner of each of this rank's nodes: the lowest rank that lists its key. Keys: not negative, unique per rank.
std::vector<int> lowestRankOfKeys(const std::vector<std::int64_t>& keys, MPI_Comm comm);

/// Collective. Replaces keys by their position among all keys of all ranks: 0..n-1 without gaps, same order.
/// `ownKeys`: this rank's share (all ranks together: every key); `keys`: changed in place.
void compactKeys(const std::vector<std::int64_t>& ownKeys, std::vector<std::int64_t>& keys, MPI_Comm comm);

/// Keys with the local number of their node, for look-up by bisection.
class KeyTable
{
public:
    /// Adds nodes firstLocal, firstLocal+1, ... with these keys (none of them present already).
    void append(const std::vector<std::int64_t>& keys, int firstLocal);

    /// Local number of the node, -1 when absent.
    int find(std::int64_t key) const;

private:
    struct Entry
    {
        std::int64_t key;
        int local;
        bool operator<(const Entry& other) const { return key < other.key; }
    };
    std::vector<Entry> entries_; // ascending
};

} // namespace flotsam
