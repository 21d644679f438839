// SPDX-License-Identifier: GPL-3.0-or-later
/// The free solids' velocities as the last unknowns of the linear system: entries on rank 0, scaled by the diagonals; elsewhere nDof values
/// per solid (free or not), the same on every rank.
#pragma once

#include "algebra/flowSystem.hpp"
#include "algebra/halo.hpp"

#include <Eigen/Dense>

namespace flotsam
{

class SolidUnknowns
{
public:
    explicit SolidUnknowns(const Halo& halo) : halo_(halo) {}

    /// Collective.
    void set(const FlowSystem& system);

    bool isEmpty() const { return free_.empty(); }
    int nEntries() const { return int(scale_.size()); }         ///< of all free solids
    int nLocalEntries() const { return halo_.rank() == 0 ? nEntries() : 0; }
    const std::vector<int>& free() const { return free_; }      ///< solids whose velocity is unknown
    using Block = Eigen::Matrix<double, -1, -1, Eigen::ColMajor, 6, 6>;     ///< nDof*nDof, 6 at most: without memory from the heap
    const Block& block(int f) const { return block_[f]; }       ///< own mass and wall block of the f-th free solid
    double scale(int f, int d) const { return scale_[f*nDof_ + d]; }

    void readVelocity(const double* entries, std::vector<double>& q);           ///< collective
    void readRows(const double* entries, std::vector<double>& rows);            ///< collective
    void writeRows(const std::vector<double>& rows, double* entries) const;     ///< rank 0
    void writeVelocity(const std::vector<double>& q, double* entries) const;    ///< rank 0

    /// w = (solid's own mass and wall block)^-1 rows.
    void solve(const std::vector<double>& rows, std::vector<double>& w) const;
    void addInertia(const double* q, double* rows) const;

private:
    const std::vector<double>& broadcast(const double* entries);

    const Halo& halo_;
    const FlowSystem* system_ = nullptr;
    int nDof_ = 0;
    std::vector<int> free_;
    std::vector<Block> block_, inverse_;
    std::vector<double> scale_; // free*nDof
    std::vector<double> values_; // work: entries; in set() blocks
};

} // namespace flotsam
