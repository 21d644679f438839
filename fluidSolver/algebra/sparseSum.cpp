// SPDX-License-Identifier: GPL-3.0-or-later
#include "algebra/sparseSum.hpp"

namespace flotsam
{

namespace
{

/// Stable, by key(entry) from 0 to n - 1: from[] in the new order into to[].
template<class Key>
void sortByCounting(int n, const std::vector<int>& from, const Key& key, std::vector<int>& next, std::vector<int>& to)
{
    next.assign(n + 1, 0);
    for (const int k : from) ++next[key(k) + 1];
    for (int i = 0; i < n; ++i) next[i + 1] += next[i];
    to.resize(from.size());
    for (const int k : from) to[next[key(k)]++] = k;
}

} // namespace

bool SparseSum::hasPlacesOf(const SparseEntries& entries) const
{
    if (entries.size() != place_.size()) return false;
    for (std::size_t k = 0; k < entries.size(); ++k)
        if (row_[place_[k]] != entries[k].row || column_[place_[k]] != entries[k].column) return false;
    return true;
}

void SparseSum::findPlaces(const SparseEntries& entries)
{
    order_.resize(entries.size());
    for (std::size_t k = 0; k < entries.size(); ++k) order_[k] = int(k);
    sortByCounting(nColumns_, order_, [&](int k) { return entries[k].column; }, next_, byColumn_);
    sortByCounting(nRows_, byColumn_, [&](int k) { return entries[k].row; }, next_, order_);
    start_.assign(nRows_ + 1, 0);
    place_.resize(entries.size());
    column_.clear();
    row_.clear();
    for (const int k : order_)
    {
        const SparseEntry& e = entries[k];
        if (column_.empty() || row_.back() != e.row || column_.back() != e.column)
        {
            row_.push_back(e.row);
            column_.push_back(e.column);
            ++start_[e.row + 1];
        }
        place_[k] = int(column_.size()) - 1;
    }
    for (int r = 0; r < nRows_; ++r) start_[r + 1] += start_[r];
}

void SparseSum::set(int nRows, int nColumns, const SparseEntries& entries)
{
    isNewPattern_ = nRows != nRows_ || nColumns != nColumns_ || !hasPlacesOf(entries);
    nRows_ = nRows;
    nColumns_ = nColumns;
    if (isNewPattern_) findPlaces(entries);
    value_.assign(column_.size(), 0.0);
    for (std::size_t k = 0; k < entries.size(); ++k) value_[place_[k]] += entries[k].value;
}

} // namespace flotsam
