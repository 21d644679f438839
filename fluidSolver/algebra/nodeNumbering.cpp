// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/nodeNumbering.hpp"

#include "algebra/exchange.hpp"

#include <algorithm>
#include <bitset>

namespace flotsam
{
namespace
{

constexpr int wordBits = 64;

int countBits(std::uint64_t word)
{
    return static_cast<int>(std::bitset<wordBits>(word).count());
}

/// For each list of keys (one per asking rank): the lowest rank that lists the key.
std::vector<std::vector<int>> lowestAskers(const std::vector<std::vector<std::int64_t>>& asked)
{
    struct Item
    {
        std::int64_t key;
        int rank, position;
    };
    std::vector<Item> items;
    std::vector<std::vector<int>> answer(asked.size());
    for (std::size_t r = 0; r < asked.size(); ++r)
    {
        answer[r].resize(asked[r].size());
        for (std::size_t k = 0; k < asked[r].size(); ++k)
        {
            items.push_back({asked[r][k], static_cast<int>(r), static_cast<int>(k)});
        }
    }
    std::sort(items.begin(), items.end(),
        [](const Item& p, const Item& q) { return p.key != q.key ? p.key < q.key : p.rank < q.rank; });
    int lowest = -1;
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        lowest = i > 0 && items[i].key == items[i - 1].key ? lowest : items[i].rank;
        answer[items[i].rank][items[i].position] = lowest;
    }
    return answer;
}

} // namespace

std::vector<int> lowestRankOfKeys(const std::vector<std::int64_t>& keys, MPI_Comm comm)
{
    int size = 1;
    MPI_Comm_size(comm, &size);
    // the rank that knows about a key is found from the key alone
    std::vector<std::vector<std::int64_t>> questions(size);
    for (const std::int64_t key : keys)
    {
        questions[key % size].push_back(key);
    }
    const std::vector<std::vector<int>> answers = exchangeLists(lowestAskers(exchangeLists(questions, comm)), comm);
    std::vector<int> owner(keys.size()), next(size, 0);
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
        const int directory = static_cast<int>(keys[i] % size);
        owner[i] = answers[directory][next[directory]++];
    }
    return owner;
}

void compactKeys(const std::vector<std::int64_t>& ownKeys, std::vector<std::int64_t>& keys, MPI_Comm comm)
{
    std::int64_t highest = -1;
    for (const std::int64_t key : ownKeys)
    {
        highest = std::max(highest, key);
    }
    MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPI_INT64_T, MPI_MAX, comm);

    // one bit per possible key: 1 MB for eight million nodes
    std::vector<std::uint64_t> present(highest / wordBits + 1, 0);
    for (const std::int64_t key : ownKeys)
    {
        present[key / wordBits] |= std::uint64_t(1) << (key % wordBits);
    }
    MPI_Allreduce(MPI_IN_PLACE, present.data(), static_cast<int>(present.size()), MPI_UINT64_T, MPI_BOR, comm);

    std::vector<std::int64_t> before(present.size() + 1, 0);
    for (std::size_t w = 0; w < present.size(); ++w)
    {
        before[w + 1] = before[w] + countBits(present[w]);
    }
    for (std::int64_t& key : keys)
    {
        const std::uint64_t lowerBits = (std::uint64_t(1) << (key % wordBits)) - 1;
        key = before[key / wordBits] + countBits(present[key / wordBits] & lowerBits);
    }
}

void KeyTable::append(const std::vector<std::int64_t>& keys, int firstLocal)
{
    const auto middle = static_cast<std::ptrdiff_t>(entries_.size());
    entries_.reserve(entries_.size() + keys.size());
    for (const std::int64_t key : keys)
    {
        entries_.push_back({key, firstLocal++});
    }
    std::sort(entries_.begin() + middle, entries_.end());
    std::inplace_merge(entries_.begin(), entries_.begin() + middle, entries_.end());
}

int KeyTable::find(std::int64_t key) const
{
    const auto place = std::lower_bound(entries_.begin(), entries_.end(), Entry{key, -1});
    return place != entries_.end() && place->key == key ? place->local : -1;
}

} // namespace flotsam
