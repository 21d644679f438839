// SPDX-License-Identifier: GPL-3.0-or-later
/// A small sparse matrix that is summed anew in every step, in memory that is kept. Its entries mostly come in the places and the order of the step before: where each goes is kept, too.
#pragma once

#include <vector>

namespace flotsam
{

struct SparseEntry { int row, column; double value; };
using SparseEntries = std::vector<SparseEntry>;

class SparseSum
{
public:
    /// Entries in one place are added up in their order.
    void set(int nRows, int nColumns, const SparseEntries& entries);

    int nRows() const { return nRows_; }
    int nPlaces() const { return int(column_.size()); }
    /// Whether the last set() has found other places than the one before.
    bool isNewPattern() const { return isNewPattern_; }
    /// Of a row: start()[r] to start()[r + 1] in column() and value(), columns ascending.
    const std::vector<int>& start() const { return start_; }
    const std::vector<int>& column() const { return column_; }
    const std::vector<double>& value() const { return value_; }

private:
    bool hasPlacesOf(const SparseEntries& entries) const;
    void findPlaces(const SparseEntries& entries);

    int nRows_ = 0, nColumns_ = 0;
    bool isNewPattern_ = true;
    std::vector<int> start_, column_;
    std::vector<double> value_;
    std::vector<int> place_;                // of each entry, in column() and value()
    std::vector<int> row_;                  // of each place
    std::vector<int> order_, byColumn_, next_;  // work
};

} // namespace flotsam
