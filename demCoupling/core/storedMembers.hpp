// SPDX-License-Identifier: GPL-3.0-or-later
/// Which of a run's structures, bodies and restraints the state knows that it goes on from. The others are new: they begin as a run begins.
#pragma once

#include <numeric>
#include <vector>

namespace flotsam
{

/// Numbers in the run, in the order of the state, rising.
struct StoredMembers
{
    std::vector<int> structures, bodies, restraints;

    static StoredMembers all(int nStructures, int nBodies, int nRestraints)
    {
        const auto upTo = [](int n)
        {
            std::vector<int> numbers(static_cast<std::size_t>(n));
            std::iota(numbers.begin(), numbers.end(), 0);
            return numbers;
        };
        return {upTo(nStructures), upTo(nBodies), upTo(nRestraints)};
    }

    /// In the list of structures, then bodies.
    std::vector<int> solids(int nStructures) const
    {
        std::vector<int> numbers = structures;
        for (const int b : bodies) numbers.push_back(nStructures + b);
        return numbers;
    }
};

/// Per number up to n: whether it is not in the list.
inline std::vector<char> areNew(const std::vector<int>& known, int n)
{
    std::vector<char> flags(static_cast<std::size_t>(n), 1);
    for (const int k : known) flags[static_cast<std::size_t>(k)] = 0;
    return flags;
}

} // namespace flotsam
